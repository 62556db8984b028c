// Program text that has been through a web page, a word processor or a book.
//
// Read as what they stand for: no-break and other Unicode blanks, full-width signs, typographic quotes, dashes and signs,
// HTML tags and entities, cells of tables, headings of networks in other languages; left out: characters that nobody sees,
// Markdown fences and what is around them, line numbers, bullets, the > of quoted mail, the times and names of a chat,
// strokes and rules of tables, quotes around each line, text around lines with these, the % before an address. All of this
// may come together, in any order. Comments and quoted text stay as they are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/text/plain_page.hpp"

namespace s7200::stl {

class PlainText {
 public:
  /// The text `original` (UTF-8) must live as long as this object. Without `is_instruction` less is read: only it can tell
  /// the title of a network from a statement.
  explicit PlainText(std::string_view original, const IsInstruction& is_instruction = {});

  /// The text for the readers. A line of the original may be several lines of it.
  std::string_view text() const { return lines_.empty() ? original_ : text_; }

  /// The tables of symbols that a printout has below its networks, each line where it stands in text(); empty: there are
  /// none.
  std::string_view symbols() const { return symbols_; }

  /// Puts the lines and places of the original in what was read from text(), and a note of what is different, if statements,
  /// symbols or values were read from such lines.
  void restore(ParseResult& read) const;

 private:
  struct Line {
    std::uint32_t original = 0;            // line of the original
    std::vector<std::uint32_t> columns{};  // columns of the original, of each character and of the end; empty: the same
    std::uint32_t changes = 0;             // what was changed, a bit of each kind
  };

  Position in_original(const Position& place) const;
  std::string note(const ParseResult& read) const;

  std::string_view original_;
  std::string text_, symbols_;
  std::vector<std::string> original_lines_;
  std::vector<Line> lines_;                // of text_; none if nothing is different
  std::vector<std::uint32_t> left_out_{};  // lines of the original around its program
  std::uint32_t around_ = 0;               // what its program was cut out of, as a change
};

/// A few characters of a program, as PlainText reads them.
std::string plain_characters(std::string_view written);

}  // namespace s7200::stl
