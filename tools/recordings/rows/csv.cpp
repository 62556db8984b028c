// Tables of logic analysers and sniffers: the first row names the columns.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/parser.hpp"
#include "tools/json/base64.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/rows/table_rows.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

char separator_of(std::string_view line) {
  for (const char c : {'\t', ';', '|', ','})
    if (line.find(c) != std::string_view::npos) return c;
  return 0;
}

struct Columns {
  char separator = 0;
  std::optional<std::size_t> time{}, direction{}, data{};
  std::optional<std::size_t> sent{}, received{};  ///< instead of direction and data
  std::size_t byte_columns = 0;  ///< from `data` on, each with a byte of the frame; 0: the bytes stand in one
  bool parts = false;            ///< each of them has a part of the frame: station, function, data, CRC
  bool headless = false;         ///< the first row names nothing: it has a character as the others do
  bool of_exchanges = false;     ///< a row has a request and its answer: `Time,Request,Response`
  std::vector<std::size_t> errors{};
  Time unit = kSecond;
  bool base64 = false;                ///< the name of the data says so
  std::string unknown_unit{};         ///< the name of the times' column, if its text in brackets is not a unit
  bool differences = false;           ///< each time counts from the row above
  std::vector<std::size_t> of_plc{};  ///< those that are called as addresses of the PLC: they have its values

  bool is_of_plc(std::size_t column) const { return std::ranges::find(of_plc, column) != of_plc.end(); }
};

/// Whether `text`, in any case, contains one of `words`, which are in capitals.
bool contains(std::string_view text, std::initializer_list<std::string_view> words) {
  const std::string capitals = stl::upper_case(text);
  return std::ranges::any_of(words, [&](std::string_view word) { return capitals.find(word) != std::string::npos; });
}

/// Whether a name is only a unit: `us`, `[ms]`, `t [us]`
bool is_unit(std::string_view name) {
  std::string word = stl::upper_case(name);
  std::erase_if(word, [](char c) { return std::ispunct(static_cast<unsigned char>(c)) != 0 || c == ' '; });
  if (word.size() > 1 && word.front() == 'T') word.erase(0, 1);
  return unit_of(word).has_value();
}

/// Finds a column with the bytes of each direction: `Time,TX,RX`. A row with bytes or times names nothing.
void find_one_for_each_direction(const std::vector<std::string>& names, Columns& columns) {
  const auto is_value = [](const std::string& name) {
    return bytes_of_text(name) || leading_time(name) || name.find("0x") != std::string::npos;
  };
  if (std::ranges::any_of(names, is_value)) return;
  const auto is_station = [](const std::string& name) { return contains(name, {"SLAVE", "MASTER"}); };
  const bool besides = std::ranges::count_if(names, [&](const std::string& name) {
                         return direction_of(name) != Direction::Unknown && !is_station(name);
                       }) > 1;  // `Slave;Raw request;Raw response`
  const auto found = [&](Direction direction) -> std::optional<std::size_t> {
    const auto name = std::ranges::find_if(
        names, [&](const std::string& each) { return direction_of(each) == direction && !(besides && is_station(each)); });
    return name == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(name - names.begin()));
  };
  const auto sent = found(Direction::Request), received = found(Direction::Answer);
  if (!sent || !received || sent == received) return;
  columns.sent = sent;
  columns.received = received;
  columns.of_exchanges = contains(names[*sent], {"REQ", "QUERY", "ANFRAGE", "SOLICITUD", "PEDIDO", "RICHIESTA"});
  columns.data = columns.direction = std::nullopt;
}

/// Whether a name says how many bytes there are, or which: `Byteanzahl`, `Data length`
bool is_count(std::string_view name) {
  return contains(name, {"ANZAHL", "COUNT", "LENGTH", "L\u00C4NGE", "L\u00E4NGE", "LAENGE", "SIZE", "INDEX", " NR", " NO"});
}

bool is_name_of_data(std::string_view name) {
  return !is_count(name) &&
         contains(name, {"DATA", "VALUE", "HEX", "BYTE", "FRAME", "PAYLOAD", "RESULT", "WERT", "DATEN", "TELEGRAM",
                         "NACHRICHT", "BASE64", "B64", "ZEICHEN", "TRAME", "TRAMA", "DATOS", "DATI", "DADOS"});
}

