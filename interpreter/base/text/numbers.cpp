#include "interpreter/base/text/numbers.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "interpreter/base/text/text.hpp"

namespace s7200 {

#ifdef __cpp_lib_to_chars
std::from_chars_result read_number(std::string_view text, float& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value);
}
std::from_chars_result read_number(std::string_view text, double& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value);
}
#else
namespace {

float to_real(const char* text, char** end, float) { return std::strtof(text, end); }
double to_real(const char* text, char** end, double) { return std::strtod(text, end); }

/// strtof() and strtod() also read what from_chars() does not: blanks and a plus sign in front, and hexadecimal.
template <class Real>
std::from_chars_result read_real(std::string_view text, Real& value) {
  const std::string digits(text.substr(0, text.find_first_of("xX")));
  const bool other = digits.empty() || std::string_view("+ \t\n\v\f\r").find(digits.front()) != std::string_view::npos;
  char* end = nullptr;
  const Real read = other ? Real{} : to_real(digits.c_str(), &end, Real{});
  if (other || end == digits.c_str()) return {text.data(), std::errc::invalid_argument};
  const char* const stopped = text.data() + (end - digits.c_str());
  const bool any_digit = digits.find_first_of("123456789") < digits.find_first_of("eE");
  if ((read == 0 && any_digit) || (std::isinf(read) && std::isdigit(static_cast<unsigned char>(end[-1]))))
    return {stopped, std::errc::result_out_of_range};
  value = read;
  return {stopped, std::errc{}};
}

}  // namespace

std::from_chars_result read_number(std::string_view text, float& value) { return read_real(text, value); }
std::from_chars_result read_number(std::string_view text, double& value) { return read_real(text, value); }
#endif

std::optional<std::int64_t> parse_integer(std::string_view text) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  int base = 10;
  for (const auto& [prefix, its_base] : {std::pair{std::string_view("16#"), 16}, {std::string_view("2#"), 2}})
    if (text.starts_with(prefix)) {
      base = its_base;
      text.remove_prefix(prefix.size());
    }
  std::string digits(text);
  if (base != 10) std::erase(digits, '_');
  std::int64_t value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, value, base);
  if (error != std::errc{} || stopped != end || digits.front() == '-') return {};
  return negative ? -value : value;
}

bool is_whole_number(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_real_number(std::string_view text) {
  double value = 0;
  const auto [stopped, error] = read_number(text, value);
  return error != std::errc::invalid_argument && stopped == text.data() + text.size() && !std::isnan(value);
}

std::optional<std::uint8_t> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<std::uint8_t>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<std::uint8_t>(c - 'A' + 10);
  return {};
}

Result<Time> parse_duration_in(std::string_view text, Between<Time> range) {
  const auto duration = parse_duration_or_never(text);
  if (!duration) return trouble("'{}' is not a duration; write for example 250ms, 2s, 1h", stl::shortened(text));
  if (range.has(*duration)) return *duration;
  return trouble("'{}' is out of range ({} to {})", stl::shortened(text), format_duration(range.least),
                 format_duration(range.most));
}

}  // namespace s7200
