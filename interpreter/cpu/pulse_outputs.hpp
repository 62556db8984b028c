// Pulse outputs Q0.0 and Q0.1: PLS, SMB66–85, events 19 and 20 (facts 3.1, 4.5).
//
//   SMB67, 77   .0 take cycle time  .1 take pulse width  .2 take pulse count  .3 ms instead of µs  .6 PWM instead of PTO
//               .7 enabled
//   SMB66, 76   .6 pulse train overflow  .7 pulse train idle
//   SMW68, 78   cycle time      SMW70, 80   pulse width      SMD72, 82   pulse count
//
// A cycle time below 2 units counts as 2 units, a pulse count of 0 as 1. A width of 0 is off, one of the whole cycle or more
// is on. PLS with .7 = 0 ends either at once (S7-200 manual C233-01, 9-50). PLS during a pulse train puts one more train in
// line; a further one sets the overflow bit and is not taken (9-52).
//
// Not documented, modelled so:
// - A pulse begins with its 1 half; an odd cycle time makes the 1 half the shorter one.
//   [PulseOutput.AnOddCycleHasItsShorterHalfFirst]
// - PLS during PWM takes effect at once, with the beginning of a cycle: a CPU 21x has no synchronous update (SM67.4).
//   [PulseOutput.PlsDuringPwmBeginsANewCycleAtOnce]
// - Once pulses have ended, their point follows its image from the end of the scan on.
//   [PulseOutput.PlsWithoutEnableEndsItAtOnceAndTheImageHasThePointAgain]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::pulse_outputs {

/// PLS: starts the pulse train or PWM of Q0.0 or Q0.1 as its special memory says, or ends it.
void program(Core& core, std::uint8_t output);

/// Whether pulses, and not the image, are what an output point shows.
bool drive(const Core& core, std::uint32_t byte, std::uint8_t bit);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);
void enter_stop(Core& core);
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace s7200::pulse_outputs
