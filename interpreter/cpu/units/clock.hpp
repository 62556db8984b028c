// The time-of-day clock: TODR and TODW (facts 6.11).
//
// Eight bytes of BCD: year, month, day, hour, minute, second, 0, day of the week (1 Sunday … 7 Saturday, 0 switched off).
// TODW does not check dates: the 30th of February is followed by the 1st of March.
// The clock runs on while power is off, as long as the capacitor lasts (facts 9.1). A clock that was lost starts at Sunday,
// 1 January 1990, 0:00:00 (A5E00066097-02, 9-72).
//
// Not documented, modelled so: TODW with a byte that is not BCD is error 0007 and leaves the clock alone.
// [Clock.BytesThatAreNotBcdAre0007AndLeaveTheClockAlone]
#pragma once

#include <array>

#include "interpreter/cpu/core.hpp"

namespace s7200::clock {

/// A CPU 212 has none.
inline constexpr CpuSet kCpusWithClock = kFrom214;

/// The eight bytes of TODR and TODW.
using Bcd = std::array<std::uint8_t, 8>;
Bcd bcd_now(const Core& core);
/// Whether each of them is a figure of a time. The day is 31 at most, whatever the month.
bool is_time(const Bcd& bytes);
/// Sets the clock. Returns false for a byte that is not BCD; the clock is left alone then.
bool set_bcd(Core& core, const Bcd& to);

void set(Core& core, const ClockTime& to);
ClockTime now(const Core& core);
/// The part of the clock's present second that has passed.
Time fraction(const Core& core);
/// The instant at which the clock changes next.
Time next_second(const Core& core);

/// TODR and TODW: `buffer` is the place of the eight bytes. Error 0091 if they run past the end of their area, 0007 if TODW
/// finds a byte that is not BCD.
void read(Core& core, std::uint32_t buffer);
void write(Core& core, std::uint32_t buffer);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);

}  // namespace s7200::clock
