#include "interpreter/base/text/text.hpp"

#include <algorithm>
#include <cstdint>

namespace s7200::stl {

namespace {

struct Lead {
  std::size_t bytes;
  char32_t bits;
  char32_t smallest;  // a smaller code in this many bytes is overlong
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {1, byte, 0};
  if (byte >= 0xC2 && byte < 0xE0) return {2, byte & 0x1FU, 0x80};
  if (byte >= 0xE0 && byte < 0xF0) return {3, byte & 0x0FU, 0x800};
  if (byte >= 0xF0 && byte < 0xF5) return {4, byte & 0x07U, 0x10000};
  return {0, 0, 0};
}

/// The end of the first line: its CR or LF. The search for either stays near the other, so that a text that has only one of
/// them is not searched to its end for each line.
std::size_t line_end(std::string_view text) {
  constexpr std::size_t kNear = 256;
  for (std::size_t from = 0; from < text.size(); from += kNear) {
    std::string_view near = text.substr(from, kNear);
    near = near.substr(0, near.find('\n'));
    const std::size_t end = std::min(near.find('\r'), near.size());
    if (end < std::min(kNear, text.size() - from)) return from + end;
  }
  return text.size();
}

constexpr Character kUnreadable{kReplacement, 1};

/// C0 and C1; marks, embeddings, overrides and isolates of bidirectional text (UAX #9); line and paragraph separators.
bool commands_a_terminal(char32_t code) {
  return (code < 0x20 && code != '\t') || (code >= 0x7F && code < 0xA0) || code == 0x061C || code == 0x200E ||
         code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

Character first_character(std::string_view text) {
  const Lead lead = lead_of(static_cast<unsigned char>(text.front()));
  if (lead.bytes == 0 || lead.bytes > text.size()) return kUnreadable;
  char32_t code = lead.bits;
  for (std::size_t i = 1; i < lead.bytes; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xC0U) != 0x80) return kUnreadable;
    code = (code << 6) | (byte & 0x3FU);
  }
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < lead.smallest || code > 0x10FFFF || surrogate) return kUnreadable;
  return {code, lead.bytes};
}

std::string to_utf8(char32_t c) {
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xC0 | (c >> 6)), static_cast<char>(0x80 | (c & 0x3F))};
  if (c < 0x10000)
    return {static_cast<char>(0xE0 | (c >> 12)), static_cast<char>(0x80 | ((c >> 6) & 0x3F)),
            static_cast<char>(0x80 | (c & 0x3F))};
  return {static_cast<char>(0xF0 | (c >> 18)), static_cast<char>(0x80 | ((c >> 12) & 0x3F)),
          static_cast<char>(0x80 | ((c >> 6) & 0x3F)), static_cast<char>(0x80 | (c & 0x3F))};
}

bool is_ascii(std::string_view text) {
  unsigned bits = 0;
  for (const char c : text) bits |= static_cast<unsigned char>(c);
  return bits < 0x80;
}

std::size_t count_characters(std::string_view text) {
  if (is_ascii(text)) return text.size();
  std::size_t count = 0;
  for ([[maybe_unused]] const Character c : characters(text)) ++count;
  return count;
}

std::string characters_at(std::string_view text, std::size_t first, std::size_t count) {
  std::string found;
  std::size_t number = 0;
  for (const Character c : characters(text)) {
    if (++number >= first + count) break;
    if (number >= first) found += text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
  }
  return found;
}

bool is_valid_utf8(std::string_view text) {
  if (is_ascii(text)) return true;
  for (const Character c : characters(text)) {
    if (c.code == kReplacement && c.bytes == 1) return false;
  }
  return true;
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, line_end(text));
  text.remove_prefix(line.size());
  text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
  return line;
}

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) lines.emplace_back(take_line(text));
  return lines;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::string_view trim_end(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view trim(std::string_view text) {
  const auto goes = [](char c) { return is_blank(c) || c == '\r'; };
  while (!text.empty() && goes(text.front())) text.remove_prefix(1);
  while (!text.empty() && goes(text.back())) text.remove_suffix(1);
  return text;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  if (count_characters(text) <= kLongest) return std::string(text);
  std::size_t bytes = 0, number = 0;
  for (const Character c : characters(text)) {
    if (++number > kLongest - 3) break;
    bytes += c.bytes;
  }
  return std::string(text.substr(0, bytes)).append("...");
}

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character c = first_character(text);
    shown += c.code == kReplacement || commands_a_terminal(c.code) ? "\uFFFD" : text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
  }
  return shown;
}

std::string printable_lines(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return shown + printable(text);
    const std::size_t line = end > 0 && text[end - 1] == '\r' ? end - 1 : end;
    shown += printable(text.substr(0, line));
    shown += text.substr(line, end + 1 - line);
    text.remove_prefix(end + 1);
  }
  return shown;
}

std::string_view take_word(std::string_view& text, const ByteSet& between) {
  const auto goes = [&between](char c) { return between.has(c) || c == '\f' || c == '\r'; };
  while (!text.empty() && goes(text.front())) text.remove_prefix(1);
  while (!text.empty() && goes(text.back())) text.remove_suffix(1);
  const std::string_view word = text.substr(0, between.first_in(text));
  text.remove_prefix(word.size());
  return word;
}

std::vector<std::string> split_words(std::string_view text) {
  std::vector<std::string> words;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) words.emplace_back(word);
  return words;
}

std::string upper_case(std::string_view text) {
  std::string capitals(text);
  for (char& c : capitals) c = capital(c);
  return capitals;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (is_upper(c)) c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

bool same_in_capitals(std::string_view text, std::string_view capitals) {
  return std::ranges::equal(text, capitals, {}, capital);
}

}  // namespace s7200::stl
