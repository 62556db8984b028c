#include "tools/scenario/reading/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::tools {
namespace {

constexpr double kMostCharacters = 1e6;

bool take(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// `3.5 characters`, `1 character`
std::optional<std::int64_t> parse_characters(std::string_view text) {
  for (const std::string_view unit : {"characters", "character"})
    if (text.ends_with(unit)) {
      const std::string_view figure = stl::trim(text.substr(0, text.size() - unit.size()));
      const auto value = parse_decimal<double>(figure);
      if (!value || !Between<double>{0, kMostCharacters}.has(*value) || figure.find_first_of("eE") != figure.npos) return {};
      return std::llround(*value * 1000);
    }
  return {};
}

}  // namespace

Time Span::in(const SerialFormat& format) const {
  if (fixed == kNever) return kNever;
  const std::int64_t divisor = 1000 * std::int64_t{format.baud};
  return fixed + (millicharacters * format.bits() * kSecond + divisor / 2) / divisor;
}

bool Window::has(Time time, const SerialFormat& format) const { return time >= from.in(format) && time <= to.in(format); }

std::optional<std::int64_t> parse_number(std::string_view text) {
  constexpr std::int64_t kLargest = 0xFFFF'FFFF;
  const auto number = parse_integer(stl::trim(text));
  return number && Between<std::int64_t>{-kLargest, kLargest}.has(*number) ? number : std::nullopt;
}

Sides sides(std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) return {stl::trim(text), {}, false};
  return {stl::trim(text.substr(0, dots)), stl::trim(text.substr(dots + 2)), true};
}

std::optional<Span> parse_span(std::string_view text) {
  Span span;
  for (;;) {
    const std::size_t plus = text.find('+');
    const std::string_view part = stl::trim(text.substr(0, plus));
    if (const auto characters = parse_characters(part)) {
      span.millicharacters += *characters;
    } else if (const auto time = part == "0" ? Time{0} : parse_duration(part)) {
      if (*time > kLongestSpan) return {};
      span.fixed += *time;
    } else {
      return {};
    }
    if (span.fixed > kLongestSpan || span.millicharacters > 1000 * static_cast<std::int64_t>(kMostCharacters)) return {};
    if (plus == std::string_view::npos) return span;
    text.remove_prefix(plus + 1);
  }
}

std::optional<Window> parse_window(std::string_view text, Time tolerance) {
  const Sides side = sides(text);
  Window window;
  if (side.range && side.from.empty() && side.to.empty()) return {};
  if (!side.from.empty() || !side.range) {
    const auto from = parse_span(side.from);
    if (!from) return {};
    window.from = *from;
  }
  if (!side.range) {
    window.to = window.from;
    window.from.fixed -= tolerance;
    window.to.fixed += tolerance;
  } else if (!side.to.empty()) {
    const auto to = parse_span(side.to);
    if (!to) return {};
    window.to = *to;
    const bool later = window.from.fixed > to->fixed || window.from.millicharacters > to->millicharacters;
    if (later && window.from.fixed >= to->fixed && window.from.millicharacters >= to->millicharacters) return {};
  }
  return window;
}

std::optional<Count> parse_count(std::string_view text) {
  const Sides side = sides(text);
  const auto from = parse_number(side.from);
  if (!from || *from < 0) return {};
  Count count{static_cast<std::uint64_t>(*from), static_cast<std::uint64_t>(*from)};
  if (!side.range) return count;
  count.to = UINT64_MAX;
  if (side.to.empty()) return count;
  const auto to = parse_number(side.to);
  if (!to || *to < *from) return {};
  count.to = static_cast<std::uint64_t>(*to);
  return count;
}

Result<std::vector<BytePattern>> parse_pattern(std::string_view text) {
  std::vector<BytePattern> pattern;
  while (!(text = stl::trim(text)).empty()) {
    if (pattern.size() == serial::kLongestRawFrame) return trouble("a frame has {} bytes at most", serial::kLongestRawFrame);
    if (take(text, "..")) {
      pattern.push_back(std::nullopt);
      continue;
    }
    const auto byte = serial::parse_hex_frame(text.substr(0, 2));
    if (!byte.ok()) return Trouble{byte.errors[0].message + "; .. stands for any byte"};
    pattern.push_back(byte.frame[0].byte);
    text.remove_prefix(2);
  }
  if (!pattern.empty()) return pattern;
  return Trouble{"at least one byte is needed; 'silence' stands for none"};
}

std::string in_words(const Window& window, const SerialFormat& format) {
  const Time from = window.from.in(format), to = window.to.in(format);
  if (from == to) return format_duration(from, 6);
  if (to == kNever) return fmt::format("{} or more", format_duration(from, 6));
  if (from <= 0) return fmt::format("{} or less", format_duration(to, 6));
  return fmt::format("{} to {}", format_duration(from, 6), format_duration(to, 6));
}

std::string in_words(const Count& count) {
  if (count.to == count.from) return std::to_string(count.from);
  if (count.to == UINT64_MAX) return fmt::format("{} or more", count.from);
  return fmt::format("{} to {}", count.from, count.to);
}

}  // namespace s7200::tools
