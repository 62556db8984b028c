// Broadcasts of Modbus RTU: all stations obey them, and none answers.
#pragma once

#include <cstdint>
#include <span>

#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/modbus/functions.hpp"

namespace s7200::tools {

inline bool is_broadcast(std::span<const std::uint8_t> frame) {
  return !frame.empty() && frame.front() == modbus::kBroadcast && modbus::crc_ok(frame);
}

}  // namespace s7200::tools