/// Finds columns with a byte each: `B0;B1;B2;B3`, `Byte 1,Byte 2,…`
void find_columns_of_bytes(const std::vector<std::string>& names, Columns& columns) {
  constexpr std::size_t kFewest = 4;
  struct Numbered {
    std::string_view name;
    std::optional<std::uint32_t> number;
  };
  const auto numbered = [](std::string_view name) {
    name = stl::trim(name);
    const std::size_t end = name.find_last_not_of("0123456789") + 1;
    return Numbered{name.substr(0, end), parse_decimal<std::uint32_t>(name.substr(end))};
  };
  for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end) {
    const Numbered first = numbered(names[begin]);
    for (end = begin + 1; end < names.size() && first.number && !first.name.empty(); ++end) {
      const Numbered next = numbered(names[end]);
      if (next.name != first.name || next.number != *first.number + (end - begin)) break;
    }
    if (end - begin < kFewest) continue;
    columns.data = begin;
    columns.byte_columns = end - begin;
    return;
  }
}

/// Finds columns with the parts of a frame, side by side: `Addr,Func,Data,CRC`
void find_columns_of_parts(const std::vector<std::string>& names, Columns& columns) {
  static constexpr std::array<std::string_view, 7> kStations{"ADDR", "ADDRESS", "STATION", "SLAVE", "UNIT", "ID", "DEVICE"};
  static constexpr std::array<std::string_view, 5> kFunctions{"FUNC", "FUNCTION", "FC", "FUNCTION CODE", "CODE"};
  const auto is_any = [&](std::size_t i, const auto& words) {
    return std::ranges::find(words, stl::upper_case(stl::trim(names[i]))) != words.end();
  };
  for (std::size_t i = 0; i + 3 < names.size(); ++i) {
    if (!is_any(i, kStations) || !is_any(i + 1, kFunctions)) continue;
    std::size_t sum = i + 2;
    while (sum < names.size() && !is_name_of_check_sum(stl::trim(names[sum]))) ++sum;
    if (sum == names.size()) continue;
    columns.data = i;
    columns.byte_columns = sum + 1 - i;
    columns.parts = true;
    return;
  }
}

bool is_name_of_difference(std::string_view name) {
  const std::string capitals = stl::upper_case(name);
  const bool is_short = capitals.starts_with("DT") && (capitals.size() == 2 || !stl::is_letter(capitals[2]));
  return is_short || contains(name, {"DELTA", "\u0394T"});
}

/// Whether a column is called as an address of the PLC, `VW20`, `%MB4`, `T37`: it has the values that are there.
bool is_address_of_plc(std::string_view name) {
  name = stl::trim(name);
  if (name.starts_with('%')) name.remove_prefix(1);
  const auto operand = stl::parse_operand(name);
  return operand && std::holds_alternative<stl::Address>(operand->value);
}

Columns columns_of(std::string_view line) {
  constexpr std::ptrdiff_t kMostColumns = 1000;
  Columns columns{.separator = separator_of(line)};
  if (columns.separator == 0 || std::ranges::count(line, columns.separator) > kMostColumns) return {};
  const auto names = fields_of(line, columns.separator);
  if (std::ranges::any_of(names, [](const std::string& name) { return leading_time(name).has_value(); })) return columns;
  find_columns_of_bytes(names, columns);
  if (columns.byte_columns == 0) find_columns_of_parts(names, columns);
  std::optional<std::size_t> difference;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_address_of_plc(names[i])) columns.of_plc.push_back(i);
    if (is_name_of_difference(names[i])) difference = difference.value_or(i);
    if (columns.byte_columns > 0 && i >= *columns.data && i < *columns.data + columns.byte_columns) continue;
    if (contains(names[i], {"ERROR"})) {
      columns.errors.push_back(i);
    } else if (!columns.time && !is_name_of_difference(names[i]) && (is_name_of_time(names[i]) || is_unit(names[i]))) {
      columns.time = i;
      if (const auto unit = unit_of(names[i]))
        columns.unit = *unit;
      else if (names[i].find_first_of("[(") != std::string::npos)
        columns.unknown_unit = names[i];
    } else if (!columns.direction && contains(names[i], {"DIR", "SIDE", "CHANNEL", "PORT", "NAME", "PHASE"})) {
      columns.direction = i;
    } else if (!columns.data && is_name_of_data(names[i])) {
      columns.data = i;
      columns.base64 = contains(names[i], {"BASE64", "B64"});
    }
  }
  if (!columns.time && difference) {
    columns.time = difference;
    columns.differences = true;
    columns.unit = unit_of(names[*difference]).value_or(columns.unit);
  }
  if (!columns.data || !columns.direction) find_one_for_each_direction(names, columns);
  return columns;
}

