// Bodies: numbers as text, and strings (facts 6.9, 10.7).
//
// A string is a byte with its length, 0 to 254, and its characters. ITA, DTA and RTA write characters without a length.
// FMT is 0000cnnn: c chooses the comma instead of the point, nnn is the number of digits after it. RTA and RTS have the size
// of their output in the upper half. Numbers stand at the right, filled up with blanks; a positive one has no sign.
//
// Not documented, modelled so:
// - A format that is not possible, or a number that has no room, fills the output with blanks; ENO is then 0.
//   [Vectors.ITA, Vectors.RTA, Eno.AFormatThatIsNotPossibleMakesItZero]
// - RTA and RTS round a half away from zero, and a number that becomes 0 has no sign. [Vectors.RTA]
// - A size of RTA and RTS below 3, or without room for a digit, the point and a sign, is not possible. [Vectors.RTA]
// - STI, STD and STR skip blanks and read as far as they can; if there is no number, or it does not fit, SM1.1 is 1 and OUT
//   stays as it was. An index beyond the end of the string finds no number. [Vectors.STI, Vectors.STR]
// - SCAT whose result would have more than 254 characters is range error 0091. [Vectors.SCAT]
// - SFND and CFND with an index beyond the string, or an empty string to look for, find nothing. [Vectors.SFND]
// - A length of 255 is range error 0091. [Vectors.SLEN]
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/instructions/compare.hpp"

