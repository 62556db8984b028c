// The time-of-day clock: TODR and TODW (facts 6.11).
//
// Eight bytes of BCD: year, month, day, hour, minute, second, 0, day of the week (1 Sunday … 7 Saturday, 0 switched off).
// Dates are not checked by TODW: the 30th of February is followed by the 1st of March.
// The clock goes on while power is off, as long as the capacitor holds out (facts 9.1); one that was lost starts at 1
// January 1990, 0:00:00, Sunday (A5E00066097-02, 9-72).
//
// Not documented, modelled so: TODW with a byte that is not BCD is error 0007 and leaves the clock alone.
// [Clock.WhatIsNoBcdIs0007AndLeavesTheClockAlone]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::clock {

void set(Core& core, const ClockTime& to);
ClockTime now(const Core& core);

/// TODR and TODW: `buffer` is the place of the eight bytes. Error 0091 if they leave their area, 0007 if TODW finds no BCD.
void read(Core& core, std::uint32_t buffer);
void write(Core& core, std::uint32_t buffer);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);

}  // namespace s7200::clock
