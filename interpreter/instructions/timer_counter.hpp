// Bodies: timers and counters (facts 6.4). Operand 2, added at load, is the number of the timer or counter.
//
// A 10 ms timer enabled in the middle of a scan gets all ticks since the start of that scan: a timed interval may be up to
// 10 ms short (S7-200 manual C230-02, 10-15).
//
// Not documented, modelled so:
// - The execution that enables a timer adds no ticks; later ones do.
//   [Timer.HundredMillisecondTimersCountWhenTheyAreExecuted]
// - The execution that enables a TON writes 0 to its current value. [Timer.TheExecutionThatEnablesATonWritesZeroToItsValue]
// - A timer's preset is the one that its last execution found. [Choices.ATimersPresetIsTheOneItsLastExecutionFound]
// - The input of a TOF that is on at its first execution after it was off, or at power-up, puts its bit on; only a change to
//   off starts it. A preset of 0 or less puts the bit off at once. [Vectors.TOF]
// - A TOF writes its bit whenever it is executed, whatever else has written it. [Timer22x.ATofWritesItsBitAtEveryExecution]
// - A TOF in a segment that is off has its value at 0 and its bit off. [Vectors.TOF]
// - CTD counts down to 0 and no further; its bit is on at 0 and below. A counter input that is 1 at the first execution is
//   not a rising edge either. [Vectors.CTD]
// - CTU and CTUD pop their extra inputs, so one level remains. [Vectors.CTU, Vectors.CTUD]
// - A counter input that is 1 at the first execution after power-up is not a rising edge.
//   [Counter.CtuCountsRisingEdgesUpTo32767AndItsResetHolds]
// - A CTUD whose two inputs rise in the same execution keeps its value. [Vectors.CTUD]
#pragma once

#include <algorithm>

#include "interpreter/cpu/core.hpp"
#include "interpreter/cpu/units/timers.hpp"

namespace s7200::bodies {

template <bool retentive>
void time_on(Core& core, const Op& op) {
  timers::execute(core, op[2].at, core.s.stack.top(), core.get<std::int16_t>(op[1]), retentive);
}

/// TOF: the rail of its segment decides whether a missing input is an off input.
inline void time_off(Core& core, const Op& op) {
  timers::execute_off_delay(core, op[2].at, core.s.stack.top(), core.get<std::int16_t>(op[1]),
                            !op.in_segment || core.s.rail);
}

inline constexpr std::uint8_t kUpEdge = 1, kDownEdge = 2;

/// Whether an input rose since the counter's last execution.
inline bool rose(std::uint8_t& memory, std::uint8_t edge, bool input) {
  const bool before = memory & edge;
  memory = static_cast<std::uint8_t>(input ? memory | edge : memory & ~edge);
  return input && !before;
}

inline void set_counter(Core& core, const Op& op, std::int16_t current, bool reset) {
  const auto preset = core.get<std::int16_t>(op[1]);  // first, because it may be this counter's own value
  if (reset) current = 0;
  core.put(op[0], current);
  const bool reached = !reset && current >= preset;
  core.put_bit(image::kCBits + op[2].at / 8, static_cast<std::uint8_t>(op[2].at % 8), reached);
}

/// CTU: S1 counts up, S0 resets.
inline void count_up(Core& core, const Op& op) {
  const bool reset = core.s.stack.top();
  core.s.stack.pop();
  const bool up = rose(core.s.counter_inputs[op[2].at], kUpEdge, core.s.stack.top());
  const auto current = core.get<std::int16_t>(op[0]);
  set_counter(core, op, static_cast<std::int16_t>(up && current < 32767 ? current + 1 : current), reset);
}

/// CTD: S1 counts down, S0 loads the preset.
inline void count_down(Core& core, const Op& op) {
  const bool load = core.s.stack.top();
  core.s.stack.pop();
  const bool down = rose(core.s.counter_inputs[op[2].at], kDownEdge, core.s.stack.top());
  const auto preset = core.get<std::int16_t>(op[1]), before = core.get<std::int16_t>(op[0]);
  const auto current = load ? preset : static_cast<std::int16_t>(down && before > 0 ? before - 1 : before);
  core.put(op[0], current);
  core.put_bit(image::kCBits + op[2].at / 8, static_cast<std::uint8_t>(op[2].at % 8), !load && current <= 0);
}

/// CTUD: S2 counts up, S1 down, S0 resets; the value wraps.
inline void count_up_down(Core& core, const Op& op) {
  const bool reset = core.s.stack.top();
  core.s.stack.pop();
  const bool down = rose(core.s.counter_inputs[op[2].at], kDownEdge, core.s.stack.top());
  core.s.stack.pop();
  const bool up = rose(core.s.counter_inputs[op[2].at], kUpEdge, core.s.stack.top());
  const int step = (up ? 1 : 0) - (down ? 1 : 0);
  set_counter(core, op, static_cast<std::int16_t>(core.get<std::int16_t>(op[0]) + step), reset);
}

}  // namespace s7200::bodies