/// A number in the column's unit, or a time as in a text. Where commas divide the columns, one in a number may stand for
/// thousands, and is not read.
std::optional<LeadingTime> time_of(std::string_view field, const Columns& columns) {
  std::string figure(stl::trim(field));
  std::ranges::replace(figure, ',', '.');
  if (const auto number = parse_decimal<long double>(figure)) {
    const long double time = *number * static_cast<long double>(columns.unit);
    const bool readable = columns.separator != ',' || field.find(',') == std::string_view::npos;
    if (!readable || !(std::abs(time) < static_cast<long double>(kFurthestTime))) return {};
    return LeadingTime{.time = std::llround(time)};
  }
  return time_in_cell(field);
}

/// Whether a field of an error column reports an error.
bool says_error(std::string_view field) {
  static constexpr std::array<std::string_view, 8> kNone{"", "0", "-", "NO", "NONE", "FALSE", "OK", "NO ERROR"};
  return std::ranges::find(kNone, stl::upper_case(stl::trim(field))) == kNone.end();
}

/// Whether a cell may be a value in decimal: it has digits alone, fewer than a frame.
bool may_be_decimal(std::string_view cell) {
  constexpr std::size_t kOfFrame = 8;
  return cell.size() < kOfFrame && std::ranges::all_of(cell, stl::is_digit);
}

/// What the cells of a column are in the first rows below the names.
struct Cells {
  std::size_t filled = 0, with_direction = 0, with_bytes = 0, bytes = 0, marked = 0;

  void take(std::string_view cell) {
    if (cell.empty()) return;
    ++filled;
    with_direction += direction_in_cell(cell) != Direction::Unknown;
    const auto read = may_be_decimal(cell) ? std::nullopt : bytes_of_text(cell);
    with_bytes += read.has_value();
    bytes += read ? read->size() : 0;
    marked += read && cell.starts_with("0x");
  }
  bool are_directions() const { return filled > 0 && with_direction == filled; }
  /// Pairs of digits alone may count something.
  bool are_bytes() const { return 2 * with_bytes > filled && (bytes > with_bytes || marked == with_bytes); }
};

/// The cells of all columns. Empty if a row has no time in the column of the times.
std::vector<Cells> cells_below(TableRows rows, const Columns& columns) {
  constexpr std::size_t kRows = 20;
  std::vector<Cells> cells;
  std::vector<std::string> fields;
  for (std::size_t count = 0; count < kRows; ++count) {
    const auto row = rows.next();
    if (!row) break;
    if (stl::trim(row->text).empty()) continue;
    take_fields(row->text, columns.separator, fields);
    if (columns.time && (*columns.time >= fields.size() || !time_of(stl::trim(fields[*columns.time]), columns))) return {};
    cells.resize(std::max(cells.size(), fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i) cells[i].take(stl::trim(fields[i]));
  }
  return cells;
}

/// Finds columns whose names are not known by what is in them: that with the most bytes, and that with a direction in each
/// row. A table is known by the name of its times.
void find_by_cells(const TableRows& rows, Columns& columns) {
  if (!columns.time || columns.sent) return;
  const std::vector<Cells> cells = cells_below(rows, columns);
  if (!columns.data)
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (i != columns.time && !columns.is_of_plc(i) && cells[i].are_bytes() &&
          (!columns.data || cells[i].bytes > cells[*columns.data].bytes))
        columns.data = i;
  if (columns.direction && *columns.direction < cells.size() && cells[*columns.direction].with_direction > 0) return;
  const auto found = std::ranges::find_if(cells, &Cells::are_directions);
  if (found != cells.end()) columns.direction = static_cast<std::size_t>(found - cells.begin());
}

/// Finds the columns of rows that each have a time, a direction and one character, in any order, below no names:
/// `TX,0.001040,03`. Nothing if a column may be something else as well.
std::optional<Columns> columns_of_characters(TableRows rows) {
  constexpr std::size_t kRows = 50, kFewestRows = 4, kFewestCells = 3, kMostCells = 8;
  struct Column {
    bool times = true, directions = true, counts = true;  ///< counts: each cell is one more than that above
    std::optional<std::uint32_t> last{};
    NotationFinder notation{};
  };
  Columns found{.headless = true};
  std::vector<Column> columns;
  std::vector<std::string> fields;
  std::size_t count = 0;
  for (auto row = rows.next(); row && count < kRows; row = rows.next()) {
    if (stl::trim(row->text).empty()) continue;
    if (count++ == 0) found.separator = separator_of(row->text);
    if (found.separator == 0) return {};
    take_fields(row->text, found.separator, fields);
    if (fields.size() < kFewestCells || fields.size() > kMostCells) return {};
    if (columns.empty()) columns.resize(fields.size());
    if (fields.size() != columns.size()) return {};
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::string_view cell = stl::trim(fields[i]);
      columns[i].times = columns[i].times && time_in_cell(cell);
      columns[i].directions = columns[i].directions && direction_in_cell(cell) != Direction::Unknown;
      const auto number = parse_decimal<std::uint32_t>(cell);
      columns[i].counts = columns[i].counts && number && (count == 1 || *number == *columns[i].last + 1);
      columns[i].last = number;
      columns[i].notation.take(cell, row->number);
    }
  }
  if (count < kFewestRows) return {};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto notation = columns[i].notation.found();
    const bool characters = notation && columns[i].notation.are_characters(*notation);
    std::optional<std::size_t>& column = columns[i].times        ? found.time
                                         : columns[i].directions ? found.direction
                                                                 : found.data;
    if (columns[i].counts || (!columns[i].times && !columns[i].directions && !characters)) continue;
    if (std::exchange(column, i)) return {};
  }
  return found.time && found.direction && found.data ? std::optional(found) : std::nullopt;
}

