// The functions of Modbus that this project speaks: one table. Modbus Application Protocol V1.1b3, section 6.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace s7200::modbus {

enum class Function : std::uint8_t {
  ReadCoils = 1,
  ReadInputs = 2,
  ReadHoldingRegisters = 3,
  ReadInputRegisters = 4,
  WriteCoil = 5,
  WriteRegister = 6,
  ReadExceptionStatus = 7,
  Diagnostics = 8,
  WriteCoils = 15,
  WriteRegisters = 16,
  ReportSlaveId = 17,
  ReadFileRecord = 20,
  WriteFileRecord = 21,
};

/// The data that a request carries and its answer brings.
enum class Shape : std::uint8_t {
  ReadBits,        ///< address, count; a byte count and bits, lowest first
  ReadRegisters,   ///< address, count; a byte count and registers, high byte first
  WriteOne,        ///< address, value; the same
  WriteBits,       ///< address, count, byte count, bits; address and count
  WriteRegisters,  ///< address, count, byte count, registers; address and count
  Status,          ///< nothing; a byte
  Diagnostics,     ///< subfunction, data; the subfunction, the same data or a counter
  SlaveId,         ///< nothing; a byte count and that many bytes
  ReadFile,        ///< a byte count and references; what they refer to
  WriteFile,       ///< a byte count and references with their data; the same
};

struct FunctionRow {
  Function function;
  std::string_view name;    ///< `read coils`
  std::string_view object;  ///< what it is about, in the singular: `coil`
  Shape shape;
  std::uint16_t most;  ///< objects in one request; for files, bytes in the request's PDU after its byte count
  bool broadcast;      ///< may go to all stations at once: what it does needs no answer
};

/// The Modbus functions in the order of their numbers.
std::span<const FunctionRow> functions();

/// Returns null if the function is not in the table.
const FunctionRow* find_function(std::uint8_t number);

/// A subfunction of function 8 and what it does.
struct DiagnosticRow {
  std::uint16_t subfunction;
  std::string_view name;
  enum class Answer : std::uint8_t { SameData, Value, None } answer;
};

std::span<const DiagnosticRow> diagnostics_subfunctions();
const DiagnosticRow* find_diagnostics_subfunction(std::uint16_t subfunction);

/// The name of an exception: `illegal data address`; `unknown code` for one that the specification (section 7) does not
/// know.
std::string_view exception_name(std::uint16_t code);

inline constexpr std::uint8_t kExceptionFlag = 0x80;  ///< in the function code of an exception
inline constexpr std::uint8_t kBroadcast = 0;         ///< station address of all stations; none of them answers
inline constexpr std::uint8_t kLastStation = 247;     ///< Modbus over Serial Line V1.02, 2.2
inline constexpr std::size_t kLongestRtuFrame = 256;  ///< Modbus over Serial Line V1.02, 2.5.1

/// How a request (function code and data) exceeds the limits of the specification, for people: `126 registers in one
/// request: function 3 (read holding registers) takes 1 to 125`. Empty when it does not, and for functions that are not in
/// the table.
std::string beyond_limits(std::span<const std::uint8_t> pdu);

}  // namespace s7200::modbus
