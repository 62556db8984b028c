// Bodies: program control, interrupts, transmit (facts 6.12, 3.3, 2.2).
//
// Not documented, modelled so:
// - FOR and NEXT store INDX before they read FINAL, which may be the same word.
//   [Choices.ForAndNextStoreTheIndexBeforeTheyReadTheFinalValue]
// - NEXT follows the pointers of its FOR again, that of INIT too: a bad one is error 0006, and the loop is left.
//   [Choices.NextFollowsThePointersOfItsForAgain]
// - SCRT to the segment it stands in leaves that segment on. [Choices.ATransitionToItsOwnSegmentLeavesItOn]
// - In a segment that is off, NOT, EU and ED work on what they find: after NOT a box runs, and ED gives its pulse in the
// scan
//   that finds the segment off. [Segment.NotInASegmentThatIsOffGivesPowerFlow, Segment.EdSeesThatTheSegmentWentOff]
// - In a segment that is off, compare contacts still look at their operands: a bad one stops the CPU.
//   [Segment.ACompareContactInASegmentThatIsOffStillFollowsItsPointers]
// - A subroutine called from a segment has a power rail of its own. [Segment.ASubroutineHasARailOfItsOwn]
#pragma once

#include "interpreter/cpu/cpu.hpp"

namespace s7200::bodies {

inline void jump(Cpu& cpu, const Op& op) { cpu.jump(op.target); }

/// FOR INDX, INIT, FINAL: an initial value above the final one skips the loop.
inline void begin_loop(Cpu& cpu, const Op& op) {
  const auto initial = cpu.get<std::int16_t>(op[1]);
  cpu.put(op[0], initial);
  if (initial > cpu.get<std::int16_t>(op[2])) cpu.jump(op.target);
}

/// NEXT has the operands of its FOR. The index is left at the final value + 1, and the top of the stack at 1.
inline void next_pass(Cpu& cpu, const Op& op) {
  const auto index = cpu.get<std::int16_t>(op[0]);
  cpu.put(op[0], static_cast<std::uint16_t>(index + 1));
  cpu.s.stack.set_top(true);
  if (index < cpu.get<std::int16_t>(op[2])) cpu.jump(op.target);
}

/// LSCR loads the S bit into the SCR stack and the logic stack. The segment is not skipped while the bit is 0: its rail has
/// no power, so contacts give no power flow, coils become 0, TON is reset and boxes do nothing (facts 9.1).
inline void begin_segment(Cpu& cpu, const Op& op) {
  cpu.s.rail = cpu.bit(op[0]);
  cpu.s.stack.push(cpu.s.rail);
}

inline void end_segment(Cpu& cpu, const Op&) { cpu.s.rail = true; }

/// SCRT: the next segment's bit goes on, that of the enclosing LSCR (operand 2, given at load) off.
inline void segment_transition(Cpu& cpu, const Op& op) {
  cpu.put_bit(op[2].at, op[2].bit, false);
  cpu.put_bit(op[0].at, op[0].bit, true);
}

inline void call(Cpu& cpu, const Op& op) { cpu.call(op.target); }
inline void return_from_subroutine(Cpu& cpu, const Op&) { cpu.return_from_subroutine(); }
inline void return_from_interrupt(Cpu& cpu, const Op&) { cpu.return_from_interrupt(); }
inline void end_main_program(Cpu& cpu, const Op&) { cpu.end_main_program(); }
inline void stop(Cpu& cpu, const Op&) { cpu.stop(); }
inline void reset_watchdog(Cpu& cpu, const Op&) { cpu.reset_watchdog(); }

template <bool enabled>
void enable_interrupts(Cpu& cpu, const Op&) {
  cpu.enable_interrupts(enabled);
}

inline void attach(Cpu& cpu, const Op& op) {
  cpu.attach(static_cast<std::uint8_t>(op[1].at), static_cast<std::uint8_t>(op[0].at));
}
inline void detach(Cpu& cpu, const Op& op) { cpu.detach(static_cast<std::uint8_t>(op[0].at)); }

inline void transmit(Cpu& cpu, const Op& op) { cpu.transmit(op[0].at); }

}  // namespace s7200::bodies
