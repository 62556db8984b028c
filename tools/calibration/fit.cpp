#include "tools/calibration/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "interpreter/model/instruction.hpp"

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
  for (std::size_t i = 0; i < loops.loops.size(); ++i) {
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

std::string names_of(Areas areas) {
  std::string names;
  for (const AreaInfo& area : all_areas())
    if (contains(areas, area.area)) names.append(names.empty() ? "" : " ").append(area.name);
  return names;
}

std::string us(double ns) { return fmt::format("{:.3f}", std::max(0.0, ns) / 1000); }

}  // namespace

std::string fitted_csv(const Fit& fit, const std::string& source) {
  std::string csv = "mnemonic,form,base_us,per_unit_us,unit,marker,source,uncertainty_percent\n";
  for (const Fitted& base : fit.forms) {
    if (base.form.per_unit || !base.found || base.ns < 0.5) continue;
    const Form of_unit{base.form.mnemonic, base.form.row, true};
    const auto unit = std::ranges::find(fit.forms, of_unit, &Fitted::form);
    const TimeRow& row = *base.form.row;
    const bool unit_found = unit != fit.forms.end() && unit->found;
    if (row.per_unit > 0 && !unit_found) continue;
    const double uncertainty = unit_found ? std::max(percent(base), percent(*unit)) : percent(base);
    csv += fmt::format("{},{},{},{},{},measured,\"{}\",{:.2f}\n", base.form.mnemonic, names_of(row.areas), us(base.ns),
                       unit_found ? us(unit->ns) : "", row.unit, source, std::ceil(uncertainty * 100) / 100);
  }
  return csv;
}

std::vector<std::string> not_measured(const Fit& fit, const CpuModel& model) {
  std::set<std::string_view> found;
  for (const Fitted& each : fit.forms)
    if (each.found && !each.form.per_unit) found.insert(each.form.mnemonic);
  std::vector<std::string> missing;
  for (const SystemTime what : {SystemTime::InterruptEntry, SystemTime::ScanOverhead, SystemTime::EepromSave})
    missing.emplace_back(name_of(what));
  for (const Instruction& instruction : all_instructions())
    if (instruction.modelled() && (instruction.cpus & model.self) && !found.contains(instruction.mnemonic))
      missing.emplace_back(instruction.mnemonic);
  return missing;
}

}  // namespace s7200::tools
