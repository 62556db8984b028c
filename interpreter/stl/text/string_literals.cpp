#include "interpreter/stl/text/string_literals.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/text/plain_line.hpp"

namespace s7200::stl {
namespace {

/// The character of an escape, which begins after the backslash, and how many bytes that takes.
struct Escaped {
  std::string character;
  std::size_t bytes;
};
Escaped escaped(std::string_view text) {
  constexpr std::string_view kLetters = "nrtbf", kMeaning = "\n\r\t\b\f";
  if (const std::size_t letter = kLetters.find(text.front()); letter != kLetters.npos) return {{kMeaning[letter]}, 1};
  constexpr std::size_t kDigits = 4;
  std::uint32_t code = 0;
  if (text.front() == 'u' && text.size() > kDigits) {
    const auto [end, trouble] = std::from_chars(text.data() + 1, text.data() + 1 + kDigits, code, 16);
    if (trouble == std::errc{} && end == text.data() + 1 + kDigits) return {to_utf8(code), 1 + kDigits};
  }
  return {{text.front()}, 1};
}

std::string without_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '\\' || at + 1 == text.size()) {
      plain += text[at++];
      continue;
    }
    const Escaped escape = escaped(text.substr(at + 1));
    plain += escape.character;
    at += 1 + escape.bytes;
  }
  return plain;
}

/// A string, without its quotes.
struct Literal {
  std::string_view written;
  bool joined = false;   ///< with the one before it: only blanks, + or \ stand between them
  bool in_list = false;  ///< only a comma stands between them
};

std::vector<Literal> literals_of(std::string_view text) {
  std::vector<Literal> literals;
  std::size_t after = 0;
  for (std::size_t at = text.find('"'); at != text.npos; at = text.find('"', after)) {
    std::size_t end = at + 1;
    while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2U : 1U;
    if (end >= text.size()) break;
    const std::string_view between = text.substr(after, at - after);
    const bool none = between.find_first_not_of(" \t\r\n+\\") == between.npos;
    const bool comma = between.find_first_not_of(" \t\r\n,") == between.npos;
    literals.push_back({text.substr(at + 1, end - at - 1), !literals.empty() && none, !literals.empty() && comma && !none});
    after = end + 1;
  }
  return literals;
}

std::size_t statements_in(std::string_view text) {
  std::size_t statements = 0;
  while (!text.empty()) statements += plain::looks_like_statement(take_line(text)) ? 1U : 0U;
  return statements;
}

}  // namespace

std::optional<ProgramInStrings> program_in_strings(std::string_view text) {
  const bool escapes = text.find("\\n") != text.npos || text.find("\\r") != text.npos;
  const std::string_view begin = trim(text).substr(0, 1);
  if (!escapes && begin != "{" && begin != "[") return {};
  std::size_t lines = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = take_line(rest);
    lines += trim(line).empty() ? 0U : 1U;
    if (line.find('\\') == line.npos && plain::looks_like_statement(line)) return {};
  }
  std::vector<std::string> programs;
  bool of_lines = false;  // each string so far of the last program is a line of it
  for (const Literal& literal : literals_of(text)) {
    std::string plain = without_escapes(literal.written);
    const bool line = plain.find('\n') == std::string::npos;
    if (literal.joined)
      programs.back() += plain;
    else if (literal.in_list && of_lines && line && !programs.empty())
      programs.back() += '\n' + plain;
    else
      programs.push_back(std::move(plain));
    of_lines = line && (literal.in_list ? of_lines : true);
  }
  std::erase_if(programs, [](const std::string& each) { return each.find('\n') == each.npos || statements_in(each) == 0; });
  if (programs.size() == 1)
    return ProgramInStrings{std::move(programs.front()), "its program was read from a string; lines are counted in that"};
  std::string whole = programs.empty() && escapes && lines == 1 ? without_escapes(text) : std::string();
  if (statements_in(whole) < 2) return {};
  return ProgramInStrings{std::move(whole), "its line ends, written as \\n, were read as such; lines are counted so"};
}

}  // namespace s7200::stl
