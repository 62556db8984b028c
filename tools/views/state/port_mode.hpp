// The mode of a CPU's port, in words.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

/// Why a port is not in Freeport mode: `the program has not switched port 0 to Freeport mode (SMB30 = 16#00)`; empty if it
/// is.
std::string why_no_freeport(const Cpu& cpu, std::uint8_t port);

}  // namespace s7200::tools
