#include "serial_sim/modbus/functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus {
namespace {

using F = Function;
using S = Shape;

// The limits keep a PDU within 253 bytes.
constexpr std::array kFunctions{
    FunctionRow{F::ReadCoils, "read coils", "coil", S::ReadBits, 2000, false},
    FunctionRow{F::ReadInputs, "read inputs", "input", S::ReadBits, 2000, false},
    FunctionRow{F::ReadHoldingRegisters, "read holding registers", "register", S::ReadRegisters, 125, false},
    FunctionRow{F::ReadInputRegisters, "read input registers", "register", S::ReadRegisters, 125, false},
    FunctionRow{F::WriteCoil, "write coil", "coil", S::WriteOne, 1, true},
    FunctionRow{F::WriteRegister, "write register", "register", S::WriteOne, 1, true},
    FunctionRow{F::ReadExceptionStatus, "read exception status", "status", S::Status, 1, false},
    FunctionRow{F::Diagnostics, "diagnostics", "subfunction", S::Diagnostics, 125, false},
    FunctionRow{F::WriteCoils, "write coils", "coil", S::WriteBits, 1968, true},
    FunctionRow{F::WriteRegisters, "write registers", "register", S::WriteRegisters, 123, true},
    FunctionRow{F::ReportSlaveId, "report slave id", "slave id", S::SlaveId, 1, false},
    FunctionRow{F::ReadFileRecord, "read file record", "reference", S::ReadFile, 245, false},
    FunctionRow{F::WriteFileRecord, "write file record", "reference", S::WriteFile, 251, true},
};

using A = DiagnosticRow::Answer;

constexpr std::array kDiagnostics{
    DiagnosticRow{0, "loopback", A::SameData},
    DiagnosticRow{1, "restart communications", A::SameData},
    DiagnosticRow{2, "diagnostic register", A::Value},
    DiagnosticRow{3, "change ASCII delimiter", A::SameData},
    DiagnosticRow{4, "force listen only mode", A::None},
    DiagnosticRow{10, "clear counters and diagnostic register", A::SameData},
    DiagnosticRow{11, "bus message count", A::Value},
    DiagnosticRow{12, "bus communication error count", A::Value},
    DiagnosticRow{13, "slave exception error count", A::Value},
    DiagnosticRow{14, "slave message count", A::Value},
    DiagnosticRow{15, "slave no response count", A::Value},
    DiagnosticRow{16, "slave NAK count", A::Value},
    DiagnosticRow{17, "slave busy count", A::Value},
    DiagnosticRow{18, "bus character overrun count", A::Value},
    DiagnosticRow{20, "clear overrun counter and flag", A::SameData},
};

struct ExceptionName {
  std::uint8_t code;
  std::string_view name;
};

constexpr std::array<ExceptionName, 10> kExceptionNames{{
    {1, "illegal function"},
    {2, "illegal data address"},
    {3, "illegal data value"},
    {4, "server device failure"},
    {5, "acknowledge"},
    {6, "server device busy"},
    {7, "negative acknowledge"},  // not in V1.1b3, but in the Modbus Protocol Reference Guide PI-MBUS-300
    {8, "memory parity error"},
    {10, "gateway path unavailable"},
    {11, "gateway target device failed to respond"},
}};

std::string function_text(const FunctionRow& row) {
  return fmt::format("function {} ({})", static_cast<int>(row.function), row.name);
}

std::string wrong_range(const FunctionRow& row, std::span<const std::uint8_t> data) {
  const unsigned first = load16(&data[0]), count = row.shape == Shape::WriteOne ? 1 : load16(&data[2]);
  if (count == 0 || count > row.most)
    return fmt::format("{} {}s in one request: {} takes 1 to {}", count, row.object, function_text(row), row.most);
  constexpr unsigned kAddresses = 65536;
  if (first + count > kAddresses)
    return fmt::format("{}s {} to {}: the last is {}", row.object, first, first + count - 1, kAddresses - 1);
  return {};
}

std::string wrong_file(const FunctionRow& row, std::span<const std::uint8_t> data) {
  constexpr std::size_t kReference = 7;
  constexpr unsigned kRecords = 10000;
  if (data.size() - 1 > row.most)
    return fmt::format("{} bytes of references in one request: {} takes up to {}", data.size() - 1, function_text(row),
                       row.most);
  std::size_t answer = 0;
  for (std::size_t place = 1; place + kReference <= data.size();) {
    if (data[place] != kFileReference) return {};  // the makers' own kinds have limits of their own
    const unsigned file = load16(&data[place + 1]), record = load16(&data[place + 3]), count = load16(&data[place + 5]);
    if (file == 0) return "files are counted from 1";
    if (count == 0) return "0 registers of a file: a reference takes at least 1";
    if (record + count > kRecords)
      return fmt::format("records {} to {} of file {}: the last is {}", record, record + count - 1, file, kRecords - 1);
    answer += 2 + 2 * std::size_t{count};
    place += kReference + (row.shape == Shape::WriteFile ? 2 * std::size_t{count} : 0);
  }
  if (row.shape == Shape::ReadFile && answer > row.most)
    return fmt::format("the answer would have {} bytes of data: {} allows {}", answer, function_text(row), row.most);
  return {};
}

}  // namespace

std::span<const FunctionRow> functions() { return kFunctions; }

const FunctionRow* find_function(std::uint8_t number) {
  const auto row = std::find_if(kFunctions.begin(), kFunctions.end(),
                                [number](const FunctionRow& r) { return static_cast<std::uint8_t>(r.function) == number; });
  return row == kFunctions.end() ? nullptr : &*row;
}

std::span<const DiagnosticRow> diagnostics_subfunctions() { return kDiagnostics; }

const DiagnosticRow* find_diagnostics_subfunction(std::uint16_t subfunction) {
  const auto row = std::find_if(kDiagnostics.begin(), kDiagnostics.end(),
                                [subfunction](const DiagnosticRow& r) { return r.subfunction == subfunction; });
  return row == kDiagnostics.end() ? nullptr : &*row;
}

std::string_view exception_name(std::uint16_t code) {
  const auto known = std::find_if(kExceptionNames.begin(), kExceptionNames.end(),
                                  [code](const ExceptionName& e) { return e.code == code; });
  return known == kExceptionNames.end() ? "unknown code" : known->name;
}

std::string beyond_limits(std::span<const std::uint8_t> pdu) {
  const FunctionRow* row = pdu.empty() ? nullptr : find_function(pdu[0]);
  if (row == nullptr) return {};
  const auto data = pdu.subspan(1);
  switch (row->shape) {
    case Shape::ReadBits:
    case Shape::ReadRegisters:
    case Shape::WriteOne:
    case Shape::WriteBits:
    case Shape::WriteRegisters:
      return data.size() < 4 ? std::string() : wrong_range(*row, data);
    case Shape::Diagnostics:
      if (data.size() > 2 + 2 * std::size_t{row->most})
        return fmt::format("{} bytes of data: {} takes up to {}", data.size() - 2, function_text(*row), 2 * row->most);
      return {};
    case Shape::ReadFile:
    case Shape::WriteFile:
      return data.empty() ? std::string() : wrong_file(*row, data);
    case Shape::Status:
    case Shape::SlaveId:
      return {};
  }
  return {};
}

}  // namespace s7200::modbus
