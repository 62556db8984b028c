#include "interpreter/trace/text/line_parts.hpp"

#include <algorithm>
#include <array>

namespace s7200 {

void append_hex(fmt::memory_buffer& text, std::uint32_t number, std::size_t digits) {
  std::array<char, 11> hex{'1', '6', '#'};
  char* const begin = hex.data();
  char* const first = begin + 3;
  char* const end = first + digits;
  for (char* place = end; place != first; number >>= 4) *--place = "0123456789ABCDEF"[number & 15];
  text.append(begin, end);
}

namespace {

/// Right to left, and appended in one go.
void append_clock_before(std::size_t spaces, fmt::memory_buffer& text, Time at) {
  constexpr int kDecimals = 6, kWhole = 7;
  std::array<char, 32> digits{};
  digits.fill(' ');
  char* const end = digits.data() + digits.size();
  char* const point = end - spaces - kDecimals - 1;
  auto decimals = static_cast<std::uint32_t>(at % kMillisecond);
  for (char* place = point + kDecimals; place != point; --place, decimals /= 10)
    *place = static_cast<char>('0' + decimals % 10);
  *point = '.';
  char* place = point;
  for (auto whole = static_cast<std::uint64_t>(at / kMillisecond); whole != 0 || place == point; whole /= 10)
    *--place = static_cast<char>('0' + whole % 10);
  text.append(std::min(place, point - kWhole), end);
}

}  // namespace

void append_clock(fmt::memory_buffer& text, Time at) { append_clock_before(0, text, at); }

void begin_line(fmt::memory_buffer& text, Time at) { append_clock_before(2, text, at); }

std::string clock_text(Time at) {
  fmt::memory_buffer text;
  append_clock(text, at);
  return fmt::to_string(text);
}

}  // namespace s7200
