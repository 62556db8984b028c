// What belongs to a timer or counter besides its current value.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

/// `bit 1, preset 5, counts 100 ms`, `mode 0, preset 100, up, not enabled`; empty for other areas. The preset of a counter
/// is that of the first instruction in the program that counts with it, as its operand is now: the CPU itself keeps only
/// the count and the bit.
std::string element_text(const Cpu& cpu, Area area, std::uint32_t number);

}  // namespace s7200::tools
