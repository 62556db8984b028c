// The instructions that write a bit, several in a scan: its value in between is not what the outputs get.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

/// The instructions of the main program and its subroutines that write a bit if they are executed, in the order of the
/// program; not those that go through a pointer. SCRT is none: it switches a step on or off for good.
std::vector<std::uint32_t> coils_of(const Cpu& cpu, const Bits& bit);

/// Those of them that may still be executed in the scan in which the CPU stands, if others have been passed. Empty if the
/// bit has its value of this scan, or still that of the last one.
std::vector<std::uint32_t> coils_to_come(const Cpu& cpu, const Bits& bit);

}  // namespace s7200::tools
