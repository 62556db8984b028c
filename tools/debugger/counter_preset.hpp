// What a counter counts to.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

/// `, preset 3`, of the first instruction in the program that counts with it, as its operand is now; nothing without one.
/// The CPU itself keeps only the count and the bit.
std::string counter_preset_text(const Cpu& cpu, std::uint32_t number);

}  // namespace s7200::tools
