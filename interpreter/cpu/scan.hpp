// The scan: read inputs, execute the program, communication, self-test, write outputs (S7-200 manual C230-02, 6-10). How a
// program gets into RUN and STOP, into subroutines and to its end.
//
// Not documented, modelled so:
// - The four parts of the scan that are not the program take a quarter of the scan overhead each.
//   [ScanCycle.InputsAreReadBeforeAndOutputsWrittenAfterTheProgram]
// - SM0.4 and SM0.5 start with their 1 half at power-up.
//   [ScanCycle.TheClockOfHalfASecondChangesAtScanEnds, ScanCycle.TheClockOfHalfAMinuteChangesAtScanEnds]
// - SM0.6 is 0 in the first scan. [ScanCycle.SM06IsZeroInTheFirstScanAndThenAlternates]
// - SMW22, SMW24 and SMW26 drop fractions of a millisecond and stop at 65535 ms.
//   [ScanCycle.LastShortestAndLongestScanInWholeMilliseconds, ScanCycle.AScanLongerThanAWordCanSayIs65535]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::scan {

void enter_run(Core& core);
/// At once, from anywhere: interrupts are disabled, pulses end, and the output points go off.
void enter_stop(Core& core);

/// A scan starts; in RUN it is watched for the time the model allows.
void begin(Core& core);
/// Goes through the parts of the scan that are not the program, as far as the loop's `until`.
void advance(Core& core);

/// END and MEND.
void end_main_program(Core& core);
/// STOP: at once in the program; in an interrupt routine it ends the routine, drops what waits, and the scan is still
/// completed (facts 4.6).
void stop(Core& core);
/// WDR: the scan may take as long again from here.
void reset_watchdog(Core& core);

/// CALL: `target` is the first op of the subroutine. Error 0008 for one that is nested deeper than the model allows.
void call(Core& core, std::uint32_t target);
/// RET and CRET.
void return_from_subroutine(Core& core);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);

}  // namespace s7200::scan
