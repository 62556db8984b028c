#include "interpreter/cpu/units/clock.hpp"

#include <algorithm>
#include <chrono>

namespace s7200::clock {
namespace {

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

std::chrono::year_month_day date_of(const ClockTime& t) {
  return {std::chrono::year(2000 + t.year), std::chrono::month(t.month), std::chrono::day(t.day)};
}

/// This goes on from a date of the calendar. A century of the clock is always that from 2000 to 2099, in which each fourth
/// year leaps.
void add_days(ClockTime& t, std::int64_t count) {
  using namespace std::chrono;
  constexpr sys_days kBegin = 2000y / January / 1, kEnd = 2100y / January / 1;
  const year_month_day date = kBegin + (sys_days(date_of(t)) - kBegin + days(count)) % (kEnd - kBegin);
  if (t.weekday != 0) t.weekday = static_cast<std::uint8_t>((t.weekday - 1 + count) % 7 + 1);
  t.day = static_cast<std::uint8_t>(static_cast<unsigned>(date.day()));
  t.month = static_cast<std::uint8_t>(static_cast<unsigned>(date.month()));
  t.year = static_cast<std::uint8_t>(static_cast<int>(date.year()) - 2000);
}

/// A date that is not in the calendar goes on day by day to one that is.
ClockTime advanced(ClockTime t, std::int64_t seconds) {
  constexpr std::int64_t kDay = 86'400;
  const std::int64_t in_all = (t.hour * 60 + t.minute) * 60 + t.second + seconds, of_day = in_all % kDay;
  std::int64_t days = in_all / kDay;
  for (; days > 0 && !date_of(t).ok(); --days) next_day(t);
  if (days > 0) add_days(t, days);
  t.hour = static_cast<std::uint8_t>(of_day / 3600);
  t.minute = static_cast<std::uint8_t>(of_day / 60 % 60);
  t.second = static_cast<std::uint8_t>(of_day % 60);
  return t;
}

}  // namespace

void set(Core& core, const ClockTime& to) {
  core.s.clock = to;
  core.s.clock_set_at = core.s.time;
}

ClockTime now(const Core& core) {
  return advanced(core.s.clock, (core.s.time - core.s.clock_set_at) / core.by_own_clock(kSecond));
}

Time fraction(const Core& core) { return (core.s.time - core.s.clock_set_at) % core.by_own_clock(kSecond); }

Time next_second(const Core& core) { return core.s.time - fraction(core) + core.by_own_clock(kSecond); }

Bcd bcd_now(const Core& core) {
  const ClockTime t = now(core);
  return {to_bcd(t.year), to_bcd(t.month), to_bcd(t.day), to_bcd(t.hour), to_bcd(t.minute), to_bcd(t.second), 0, t.weekday};
}

bool is_time(const Bcd& b) {
  if (!std::all_of(b.begin(), b.end(), is_bcd)) return false;
  const int month = from_bcd(b[1]), day = from_bcd(b[2]);
  return month >= 1 && month <= 12 && day >= 1 && day <= 31 && from_bcd(b[3]) < 24 && from_bcd(b[4]) < 60 &&
         from_bcd(b[5]) < 60 && from_bcd(b[7]) <= 7;
}

bool set_bcd(Core& core, const Bcd& b) {
  if (!std::all_of(b.begin(), b.end(), is_bcd)) return false;
  set(core,
      {from_bcd(b[0]), from_bcd(b[1]), from_bcd(b[2]), from_bcd(b[3]), from_bcd(b[4]), from_bcd(b[5]), from_bcd(b[7])});
  return true;
}

void read(Core& core, std::uint32_t buffer) {
  const Bcd bytes = bcd_now(core);
  if (!core.in_area(buffer, bytes.size())) return core.run_error(RunError::OperandRange);
  std::copy(bytes.begin(), bytes.end(), core.s.image.begin() + buffer);
}

void write(Core& core, std::uint32_t buffer) {
  Bcd bytes{};
  if (!core.in_area(buffer, bytes.size())) return core.run_error(RunError::OperandRange);
  std::copy_n(core.s.image.begin() + buffer, bytes.size(), bytes.begin());
  if (!set_bcd(core, bytes)) core.run_error(RunError::Clock);
}

/// The clock has run on while power was off.
void power_up(Core& core, const RetentiveMemory* memory) {
  if (!memory || memory->ram_lost) return;
  const Time passed = memory->clock_fraction + memory->power_off, second = core.by_own_clock(kSecond);
  core.s.clock = advanced(memory->clock, passed / second);
  core.s.clock_set_at = core.s.time - passed % second;
}

}  // namespace s7200::clock
