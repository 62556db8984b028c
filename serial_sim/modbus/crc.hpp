// The checksum at the end of a Modbus RTU frame.
#pragma once

#include <cstdint>
#include <span>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/line/crc16.hpp"

namespace s7200::modbus {

using serial::Crc;
using serial::crc16;

/// Appends the CRC of `bytes`, low byte first.
void add_crc(Bytes& bytes);

/// Whether the last two bytes are the CRC of those before. Never true of fewer than three bytes.
bool crc_ok(std::span<const std::uint8_t> bytes);

}  // namespace s7200::modbus
