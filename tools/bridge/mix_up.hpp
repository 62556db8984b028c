// Bytes from outside that are right, but not for this line: the note that says so.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "interpreter/cpu/state.hpp"

namespace s7200::tools {

/// The likely mistake behind what comes in one piece: a request of Modbus TCP, one of Modbus RTU that lacks its CRC, a frame
/// of PPI for a port in Freeport mode. `state` is that of the PLC at this end of the line, with its port; null if there is
/// none. Empty if it is none of these mistakes.
std::string mix_up(std::span<const std::uint8_t> bytes, const State* state, std::size_t port);

/// Whether the PLC has a frame of its own on the line: what a master says then collides with it.
bool is_sending(const State& state, std::size_t port);

}  // namespace s7200::tools
