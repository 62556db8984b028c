// Tables of voltages, as oscilloscopes export them: times, or the numbers of samples, and the volts of each channel. A
// threshold half-way makes levels of them.
//
// The forms differ in what stands above the rows: names and units in a row each (Keysight, PicoScope), a record of settings
// (Siglent, Tektronix), which older Tektronix have in the columns beside the first rows, or the interval of the samples
// (Rigol).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/levels/levels.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/table_rows.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostHeadLines = 60;

/// A number that is not inf, as some oscilloscopes write what is beyond their range.
std::optional<double> finite(std::string_view figure) {
  const auto number = parse_decimal<double>(figure);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// A number with the sign of decimals that the table has. Tektronix has plus signs and leading zeros.
std::optional<double> number_in(std::string_view cell, char separator) {
  cell = stl::trim(cell);
  if (cell.starts_with('+')) cell.remove_prefix(1);
  if (separator == ',' || cell.find(',') == std::string_view::npos) return finite(cell);
  std::string figure(cell);
  std::ranges::replace(figure, ',', '.');
  return finite(figure);
}

/// Whether a word of a cell is a unit of voltage: `CH1(V)`, `Volt`, `(mV)`, `CH1V`
bool is_of_volts(std::string_view cell) {
  constexpr std::array<std::string_view, 5> kUnits{"V", "MV", "VOLT", "VOLTS", "VOLTAGE"};
  const std::string capitals = stl::upper_case(cell);
  for (auto begin = capitals.begin(); begin != capitals.end();) {
    begin = std::find_if(begin, capitals.end(), stl::is_letter);
    const auto end = std::find_if_not(begin, capitals.end(), stl::is_letter);
    const bool of_channel = begin != capitals.begin() && stl::is_digit(*(begin - 1)) && std::string_view(begin, end) == "V";
    if (of_channel || std::ranges::find(kUnits, std::string_view(begin, end)) != kUnits.end()) return true;
    begin = end;
  }
  return false;
}

/// Whether a cell is the name of a channel of an oscilloscope: `CH1`, `Channel A`, `C1 (V)`, `CH2V`, `Ampl`
bool is_name_of_channel(std::string_view cell) {
  constexpr std::array<std::string_view, 5> kNames{"CHANNEL ", "CHAN", "CH", "C", "ANALOG "};
  const std::string capitals = stl::upper_case(stl::trim(cell));
  const std::string_view written = capitals, name = stl::trim_end(written.substr(0, written.find_first_of("([")));
  if (name == "AMPL") return true;
  return std::ranges::any_of(kNames, [&](std::string_view each) {
    const std::string_view number = name.starts_with(each) ? name.substr(each.size()) : "";
    return number.size() == 1 || (number.size() == 2 && stl::is_digit(number[0]));
  });
}

/// What stands above the rows, and where the columns are.
struct VoltsHead {
  char separator = ',';
  std::size_t lines = 0;                  ///< before the first row
  std::size_t first = 0;                  ///< column of the times, or of the first channel
  std::size_t columns = 0;                ///< with it
  bool counts = false;                    ///< the first column has numbers of samples
  bool has_time = true;                   ///< the first column has times, or numbers of samples if `interval` is known
  long double unit = kSecond;             ///< of the times, in nanoseconds
  std::optional<long double> interval{};  ///< between samples, in nanoseconds
  std::vector<std::string> names{};       ///< of the channels

  std::size_t first_channel() const { return has_time ? 1 : 0; }
};

/// The fields of the first lines.
std::vector<std::vector<std::string>> fields_of_beginning(std::string_view text, char separator) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string_view line : Lines(text)) {
    rows.push_back(fields_of(line, separator));
    if (rows.size() == kMostHeadLines) break;
  }
  return rows;
}

/// Whether a row has a number in its first column; others may be beyond the range.
bool is_row_of_volts(const std::vector<std::string>& fields, const VoltsHead& head) {
  return head.first < fields.size() && number_in(fields[head.first], head.separator);
}

/// Finds the columns by the numbers in a row, which has nothing before them.
bool find_columns_in(const std::vector<std::string>& row, VoltsHead& head) {
  std::size_t end = row.size();
  while (end > 0 && !number_in(row[end - 1], head.separator)) --end;
  std::size_t begin = end;
  while (begin > 0 && number_in(row[begin - 1], head.separator)) --begin;
  head.first = begin;
  head.columns = end - begin;
  return head.columns > 0 && std::all_of(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(begin),
                                         [](std::string_view cell) { return stl::trim(cell).empty(); });
}

/// Finds the columns by the last rows: of these the one with the most numbers, as a cell may be beyond the range.
bool find_columns(const std::vector<std::vector<std::string>>& rows, VoltsHead& head) {
  constexpr std::size_t kRows = 6;
  VoltsHead found = head;
  for (std::size_t i = rows.size() - kRows; i + 1 < rows.size(); ++i)
    if (find_columns_in(rows[i], found) && found.columns > head.columns) head = found;
  return head.columns > 0;
}

