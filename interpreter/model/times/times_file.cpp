#include "interpreter/model/times/times_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "interpreter/base/text/csv.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200 {
namespace {

/// The columns of a table, from left to right.
enum Column : std::size_t {
  kMnemonic,     ///< several, with blanks between them, that take the same time; `(scan overhead)`, a system time
  kForm,         ///< areas of the first operand that it is of, `I Q M`; anything else is said to people, and it is of all
  kBase,         ///< time of an execution
  kPerUnit,      ///< and for each bit, byte or the like; empty: nothing
  kUnit,         ///< the unit, in words
  kMarker,       ///< what kind of figure it is: kMarkers
  kSource,       ///< source of the figure
  kUncertainty,  ///< empty: that of the marker, or none if one of the next two columns is filled
  kBaseWithin,   ///< so far the true figures are from these at most; empty: the percentage says it
  kPerUnitWithin,
};
constexpr std::array<std::string_view, kPerUnitWithin + 1> kColumns{"mnemonic",       "form",
                                                                    "base_us",        "per_unit_us",
                                                                    "unit",           "marker",
                                                                    "source",         "uncertainty_percent",
                                                                    "base_within_us", "per_unit_within_us"};
constexpr std::size_t kNeededColumns = kMarker + 1;

constexpr std::string_view kCpu = "# CPU ";

/// The kind of a figure, and its uncertainty in percent if its line does not have one.
struct Marker {
  std::string_view name;
  double uncertainty;
};
constexpr std::array<Marker, 5> kMarkers{
    {{"manual", 5}, {"measured", 5}, {"calibrated", 25}, {"remembered", 25}, {"estimate", 50}}};

/// The range of figures, in microseconds.
constexpr Between<double> kFigures{0.001, static_cast<double>(kLongestFigure) / kMicrosecond};

std::string header(std::size_t columns) { return fmt::format("{}", fmt::join(std::span(kColumns).first(columns), ",")); }

/// The header with brackets around optional columns: `…,marker[,source[,uncertainty_percent]]`
std::string needed_header() {
  const auto optional = std::span(kColumns).subspan(kNeededColumns);
  return fmt::format("{}[,{}{}", header(kNeededColumns), fmt::join(optional, "[,"), std::string(optional.size(), ']'));
}

/// Whether these are the names of the columns, in their order.
bool is_header(const std::vector<std::string>& fields) {
  return fields.size() >= kNeededColumns && fields.size() <= kColumns.size() &&
         std::equal(fields.begin(), fields.end(), kColumns.begin());
}

std::optional<Time> microseconds(const std::string& text) {
  const auto value = parse_decimal<double>(text);
  if (!value || (*value != 0 && !kFigures.has(*value))) return {};
  return static_cast<Time>(std::llround(*value * kMicrosecond));
}

std::string not_a_time(const std::string& text) {
  return fmt::format("'{}' is not a time in microseconds ({} to {})", stl::shortened(text), kFigures.least, kFigures.most);
}

/// The areas that a form names; none if it contains any other word.
Areas areas_of(std::string_view form) {
  Areas areas = 0;
  for (const std::string& word : stl::split_words(form)) {
    const auto area = area_named(word);
    if (!area) return 0;
    areas |= set_of(*area);
  }
  return areas;
}

/// The name of a system time has blanks in its brackets.
std::vector<std::string> mnemonics_of(const std::string& text) {
  return text.starts_with('(') ? std::vector{text} : stl::split_words(text);
}

bool may_be_free(const TimeRow& row) {
  return std::ranges::all_of(row.mnemonics, [](const std::string& m) { return m == "LBL" || m == "SBR" || m == "INT"; });
}

std::string unknown_marker(const std::string& marker) {
  return fmt::format("'{}' is not a marker; there are {}", stl::shortened(marker), stl::joined(kMarkers, &Marker::name));
}

/// Reads one line into `row`. Returns what is wrong with it; empty if nothing is.
std::string read_row(std::string_view line, char separator, TimeRow& row) {
  auto read = csv_fields(line, separator);
  if (!read) return "a double quote is not closed";
  std::vector<std::string>& field = *read;
  if (field.size() < kNeededColumns)
    return fmt::format("{} columns, but {} are needed ({})", field.size(), kNeededColumns, header(kNeededColumns));
  if (field.size() > kColumns.size())
    return fmt::format("{} columns, but there are {} ({}); write a text with commas in double quotes", field.size(),
                       kColumns.size(), header(kColumns.size()));
  for (const Column number : {kBase, kPerUnit, kUncertainty, kBaseWithin, kPerUnitWithin})
    if (number < field.size()) field[number] = with_decimal_point(std::move(field[number]), separator);
  row.mnemonics = mnemonics_of(field[kMnemonic]);
  if (row.mnemonics.empty()) return "the mnemonic is missing";
  row.form = field[kForm];
  row.areas = areas_of(row.form);
  const auto base = microseconds(field[kBase]);
  if (!base) return not_a_time(field[kBase]);
  row.base = *base;
  const auto per_unit = field[kPerUnit].empty() ? Time{0} : microseconds(field[kPerUnit]);
  if (!per_unit) return not_a_time(field[kPerUnit]);
  row.per_unit = *per_unit;
  row.unit = field[kUnit];
  row.marker = field[kMarker];
  const auto marker = std::ranges::find(kMarkers, row.marker, &Marker::name);
  if (marker == kMarkers.end()) return unknown_marker(row.marker);
  row.source = field.size() > kSource ? field[kSource] : "";
  const auto given = [&](Column column) { return field.size() > column && !field[column].empty(); };
  for (const auto& [column, within] : {std::pair{kBaseWithin, &row.base_within}, {kPerUnitWithin, &row.per_unit_within}}) {
    if (!given(column)) continue;
    const auto most = microseconds(field[column]);
    if (!most) return not_a_time(field[column]);
    *within = *most;
  }
  const double usual = given(kBaseWithin) || given(kPerUnitWithin) ? 0 : marker->uncertainty;
  const auto uncertainty = given(kUncertainty) ? parse_decimal<double>(field[kUncertainty]) : usual;
  if (!uncertainty || !Between<double>{0, 1000}.has(*uncertainty))
    return fmt::format("'{}' is not an uncertainty in percent (0 to 1000)", stl::shortened(field[kUncertainty]));
  row.uncertainty = *uncertainty;
  if (row.base == 0 && !may_be_free(row)) return fmt::format("{}: an execution time must be above 0", field[kMnemonic]);
  return {};
}

/// The first operands of each mnemonic for which earlier lines give the time.
class Given {
 public:
  bool hides(const std::string& mnemonic, Areas areas) const {
    const auto known = areas_.find(mnemonic);
    return mnemonic != kSum && known != areas_.end() && (known->second & all(areas)) == all(areas);
  }
  void add(const TimeRow& row) {
    for (const std::string& mnemonic : row.mnemonics) areas_[mnemonic] |= all(row.areas);
  }

