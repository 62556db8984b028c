// The checksum of Modbus RTU and of other protocols on such lines.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace s7200::serial {

/// The effect of one byte on the CRC: polynomial x^16 + x^15 + x^2 + 1, least significant bit first (Modbus over Serial
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

/// The CRC of a stream, byte by byte.
class Crc {
 public:
  void take(std::uint8_t byte) { value_ = static_cast<std::uint16_t>(value_ >> 8 ^ kCrcTable[(value_ ^ byte) & 0xFF]); }
  std::uint16_t value() const { return value_; }
  /// Whether the last two bytes were the CRC of the bytes before them: then the remainder is 0.
  bool is_at_its_end() const { return value_ == 0; }

 private:
  std::uint16_t value_ = 0xFFFF;
};

/// The CRC of all bytes in front of it; it is sent low byte first.
inline std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  Crc crc;
  for (const std::uint8_t byte : bytes) crc.take(byte);
  return crc.value();
}

}  // namespace s7200::serial
