// What DSView's decoder list exports: `Id,Time[ns],0:UART: RX/TX`, also `Id,Start[ns],End[ns],…`, a character in each row.
// The column's name says whose it is: `0:UART: RX`.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/rows/table_rows.hpp"

namespace s7200::tools {
namespace {

constexpr std::array<std::string_view, 2> kHeads{"Id,Time[ns],", "Id,Start[ns],End[ns],"};
constexpr std::size_t kTime = 1;

/// The first column with characters; 0: it is no table of DSView.
std::size_t first_data(std::string_view bytes) {
  for (const std::string_view head : kHeads)
    if (bytes.starts_with(head)) return static_cast<std::size_t>(std::ranges::count(head, ','));
  return 0;
}

/// A remark of the decoder in place of a character.
enum class Remark : std::uint8_t { None, Damage, Bit };
Remark remark_of(std::string_view cell) {
  const std::string words = stl::lower_case(cell);
  const auto says = [&](std::string_view word) { return words.find(word) != std::string::npos; };
  if (says("error") || says("break")) return Remark::Damage;
  return says("start bit") || says("stop bit") || says("parity bit") ? Remark::Bit : Remark::None;
}

}  // namespace

bool looks_like_dsview(std::string_view bytes) { return first_data(bytes) > 0; }

Result<LineRecording> read_dsview(std::string_view bytes, const ReadingChoices& choices) {
  TableRows rows(bytes, choices.stop);
  const auto names = fields_of(rows.next()->text, ',');
  const std::size_t first = first_data(bytes);
  NotationFinder finder;
  const auto for_each_cell = [&](auto tell) {
    TableRows below = rows;
    while (const auto row = below.next()) {
      const auto fields = fields_of(row->text, ',');
      for (std::size_t column = first; column < fields.size() && column < names.size(); ++column)
        if (const std::string_view cell = stl::trim(fields[column]); !cell.empty()) tell(*row, fields, column, cell);
    }
  };
  for_each_cell([&](const TableRow& row, const auto&, std::size_t, std::string_view cell) {
    if (remark_of(cell) == Remark::None) finder.take(cell, row.number);
  });
  const auto notation = finder.found();
  if (!notation) return notation.trouble();
  LineRecording recording;
  for_each_cell([&](const TableRow& row, const auto& fields, std::size_t column, std::string_view cell) {
    const Remark remark = remark_of(cell);
    if (remark == Remark::Damage && !recording.frames.empty()) recording.frames.back().damaged = {0};
    if (remark != Remark::None) return;
    const auto time = parse_decimal<long double>(stl::trim(fields[kTime]));
    if (!time || !(*time >= 0 && *time < static_cast<long double>(kFurthestTime)))
      return recording.frames.push_back(
          row_not_read(row.number, not_understood(fields[kTime]), {}, direction_of(names[column])));
    recording.frames.push_back({.at = static_cast<Time>(*time),
                                .direction = direction_of(names[column]),
                                .bytes = *notation->read(cell),
                                .place = fmt::format("line {}", row.number)});
  });
  count_from_first(recording);
  join_characters(recording, choices);
  return recording;
}

}  // namespace s7200::tools