/// The next row that is not blank; nothing at the end, or where many are blank.
std::optional<TableRow> next_filled(TableRows& rows) {
  constexpr std::size_t kMostBlank = 100;
  for (std::size_t blank = 0; blank <= kMostBlank; ++blank) {
    const auto row = rows.next();
    if (!row || !stl::trim(row->text).empty()) return row;
  }
  return {};
}

/// The columns of a table, whose names are taken off it.
Columns take_columns(TableRows& rows) {
  if (auto columns = columns_of_characters(rows)) return *columns;
  const auto names = next_filled(rows);
  Columns columns = columns_of(names ? names->text : "");
  find_by_cells(rows, columns);
  return columns;
}

/// A list without times is one of bytes in its second row already.
bool has_bytes_below(TableRows rows, const Columns& columns) {
  const auto second = next_filled(rows);
  const auto fields = second ? fields_of(second->text, columns.separator) : std::vector<std::string>{};
  return *columns.data < fields.size() && bytes_of_text(fields[*columns.data]);
}

/// Bytes without the mark that keeps them a text in a spreadsheet: `'0103000A`, `="0103000A"`
std::string_view without_mark_of_text(std::string_view cell) {
  constexpr std::size_t kFewest = 8;  // digits
  if (cell.size() <= kFewest || !is_any_of(cell.front(), "'=") || !bytes_of_text(cell.substr(1))) return cell;
  return cell.substr(1);
}

/// The content of a cell without blanks around it. A blank or a line end alone is a recorded character, unless the row has a
/// column for each direction: then the cell is empty.
std::string_view content_of(std::string_view field, const Columns& columns) {
  return field.size() == 1 && !columns.sent ? field : without_mark_of_text(stl::trim(field));
}

/// The cell with the bytes. Those of a column each are joined, in `joined`, up to the first that is empty.
std::string_view cell_of(const std::vector<std::string>& fields, std::size_t column, const Columns& columns,
                         std::string& joined) {
  if (columns.byte_columns == 0) return column < fields.size() ? std::string_view(fields[column]) : "";
  joined.clear();
  for (std::size_t i = column; i < std::min(fields.size(), column + columns.byte_columns); ++i) {
    const std::string_view cell = stl::trim(fields[i]);
    if (cell.empty() && columns.parts) continue;  // a function without data
    if (cell.empty()) break;
    joined.append(joined.empty() ? "" : " ").append(cell);
  }
  return joined;
}

constexpr Notation kBase64{"base64", [](std::string_view cell) -> std::optional<Bytes> {
                             auto bytes = from_base64(cell);
                             return bytes && !bytes->empty() ? std::move(bytes) : std::nullopt;
                           }};

/// The notation of the bytes below the names.
struct ColumnNotation {
  const Notation* notation = nullptr;
  bool characters = false;          ///< each row has one
  const Notation* other = nullptr;  ///< the bytes may be in this as well; the protocol tells
};
Result<ColumnNotation> notation_of(TableRows rows, const Columns& columns) {
  if (columns.base64) return ColumnNotation{.notation = &kBase64};
  NotationFinder finder;
  std::vector<std::string> fields;
  std::string joined;
  while (const auto row = rows.next()) {
    take_fields(row->text, columns.separator, fields);
    for (const auto& column : {columns.data, columns.sent, columns.received})
      if (column && *column < fields.size())
        if (const std::string_view cell = content_of(cell_of(fields, *column, columns, joined), columns); !cell.empty())
          finder.take(without_error(cell).cell, row->number);
  }
  const auto found = finder.found();
  if (!found) return found.trouble();
  return ColumnNotation{
      .notation = &*found, .characters = columns.time && finder.are_characters(*found), .other = finder.other(*found)};
}

}  // namespace

