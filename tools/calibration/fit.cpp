#include "tools/calibration/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times_file.hpp"

namespace s7200::tools {
namespace {

/// Counts are whole numbers, and remain small fractions.
constexpr double kZero = 1e-9;

/// An equation: so often each form takes so long. `of` says which loops were added up for it, how often each.
struct Equation {
  std::vector<double> counts, of;
};

void subtract(Equation& from, const Equation& other, double times) {
  for (std::size_t i = 0; i < from.counts.size(); ++i) {
    from.counts[i] -= times * other.counts[i];
    if (std::abs(from.counts[i]) < kZero) from.counts[i] = 0;
  }
  for (std::size_t i = 0; i < from.of.size(); ++i) from.of[i] -= times * other.of[i];
}

void divide(Equation& equation, double by) {
  for (double& count : equation.counts) count /= by;
  for (double& loop : equation.of) loop /= by;
}

LoopTime time_of(const Equation& equation, const std::vector<LoopTime>& times) {
  LoopTime sum;
  for (std::size_t i = 0; i < equation.of.size(); ++i) {
    sum.ns += equation.of[i] * times[i].ns;
    sum.within += std::abs(equation.of[i]) * times[i].within;
  }
  return sum;
}

}  // namespace

Fit fit(const Loops& loops, const std::vector<LoopTime>& times) {
  std::vector<Equation> equations;
  for (std::size_t i = 0; i < times.size(); ++i) {
    equations.push_back({loops.loops[i], std::vector<double>(times.size(), 0)});
    equations.back().of[i] = 1;
  }
  std::size_t solved = 0;
  for (std::size_t form = 0; form < loops.forms.size(); ++form) {
    // Of those that have the form the one that is surest of it.
    std::size_t best = equations.size();
    double best_within = 0;
    for (std::size_t i = solved; i < equations.size(); ++i) {
      if (equations[i].counts[form] == 0) continue;
      const double within = time_of(equations[i], times).within / std::abs(equations[i].counts[form]);
      if (best == equations.size() || within < best_within) {
        best = i;
        best_within = within;
      }
    }
    if (best == equations.size()) continue;
    std::swap(equations[solved], equations[best]);
    divide(equations[solved], equations[solved].counts[form]);
    for (std::size_t i = 0; i < equations.size(); ++i)
      if (i != solved && equations[i].counts[form] != 0)
        subtract(equations[i], equations[solved], equations[i].counts[form]);
    ++solved;
  }
  Fit result;
  for (const Form& form : loops.forms) result.forms.push_back({form});
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const LoopTime time = time_of(equations[i], times);
    const auto left = std::ranges::count_if(equations[i].counts, [](double count) { return count != 0; });
    if (left == 0) result.contradiction = std::max(result.contradiction, std::abs(time.ns) - time.within);
    if (left != 1) continue;
    const auto form = std::ranges::find_if(equations[i].counts, [](double count) { return count != 0; });
    result.forms[static_cast<std::size_t>(form - equations[i].counts.begin())] = {
        loops.forms[static_cast<std::size_t>(form - equations[i].counts.begin())], true, time.ns, time.within};
  }
  return result;
}

