// High-speed counters HSC0–HSC2: HDEF, HSC, SMB36–65, events 12–18 (facts 3.1, 4.5, 5.2).
//
// Modes: 0–2 direction by the control byte, 3–5 by an input, 6–8 separate up and down clocks, 9–11 two clocks 90° apart;
// the second of each group adds an external reset, the third reset and start. HSC0 has mode 0 only.
//
//   SMB37, 47, 57   .0 reset active low  .1 start active low  .2 quadrature counts once a period, else four times
//                   .3 up  .4 take direction  .5 take new preset  .6 take new current value  .7 enabled
//   SMB36, 46, 56   .5 counting up  .6 current = preset  .7 current > preset
//   SMD38, 48, 58   new current value      SMD42, 52, 62   new preset
//
// .0–.2 are taken by HDEF; .3 is the direction in modes 0–2 and the direction to begin with in the others (S7-200 manual
// C233-01, 9-38). All modes have the event of the preset, those with a reset input that of the reset, and all but 0–2 that
// of a change of direction (A5E00066097-02, 9-39). While start is not active, clocks and reset are ignored; a counter that
// is started during reset is cleared (the manual's chapter on the counters).
//
// Not documented, modelled so:
// - Loading a current value or a preset that makes the two equal is not the event of the preset.
//   [HighSpeedCounter.LoadingThePresetOrTheCurrentValueGivesNoEvent]
// - A counter that is started during reset gives the event of the reset.
//   [HighSpeedCounter.Mode2WithoutStartClocksAndResetAreIgnored]
// - In modes 3–5, HSC takes the level of the direction input for the direction to begin with.
//   [HighSpeedCounter.Modes3To5TakeTheirDirectionFromAnInputEvenBeforeItChanges]
// - One count a period (.2 = 1): the rising edge of clock A counts up and its falling edge down, both while B is 0.
//   [HighSpeedCounter.Modes9To11CountOnceAPeriodIfAsked]
// - In STOP the counters go on; their events are not taken. [HighSpeedCounter.InStopTheCounterGoesOnWithoutEvents]
// Not modelled: the highest frequency of the inputs (7 kHz, 2 kHz for HSC0). The counters follow every edge.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::high_speed_counters {

/// HDEF, once for each counter: mode 0 to 11, with bits .0–.2 of the control byte. Error 000A if the counter has a mode
/// already, 0003 if an interrupt is attached to one of its inputs.
void define(Core& core, std::uint8_t number, std::uint8_t mode);

/// HSC: takes over control byte, values and enable. Error 0001 before HDEF.
void program(Core& core, std::uint8_t number);

/// Whether the input of an edge event is taken by a counter: events 0 and 1 by HSC0.
bool use_event(const Core& core, std::uint8_t event);

// For the table of units.
void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at);

}  // namespace s7200::high_speed_counters
