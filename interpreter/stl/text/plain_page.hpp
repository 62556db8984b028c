// All lines of such a program together: margins, rows of tables, fences, and text around the program.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/stl/is_instruction.hpp"
#include "interpreter/stl/text/plain_line.hpp"

namespace s7200::stl::plain {

/// A line of what has been read so far.
struct Row {
  std::uint32_t original = 0;            // line of the original
  std::string text{};                    // text of the line
  std::vector<std::uint32_t> columns{};  // columns of the original, of each character and of the end; empty: the same
  std::uint32_t changes = 0;
  std::string symbol{};  // row of a table of symbols that stood here

  /// Puts `by` (ASCII) in place of some bytes; it has the column of the first of them.
  void replace(std::size_t at, std::size_t bytes, std::string_view by, Change change);

  /// Puts text at the end, which has the column of the end.
  void append(std::string_view more, Change change);

  void leave_out_beginning(std::size_t bytes, Change change) {
    if (bytes != 0) replace(0, bytes, "", change);
  }

  void leave_out(Change change) {
    text.clear();
    columns.clear();
    changes |= change;
  }
};

/// Rows that are read one by one, and what is left out of them and around them.
struct Page {
  std::vector<Row> rows{};
  std::vector<std::uint32_t> left_out{};  // lines of the original around the program
  std::uint32_t around = 0;               // what the program was cut out of, as a change
};

/// Makes the changes that need all rows. `lines` are those of the original.
Page read_page(std::vector<Row> rows, const std::vector<std::string>& lines, const IsInstruction& is_instruction);

/// Whether a line alone says that the page is to be read: a heading of another language, a row of a table, a margin.
bool may_need_page(std::string_view line);

/// Whether a line may be numbered, quoted, a row of a list or of a table, or a heading.
bool may_have_margin(std::string_view line);

}  // namespace s7200::stl::plain
