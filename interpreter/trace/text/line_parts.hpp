// Pieces of a line of a trace, appended to it: a trace has millions of lines.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "interpreter/base/time.hpp"

namespace s7200 {

inline void append_part(fmt::memory_buffer& text, std::string_view part) {
  text.append(part.data(), part.data() + part.size());
}
void append_part(fmt::memory_buffer& text, std::integral auto number) {
  const fmt::format_int digits(number);
  append_part(text, std::string_view(digits.data(), digits.size()));
}

/// Texts and decimal numbers, one after the other.
void append(fmt::memory_buffer& text, const auto&... parts) { (append_part(text, parts), ...); }

/// `16#0F`: the last `digits` hexadecimal digits of a number, 8 at most.
void append_hex(fmt::memory_buffer& text, std::uint32_t number, std::size_t digits);

/// `      15.193000`: milliseconds with six decimals, exact to the nanosecond; columns stay aligned for an hour.
void append_clock(fmt::memory_buffer& text, Time at);
std::string clock_text(Time at);

/// The same with the space that follows it in a line.
void begin_line(fmt::memory_buffer& text, Time at);

}  // namespace s7200
