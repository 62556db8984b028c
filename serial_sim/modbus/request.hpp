// Modbus RTU requests, their answers in words, and frames as people type them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/modbus/crc.hpp"

namespace s7200::modbus {

/// The functions of Application Tip 41.
enum class Function : std::uint8_t {
  ReadCoils = 1,
  ReadInputs = 2,
  ReadHoldingRegisters = 3,
  ReadInputRegisters = 4,
  WriteCoil = 5,
  WriteRegister = 6,
  WriteCoils = 15,
  WriteRegisters = 16,
};

inline constexpr std::size_t kLongestRtuFrame = 256;  // Modbus over Serial Line, 2.5.1
inline constexpr std::size_t kLongestRawFrame = 1024;

/// Protocol data units: function code and data. Addresses count from 0, as on the wire.
/// Counts are not checked against the protocol's limits, because tests of a slave exceed them on purpose.
Bytes read_coils(std::uint16_t first, std::uint16_t count);
Bytes read_inputs(std::uint16_t first, std::uint16_t count);
Bytes read_holding_registers(std::uint16_t first, std::uint16_t count);
Bytes read_input_registers(std::uint16_t first, std::uint16_t count);
Bytes write_coil(std::uint16_t address, bool on);
Bytes write_register(std::uint16_t address, std::uint16_t value);
Bytes write_coils(std::uint16_t first, const std::vector<bool>& on);
Bytes write_registers(std::uint16_t first, std::span<const std::uint16_t> values);

/// Station address, PDU, CRC.
Bytes rtu_frame(std::uint8_t station, std::span<const std::uint8_t> pdu);

/// What the answer says, in one line for people: `3 registers: 16#1234 16#0000 16#FFFF`, `coils 0…7: 1010 1010`,
/// `exception 2: illegal data address`, or what is wrong with it.
std::string describe(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response);

/// One character of a raw frame.
struct FrameCharacter {
  std::uint8_t byte = 0;
  bool wrong_parity = false;  ///< to be sent with its parity bit the wrong way round

  bool operator==(const FrameCharacter&) const = default;
};

using Frame = std::vector<FrameCharacter>;

Frame to_frame(std::span<const std::uint8_t> bytes);
Bytes bytes_of(std::span<const FrameCharacter> frame);

/// Appends the CRC of the frame's bytes.
void append_crc(Frame& frame);

/// Such a frame can only be sent in a format with parity.
bool has_wrong_parity(std::span<const FrameCharacter> frame);

struct FrameError {
  std::size_t column = 1;  ///< in the text, from 1
  std::string message;

  bool operator==(const FrameError&) const = default;
};

struct ParsedFrame {
  Frame frame;  ///< of use only if there are no errors
  std::vector<FrameError> errors;

  bool ok() const { return errors.empty(); }
};

/// Reads `01 03 00 0a`: two hex digits a byte in either case, blanks between bytes as you like, `p` behind a byte to send
/// it with wrong parity. From one to 1024 bytes.
ParsedFrame parse_hex_frame(std::string_view text);

/// `01 03 00 0a`
std::string to_hex(std::span<const std::uint8_t> bytes);

/// The same with its `p`, as parse_hex_frame reads it.
std::string to_hex(std::span<const FrameCharacter> frame);

}  // namespace s7200::modbus