bool looks_like_csv(std::string_view bytes) {
  if (!is_text(bytes) || bytes.empty()) return false;
  TableRows rows(bytes);
  const Columns columns = take_columns(rows);
  TableRows below = rows;
  if (!columns.headless && !next_filled(below)) return false;  // one row alone names nothing
  if (columns.sent) return true;
  if (!columns.data || columns.time) return columns.data.has_value();
  return columns.direction && has_bytes_below(rows, columns);
}

bool is_table_without_bytes(std::string_view bytes) {
  if (!is_text(bytes) || bytes.empty()) return false;
  TableRows rows(bytes);
  const Columns columns = take_columns(rows);
  return columns.time && !columns.data && !columns.sent && !cells_below(rows, columns).empty();
}

Result<LineRecording> read_csv(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  TableRows rows(bytes, choices.stop);
  const Columns columns = take_columns(rows);
  const auto found = notation_of(rows, columns);
  if (!found) return found.trouble();
  const auto [notation, characters, other] = *found;
  DayCounter days;
  CharacterJoiner joiner(choices);
  std::vector<std::string> fields;
  std::string joined;
  LeftOut left_out;
  Time since_first = 0;  // of times that are differences
  while (const auto row = rows.next()) {
    if (row->text.find_first_not_of(" \t,;") == std::string::npos) continue;
    take_fields(row->text, columns.separator, fields);
    const auto field = [&](std::optional<std::size_t> column) {
      return column && *column < fields.size() ? std::string_view(fields[*column]) : "";
    };
    auto time = columns.time ? time_of(field(columns.time), columns) : std::nullopt;
    if (time && columns.differences) time->time = since_first += time->time;
    const bool is_received = columns.sent && stl::trim(field(columns.sent)).empty();
    const auto data_column = !columns.sent ? columns.data : is_received ? columns.received : columns.sent;
    const std::string_view cell = content_of(data_column ? cell_of(fields, *data_column, columns, joined) : "", columns);
    const WrittenCharacter written = without_error(cell);
    auto data = notation->read(written.cell);
    if (time && !time->of_day && !columns.unknown_unit.empty())
      return trouble("line 1: '{}' names no unit; write [s], [ms], [us] or [ns]", stl::shortened(columns.unknown_unit));
    const bool no_time = columns.time && !time;
    if (!no_time && cell.empty()) {  // sniffers note reads that brought nothing
      left_out.without_bytes(row->number);
      continue;
    }
    if (!columns.of_exchanges && columns.sent && !is_received && !stl::trim(field(columns.received)).empty())
      return trouble("line {}: bytes in both directions; write them in two lines", row->number);
    const std::string_view other_cell =  // of a row with a request and its answer
        columns.sent && !is_received ? content_of(stl::trim(field(columns.received)), columns) : std::string_view();
    auto answer = other_cell.empty() ? std::nullopt : notation->read(other_cell);
    if (no_time || !data || (!other_cell.empty() && !answer)) {
      const std::string_view wrong = no_time ? field(columns.time) : data ? other_cell : cell;
      return trouble("line {}: '{}' is not {}", row->number, stl::shortened(wrong),
                     no_time ? "a time" : fmt::format("bytes in {}", notation->name));
    }
    RecordedFrame frame{.at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt,
                        .direction = !columns.sent ? direction_in_cell(field(columns.direction))
                                     : is_received ? Direction::Answer
                                                   : Direction::Request,
                        .bytes = std::move(*data),
                        .place = fmt::format("line {}", row->number)};
    if (const auto others = other != nullptr ? other->read(written.cell) : std::nullopt; others && *others != frame.bytes)
      frame.doubt = std::make_shared<Doubt>(Doubt{.why = "its numbers may be decimal or hex",
                                                  .word = stl::printable(stl::shortened(written.cell)),
                                                  .readings = {{frame.bytes, false}, {*others, false}}});
    if (written.damaged ||
        std::ranges::any_of(columns.errors, [&](std::size_t column) { return says_error(field(column)); }))
      for (std::size_t place = 0; place < frame.bytes.size(); ++place) frame.damaged.push_back(place);
    if (characters)
      joiner.add(frame, recording.frames);
    else
      recording.frames.push_back(std::move(frame));
    if (answer)  // the row has one time, that of the request
      recording.frames.push_back(
          {.direction = Direction::Answer, .bytes = std::move(*answer), .place = fmt::format("line {}", row->number)});
  }
  count_from_first(recording);
  if (columns.differences) recording.notes.emplace_back("its times are called differences: each counts from the row above");
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools
