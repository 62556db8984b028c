#include "tools/scenario/reading/name_pattern.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace s7200::tools {
namespace {

/// Of ASCII.
char lower_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_between(char c, char first, char last) {
  const auto rank = [](char of) { return static_cast<unsigned char>(lower_letter(of)); };
  return rank(first) <= rank(c) && rank(c) <= rank(last);
}

struct PatternItem {
  std::size_t length = 1;  ///< in the pattern
  bool matches = false;
};

/// [a-z] or [!a-z] at the beginning of a pattern; nothing if the ] is missing. A ] that comes first is one of the
/// characters.
std::optional<PatternItem> set_of_pattern(std::string_view pattern, char c) {
  std::size_t at = 1;
  const bool others = at < pattern.size() && (pattern[at] == '!' || pattern[at] == '^');
  if (others) ++at;
  bool found = false;
  for (const std::size_t first = at; at < pattern.size() && (pattern[at] != ']' || at == first); ++at) {
    if (pattern[at] == '\\' && at + 1 < pattern.size()) ++at;
    const char from = pattern[at];
    const bool is_range = at + 2 < pattern.size() && pattern[at + 1] == '-' && pattern[at + 2] != ']';
    if (is_range) at += 2;
    found = found || is_between(c, from, pattern[at]);
  }
  if (at >= pattern.size()) return {};
  return PatternItem{at + 1, found != others};
}

/// What stands at the beginning of a pattern, but for a *, and whether a character is that.
PatternItem item_of_pattern(std::string_view pattern, char c) {
  if (pattern[0] == '?') return {1, true};
  if (pattern[0] == '[')
    if (const auto of_set = set_of_pattern(pattern, c)) return *of_set;
  const std::size_t escaped = pattern[0] == '\\' && pattern.size() > 1 ? 1 : 0;
  return {1 + escaped, lower_letter(pattern[escaped]) == lower_letter(c)};
}

}  // namespace

/// After a mismatch the last * takes one character more: no other one needs to be tried again.
bool matches_pattern(std::string_view text, std::string_view pattern) {
  std::size_t at = 0, in_pattern = 0;
  std::optional<std::size_t> star, after_star;
  while (at < text.size() || in_pattern < pattern.size()) {
    if (in_pattern < pattern.size() && pattern[in_pattern] == '*') {
      star = ++in_pattern;
      after_star = at;
      continue;
    }
    const PatternItem next = in_pattern < pattern.size() && at < text.size()
                                 ? item_of_pattern(pattern.substr(in_pattern), text[at])
                                 : PatternItem{};
    if (next.matches) {
      ++at;
      in_pattern += next.length;
    } else if (star && *after_star < text.size()) {
      in_pattern = *star;
      at = ++*after_star;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace s7200::tools
