#include "interpreter/base/text/wrapped.hpp"

#include <algorithm>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl {
namespace {

/// Room that the lines below a broken one have at least.
constexpr std::size_t kLeast = 24;

/// Control sequences such as `ESC [ 33 m` take no room on a screen.
class Screen {
 public:
  bool takes_room(char32_t code) {
    constexpr char32_t kEscape = 0x1B;
    if (code == kEscape) in_sequence_ = true;
    if (!in_sequence_) return true;
    in_sequence_ = code > 0x7F || !is_letter(static_cast<char>(code));
    return false;
  }

 private:
  bool in_sequence_ = false;
};

/// The start of the last column of a line that leaves enough room for the rest of the line.
std::size_t indent_of(std::string_view line, std::size_t width) {
  const std::size_t most = width > kLeast ? width - kLeast : 0;
  std::size_t indent = std::min(line.find_first_not_of(' '), line.size()), column = 0, blanks = 0;
  if (indent > most) return 0;
  Screen screen;
  for (const Character c : characters(line)) {
    if (!screen.takes_room(c.code)) continue;
    if (c.code != ' ' && blanks >= 2 && column <= most) indent = column;
    blanks = c.code == ' ' ? blanks + 1 : 0;
    ++column;
  }
  return indent;
}

/// The number of bytes that fit in a line of `width` characters from `column` on: up to a blank, or the whole of a word that
/// is wider. The line is not broken at the blanks that it begins with.
std::size_t bytes_that_fit(std::string_view line, std::size_t width, std::size_t column) {
  std::size_t bytes = 0, last_blank = 0;
  bool in_text = false;
  Screen screen;
  for (const Character c : characters(line)) {
    if (!screen.takes_room(c.code)) {
      bytes += c.bytes;
      continue;
    }
    if (column > width && last_blank > 0) return last_blank;
    if (c.code == ' ' && in_text) last_blank = bytes;
    in_text |= c.code != ' ';
    bytes += c.bytes;
    ++column;
  }
  return column > width && last_blank > 0 ? last_blank : line.size();
}

void add_wrapped(std::string& text, std::string_view line, std::size_t width, std::size_t indent) {
  for (std::size_t column = 0;; column = indent) {
    const std::size_t bytes = bytes_that_fit(line, width, column);
    text.append(column, ' ').append(trim_end(line.substr(0, bytes))).append(1, '\n');
    const std::size_t rest = line.find_first_not_of(' ', bytes);
    if (rest == std::string_view::npos) return;
    line.remove_prefix(rest);
  }
}

template <class Indent>
std::string wrapped_by(std::string_view text, std::size_t width, Indent indent) {
  std::string wrapped;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.size() <= width)  // no character has less than a byte
      wrapped.append(trim_end(line)).append(1, '\n');
    else
      add_wrapped(wrapped, line, width, indent(line));
  }
  return wrapped;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t width) {
  return wrapped_by(text, width, [&](std::string_view line) { return indent_of(line, width); });
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  return wrapped_by(text, width, [&](std::string_view) { return indent; });
}

}  // namespace s7200::stl