 private:
  static Areas all(Areas areas) { return areas == 0 ? static_cast<Areas>(~Areas{0}) : areas; }

  std::map<std::string, Areas> areas_;
};

/// The CPU in a comment such as `# CPU 224`, perhaps with the separators that spreadsheets add. With more words it is a
/// comment like any other.
std::string cpu_of(std::string_view comment) {
  if (!comment.starts_with(kCpu)) return {};
  comment.remove_prefix(kCpu.size());
  const auto words = stl::split_words(comment.substr(0, comment.find_first_of(",;\t")));
  return words.size() == 1 ? words.front() : std::string();
}

/// The number of columns that the table needs: bounds in microseconds only where a line has one.
std::size_t columns_of(const TimeTable& times) {
  const auto has_bound = [](const TimeRow& row) { return row.base_within > 0 || row.per_unit_within > 0; };
  return std::ranges::any_of(times.rows(), has_bound) ? kColumns.size() : std::size_t{kBaseWithin};
}

std::string line_of(const TimeRow& row, std::size_t columns) {
  std::array<std::string, kColumns.size()> field;
  field[kMnemonic] = fmt::format("{}", fmt::join(row.mnemonics, " "));
  field[kForm] = row.form;
  field[kBase] = in_microseconds(row.base);
  if (row.per_unit) field[kPerUnit] = in_microseconds(row.per_unit);
  field[kUnit] = row.unit;
  field[kMarker] = row.marker;
  field[kSource] = row.source;
  field[kUncertainty] = fmt::format("{}", row.uncertainty);
  if (row.base_within) field[kBaseWithin] = in_microseconds(row.base_within);
  if (row.per_unit_within) field[kPerUnitWithin] = in_microseconds(row.per_unit_within);
  std::ranges::transform(field, field.begin(), csv_field);
  return fmt::format("{}\n", fmt::join(std::span(field).first(columns), ","));
}

}  // namespace

