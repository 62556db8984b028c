// Interrupts: attaching, queues, priority, entry and return (S7-200 manual C230-02, 10-120; facts 3); timed interrupts.
//
// Not documented, modelled so:
// - An interrupt routine starts with 1 on top of the logic stack, as a subroutine does.
//   [Choices.AnInterruptRoutineStartsWithTheTopOfTheStackAtOne]
// - DTCH drops the queued interrupts of its event. ATCH keeps them; the routine that is attached when they are served runs.
//   [Interrupt.DtchDropsWhatItsEventHasQueuedAndNothingElse, Interrupt.TheRoutineAttachedLastServesWhatWaits]
// - A timed interrupt with an interval of 0, or below the shortest one of the CPU, gets the shortest one.
//   [TimedInterrupt.ShorterThan5MillisecondsAndZeroAre5]
// - Timed interrupts count whole milliseconds from the end of ATCH, not ticks of a clock of their own.
//   [TimedInterrupt.AnotherAtchStartsAgainWithTheNewPeriod]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::interrupts {

/// ATCH. Events 10 and 11 take their interval from SMB34 or SMB35, in milliseconds, and start at the end of ATCH. Error 0002
/// for an input that a high-speed counter uses.
void attach(Core& core, std::uint8_t event, std::uint8_t routine);

/// DTCH: from now on the event is ignored.
void detach(Core& core, std::uint8_t event);

/// ENI and DISI, shown in SM4.4.
void enable(Core& core, bool enabled);

/// An event has occurred: it waits in its queue or, if the queue is full, is lost and sets the queue's bit in SM4.0–SM4.2.
/// Does nothing if the event is not attached. A port's receive event brings its character.
void occurred(Core& core, std::uint8_t event, Time at, std::uint8_t byte = 0, bool parity_error = false);

/// Whether an interrupt must be taken before the next instruction.
inline bool due(const Core& core) { return core.s.waiting != 0 && core.s.interrupts_enabled && !core.s.in_interrupt; }
/// Starts the routine of the first interrupt in the queue of highest priority that is not empty.
void take(Core& core);
/// RETI and CRETI.
void return_from(Core& core);

/// Drops all waiting interrupts and disables interrupts.
void drop_all(Core& core);

// For the table of units.
void enter_stop(Core& core);
void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at);
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace s7200::interrupts