namespace s7200::bodies {

// --- numbers as text ---

inline constexpr std::uint32_t kIntegerText = 8, kDoubleText = 12, kShortestRealText = 3;

/// The format FMT of a number's text, without the size.
struct NumberFormat {
  std::uint32_t decimals;
  char point;
  bool possible;
};

inline NumberFormat number_format(std::uint8_t format) {
  const std::uint32_t decimals = format & 7;
  return {decimals, format & 8 ? ',' : '.', decimals <= 5};
}

/// A magnitude in units of its last decimal, at the right end of `size` characters; blanks if it has no room.
inline std::string number_text(std::uint64_t units, bool negative, const NumberFormat& format, std::uint32_t size) {
  std::string digits = std::to_string(units);
  if (digits.size() <= format.decimals) digits.insert(0, format.decimals + 1 - digits.size(), '0');
  if (format.decimals != 0) digits.insert(digits.size() - format.decimals, 1, format.point);
  if (negative && units != 0) digits.insert(0, 1, '-');
  if (digits.size() > size) return {};
  return std::string(size - digits.size(), ' ') + digits;
}

/// Writes a number's text, or blanks if there is none.
inline void put_number(Core& core, std::uint32_t at, const std::string& number, std::uint32_t size) {
  const std::string text = number.empty() ? std::string(size, ' ') : number;
  std::copy(text.begin(), text.end(), core.s.image.begin() + at);
  if (number.empty()) core.s.eno = false;
}

/// ITA, DTA; with a length byte in front of them ITS, DTS.
template <class Signed, std::uint32_t size, bool string>
void integer_to_text(Core& core, const Op& op) {
  const std::int64_t value = core.get<Signed>(op[0]);
  const auto format = core.get<std::uint8_t>(op[2]);
  if (!core.in_area(op[1].at, size + string)) return core.run_error(RunError::OperandRange);
  NumberFormat how = number_format(format);
  how.possible &= format < 0x10;
  if (string) core.put(op[1], static_cast<std::uint8_t>(size));
  const auto magnitude = static_cast<std::uint64_t>(value < 0 ? -value : value);
  put_number(core, op[1].at + string, how.possible ? number_text(magnitude, value < 0, how, size) : "", size);
}

/// RTA; with a length byte in front RTS.
template <bool string>
void real_to_text(Core& core, const Op& op) {
  const double value = static_cast<double>(core.get<float>(op[0]));
  const auto format = core.get<std::uint8_t>(op[2]);
  const std::uint32_t size = format >> 4;
  if (!core.in_area(op[1].at, size + string)) return core.run_error(RunError::OperandRange);
  const NumberFormat how = number_format(format);
  const bool possible = how.possible && size >= kShortestRealText && size >= how.decimals + 3;
  const double units = std::round(std::abs(value) * std::pow(10.0, how.decimals));
  const std::string text =
      possible && units < 1e15 ? number_text(static_cast<std::uint64_t>(units), value < 0, how, size) : "";
  const auto digits = std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  core.spend(op, std::max<std::int64_t>(0, digits - 1));
  if (string) core.put(op[1], static_cast<std::uint8_t>(size));
  put_number(core, op[1].at + string, text, size);
}

// --- strings ---

inline constexpr std::uint32_t kLongestString = 254;

/// The characters of the string at `at`; reports a range error and returns nothing if there is none.
inline std::optional<std::string_view> string_at(Core& core, std::uint32_t at) {
  const std::uint32_t length = core.s.image[at];
  const bool constant = at >= image::kConstants;
  if (constant || (length <= kLongestString && core.in_area(at, 1 + length)))
    return std::string_view(reinterpret_cast<const char*>(&core.s.image[at + 1]), length);
  core.run_error(RunError::OperandRange);
  return {};
}

/// Writes a string; it may come from where it goes to. Takes the time of `characters`.
inline void put_string(Core& core, const Op& op, const std::string& text, std::size_t characters) {
  const std::uint32_t at = op[1].at;
  if (text.size() > kLongestString || !core.in_area(at, static_cast<std::uint32_t>(1 + text.size())))
    return core.run_error(RunError::OperandRange);
  core.spend(op, static_cast<std::int64_t>(characters));
  core.s.image[at] = static_cast<std::uint8_t>(text.size());
  std::copy(text.begin(), text.end(), core.s.image.begin() + at + 1);
}

/// The index of a first character, from 1; reports error 009B and returns nothing for 0.
inline std::optional<std::uint32_t> index_of(Core& core, const Operand& operand) {
  const std::uint32_t index = core.get<std::uint8_t>(operand);
  if (index != 0) return index;
  core.run_error(RunError::StringIndex);
  return {};
}

inline void string_length(Core& core, const Op& op) {
  if (const auto text = string_at(core, op[0].at)) core.put(op[1], static_cast<std::uint8_t>(text->size()));
}

inline void copy_string(Core& core, const Op& op) {
  if (const auto text = string_at(core, op[0].at)) put_string(core, op, std::string(*text), text->size());
}

/// SCAT: IN after OUT.
inline void join_strings(Core& core, const Op& op) {
  const auto tail = string_at(core, op[0].at), head = tail ? string_at(core, op[1].at) : std::nullopt;
  if (head) put_string(core, op, std::string(*head) + std::string(*tail), tail->size());
}

/// SFND IN1, IN2, OUT: where IN2 is in IN1 from character OUT on; CFND: where any character of IN2 is. 0: nowhere.
template <bool whole>
void find_in_string(Core& core, const Op& op) {
  const auto text = string_at(core, op[0].at), wanted = text ? string_at(core, op[1].at) : std::nullopt;
  const auto from = wanted ? index_of(core, op[2]) : std::nullopt;
  if (!from) return;
  const std::size_t start = *from - 1;
  const std::size_t found = wanted->empty() ? std::string_view::npos
                            : whole         ? text->find(*wanted, start)
                                            : text->find_first_of(*wanted, start);
  const std::size_t end = found == std::string_view::npos ? text->size() : found + 1;
  core.spend(op, end > start ? static_cast<std::int64_t>(end - start) : 0);
  core.put(op[2], static_cast<std::uint8_t>(found == std::string_view::npos ? 0 : found + 1));
}

/// LDS=, AS<> …: a string that runs past the end of its area stops the CPU (facts 5.1).
template <Join join, bool equal, Rail rail = Rail::Always>
void compare_strings(Core& core, const Op& op) {
  const auto a = string_at(core, op[0].at), b = a ? string_at(core, op[1].at) : std::nullopt;
  if (!b) return core.fatal_error(FatalError::CompareRange);
  const auto same = std::mismatch(a->begin(), a->end(), b->begin(), b->end()).first - a->begin();
  core.spend(op, std::min<std::int64_t>(same + 1, static_cast<std::int64_t>(std::min(a->size(), b->size()))));
  combine<join>(core.s.stack, (*a == *b) == equal && fed<join, rail>(core));
}

template <Join join, bool equal>
inline constexpr Bodies kCompareStrings{compare_strings<join, equal>, compare_strings<join, equal, Rail::Segment>};

/// The number that STI, STD and STR read: from character INDX on, without the blanks in front, as far as it is a number.
inline std::optional<std::string> number_in(Core& core, const Op& op, bool real) {
  const auto text = string_at(core, op[0].at);
  const auto from = text ? index_of(core, op[1]) : std::nullopt;
  if (!from) return {};
  std::string_view rest = text->substr(std::min<std::size_t>(*from - 1, text->size()));
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  std::string number;
  if (!rest.empty() && (rest.front() == '-' || rest.front() == '+')) {
    if (rest.front() == '-') number = "-";
    rest.remove_prefix(1);
  }
  for (bool point = false; !rest.empty(); rest.remove_prefix(1)) {
    const char c = rest.front();
    const bool is_point = real && !point && (c == '.' || c == ',');
    if (!is_point && (c < '0' || c > '9')) break;
    point |= is_point;
    number += is_point ? '.' : c;
  }
  core.spend(op, static_cast<std::int64_t>(number.size()));
  return number;
}

template <class Number>
void text_to_number(Core& core, const Op& op) {
  const auto text = number_in(core, op, std::is_floating_point_v<Number>);
  if (!text) return;
  Number value{};
  const auto [end, error] = read_number(*text, value);
  if (error != std::errc{} || end != text->data() + text->size()) return core.set_flags(kOverflow, kOverflow);
  core.put(op[2], value);
  core.set_flags(kOverflow, 0);
}

}  // namespace s7200::bodies