namespace {

/// In percent, as the tables have it: the true figure is between this one / (1 + p / 100) and this one × (1 + p / 100).
double percent(const Fitted& fitted) {
  const double least = fitted.ns - fitted.within;
  return least <= 0 ? 1000 : std::min(1000.0, 100 * (fitted.ns / least - 1));
}

/// Labels alone may take no time, and areas may add none.
bool can_be_written(const Fitted& fitted) {
  if (fitted.form.mnemonic == name_of(SystemTime::OperandArea)) return fitted.found && fitted.ns > fitted.within;
  return fitted.found && (fitted.ns >= 0.5 || fitted.form.mnemonic == "LBL");
}

Time in_ns(double ns) { return std::clamp<Time>(std::llround(ns), 0, kLongestFigure); }

/// The lines of what was found. Base and unit are of use only together.
std::vector<TimeRow> measured_rows(const Fit& fit, const std::string& source) {
  std::vector<TimeRow> rows;
  for (const Fitted& base : fit.forms) {
    if (base.form.per_unit || !can_be_written(base)) continue;
    const Form of_unit{base.form.mnemonic, base.form.row, true};
    const auto unit = std::ranges::find(fit.forms, of_unit, &Fitted::form);
    TimeRow row = *base.form.row;
    const bool unit_found = unit != fit.forms.end() && unit->found;
    if (row.per_unit > 0 && !unit_found) continue;
    const double uncertainty = unit_found ? std::max(percent(base), percent(*unit)) : percent(base);
    row.mnemonics = {base.form.mnemonic};
    row.form = names_of(row.areas);
    row.base = in_ns(base.ns);
    row.per_unit = unit_found ? in_ns(unit->ns) : 0;
    row.marker = "measured";
    row.source = source;
    row.uncertainty = row.base == 0 ? 0 : std::ceil(uncertainty * 100) / 100;
    rows.push_back(std::move(row));
  }
  return rows;
}

/// By what the figures that were not measured are multiplied. The EEPROM is a part of its own.
void estimate(TimeRow& row, double ratio) {
  if (row.mnemonics.front() == name_of(SystemTime::EepromSave)) {
    row.source = "not measured; " + row.source;
    return;
  }
  const auto scaled = [&](Time time) { return time == 0 ? 0 : std::max<Time>(1, in_ns(static_cast<double>(time) * ratio)); };
  row.base = scaled(row.base);
  row.per_unit = scaled(row.per_unit);
  row.source = fmt::format("not measured: {:.2f} × {}, {}", ratio, row.marker, row.source);
  row.marker = "calibrated";
  const double most = (1 + row.uncertainty / 100) * std::max(ratio, 1 / ratio);
  row.uncertainty = std::min(1000.0, std::ceil(100 * (most - 1)));
}

}  // namespace

double ratio_to_known(const Fit& fit) {
  std::vector<double> ratios;
  for (const Fitted& each : fit.forms)
    if (each.found && !each.form.per_unit && each.ns >= 0.5 && each.form.row->base > 0)
      ratios.push_back(each.ns / static_cast<double>(each.form.row->base));
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

TimeTable calibrated(const Fit& fit, const TimeTable& known, const TimeTable& own, const std::string& source) {
  const double ratio = ratio_to_known(fit);
  // What an area adds and the CPU's own table does not know is in the table if it was measured.
  const auto is_known = [&](const TimeRow& row) {
    return row.mnemonics.front() != name_of(SystemTime::OperandArea) ||
           own.find(row.mnemonics.front(), area_named(row.form));
  };
  TimeTable table = known.filtered(is_known).with([&](TimeRow& row) { estimate(row, ratio); });
  table.add(table_of(measured_rows(fit, source)));
  return in_use(table);
}

namespace {

/// What operands in an area add to any instruction.
bool is_measured(const Fit& fit, Area area) {
  return std::ranges::any_of(fit.forms, [&](const Fitted& each) {
    return each.found && each.form.mnemonic == name_of(SystemTime::OperandArea) && contains(each.form.row->areas, area);
  });
}

}  // namespace

std::vector<std::string> not_measured(const Fit& fit, const CpuModel& model) {
  std::set<std::string_view> found;
  for (const Fitted& each : fit.forms)
    if (each.found && !each.form.per_unit) found.insert(each.form.mnemonic);
  std::vector<std::string> missing;
  for (const SystemTime what : {SystemTime::InterruptEntry, SystemTime::ScanOverhead, SystemTime::EepromSave})
    missing.emplace_back(name_of(what));
  for (const Area area : {Area::AI, Area::AQ})  // they need a module
    if (model.size_of(area) > 0 && !is_measured(fit, area)) missing.push_back(fmt::format("({} operands)", info(area).name));
  for (const Instruction& instruction : all_instructions())
    if (instruction.modelled() && (instruction.cpus & model.self) && !found.contains(instruction.mnemonic))
      missing.emplace_back(instruction.mnemonic);
  return missing;
}

}  // namespace s7200::tools
