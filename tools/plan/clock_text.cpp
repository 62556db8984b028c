#include "tools/plan/clock_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/cpu/units/clock.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kForm = "dddd-dd-dd dd:dd:dd";

bool has_form(std::string_view text) {
  return std::equal(text.begin(), text.end(), kForm.begin(), kForm.end(),
                    [](char c, char form) { return form == 'd' ? c >= '0' && c <= '9' : c == form; });
}

unsigned number(std::string_view digits) {
  unsigned value = 0;
  for (const char digit : digits) value = value * 10 + static_cast<unsigned>(digit - '0');
  return value;
}

}  // namespace

std::string why_no_clock(const CpuModel& model) {
  if ((model.self & clock::kCpusWithClock) != 0) return {};
  return fmt::format("CPU {} has no time-of-day clock", model.name);
}

std::optional<ClockTime> parse_clock(std::string_view text) {
  if (!has_form(text)) return {};
  const unsigned year = number(text.substr(0, 4)), month = number(text.substr(5, 2)), day = number(text.substr(8, 2));
  const unsigned hour = number(text.substr(11, 2)), minute = number(text.substr(14, 2)), second = number(text.substr(17, 2));
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)), std::chrono::month(month),
                                         std::chrono::day(day)};
  if (!date.ok() || year < 1990 || year > 2089 || hour > 23 || minute > 59 || second > 59) return {};
  const std::chrono::weekday weekday{std::chrono::sys_days(date)};
  return ClockTime{.year = static_cast<std::uint8_t>(year % 100),
                   .month = static_cast<std::uint8_t>(month),
                   .day = static_cast<std::uint8_t>(day),
                   .hour = static_cast<std::uint8_t>(hour),
                   .minute = static_cast<std::uint8_t>(minute),
                   .second = static_cast<std::uint8_t>(second),
                   .weekday = static_cast<std::uint8_t>(weekday.c_encoding() + 1)};
}

std::optional<std::int32_t> parse_clock_error(std::string_view text) {
  constexpr std::string_view kUnit = "ppm";
  constexpr Between<std::int32_t> kRange{-1000, 1000};
  if (!text.ends_with(kUnit)) return {};
  text.remove_suffix(kUnit.size());
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto millionths = parse_decimal<std::int32_t>(text);
  return millionths && kRange.has(*millionths) ? millionths : std::nullopt;
}

}  // namespace s7200::tools
