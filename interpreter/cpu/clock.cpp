// The time-of-day clock: TODR and TODW (facts 6.11).
//
// Eight bytes of BCD: year, month, day, hour, minute, second, 0, day of the week (1 Sunday … 7 Saturday, 0 switched off).
// Dates are not checked by TODW: the 30th of February is followed by the 1st of March.
// The clock goes on while power is off, as long as the capacitor holds out (facts 9.1); one that was lost starts at 1
// January 1990, 0:00:00, Sunday (A5E00066097-02, 9-72).
//
// Not documented, modelled so: TODW with a byte that is not BCD is error 0007 and leaves the clock alone.
// [Clock.WhatIsNoBcdIs0007AndLeavesTheClockAlone]
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

constexpr std::uint32_t kBufferBytes = 8;

std::uint8_t to_bcd(std::uint8_t value) { return static_cast<std::uint8_t>(value / 10 << 4 | value % 10); }
std::uint8_t from_bcd(std::uint8_t bcd) { return static_cast<std::uint8_t>((bcd >> 4) * 10 + (bcd & 15)); }
bool is_bcd(std::uint8_t byte) { return (byte & 15) <= 9 && byte >> 4 <= 9; }

std::uint8_t days_in_month(const ClockTime& t) {
  static constexpr std::uint8_t kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (t.month == 2 && t.year % 4 == 0) return 29;
  return t.month >= 1 && t.month <= 12 ? kDays[t.month - 1] : 31;
}

void next_day(ClockTime& t) {
  if (t.weekday != 0) t.weekday = static_cast<std::uint8_t>(t.weekday % 7 + 1);
  if (t.day++ < days_in_month(t)) return;
  t.day = 1;
  if (t.month++ < 12) return;
  t.month = 1;
  t.year = static_cast<std::uint8_t>((t.year + 1) % 100);
}

ClockTime advanced(ClockTime t, std::int64_t seconds) {
  std::int64_t of_day = (t.hour * 60 + t.minute) * 60 + t.second + seconds;
  for (; of_day >= 86'400; of_day -= 86'400) next_day(t);
  t.hour = static_cast<std::uint8_t>(of_day / 3600);
  t.minute = static_cast<std::uint8_t>(of_day / 60 % 60);
  t.second = static_cast<std::uint8_t>(of_day % 60);
  return t;
}

}  // namespace

ClockTime clock_after(const ClockTime& from, Time time) { return advanced(from, time / kSecond); }

void Cpu::set_clock(const ClockTime& to) {
  s.clock = to;
  s.clock_set_at = s.time;
}

ClockTime Cpu::clock() const { return clock_after(s.clock, s.time - s.clock_set_at); }

void Cpu::read_clock(std::uint32_t buffer) {
  if (!in_area(buffer, kBufferBytes)) return run_error(RunError::OperandRange);
  const ClockTime t = clock();
  const std::uint8_t bytes[kBufferBytes] = {
      to_bcd(t.year), to_bcd(t.month), to_bcd(t.day), to_bcd(t.hour), to_bcd(t.minute), to_bcd(t.second), 0, t.weekday};
  std::copy_n(bytes, kBufferBytes, s.image.begin() + buffer);
}

void Cpu::write_clock(std::uint32_t buffer) {
  if (!in_area(buffer, kBufferBytes)) return run_error(RunError::OperandRange);
  const std::uint8_t* b = &s.image[buffer];
  if (!std::all_of(b, b + kBufferBytes, is_bcd)) return run_error(RunError::Clock);
  set_clock(
      {from_bcd(b[0]), from_bcd(b[1]), from_bcd(b[2]), from_bcd(b[3]), from_bcd(b[4]), from_bcd(b[5]), from_bcd(b[7])});
}

}  // namespace s7200
