// Lines of a program that has been through something: characters, HTML and Markdown's marks within a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl::plain {

/// What is changed, a bit of each kind.
enum Change : std::uint32_t {
  kBlanks = 1U << 0,
  kFullWidth = 1U << 1,
  kQuotes = 1U << 2,
  kDashes = 1U << 3,
  kSigns = 1U << 4,
  kInvisible = 1U << 5,
  kHtml = 1U << 6,
  kMarkdown = 1U << 7,
  kLineNumbers = 1U << 8,
  kPercent = 1U << 9,
  kMargin = 1U << 10,
  kLineEnds = 1U << 11,
  kQuotedLines = 1U << 12,
  kTable = 1U << 13,
  kHeadings = 1U << 14,
  kLetters = 1U << 15,
  kBrokenComments = 1U << 16,
  kInformation = 1U << 17,
  kSemicolons = 1U << 18,
  kComments = 1U << 19,
  kWrapping = 1U << 20,
  kGaps = 1U << 21,
  kForum = 1U << 22,
  kWiki = 1U << 23,
  kEditors = 1U << 24,
};

/// The names of changes, for a note.
std::vector<std::string_view> names_of(std::uint32_t changes);

/// A part of a line, in bytes.
struct Part {
  std::size_t from = 0, to = 0;

  bool empty() const { return from == to; }
};

inline constexpr ByteSet kQuotationMarks{"'\""};

/// A tag of HTML.
struct Tag {
  std::string name;  // in small letters
  bool closes = false;
  std::size_t bytes = 0;

  bool breaks_line() const;
};

/// The tag at the beginning of a text.
std::optional<Tag> tag_at(std::string_view text);

/// The place of a tag of this name before any comment of a line.
std::size_t find_tag(std::string_view line, std::string_view name, bool closes);

bool has_html(std::string_view line);

/// The line without its comment.
std::string_view code_of(std::string_view line);

/// Its words in capitals; a comma is a blank.
std::vector<std::string> words_of_code(std::string_view line);

/// The first of these words, and how many follow it: `MOVW` and 2. No word: the line has no code.
struct FirstWord {
  std::string word{};
  std::size_t others = 0;
};
FirstWord first_word_of_code(std::string_view line);

/// Whether a line is one of the marks around code: those of Markdown, of forums, `[code]`, `[code=stl]`, `[/code]`, of Jira,
/// `{code}`, of Org, `#+BEGIN_SRC`, and of LaTeX, `\begin{verbatim}`.
bool is_fence(std::string_view line);

/// What a fence is of: Markdown, BBCode, a wiki, Org or LaTeX.
Change change_of_fence(std::string_view line);

/// Whether a line is a short word and operands one of which is an address: `LD I0.0`, `movb 1, vb0`. Good enough to tell a
/// program from text.
bool looks_like_statement(std::string_view line);

/// Whether a text may be the operands of a statement: a few words one of which is an address.
bool look_like_operands(std::string_view text);

/// A line as it is read, with the column that each of its characters had.
struct WrittenLine {
  std::string text{};
  std::vector<std::uint32_t> columns{};  // of each character and of the end
  std::uint32_t changes = 0;
};

/// A part of a line, read; it may be several lines.
std::vector<WrittenLine> written_lines(std::string_view line, Part part, bool html);

/// Whether a line may be different, whatever stands around it.
bool may_be_different(std::string_view line);

}  // namespace s7200::stl::plain
