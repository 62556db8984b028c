// The scan: read inputs, execute the program, communication, self-test, write outputs (S7-200 manual C230-02, 6-10). Also
// the changes to RUN and STOP, and calls, returns and the end of the program.
//
// Not documented, modelled so:
// - The four parts of the scan other than the program each take a quarter of the scan overhead.
//   [ScanCycle.InputsAreReadBeforeAndOutputsWrittenAfterTheProgram]
// - SM0.4 and SM0.5 start with their 1 half at power-up.
//   [ScanCycle.TheHalfSecondClockChangesAtScanEnds, ScanCycle.TheHalfMinuteClockChangesAtScanEnds]
// - SM0.6 is 0 in the first scan. [ScanCycle.SM06IsZeroInTheFirstScanAndThenAlternates]
// - SMW22, SMW24 and SMW26 drop fractions of a millisecond and stop at 65535 ms.
//   [ScanCycle.LastShortestAndLongestScanInWholeMilliseconds, ScanCycle.AScanTooLongForAWordIs65535]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::scan {

/// Changes the mode as a programming device asks for it; nothing happens if the CPU is in that mode already.
void change_mode(Core& core, Mode wanted);

void enter_run(Core& core);
/// Enters STOP at once, from anywhere: disables interrupts, ends pulses, and switches the output points off.
void enter_stop(Core& core);

/// Starts a scan; in RUN the watchdog allows it the time of the model.
void begin(Core& core);
/// Goes through the parts of the scan other than the program, up to the loop's `until`.
void advance(Core& core);

/// Moves on, by that time, what goes on by itself over scans that are all alike.
void pass(const Core& core, State& s, Time by);
/// So many scans have ended, the last one at `at`: one that is under way, and others that have taken `each`.
void end_alike(const Core& core, State& s, Time scans, Time at, Time each);

/// END and MEND.
void end_main_program(Core& core);
/// STOP: at once in the program. In an interrupt routine it ends the routine and drops waiting interrupts, and the scan is
/// still completed (facts 4.6).
void stop(Core& core);
/// WDR: restarts the watchdog.
void reset_watchdog(Core& core);

/// CALL: `target` is the first op of the subroutine. False after error 0008, if it is nested deeper than the model allows.
bool call(Core& core, std::uint32_t target);
/// RET and CRET.
void return_from_subroutine(Core& core);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);

}  // namespace s7200::scan