/// The interval that a cell names, in seconds: `tInc = 1e-06`, or the number below or after `Increment`, `Sample Interval`.
std::optional<double> interval_in(const std::vector<std::vector<std::string>>& rows, std::size_t line, std::size_t column,
                                  char separator) {
  const std::string cell = stl::lower_case(rows[line][column]);
  if (const std::size_t at = cell.find("tinc"); at != std::string::npos) {
    const std::size_t equals = cell.find('=', at);
    return equals == std::string::npos ? std::nullopt : number_in(std::string_view(cell).substr(equals + 1), separator);
  }
  if (cell.find("increment") != std::string::npos && line + 1 < rows.size() && column < rows[line + 1].size())
    return number_in(rows[line + 1][column], separator);
  return {};
}

/// Whether a cell above the first column says that it has times.
bool names_time(const std::vector<std::vector<std::string>>& rows, const VoltsHead& head) {
  return std::any_of(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(head.lines), [&](const auto& row) {
    return head.first < row.size() && (is_name_of_time(row[head.first]) || unit_of(row[head.first]) ||
                                       stl::lower_case(row[head.first]).starts_with("x-axis"));
  });
}

/// Whether the first column counts the rows.
bool counts_up(const std::vector<std::vector<std::string>>& rows, const VoltsHead& head) {
  const auto last = number_in(rows[rows.size() - 2][head.first], head.separator);
  const auto before = number_in(rows[rows.size() - 3][head.first], head.separator);
  return last && before && *last == *before + 1;
}

void take_head(const std::vector<std::vector<std::string>>& rows, VoltsHead& head) {
  for (std::size_t line = 0; line < head.lines; ++line) {
    for (std::size_t column = 0; column < rows[line].size(); ++column)
      if (const auto interval = interval_in(rows, line, column, head.separator))
        head.interval = static_cast<long double>(*interval) * kSecond;
    if (rows[line].size() < head.first + head.columns) continue;
    const std::string& name = rows[line][head.first];
    if (const auto unit = unit_of(name); unit && (is_name_of_time(name) || !is_of_volts(name))) head.unit = *unit;
    std::vector<std::string> names(rows[line].begin() + static_cast<std::ptrdiff_t>(head.first),
                                   rows[line].begin() + static_cast<std::ptrdiff_t>(head.first + head.columns));
    if (std::ranges::any_of(names, is_name_of_channel) || head.names.empty()) head.names = std::move(names);
  }
  head.counts = !names_time(rows, head) && counts_up(rows, head);
  head.has_time = head.columns > 1 && !(head.names.size() == head.columns && is_name_of_channel(head.names.front()));
}

/// Whether a cell above the columns or beside them says that they have voltages.
bool says_volts(const std::vector<std::vector<std::string>>& rows, const VoltsHead& head) {
  for (std::size_t line = 0; line < rows.size(); ++line)
    for (std::size_t i = 0; i < (line < head.lines ? rows[line].size() : head.first); ++i)
      if (is_of_volts(rows[line][i]) || is_name_of_channel(rows[line][i])) return true;
  return false;
}

/// Returns nothing for a text that is not a table of numbers with volts.
std::optional<VoltsHead> volts_head_of(std::string_view bytes) {
  constexpr std::size_t kFewestRows = 8;
  const std::string_view beginning = beginning_of(bytes);
  for (const char separator : {'\t', ';', ','}) {
    const auto rows = fields_of_beginning(beginning, separator);
    VoltsHead head{.separator = separator};
    if (rows.size() <= kFewestRows || !find_columns(rows, head)) continue;
    const auto is_row = [&](const std::vector<std::string>& row) { return is_row_of_volts(row, head); };
    head.lines = static_cast<std::size_t>(std::find_if_not(rows.rbegin() + 1, rows.rend(), is_row).base() - rows.begin());
    if (rows.size() - head.lines <= kFewestRows || !says_volts(rows, head)) continue;
    take_head(rows, head);
    if (head.columns > head.first_channel()) return head;
  }
  return {};
}

/// The lowest and the highest voltage of a channel within the range.
struct Swing {
  double low = 0, high = 0;
  bool any = false;

  void take(double volts) {
    if (std::isinf(volts)) return;
    low = any ? std::min(low, volts) : volts;
    high = any ? std::max(high, volts) : volts;
    any = true;
  }
};

class VoltsReader {
 public:
  VoltsReader(const VoltsHead& head, const ReadingChoices& choices) : head_(head), choices_(choices) {}

