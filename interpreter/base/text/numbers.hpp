// Reads numbers in texts.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "interpreter/base/result.hpp"
#include "interpreter/base/time.hpp"

namespace s7200 {

/// A range from `least` to `most`, both included.
template <class Number>
struct Between {
  Number least{}, most{};

  /// NaN is in no range.
  bool has(Number value) const { return value >= least && value <= most; }
};

/// Reads a number from the beginning of a text as std::from_chars does, which some standard libraries lack for reals.
std::from_chars_result read_number(std::string_view text, float& value);
std::from_chars_result read_number(std::string_view text, double& value);
template <class Integer>
std::from_chars_result read_number(std::string_view text, Integer& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value);
}

/// All of `text` as a decimal number, without blanks or a plus sign. Returns nothing for anything else, and for a number
/// that the type cannot hold.
template <class Number>
std::optional<Number> parse_decimal(std::string_view text) {
  Number value{};
  const auto [stopped, error] = read_number(text, value);
  if (error != std::errc{} || stopped != text.data() + text.size()) return {};
  return value;
}

/// Whether a text is a number in decimal, however large.
bool is_whole_number(std::string_view text);
bool is_real_number(std::string_view text);

/// Reads a whole number as STL writes it: `12`, `-5`, `16#FF`, `2#1010_0001`.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// Value of a hex digit in either case.
std::optional<std::uint8_t> hex_digit(char c);

/// The longest duration that options and actions take: more than a year. Sums of a few hundred such times still fit a Time.
inline constexpr Time kLongestDuration = Time{10'000} * 3600 * kSecond;

/// A duration in the range. Trouble for anything else.
Result<Time> parse_duration_in(std::string_view text, Between<Time> range);

}  // namespace s7200
