#include "tools/recordings/rows/bare_cells.hpp"

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/table_rows.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kFewestBareCells = 3, kMostBareCells = 8;

/// A direction that all of a cell is: also W, T and R, as write, transmit and read or receive.
Direction direction_of_all(std::string_view cell) {
  const std::string word = stl::upper_case(cell);
  if (word == "W" || word == "T") return Direction::Request;
  if (word == "R") return Direction::Answer;
  return std::ranges::all_of(word, is_word_sign) ? direction_in_cell(cell) : Direction::Unknown;
}

/// Whether a cell is as many bytes as most frames have.
bool has_frame_in(std::string_view cell) {
  constexpr std::size_t kFewest = 4;
  const auto bytes = bytes_of_text(cell);
  return bytes && bytes->size() >= kFewest;
}

/// Whether a cell says something else for sure: nothing, a number, or a word.
bool is_besides(std::string_view cell) {
  return std::ranges::all_of(cell, stl::is_digit) || (std::ranges::all_of(cell, stl::is_letter) && !bytes_of_text(cell));
}

struct BareRow {
  std::string_view time{}, bytes{};
  Direction direction = Direction::Unknown;
};

/// Puts a cell where it belongs. Returns false if that is not clear.
bool take_cell(BareRow& row, std::string_view cell) {
  const Direction direction = direction_of_all(cell);
  if (direction != Direction::Unknown && row.direction == Direction::Unknown) return row.direction = direction, true;
  if (row.time.empty() && time_in_cell(cell)) return row.time = cell, true;
  if (row.bytes.empty() && has_frame_in(cell)) return row.bytes = cell, true;
  return is_besides(cell);
}

/// The row in a line with that separator; nothing if it has no direction or no bytes.
std::optional<BareRow> row_with(std::string_view line, char separator) {
  const auto cells = std::ranges::count(line, separator) + 1;
  if (cells < static_cast<std::ptrdiff_t>(kFewestBareCells) || cells > static_cast<std::ptrdiff_t>(kMostBareCells))
    return {};
  BareRow row;
  for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + 1) {
    end = line.find(separator, begin);
    if (!take_cell(row, stl::trim(line.substr(begin, end == std::string_view::npos ? end : end - begin)))) return {};
  }
  return row.bytes.empty() || row.direction == Direction::Unknown ? std::nullopt : std::optional(row);
}

std::optional<BareRow> bare_row(std::string_view line) {
  for (const char separator : {';', '\t', ','})
    if (const auto row = row_with(line, separator)) return row;
  return {};
}

}  // namespace

std::optional<std::string> without_bare_cells(std::string_view text) {
  if (std::ranges::none_of(Lines(beginning_of(text)), [](std::string_view line) { return bare_row(line).has_value(); }))
    return {};
  std::string plain;
  const char* copied = text.data();
  for (const std::string_view line : Lines(text)) {
    const auto row = bare_row(line);
    if (!row) continue;
    plain.append(copied, line.data()).append(row->time);
    plain.append(row->direction == Direction::Request ? " TX " : " RX ").append(row->bytes);
    copied = line.data() + line.size();
  }
  return plain.append(copied, text.data() + text.size());
}

}  // namespace s7200::tools
