#include "interpreter/base/diagnostic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::stl {

namespace {

constexpr std::size_t kWindow = 120;      // of a longer line only the part around the place is shown
constexpr std::size_t kBeforePlace = 60;  // and this many characters before it

constexpr const char* kBold = "\x1b[1m";
constexpr const char* kRed = "\x1b[1;31m";
constexpr const char* kMagenta = "\x1b[1;35m";
constexpr const char* kGreen = "\x1b[1;32m";
constexpr const char* kPlain = "\x1b[0m";

std::string painted(std::string text, const char* paint, bool colour) { return colour ? paint + text + kPlain : text; }

/// East Asian characters take two columns of a terminal.
bool is_wide(char32_t code) {
  return (code >= 0x1100 && code <= 0x115F) || (code >= 0x2E80 && code <= 0xD7A3) || (code >= 0xF900 && code <= 0xFAFF) ||
         (code >= 0xFE30 && code <= 0xFE6F) || (code >= 0xFF00 && code <= 0xFF60);
}

/// A blank as wide as the character, for the caret line; the ideographic space is as wide as a wide character.
std::string_view blank_like(char32_t code) {
  if (code == '\t') return "\t";
  return is_wide(code) ? "\u3000" : " ";
}

struct Excerpt {
  std::string shown;
  std::string marks;
};

Excerpt excerpt(std::string_view line, const Position& position) {
  const std::size_t place = position.column - 1;
  const std::size_t length = count_characters(line);
  const std::size_t from = length > kWindow && place > kBeforePlace ? place - kBeforePlace : 0;
  const std::size_t to = std::min(length, from + kWindow);

  Excerpt result;
  if (from > 0) {
    result.shown = "...";
    result.marks = "   ";
  }
  std::size_t index = 0;
  for (const Character c : characters(line)) {
    if (index >= to) break;
    if (index >= from) {
      result.shown += printable(line.substr(0, c.bytes));
      if (index < place) result.marks += blank_like(c.code);
    }
    line.remove_prefix(c.bytes);
    ++index;
  }
  if (to < length) result.shown += "...";

  const std::size_t last = std::min<std::size_t>(to, place + position.length);
  result.marks += '^';
  if (last > place + 1) result.marks.append(last - place - 1, '~');
  return result;
}

std::string location(const Diagnostic& diagnostic, const SourceLines& source) {
  const Position& position = diagnostic.position;
  const FileLine place = in_file(source, position.line);
  const std::string name = printable(place.file);
  if (position.line == 0) return name;
  if (position.column == 0) return fmt::format("{}:{}", name, place.line);
  return fmt::format("{}:{}:{}", name, place.line, position.column);
}

struct Cause {
  const Diagnostic* first;
  std::vector<const Diagnostic*> others;
};

/// The causes in the order of their first diagnostics.
std::vector<Cause> causes_of(const Diagnostics& diagnostics) {
  std::vector<Cause> causes;
  std::map<std::pair<Severity, std::string_view>, std::size_t> known;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!diagnostic.cause.empty()) {
      const auto [found, added] = known.try_emplace({diagnostic.severity, diagnostic.cause}, causes.size());
      if (!added) {
        causes[found->second].others.push_back(&diagnostic);
        continue;
      }
    }
    causes.push_back({&diagnostic, {}});
  }
  return causes;
}

/// The number and the lines of further diagnostics: `3 more, in lines 4, 7, 9`; of many lines only the first ones and the
/// last. A line of another file than that of `first` has its file's name.
std::string where_else(const Diagnostic& first, const std::vector<const Diagnostic*>& others, const SourceLines& source) {
  constexpr std::size_t kLinesShown = 10;
  std::vector<std::uint32_t> lines;
  for (const Diagnostic* diagnostic : others)
    if (lines.empty() || lines.back() != diagnostic->position.line) lines.push_back(diagnostic->position.line);
  const auto shown = [&, home = &in_file(source, first.position.line).file](std::uint32_t line) {
    const FileLine place = in_file(source, line);
    return &place.file == home ? std::to_string(place.line) : fmt::format("{}:{}", printable(place.file), place.line);
  };
  std::string text = fmt::format("{} more, in {} ", others.size(), noun(lines.size(), "line"));
  const bool all = lines.size() <= kLinesShown;
  for (std::size_t i = 0; i < (all ? lines.size() : kLinesShown - 1); ++i) text += (i > 0 ? ", " : "") + shown(lines[i]);
  return all ? text : fmt::format("{} … {}", text, shown(lines.back()));
}

}  // namespace

bool has_errors(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& diagnostic) { return diagnostic.severity == Severity::Error; });
}

void sort(Diagnostics& diagnostics) {
  const auto place = [](const Diagnostic& diagnostic) {
    return std::tuple(diagnostic.position.line, diagnostic.position.column);
  };
  std::stable_sort(diagnostics.begin(), diagnostics.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
}

std::string render(const Diagnostic& diagnostic, const SourceLines& source, bool colour) {
  const bool error = diagnostic.severity == Severity::Error;
  std::string text = painted(location(diagnostic, source) + ":", kBold, colour);
  text += ' ' + painted(error ? "error:" : "warning:", error ? kRed : kMagenta, colour);
  text += ' ' + printable(diagnostic.message);
  if (const std::string section = section_at(source, diagnostic.position.line); !section.empty())
    text += fmt::format(" ({})", printable(section));
  text += diagnostic.name.empty() ? "\n" : fmt::format(" [{}]\n", diagnostic.name);

  const Position& position = diagnostic.position;
  if (position.line > 0 && position.column > 0 && position.line <= source.text.size()) {
    const Excerpt lines = excerpt(source.text[position.line - 1], position);
    text += lines.shown + '\n' + painted(lines.marks, kGreen, colour) + '\n';
  }
  if (!diagnostic.hint.empty()) text += "hint: " + printable(diagnostic.hint) + '\n';
  return text;
}

std::string render(const Diagnostics& diagnostics, const SourceLines& source, bool colour) {
  std::string text;
  for (const Cause& cause : causes_of(diagnostics)) {
    text += render(*cause.first, source, colour);
    if (!cause.others.empty()) text += "also: " + where_else(*cause.first, cause.others, source) + '\n';
  }
  return text;
}

std::size_t count_causes(const Diagnostics& diagnostics) { return causes_of(diagnostics).size(); }

}  // namespace s7200::stl