  /// Calls `tell` with the number of a row's line, its time and its fields. Trouble if a row has no
  /// time, or one before that of the row above.
  template <typename Tell>
  Result<> each_row(std::string_view bytes, Tell tell) const {
    std::vector<std::string> fields;
    std::size_t line = 0;
    std::uint64_t sample = 0;
    std::optional<long double> begin;
    Time last = 0;
    for (const std::string_view text : Lines(bytes, choices_.stop)) {
      if (line++ < head_.lines || stl::trim(text).empty()) continue;
      take_fields(text, head_.separator, fields);
      fields.resize(std::max(fields.size(), head_.first + head_.columns));
      const auto time = time_of(fields[head_.first], sample++);
      if (time && !begin) begin = *time;
      const long double since = time ? *time - *begin : -1;
      if (!(since >= static_cast<long double>(last) && since < static_cast<long double>(kFurthestTime)))
        return trouble("line {}: '{}' is not at a time after the row above it", line, stl::shortened(stl::trim(text)));
      last = std::llround(since);
      tell(last, fields);
    }
    return {};
  }

  /// The voltage of a channel in a row, infinite beyond the range; nothing where the oscilloscope has none.
  std::optional<double> volts(const std::vector<std::string>& fields, std::size_t channel) const {
    const std::string_view cell = stl::trim(fields[head_.first + head_.first_channel() + channel]);
    const bool below = cell.starts_with('-');
    const std::string magnitude = stl::lower_case(cell.substr(below ? 1 : 0));
    if (magnitude != "inf" && magnitude != "\u221E") return number_in(cell, head_.separator);
    return below ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  }

 private:
  std::optional<long double> time_of(std::string_view cell, std::uint64_t sample) const {
    const long double interval =
        choices_.samplerate != 0 ? kSecond / static_cast<long double>(choices_.samplerate) : head_.interval.value_or(0);
    if (interval > 0) return static_cast<long double>(sample) * interval;
    const auto figure = number_in(cell, head_.separator);
    return figure ? std::optional(static_cast<long double>(*figure) * head_.unit) : std::nullopt;
  }

  const VoltsHead& head_;
  const ReadingChoices& choices_;
};

/// The level of a voltage; nothing between the thresholds, where noise and an undriven line are.
std::optional<bool> level_of(double volts, const Swing& swing) {
  constexpr double kHysteresis = 0.1;  // of the swing, to either side of its middle
  const double middle = (swing.low + swing.high) / 2, off = kHysteresis * (swing.high - swing.low);
  if (std::abs(volts - middle) <= off) return {};
  return volts > middle;
}

std::string name_of_channel(const VoltsHead& head, std::size_t channel) {
  const std::size_t column = head.first_channel() + channel;
  const std::string name = column < head.names.size() ? std::string(stl::trim(head.names[column])) : "";
  const bool is_number = std::ranges::all_of(name, stl::is_digit);
  return is_number ? fmt::format("channel {}", channel + 1) : name;
}

}  // namespace

bool looks_like_volts_table(std::string_view bytes) { return is_text(bytes) && volts_head_of(bytes).has_value(); }

Result<LineRecording> read_volts_table(std::string_view bytes, const ReadingChoices& choices) {
  const VoltsHead head = *volts_head_of(bytes);
  if ((!head.has_time || head.counts) && !head.interval && choices.samplerate == 0)
    return Trouble{
        "it has volts and no times: name the rate of its samples with --samplerate, as 1MHz, or export the times, too"};
  const VoltsReader reader(head, choices);
  std::vector<Swing> swings(head.columns - head.first_channel());
  Time end = 0;
  std::size_t rows = 0;
  const auto measure = [&](Time at, const std::vector<std::string>& fields) {
    end = at;
    ++rows;
    for (std::size_t i = 0; i < swings.size(); ++i)
      if (const auto volts = reader.volts(fields, i)) swings[i].take(*volts);
  };
  if (const auto done = reader.each_row(bytes, measure); !done) return done.trouble();
  Levels levels{.end = end};
  for (std::size_t i = 0; i < swings.size(); ++i) levels.channels.push_back({.name = name_of_channel(head, i)});
  const auto take = [&](Time at, const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < swings.size(); ++i)
      if (const auto volts = reader.volts(fields, i))
        if (const auto level = level_of(*volts, swings[i])) levels.channels[i].set(at, *level);
  };
  if (const auto done = reader.each_row(bytes, take); !done) return done.trouble();
  for (std::size_t i = 0; i < swings.size(); ++i) {
    if (levels.channels[i].edges.empty()) continue;
    levels.notes.push_back(fmt::format("{}: its volts from {:g} to {:g} are levels by a threshold of {:g}",
                                       stl::printable(stl::shortened(levels.channels[i].name)), swings[i].low,
                                       swings[i].high, (swings[i].low + swings[i].high) / 2));
  }
  auto recording = frames_of(std::move(levels), choices);
  if (!recording && rows > 1)
    return trouble(
        "{}; its samples are {} apart: a line needs four or more in each bit, and if there are fewer, export "
        "more of them, or the frames of the oscilloscope's serial decoder",
        recording.why(), format_duration(end / static_cast<Time>(rows - 1), 0));
  return recording;
}

}  // namespace s7200::tools
