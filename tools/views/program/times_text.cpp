#include "tools/views/program/times_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "tools/views/text_table.hpp"

namespace s7200::tools {
namespace {

/// A line of the table with one figure for each table of times.
struct Line {
  std::vector<std::string_view> mnemonics;
  Areas areas = 0;                    ///< of the first operand; 0: any
  std::vector<const TimeRow*> found;  ///< in each table; null if it has no figure
};

bool same_figures(const std::vector<const TimeRow*>& a, const std::vector<const TimeRow*>& b) {
  return std::ranges::equal(a, b, [](const TimeRow* x, const TimeRow* y) {
    return (!x && !y) || (x && y && x->base == y->base && x->per_unit == y->per_unit && x->marker == y->marker &&
                          range_of_base(*x) == range_of_base(*y) && range_of_unit(*x) == range_of_unit(*y));
  });
}

bool depends_on_area(std::string_view mnemonic, const std::vector<TitledTimes>& tables) {
  return std::ranges::any_of(tables, [&](const TitledTimes& table) {
    return std::ranges::any_of(table.times.rows(), [&](const TimeRow& row) {
      return row.areas != 0 && std::ranges::find(row.mnemonics, mnemonic) != row.mnemonics.end();
    });
  });
}

/// The lines of one name: for each set of areas with the same figures one.
std::vector<Line> lines_of_name(std::string_view name, const std::vector<Area>& areas,
                                const std::vector<TitledTimes>& tables) {
  const auto found_in_all = [&](std::optional<Area> area) {
    std::vector<const TimeRow*> found;
    for (const TitledTimes& table : tables) found.push_back(table.times.find(name, area));
    return found;
  };
  if (areas.empty()) return {{{name}, 0, found_in_all({})}};
  std::vector<Line> lines;
  for (const Area area : areas) {
    const auto found = found_in_all(area);
    const auto same = std::ranges::find_if(lines, [&](const Line& line) { return same_figures(line.found, found); });
    if (same == lines.end())
      lines.push_back({{name}, set_of(area), found});
    else
      same->areas |= set_of(area);
  }
  return lines;
}

void add_to(std::vector<Line>& lines, const Line& line) {
  if (std::ranges::all_of(line.found, [](const TimeRow* row) { return row == nullptr; })) return;
  const auto same = std::ranges::find_if(
      lines, [&](const Line& other) { return other.areas == line.areas && same_figures(other.found, line.found); });
  if (same == lines.end())
    lines.push_back(line);
  else
    same->mnemonics.insert(same->mnemonics.end(), line.mnemonics.begin(), line.mnemonics.end());
}

std::vector<Area> areas_of(const Instruction& instruction, const CpuModel& model) {
  std::vector<Area> areas;
  if (instruction.rules().empty()) return areas;
  for (const AreaInfo& area : all_areas())
    if (contains(instruction.operand[0].areas, area.area) && model.size_of(area.area) > 0) areas.push_back(area.area);
  return areas;
}

std::vector<Line> lines_of_all(const CpuModel& model, const std::vector<TitledTimes>& tables) {
  std::vector<Line> lines;
  for (const SystemTime what : kSystemTimes) {
    std::vector<Area> areas;
    if (what == SystemTime::OperandArea)
      for (const AreaInfo& area : all_areas())
        if (model.size_of(area.area) > 0) areas.push_back(area.area);
    for (const Line& line : lines_of_name(name_of(what), areas, tables)) add_to(lines, line);
  }
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled() || !(instruction.cpus & model.self)) continue;
    const bool by_area = depends_on_area(instruction.mnemonic, tables);
    const auto areas = by_area ? areas_of(instruction, model) : std::vector<Area>{};
    for (const Line& line : lines_of_name(instruction.mnemonic, areas, tables)) add_to(lines, line);
  }
  return lines;
}

/// A figure as base and time per unit: `76 + 4`.
std::string figure_text(const TimeRow* row) {
  if (!row) return "–";
  if (row->per_unit == 0) return in_microseconds(row->base);
  return fmt::format("{} + {}", in_microseconds(row->base), in_microseconds(row->per_unit));
}

nlohmann::ordered_json in_us(Time time) { return static_cast<double>(time) / kMicrosecond; }

/// The uncertainty of base and unit: `25%`; `± 0.6`, `± 0.6, 0.02`.
std::string within_text(const TimeRow& row) {
  if (row.base_within == 0 && row.per_unit_within == 0) return fmt::format("{:g}%", row.uncertainty);
  std::string text = "± " + in_microseconds(row.base_within);
  if (row.per_unit_within > 0) text += ", " + in_microseconds(row.per_unit_within);
  return row.uncertainty > 0 ? fmt::format("{:g}% {}", row.uncertainty, text) : text;
}

constexpr auto kRight = TextTable::Align::Right;

}  // namespace

