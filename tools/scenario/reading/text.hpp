// The small things a scenario is written with: numbers, durations, windows, counts, patterns of bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/base/serial_format.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// A duration that may depend on the line: so many characters of its format, and a fixed part.
struct Span {
  Time fixed = 0;
  std::int64_t millicharacters = 0;

  Time in(const SerialFormat& format) const;
  bool operator==(const Span&) const = default;
};

/// From … to, both included.
struct Window {
  Span from{}, to{kNever};

  bool has(Time time, const SerialFormat& format) const;
  bool operator==(const Window&) const = default;
};

/// How often something happened, from … to, both included.
struct Count {
  std::uint64_t from = 0, to = 0;

  bool has(std::uint64_t count) const { return count >= from && count <= to; }
  bool operator==(const Count&) const = default;
};

/// A byte that must be, or any.
using BytePattern = std::optional<std::uint8_t>;

/// The bytes that must be, each of them.
inline std::vector<BytePattern> pattern_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// `12`, `-5`, `16#FF`, `2#1010`, 32 bits at most.
std::optional<std::int64_t> parse_number(std::string_view text);

/// The two sides of `..` without blanks around them; of a text without `..`, all of it is `from`.
struct Sides {
  std::string_view from, to;
  bool range = false;
};
Sides sides(std::string_view text);

inline constexpr Time kLongestSpan = kLongestYamlDuration;

/// `5ms`, `3.5 characters`, `3.5 characters + 2ms`. A million characters and kLongestSpan at most.
std::optional<Span> parse_span(std::string_view text);

/// `8ms..20ms`, `..20ms`, `8ms..`, or one span: that, give or take `tolerance`. Nothing when no time can be inside.
std::optional<Window> parse_window(std::string_view text, Time tolerance);

/// `3`, `1..3`, `1..`.
std::optional<Count> parse_count(std::string_view text);

/// Two hex digits or `..` a byte, blanks between as you like. Trouble for anything else.
Result<std::vector<BytePattern>> parse_pattern(std::string_view text);

/// `8 ms to 20 ms`, `1 s or more`.
std::string in_words(const Window& window, const SerialFormat& format);
std::string in_words(const Count& count);

}  // namespace s7200::tools
