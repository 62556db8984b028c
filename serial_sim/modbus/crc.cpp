#include "serial_sim/modbus/crc.hpp"

namespace s7200::modbus {

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  Crc crc;
  for (const std::uint8_t byte : bytes) crc.take(byte);
  return crc.value();
}

void add_crc(Bytes& bytes) {
  const std::uint16_t crc = crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
}

bool crc_ok(std::span<const std::uint8_t> bytes) {
  // A frame followed by its own CRC leaves nothing.
  return bytes.size() > 2 && crc16(bytes) == 0;
}

}  // namespace s7200::modbus