TimesFile read_times(std::string_view csv, const std::string& name, std::vector<std::string>& errors) {
  TimesFile file;
  bool header_seen = false, any_line = false;
  char separator = ',';
  std::size_t number = 0;
  while (!csv.empty()) {
    ++number;
    std::string_view line = csv.substr(0, csv.find('\n'));
    csv.remove_prefix(std::min(csv.size(), line.size() + 1));
    line = stl::trim(line);
    if (line.starts_with('#') || line.starts_with("\"#")) {
      if (std::string cpu = cpu_of(line); !cpu.empty()) {
        file.cpu = std::move(cpu);
        file.cpu_line = number;
      }
      continue;
    }
    if (line.find_first_not_of(",;\t ") == std::string_view::npos) continue;
    if (!header_seen) {
      separator = csv_separator(line);
      header_seen = is_header(csv_fields(line, separator).value_or(std::vector<std::string>()));
      if (header_seen) continue;
      errors.push_back(
          fmt::format("{}:{}: not a table of execution times: the first line must be {}", name, number, needed_header()));
      return file;
    }
    any_line = true;
    TimeRow row;
    if (const std::string error = read_row(line, separator, row); !error.empty())
      errors.push_back(fmt::format("{}:{}: {}", name, number, error));
    else
      file.lines.push_back({number, std::move(row)});
  }
  if (!header_seen)
    errors.push_back(fmt::format("{}: the table is empty", name));
  else if (!any_line)
    errors.push_back(fmt::format("{}:{}: the table has no line with a time", name, number));
  return file;
}

std::string cpu_line(std::string_view cpu) { return fmt::format("{}{}\n", kCpu, cpu); }

std::string comment_line(std::string_view text) { return text.empty() ? "" : fmt::format("# {}\n", text); }

std::vector<std::string> hidden_lines(const TimesFile& file, const std::string& name) {
  std::vector<std::string> slips;
  Given given;
  for (const auto& [number, row] : file.lines) {
    const auto is_hidden = [&given, areas = row.areas](const std::string& m) { return given.hides(m, areas); };
    const auto hidden = std::ranges::find_if(row.mnemonics, is_hidden);
    if (hidden != row.mnemonics.end())
      slips.push_back(fmt::format("{}:{}: an earlier line has the time of {} already{}; delete one of them", name, number,
                                  *hidden, row.areas == 0 ? "" : fmt::format(", for {}", row.form)));
    given.add(row);
  }
  return slips;
}

TimeTable in_use(const TimeTable& times) {
  Given given;
  const auto take_what_is_hidden = [&](TimeRow& row) {
    std::erase_if(row.mnemonics, [&](const std::string& mnemonic) { return given.hides(mnemonic, row.areas); });
    given.add(row);
  };
  return times.with(take_what_is_hidden).filtered([](const TimeRow& row) { return !row.mnemonics.empty(); });
}

std::string names_of(Areas areas) {
  std::string names;
  for (const AreaInfo& area : all_areas())
    if (contains(areas, area.area)) names.append(names.empty() ? "" : " ").append(area.name);
  return names;
}

std::string to_csv(const TimeTable& times) {
  const std::size_t columns = columns_of(times);
  std::string text = header(columns) + '\n';
  for (const TimeRow& row : times.rows()) text += line_of(row, columns);
  return text;
}

}  // namespace s7200
