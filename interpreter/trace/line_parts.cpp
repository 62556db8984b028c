#include "interpreter/trace/line_parts.hpp"

#include <array>

namespace s7200 {

void append_hex(fmt::memory_buffer& text, std::uint32_t number, int digits) {
  while (digits-- > 0) text.push_back("0123456789ABCDEF"[number >> 4 * digits & 15]);
}

void append_clock(fmt::memory_buffer& text, Time at) {
  constexpr std::size_t kDecimals = 6, kWhole = 7;
  const fmt::format_int whole(at / kMillisecond);
  std::array<char, kDecimals + 1> decimals{'.'};
  auto rest = static_cast<std::uint32_t>(at % kMillisecond);
  for (std::size_t place = kDecimals; place > 0; --place, rest /= 10) decimals[place] = static_cast<char>('0' + rest % 10);
  for (std::size_t width = whole.size(); width < kWhole; ++width) text.push_back(' ');
  append(text, std::string_view(whole.data(), whole.size()), std::string_view(decimals.data(), decimals.size()));
}

std::string clock_text(Time at) {
  fmt::memory_buffer text;
  append_clock(text, at);
  return fmt::to_string(text);
}

}  // namespace s7200
