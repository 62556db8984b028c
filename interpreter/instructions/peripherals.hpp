// Bodies: clock, high-speed counters, pulse outputs (facts 6.11, 6.12). The work is in cpu/.
#pragma once

#include "interpreter/cpu/cpu.hpp"

namespace s7200::bodies {

inline void read_clock(Cpu& cpu, const Op& op) { cpu.read_clock(op[0].at); }
inline void write_clock(Cpu& cpu, const Op& op) { cpu.write_clock(op[0].at); }

inline void define_counter(Cpu& cpu, const Op& op) {
  cpu.define_counter(static_cast<std::uint8_t>(op[0].at), static_cast<std::uint8_t>(op[1].at));
}
inline void program_counter(Cpu& cpu, const Op& op) { cpu.program_counter(static_cast<std::uint8_t>(op[0].at)); }
inline void program_pulses(Cpu& cpu, const Op& op) { cpu.program_pulses(static_cast<std::uint8_t>(op[0].at)); }

}  // namespace s7200::bodies
