// Timers of 1, 10 and 100 ms (facts 6.4): what adds the ticks, and when (S7-200 manual C230-02, 10-14 and 10-15).
// Not documented, modelled so: timers do not count in STOP, and go on in RUN from the value they have.
// [Timer.InStopTimersDoNotCount, Timer.AfterAStopTimersGoOnFromTheirValue]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::timers {

/// TON, or TONR if `retentive`. `preset` is in ticks of the timer's time base.
void execute(Core& core, std::uint32_t number, bool enabled, std::int16_t preset, bool retentive);

/// TOF. `powered`: not in a segment that is off, where a TOF is reset instead of timing.
void execute_off_delay(Core& core, std::uint32_t number, bool input, std::int16_t preset, bool powered);

/// R on `count` timers or counters: their current values become 0. A timer of 1 or 10 ms then stops until its instruction is
/// executed with power flow again; a timer of 100 ms counts in its instruction, so it goes on (S7-200 manual C230-02, 10-14
/// and 10-15). A TOF starts again when its input goes off again.
void clear_current_values(Core& core, const Operand& first, std::uint32_t count);

// Over scans that are all alike.

/// The instant at which the timers next change something that the program looks at; kNever if none does.
Time next_change(const Core& core);
/// Whether any timer counts.
bool any_counts(const Core& core);
void move_on(const Core& core, State& s, Time by, Time last_scan);
/// Moves the timers on. `last_scan`: from the begin of the program in one scan to that in the last.
inline void pass(const Core& core, State& s, Time by, Time last_scan) {
  if (core.program().uses_timers) move_on(core, s, by, last_scan);
}

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);
void enter_run(Core& core);
void enter_stop(Core& core);
void count_scan(Core& core);
/// 10 ms timers stay the same during a scan; 100 ms timers add the ticks of the previous scan when they are executed.
inline void begin_scan(Core& core) {
  if (core.program().uses_timers) count_scan(core);
}
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace s7200::timers
