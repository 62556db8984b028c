// High-speed counters: HDEF, HSC, SMB36–65 and SMB136–165, events 12–18 and 27–33 (facts 3.1, 4.5, 5.2, 10.4).
//
// Modes: 0–2 direction by the control byte, 3–5 by an input, 6–8 separate up and down clocks, 9–11 two clocks 90° apart;
// the second of each group adds an external reset, the third reset and start. In mode 12, on CPUs 22x of release 2, HSC0
// counts the pulses of PTO0 and HSC3 those of PTO1, without inputs; the control byte gives the direction (facts 10.4).
// Inputs and events of each counter: model/counters.hpp. The counters of a CPU and their modes: in its model.
//
//   SMB37 …   .0 reset active low  .1 start active low  .2 quadrature counts once a period, otherwise four times
//                   .3 up  .4 take direction  .5 take new preset  .6 take new current value  .7 enabled
//   SMB36 …   .5 counting up  .6 current = preset  .7 current > preset
//   SMD38 …   new current value      SMD42 …   new preset
//
// HDEF takes .0–.2; .3 is the direction in modes 0–2 and the initial direction in the others (S7-200 manual C233-01, 9-38).
// All modes have the preset event, those with a reset input have the reset event, and all but 0–2 have the event for a
// change of direction (A5E00066097-02, 9-39). While start is not active, clocks and reset are ignored; a counter that is
// started during reset is cleared (the manual's chapter on the counters).
//
// Not documented, modelled so:
// - Loading a current value or a preset that makes the two equal does not cause the preset event.
//   [HighSpeedCounter.LoadingThePresetOrTheCurrentValueGivesNoEvent]
// - A counter that is started during reset causes the reset event.
//   [HighSpeedCounter.Mode2WithoutStartClocksAndResetAreIgnored]
// - In modes 3–5, HSC takes the initial direction from the level of the direction input.
//   [HighSpeedCounter.Modes3To5TakeTheirDirectionFromAnInputEvenBeforeItChanges]
// - One count a period (.2 = 1): the rising edge of clock A counts up and its falling edge counts down, both while B is 0.
//   [HighSpeedCounter.Modes9To11CountOnceAPeriodIfAsked]
// - HDEF with an input that another counter uses is error 0003, and an interrupt is not attached to an edge of it: 0002.
//   [HighSpeedCounter.CountersDoNotShareAnInput]
// - In STOP the counters go on, but their events are ignored. [HighSpeedCounter.InStopTheCounterGoesOnWithoutEvents]
// - In mode 12 a pulse counts when it begins; the cycles of a PWM do not count.
//   [HighSpeedCounter.Mode12CountsThePulsesOfAnOutput]
// Not modelled: the highest frequency of the inputs (7 kHz, 2 kHz for HSC0). The counters follow every edge.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::high_speed_counters {

/// HDEF, once for each counter: mode 0 to 12, with bits .0–.2 of the control byte. Error 000A if the counter already has a
/// mode, 0003 if an interrupt is attached to one of its inputs or another counter uses one.
void define(Core& core, std::uint8_t number, std::uint8_t mode);

/// HSC: takes over the control byte, the values and enable. Error 0001 before HDEF.
void program(Core& core, std::uint8_t number);

/// A pulse of a PTO begins at Q0.0 or Q0.1.
void pulse_begins(Core& core, std::uint8_t output, Time at);

/// Whether a counter uses the input of an edge event.
bool use_event(const Core& core, std::uint8_t event);

// For the table of units.
void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at);

}  // namespace s7200::high_speed_counters
