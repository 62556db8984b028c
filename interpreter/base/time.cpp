#include "interpreter/base/time.hpp"

#include <array>

namespace s7200 {

namespace {

struct Unit {
  std::string_view name;
  Time length;
};

constexpr Time kMinute = 60 * kSecond;
constexpr Time kHour = 60 * kMinute;
constexpr std::array kUnits{Unit{"ns", 1},      Unit{"us", kMicrosecond}, Unit{"ms", kMillisecond},
                            Unit{"s", kSecond}, Unit{"min", kMinute},     Unit{"h", kHour}};
constexpr std::size_t kSecondUnit = 3;

const Unit* unit_named(std::string_view name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

/// Removes the digits at the start of `text` and returns them.
std::string_view take_digits(std::string_view& text) {
  std::size_t count = 0;
  while (count < text.size() && text[count] >= '0' && text[count] <= '9') ++count;
  const std::string_view digits = text.substr(0, count);
  text.remove_prefix(count);
  return digits;
}

// 128 bits: the decimals of an hour go far beyond 64 before they are divided again.
__extension__ using Wide = __int128;

constexpr Wide kTooMuch = Wide{kNever} * 1'000'000;

/// Minutes and hours only where they are exact.
std::size_t unit_for(std::uint64_t magnitude) {
  for (std::size_t i = kUnits.size(); i-- > 0;) {
    const auto length = static_cast<std::uint64_t>(kUnits[i].length);
    const bool exact = i <= kSecondUnit || magnitude % length == 0;
    if (magnitude >= length && exact) return i;
  }
  return 0;
}

std::uint64_t power_of_ten(int exponent) {
  std::uint64_t power = 1;
  for (; exponent > 0; --exponent) power *= 10;
  return power;
}

std::string decimals(std::uint64_t fraction, int digits) {
  if (fraction == 0) return {};
  std::string text = std::to_string(fraction);
  text.insert(0, static_cast<std::size_t>(digits) - text.size(), '0');
  while (text.back() == '0') text.pop_back();
  text.insert(0, 1, '.');
  return text;
}

}  // namespace

std::optional<Time> parse_duration(std::string_view text) {
  const auto duration = parse_duration_or_never(text);
  return duration == kNever ? std::nullopt : duration;
}

std::optional<Time> parse_duration_or_never(std::string_view text) {
  const std::string_view whole = take_digits(text);
  std::string_view fraction;
  if (!text.empty() && text.front() == '.') {
    text.remove_prefix(1);
    fraction = take_digits(text);
    if (fraction.empty()) return std::nullopt;
  }
  if (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  const Unit* unit = unit_named(text);
  if (whole.empty() || unit == nullptr) return std::nullopt;

  Wide figure = 0;
  for (const char digit : whole) {
    figure = figure * 10 + (digit - '0');
    if (figure > kTooMuch) return kNever;
  }
  Wide duration = figure * unit->length;
  Wide place = unit->length;  // what a one at this decimal is worth
  for (const char digit : fraction) {
    if (place % 10 != 0 && digit != '0') return std::nullopt;  // finer than a nanosecond
    place /= 10;
    duration += place * (digit - '0');
  }
  return duration >= kNever ? kNever : static_cast<Time>(duration);
}

std::string format_duration(Time duration, int digits) {
  if (duration == kNever) return "never";
  const std::uint64_t magnitude =
      duration < 0 ? 0 - static_cast<std::uint64_t>(duration) : static_cast<std::uint64_t>(duration);
  std::size_t unit = unit_for(magnitude);
  digits = digits < 0 ? 0 : digits > 9 ? 9 : digits;

  const std::uint64_t scale = power_of_ten(digits);
  const auto rounded_in = [&](std::size_t index) {
    const auto length = static_cast<std::uint64_t>(kUnits[index].length);
    const std::uint64_t step = length > scale ? length / scale : 1;  // round what is not shown
    return (magnitude + step / 2) / step * step;
  };
  std::uint64_t rounded = rounded_in(unit);
  const bool carried = unit < kSecondUnit && rounded >= static_cast<std::uint64_t>(kUnits[unit + 1].length);
  if (carried) rounded = rounded_in(++unit);

  const auto length = static_cast<std::uint64_t>(kUnits[unit].length);
  std::uint64_t remainder = rounded % length;
  int places = digits;
  if (length < scale) {  // a nanosecond has no decimals, a microsecond three
    places = 0;
    for (std::uint64_t rest = length; rest > 1; rest /= 10) ++places;
  } else {
    remainder /= length / scale;
  }
  std::string text = duration < 0 ? "-" : "";
  text += std::to_string(rounded / length);
  text += decimals(remainder, places);
  text += ' ';
  text += kUnits[unit].name;
  return text;
}

}  // namespace s7200
