#include "tools/views/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kGap = 2;

std::size_t longest_word(const std::string& text) {
  std::size_t longest = 0;
  for (const std::string& word : stl::split_words(text)) longest = std::max(longest, stl::count_characters(word));
  return longest;
}

std::vector<std::string> lines_of_cell(const std::string& cell, std::size_t width) {
  const std::string broken = stl::wrapped(cell, width, 0);
  std::vector<std::string> lines;
  for (std::string_view rest = broken; !rest.empty();) lines.emplace_back(stl::take_line(rest));
  return lines;
}

}  // namespace

TextTable::TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

void TextTable::add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

/// Columns are as wide as their contents; then the widest of those that break gives way until all fit.
std::vector<std::size_t> TextTable::widths(std::size_t width) const {
  std::vector<std::size_t> widths, narrowest;
  std::size_t total = kGap * (columns_.size() - 1);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    widths.push_back(stl::count_characters(columns_[i].heading));
    narrowest.push_back(widths[i]);
    for (const auto& row : rows_) {
      widths[i] = std::max(widths[i], stl::count_characters(row[i]));
      narrowest[i] = std::max(narrowest[i], columns_[i].breaks ? longest_word(row[i]) : widths[i]);
    }
    total += widths[i];
  }
  for (; total > width; --total) {
    std::size_t widest = columns_.size();
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (widths[i] > narrowest[i] && (widest == columns_.size() || widths[i] > widths[widest])) widest = i;
    if (widest == columns_.size()) break;
    --widths[widest];
  }
  return widths;
}

std::string TextTable::row_text(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) const {
  std::vector<std::vector<std::string>> columns;
  std::size_t height = 1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    columns.push_back(lines_of_cell(cells[i], widths[i]));
    height = std::max(height, columns.back().size());
  }
  std::string text;
  for (std::size_t line = 0; line < height; ++line) {
    std::string row;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string part = line < columns[i].size() ? columns[i][line] : "";
      const char* const between = i == 0 ? "" : "  ";
      row += columns_[i].align == Align::Left ? fmt::format("{}{:<{}}", between, part, widths[i])
                                              : fmt::format("{}{:>{}}", between, part, widths[i]);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + '\n';
  }
  return text;
}

std::string TextTable::text(std::size_t width) const {
  const std::vector<std::size_t> fitting = widths(width);
  std::vector<std::string> headings;
  for (const Column& column : columns_) headings.push_back(column.heading);
  std::string text = row_text(headings, fitting);
  for (const auto& row : rows_) text += row_text(row, fitting);
  return text;
}

}  // namespace s7200::tools
