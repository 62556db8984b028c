// Pulse outputs Q0.0 and Q0.1: PLS, SMB66–85 and SMB166–179, events 19 and 20 (facts 3.1, 4.5, 10.4).
//
//   SMB67, 77   .0 take cycle time  .1 take pulse width  .2 take pulse count  .3 ms instead of µs  .4 PWM: a change
//               waits for the end of the cycle  .5 PTO: a profile of several segments  .6 PWM instead of PTO  .7 enabled
//   SMB66, 76   .4 cycle time of the profile out of range  .5 profile ended by PLS  .6 pulse train overflow  .7 idle
//   SMW68, 78   cycle time      SMW70, 80   pulse width      SMD72, 82   pulse count
//
// A cycle time below 2 units counts as 2 units, a pulse count of 0 as 1. With a width of 0 the output stays off, with the
// whole cycle or more it stays on. PLS with .7 = 0 ends either at once (S7-200 manual C233-01, 9-50). PLS during a pulse
// train queues one more train; a further PLS sets the overflow bit and is ignored (9-52).
//
// A profile (.5, only on CPUs 22x) is a table in V memory: at the offset in SMW168, 178 the number of segments, then for
// each its first cycle time (word), by how much each of its cycles is longer (word, signed) and its number of pulses (double
// word). SMB166, 176 have the number of the segment in progress. Event 19 or 20 comes after the last one.
//
// Not documented, modelled so:
// - A segment is read when it begins. [PulseOutput.ASegmentIsReadWhenItBegins]
// - A cycle time out of range ends the profile without event. [PulseOutput.ACycleTimeOutOfRangeEndsTheProfile]
// - A profile that is not in V memory is error 0091, and nothing starts. [PulseOutput.AProfileOutsideVIs0091]
// - A pulse begins with its 1 half; if the cycle time is odd, the 1 half is the shorter one.
//   [PulseOutput.AnOddCycleHasItsShorterHalfFirst]
// - PLS during PWM takes effect at once and starts a new cycle, unless SM67.4 is 1, which a CPU 21x does not have.
//   [PulseOutput.PlsDuringPwmStartsANewCycleAtOnce]
// - After pulses have ended, their point follows its image again from the end of the scan.
//   [PulseOutput.PlsWithoutEnableEndsPulsesAtOnceAndThePointFollowsItsImageAgain]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::pulse_outputs {

/// PLS: starts the pulse train or PWM of Q0.0 or Q0.1 as its special memory says, or ends it.
void program(Core& core, std::uint8_t output);

/// Whether an output point shows pulses instead of its image.
bool drive(const Core& core, std::uint32_t byte, std::uint8_t bit);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);
void enter_stop(Core& core);
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace s7200::pulse_outputs
