// The small things a scenario is written with: numbers, durations, windows, patterns of bytes, and `${…}`.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

/// `12`, `-5`, `16#FF`, `2#1010`, 32 bits at most.
std::optional<std::int64_t> parse_number(std::string_view text);

/// The two sides of `..` without blanks around them; of a text without `..`, all of it is `from`.
struct Sides {
  std::string_view from, to;
  bool range = false;
};
Sides sides(std::string_view text);

inline constexpr Time kLongestSpan = 24 * 3600 * kSecond;

/// `5ms`, `3.5 characters`, `3.5 characters + 2ms`. A million characters and kLongestSpan at most.
std::optional<Span> parse_span(std::string_view text);

/// `8ms..20ms`, `..20ms`, `8ms..`, or one span: that, give or take `tolerance`. Nothing when no time can be inside.
std::optional<Window> parse_window(std::string_view text, Time tolerance);

/// `3`, `1..3`, `1..`.
std::optional<Count> parse_count(std::string_view text);

/// Two hex digits or `..` a byte, blanks between as you like. Nothing, and `why`, for anything else.
std::optional<std::vector<BytePattern>> parse_pattern(std::string_view text, std::string& why);

/// Named values. A list L of a, b has its elements in `lists`, and 1 as L.a and L.b.
struct Parameters {
  std::map<std::string, std::string, std::less<>> values{};
  std::map<std::string, std::vector<std::string>, std::less<>> lists{};
  std::set<std::string, std::less<>> empty{};  ///< have no value
};

/// Puts values in the place of each `${…}`. Inside stands the name of a parameter, or a calculation with whole numbers:
/// + - * / % < <= > >= = != and parentheses, the functions byte(x), word(x) and bytes(n, x), which give hex: `0a`, `00 0a`,
/// and n bytes x, and has(NAME): 1 for a parameter with a value. Nothing, and `why`, if it cannot be done. A text
/// that is `${NAME}` of a parameter without a value becomes empty.
std::optional<std::string> substitute(std::string_view text, const Parameters& parameters, std::string& why);

/// What stands inside `${…}`.
std::optional<std::string> evaluate(std::string_view expression, const Parameters& parameters, std::string& why);

/// Whether a calculation comes to anything but 0. A parameter without a value makes it false.
std::optional<bool> holds(std::string_view expression, const Parameters& parameters, std::string& why);

inline constexpr std::size_t kLongestSubstitution = 16 * 1024;  ///< characters of one text

}  // namespace s7200::tools
