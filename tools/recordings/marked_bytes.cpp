#include "tools/recordings/marked_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "tools/recordings/forms.hpp"
#include "tools/recordings/lines.hpp"

namespace s7200::tools {
namespace {

/// A way to mark a byte, with all of its digits.
struct ByteMark {
  std::string_view before, after;
  int base;
  std::size_t digits;
};
constexpr std::array kByteMarks{
    ByteMark{"", "h", 16, 2},  ByteMark{"", "H", 16, 2},   ByteMark{"$", "", 16, 2},
    ByteMark{"&H", "", 16, 2}, ByteMark{"16#", "", 16, 2}, ByteMark{"#", "", 16, 2},
    ByteMark{"0b", "", 2, 8},  ByteMark{"2#", "", 2, 8},   ByteMark{"", "", 2, 8},
};

struct PlainSign {
  std::string_view sign, plain;
};
/// A dash before a blank only divides: `01 \u2013 03`. The first row that fits is the one.
constexpr std::array kPlainSigns{PlainSign{"\u2013 ", ""}, PlainSign{"\u2014 ", ""}, PlainSign{"\u2013", "-"},
                                 PlainSign{"\u2014", "-"}, PlainSign{"\u2212", "-"}, PlainSign{"\u00A0", " "},
                                 PlainSign{"\u2009", " "}, PlainSign{"\u202F", " "}};

std::optional<std::uint8_t> byte_of(std::string_view word, const ByteMark& mark) {
  if (word.size() != mark.before.size() + mark.digits + mark.after.size()) return {};
  if (!word.starts_with(mark.before) || !word.ends_with(mark.after)) return {};
  const std::string_view digits = word.substr(mark.before.size(), mark.digits);
  std::uint8_t byte = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, mark.base);
  return error == std::errc{} && end == digits.data() + digits.size() ? std::optional(byte) : std::nullopt;
}

bool is_between_words(char c) { return std::string_view(" \t,;[]()<>").find(c) != std::string_view::npos; }

/// Calls `see` with each word of a line.
template <typename See>
void for_each_word(std::string_view line, See see) {
  for (std::size_t begin = 0; begin < line.size();) {
    std::size_t end = begin;
    while (end < line.size() && !is_between_words(line[end])) ++end;
    if (end > begin) see(line.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// The most bytes in that notation, one after the other, in a line.
std::size_t longest_run(std::string_view line, const ByteMark& mark) {
  std::size_t run = 0, longest = 0;
  for_each_word(line, [&](std::string_view word) {
    run = byte_of(word, mark) ? run + 1 : 0;
    longest = std::max(longest, run);
  });
  return longest;
}

const ByteMark* mark_of(std::string_view text) {
  constexpr std::size_t kEnough = 4;
  for (const std::string_view line : Lines(beginning_of(text)))
    for (const ByteMark& mark : kByteMarks)
      if (longest_run(line, mark) >= kEnough) return &mark;
  return nullptr;
}

std::string with_plain_signs(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = std::min(text.find_first_of("\xC2\xE2"), text.size());
    plain.append(text.substr(0, length));
    text.remove_prefix(length);
    const auto sign = std::ranges::find_if(kPlainSigns, [&](const PlainSign& each) { return text.starts_with(each.sign); });
    plain.append(sign == kPlainSigns.end() ? text.substr(0, 1) : sign->plain);
    text.remove_prefix(sign == kPlainSigns.end() ? std::min<std::size_t>(1, text.size()) : sign->sign.size());
  }
  return plain;
}

std::string with_plain_bytes(std::string_view text, const ByteMark& mark) {
  std::string plain;
  plain.reserve(text.size());
  const char* copied = text.data();
  const auto copy_to = [&](const char* to) { plain.append(copied, to), copied = to; };
  for (const std::string_view line : Lines(text))
    for_each_word(line, [&](std::string_view word) {
      const auto byte = byte_of(word, mark);
      if (!byte) return;
      copy_to(word.data());
      plain += fmt::format("{:02X}", *byte);
      copied = word.data() + word.size();
    });
  copy_to(text.data() + text.size());
  return plain;
}

}  // namespace

std::optional<std::string> in_plain_hex(std::string_view text) {
  const bool has_signs = std::ranges::any_of(
      kPlainSigns, [&](const PlainSign& each) { return beginning_of(text).find(each.sign) != std::string_view::npos; });
  const std::string signs = has_signs ? with_plain_signs(text) : std::string();
  const std::string_view plain = has_signs ? std::string_view(signs) : text;
  if (const ByteMark* const mark = mark_of(plain)) return with_plain_bytes(plain, *mark);
  return has_signs ? std::optional(signs) : std::nullopt;
}

}  // namespace s7200::tools