std::string table_text(const CpuModel& model, const TimeTable& times, std::size_t width) {
  TextTable table({{.heading = "instructions", .breaks = true},
                   {.heading = "form", .breaks = true},
                   {.heading = "base", .align = kRight},
                   {.heading = "per unit", .align = kRight},
                   {.heading = "unit"},
                   {.heading = "marker"},
                   {.heading = "within", .align = kRight},
                   {.heading = "source", .breaks = true}});
  for (const TimeRow& row : times.rows())
    table.add({stl::printable(fmt::format("{}", fmt::join(row.mnemonics, " "))), stl::printable(row.form),
               in_microseconds(row.base), row.per_unit ? in_microseconds(row.per_unit) : "", stl::printable(row.unit),
               row.marker, within_text(row), stl::printable(row.source)});
  const std::string about = fmt::format(
      "Execution times of CPU {0} in microseconds. Only a figure marked 'manual' was read in a manual.\n"
      "To correct them: s7200 times --cpu {0} --csv > my_times.csv, edit, and give --times my_times.csv to a verb, or "
      "write times: my_times.csv into a scenario or a system file.\n\n",
      model.name);
  return stl::wrapped(about, width) + table.text(width);
}

nlohmann::ordered_json table_json(const TimeTable& times) {
  auto rows = nlohmann::ordered_json::array();
  for (const TimeRow& row : times.rows())
    rows.push_back({{"mnemonics", row.mnemonics},
                    {"form", row.form},
                    {"base_us", in_us(row.base)},
                    {"per_unit_us", in_us(row.per_unit)},
                    {"unit", row.unit},
                    {"marker", row.marker},
                    {"source", row.source},
                    {"uncertainty_percent", row.uncertainty},
                    {"base_within_us", in_us(row.base_within)},
                    {"per_unit_within_us", in_us(row.per_unit_within)}});
  return rows;
}

std::string tables_text(const CpuModel& model) {
  std::string text = fmt::format("Tables for CPU {}, for --times:\n", model.name);
  for (const NamedTimes* times : times_of(model))
    text += fmt::format("  {:<18} {}{}\n", times->name, times->about, times->own ? "; the CPU's own" : "");
  return text;
}

nlohmann::ordered_json tables_json(const CpuModel& model) {
  auto tables = nlohmann::ordered_json::array();
  for (const NamedTimes* times : times_of(model))
    tables.push_back({{"name", times->name}, {"about", times->about}, {"own", times->own}});
  return tables;
}

/// The largest by the smallest; 0 where a table has none.
double ratio_of(const Line& line, Time TimeRow::*figure) {
  Time smallest = kNever, largest = 0;
  for (const TimeRow* row : line.found) {
    smallest = std::min(smallest, row ? row->*figure : 0);
    largest = std::max(largest, row ? row->*figure : 0);
  }
  return smallest > 0 ? static_cast<double>(largest) / static_cast<double>(smallest) : 0;
}

std::string side_by_side_text(const CpuModel& model, const std::vector<TitledTimes>& tables, std::size_t width) {
  std::vector<TextTable::Column> columns{{.heading = "instructions", .breaks = true},
                                         {.heading = "first operand", .breaks = true}};
  for (const TitledTimes& table : tables) columns.push_back({.heading = stl::shortened(table.title), .align = kRight});
  columns.push_back({.heading = "ratio", .align = kRight});
  TextTable table(std::move(columns));
  for (const Line& line : lines_of_all(model, tables)) {
    std::vector<std::string> cells{fmt::format("{}", fmt::join(line.mnemonics, " ")), names_of(line.areas)};
    for (const TimeRow* row : line.found) cells.push_back(figure_text(row));
    const double ratio = std::max(ratio_of(line, &TimeRow::base), ratio_of(line, &TimeRow::per_unit));
    cells.push_back(ratio > 0 ? fmt::format("{:.2f}", ratio) : "");
    table.add(std::move(cells));
  }
  const std::string about = fmt::format(
      "Execution times of CPU {} in microseconds, base + per unit, and by how many times they differ, in the one or the "
      "other.\n\n",
      model.name);
  return stl::wrapped(about, width) + table.text(width);
}

nlohmann::ordered_json side_by_side_json(const CpuModel& model, const std::vector<TitledTimes>& tables) {
  auto lines = nlohmann::ordered_json::array();
  for (const Line& line : lines_of_all(model, tables)) {
    auto figures = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const TimeRow* row = line.found[i];
      figures.push_back({{"table", tables[i].title},
                         {"base_us", row ? in_us(row->base) : nlohmann::ordered_json()},
                         {"per_unit_us", row ? in_us(row->per_unit) : nlohmann::ordered_json()},
                         {"marker", row ? nlohmann::ordered_json(row->marker) : nlohmann::ordered_json()}});
    }
    lines.push_back({{"mnemonics", line.mnemonics}, {"areas", names_of(line.areas)}, {"figures", std::move(figures)}});
  }
  return lines;
}

}  // namespace s7200::tools
