// The checksum of Modbus RTU and of other protocols on such lines.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace s7200::serial {

/// What one byte does to the CRC: polynomial x^16 + x^15 + x^2 + 1, least significant bit first (Modbus over Serial
/// Line, 6.2.2).
inline constexpr std::array<std::uint16_t, 256> kCrcTable = [] {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    unsigned crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xA001U : crc >> 1;
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}();

/// Of all bytes in front of it; it is sent low byte first.
inline std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = static_cast<std::uint16_t>(crc >> 8 ^ kCrcTable[(crc ^ byte) & 0xFF]);
  return crc;
}

}  // namespace s7200::serial
