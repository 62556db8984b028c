// Bodies: program control, interrupts, transmit and receive (facts 6.12, 3.3, 2.2).
//
// Not documented, modelled so:
// - FOR and NEXT store INDX before they read FINAL, which may be the same word.
//   [Choices.ForAndNextStoreTheIndexBeforeTheyReadTheFinalValue]
// - NEXT follows the pointers of its FOR again, including that of INIT: a bad one is error 0006, and the loop ends.
//   [Choices.NextFollowsThePointersOfItsForAgain]
// - SCRT to the segment that it is in leaves that segment on. [Choices.ATransitionToItsOwnSegmentLeavesItOn]
// - In a segment that is off, NOT, EU and ED work on what they find: after NOT a box runs, and ED gives its pulse in the
//   scan that finds the segment off. [Segment.NotInASegmentThatIsOffGivesPowerFlow, Segment.EdSeesThatTheSegmentWentOff]
// - In a segment that is off, compare contacts still read their operands: a bad one stops the CPU.
//   [Segment.ACompareContactInASegmentThatIsOffStillFollowsItsPointers]
// - A subroutine called from a segment has its own power rail. [Segment.ASubroutineHasItsOwnRail]
#pragma once

#include "interpreter/cpu/core.hpp"
#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/network.hpp"
#include "interpreter/cpu/ports/freeport.hpp"
#include "interpreter/cpu/ports/message_receiver.hpp"
#include "interpreter/cpu/scan.hpp"

namespace s7200::bodies {

inline void jump(Core& core, const Op& op) { core.jump(op.target); }

/// FOR INDX, INIT, FINAL: an initial value above the final one skips the loop.
inline void begin_loop(Core& core, const Op& op) {
  const auto initial = core.get<std::int16_t>(op[1]);
  core.put(op[0], initial);
  if (initial > core.get<std::int16_t>(op[2])) core.jump(op.target);
}

/// NEXT has the operands of its FOR. The index is left at the final value + 1, and the top of the stack at 1.
inline void next_pass(Core& core, const Op& op) {
  const auto index = core.get<std::int16_t>(op[0]);
  core.put(op[0], static_cast<std::uint16_t>(index + 1));
  core.s.stack.set_top(true);
  if (index < core.get<std::int16_t>(op[2])) core.jump(op.target);
}

/// LSCR loads the S bit into the SCR stack and the logic stack. While the bit is 0 the segment is not skipped, but its rail
/// has no power: contacts give no power flow, coils become 0, TON is reset and boxes do nothing (facts 9.1).
inline void begin_segment(Core& core, const Op& op) {
  core.s.rail = core.bit(op[0]);
  core.s.stack.push(core.s.rail);
}

inline void end_segment(Core& core, const Op&) { core.s.rail = true; }

/// CSCRE goes to the SCRE of its segment; the S bit and the logic stack stay as they are.
/// Not documented, modelled so: that SCRE takes its time. [Vectors.CSCRE]
inline void leave_segment(Core& core, const Op& op) { core.jump(op.target); }

/// SCRT: switches the next segment's bit on and the bit of the enclosing LSCR (operand 2, added at load) off.
inline void segment_transition(Core& core, const Op& op) {
  core.put_bit(op[2].at, op[2].bit, false);
  core.put_bit(op[0].at, op[0].bit, true);
}

inline void call(Core& core, const Op& op) { scan::call(core, op.target); }
inline void return_from_subroutine(Core& core, const Op&) { scan::return_from_subroutine(core); }
inline void return_from_interrupt(Core& core, const Op&) { interrupts::return_from(core); }
inline void end_main_program(Core& core, const Op&) { scan::end_main_program(core); }
inline void stop(Core& core, const Op&) { scan::stop(core); }
inline void reset_watchdog(Core& core, const Op&) { scan::reset_watchdog(core); }

template <bool enabled>
void enable_interrupts(Core& core, const Op&) {
  interrupts::enable(core, enabled);
}

inline void attach(Core& core, const Op& op) {
  interrupts::attach(core, static_cast<std::uint8_t>(op[1].at), static_cast<std::uint8_t>(op[0].at));
}
inline void detach(Core& core, const Op& op) { interrupts::detach(core, static_cast<std::uint8_t>(op[0].at)); }

/// NETR and NETW; NETW takes time for each byte.
template <bool writes>
void use_network(Core& core, const Op& op) {
  core.spend(op, network::length_of(core, op[0].at));
  network::start(core, static_cast<std::uint8_t>(op[1].at), op[0].at, writes);
}

inline void transmit(Core& core, const Op& op) { freeport::transmit(core, static_cast<std::uint8_t>(op[1].at), op[0].at); }
inline void receive(Core& core, const Op& op) {
  message_receiver::receive(core, static_cast<std::uint8_t>(op[1].at), op[0].at);
}

}  // namespace s7200::bodies
