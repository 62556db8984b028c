// A table of text that keeps to the width of a screen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace s7200::tools {

/// Rows of cells in aligned columns with a heading each, two blanks apart.
class TextTable {
 public:
  enum class Align : std::uint8_t { Left, Right };

  struct Column {
    std::string heading;
    Align align = Align::Left;
    bool breaks = false;  ///< a cell that is too wide goes on below, at blanks
  };

  explicit TextTable(std::vector<Column> columns);

  /// A cell for each column.
  void add(std::vector<std::string> cells);

  /// Each line has at most `width` characters, if the columns that break and their longest words allow it.
  std::string text(std::size_t width) const;

 private:
  std::vector<std::size_t> widths(std::size_t width) const;
  std::string row_text(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace s7200::tools
