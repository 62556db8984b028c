// Bodies: clock, high-speed counters, pulse outputs (facts 6.11, 6.12). The work is in cpu/.
#pragma once

#include "interpreter/cpu/clock.hpp"
#include "interpreter/cpu/core.hpp"
#include "interpreter/cpu/high_speed_counters.hpp"
#include "interpreter/cpu/pulse_outputs.hpp"

namespace s7200::bodies {

inline void read_clock(Core& core, const Op& op) { clock::read(core, op[0].at); }
inline void write_clock(Core& core, const Op& op) { clock::write(core, op[0].at); }

inline void define_counter(Core& core, const Op& op) {
  high_speed_counters::define(core, static_cast<std::uint8_t>(op[0].at), static_cast<std::uint8_t>(op[1].at));
}
inline void program_counter(Core& core, const Op& op) {
  high_speed_counters::program(core, static_cast<std::uint8_t>(op[0].at));
}
inline void program_pulses(Core& core, const Op& op) { pulse_outputs::program(core, static_cast<std::uint8_t>(op[0].at)); }

}  // namespace s7200::bodies
