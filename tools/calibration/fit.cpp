#include "tools/calibration/fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "interpreter/base/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times_file.hpp"
#include "tools/calibration/measure_protocol.hpp"

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

/// Percent, the most that a table may have.
constexpr double kMostUncertain = 1000;

/// By how much less is known how long a run took in which interrupts came: half a millisecond more, to one and a half.
constexpr double kWithInterrupts = 4.0 / 3;

LoopTime time_of(const Equation& equation, const std::vector<LoopTime>& times) {
  LoopTime sum;
  for (std::size_t i = 0; i < equation.of.size(); ++i) {
    sum.ns += equation.of[i] * times[i].ns;
    sum.within += std::abs(equation.of[i]) * times[i].within;
  }
  return sum;
}

/// Loops with interrupts: so many came in a repetition, and one more or less at both ends of the run.
Equation equation_of(const Loops& loops, std::size_t loop, std::vector<LoopTime>& times) {
  Equation equation{loops.loops[loop], std::vector<double>(times.size(), 0)};
  equation.of[loop] = 1;
  const auto found = loops.interrupts.find(loop);
  if (found == loops.interrupts.end()) return equation;
  const double came = times[loop].run / static_cast<double>(measuring::kInterruptEvery);
  for (std::size_t form = 0; form < equation.counts.size(); ++form) equation.counts[form] += came * found->second[form];
  times[loop].within *= kWithInterrupts;
  return equation;
}

/// Of the equations from `first` on that have the form, the surest one; equations.size() if none has it.
std::size_t surest_equation(const std::vector<Equation>& equations, std::size_t first, std::size_t form,
                            const std::vector<LoopTime>& times) {
  std::size_t best = equations.size();
  double best_within = 0;
  for (std::size_t i = first; i < equations.size(); ++i) {
    if (equations[i].counts[form] == 0) continue;
    const double within = time_of(equations[i], times).within / std::abs(equations[i].counts[form]);
    if (best != equations.size() && within >= best_within) continue;
    best = i;
    best_within = within;
  }
  return best;
}

/// Takes an equation for each form as far as it goes, and that form out of all others.
void eliminate(std::vector<Equation>& equations, std::size_t forms, const std::vector<LoopTime>& times) {
  std::size_t solved = 0;
  for (std::size_t form = 0; form < forms; ++form) {
    const std::size_t best = surest_equation(equations, solved, form, times);
    if (best == equations.size()) continue;
    std::swap(equations[solved], equations[best]);
    divide(equations[solved], equations[solved].counts[form]);
    for (std::size_t i = 0; i < equations.size(); ++i)
      if (i != solved && equations[i].counts[form] != 0)
        subtract(equations[i], equations[solved], equations[i].counts[form]);
    ++solved;
  }
}

bool is_there(double count) { return count != 0; }

/// What an equation says once the forms are eliminated: the time of the only form that is left, or by how much the loops
/// contradict each other. A form that is found goes out of `loops`.
void read_off(const Equation& equation, const std::vector<LoopTime>& times, Fit& fit, std::vector<Equation>& loops) {
  const LoopTime time = time_of(equation, times);
  const auto left = std::ranges::count_if(equation.counts, is_there);
  if (left == 0) {
    fit.residual = std::max(fit.residual, std::abs(time.ns));
    fit.contradiction = std::max(fit.contradiction, std::abs(time.ns) - time.within);
  }
  if (left != 1) return;
  const auto form = static_cast<std::size_t>(std::ranges::find_if(equation.counts, is_there) - equation.counts.begin());
  fit.forms[form] = {fit.forms[form].form, true, time.ns, time.within};
  for (Equation& loop : loops)
    if (loop.counts[form] != 0) subtract(loop, equation, loop.counts[form]);
}

double known_figure(const Form& form) { return static_cast<double>(form.per_unit ? form.row->per_unit : form.row->base); }

/// Sums of forms, divided.
class Division {
 public:
  Division(Fit& fit, const std::vector<LoopTime>& times) : fit_(fit), times_(times) {}

  /// Of an equation that has no form that was found.
  void add(Equation equation) {
    const auto first = std::ranges::find_if(equation.counts, is_there);
    if (first == equation.counts.end()) return;
    divide(equation, *first);
    const LoopTime whole = time_of(equation, times_);
    double least = whole.ns - whole.within, most = whole.ns + whole.within, middle = whole.ns;
    std::vector<std::size_t> parts;
    std::vector<std::string> names;
    for (std::size_t form = 0; form < equation.counts.size(); ++form) {
      const double count = equation.counts[form];
      if (count == 0) continue;
      const Fitted& known = fit_.forms[form];
      if (count < 0 || known.form.per_unit) return;
      names.push_back(count == 1 ? known.form.mnemonic : fmt::format("{:g} × {}", count, known.form.mnemonic));
      if (known_figure(known.form) == 0) continue;
      if (!known.sum) {
        parts.push_back(form);
        continue;
      }
      middle -= count * known.ns;
      least -= count * known.ns * (1 + known.uncertainty / 100);
      most -= count * known.ns / (1 + known.uncertainty / 100);
    }
    if (parts.empty() || middle <= 0) return;
    fit_.sums.push_back({fmt::format("{}", fmt::join(names, " + ")), whole.ns, whole.within});
    for (const std::size_t part : parts) take_part(equation, part, parts, {least, middle, most});
  }

 private:
  struct Rest {
    double least, middle, most;
  };

  /// The part is largest if its own figure is as large as it may be and those of the others are as small.
  void take_part(const Equation& equation, std::size_t part, const std::vector<std::size_t>& parts, const Rest& rest) {
    double others = 0, others_least = 0, others_most = 0;
    for (const std::size_t other : parts) {
      if (other == part) continue;
      const Form& form = fit_.forms[other].form;
      const double figure = equation.counts[other] * known_figure(form), factor = 1 + form.row->uncertainty / 100;
      others += figure;
      others_least += figure / factor;
      others_most += figure * factor;
    }
    Fitted& fitted = fit_.forms[part];
    const double count = equation.counts[part], own = count * known_figure(fitted.form);
    const double factor = 1 + fitted.form.row->uncertainty / 100;
    fitted.ns = rest.middle / count * own / (own + others);
    const double least = rest.least / count * (own / factor) / (own / factor + others_most);
    const double most = rest.most / count * (own * factor) / (own * factor + others_least);
    fitted.uncertainty =
        least <= 0 ? kMostUncertain : std::min(kMostUncertain, 100 * (std::max(fitted.ns / least, most / fitted.ns) - 1));
    fitted.sum = fit_.sums.size() - 1;
  }

  Fit& fit_;
  const std::vector<LoopTime>& times_;
};

}  // namespace

Fit fit(const Loops& loops, const std::vector<LoopTime>& measured) {
  std::vector<LoopTime> times = measured;
  std::vector<Equation> loop_equations;
  for (std::size_t i = 0; i < times.size(); ++i) loop_equations.push_back(equation_of(loops, i, times));
  std::vector<Equation> equations = loop_equations;
  eliminate(equations, loops.forms.size(), times);
  Fit result;
  for (const Form& form : loops.forms) result.forms.push_back({form});
  for (const Equation& equation : equations) read_off(equation, times, result, loop_equations);
  Division division(result, times);
  for (const Equation& loop : loop_equations) division.add(loop);
  return result;
}

namespace {

/// In percent, as the tables have it: the true figure is between this one / (1 + p / 100) and this one × (1 + p / 100).
double percent(const Fitted& fitted) {
  if (fitted.sum) return fitted.uncertainty;
  const double least = fitted.ns - fitted.within;
  return least <= 0 ? kMostUncertain : std::min(kMostUncertain, 100 * (fitted.ns / least - 1));
}

/// Labels alone may take no time, and areas may add none.
bool can_be_written(const Fitted& fitted) {
  if (fitted.form.mnemonic == name_of(SystemTime::OperandArea)) return fitted.found && fitted.ns > fitted.within;
  if (fitted.sum) return fitted.ns >= 0.5;
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
    row.marker = base.sum ? "calibrated" : "measured";
    row.source = source;
    if (base.sum) {
      const Sum& sum = fit.sums[*base.sum];
      row.source = fmt::format("{} = {:.2f} us, divided as the estimates are; {}", sum.text, sum.ns / 1000, source);
    }
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
  table.add(TimeTable(measured_rows(fit, source)));
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

namespace {

/// What the program does not run, and why.
struct Unfit {
  std::string_view mnemonics, why;
};
constexpr std::array<Unfit, 6> kUnfit{{
    {"XMT RCV NETR NETW", "it uses the line"},
    {"HDEF HSC PLS", "it sets up hardware that may be wired"},
    {"TODW TODWX", "it sets the clock"},
    {"STOP", "it ends the measurement"},
    {"END", "it takes the place of MEND, and what else a scan takes is a thousand times as long"},
    {"SBR INT", "it is never without CALL, or without an interrupt"},
}};

std::string_view reason_for(const Instruction& instruction) {
  for (const Unfit& unfit : kUnfit)
    for (const std::string& mnemonic : stl::split_words(unfit.mnemonics))
      if (mnemonic == instruction.mnemonic) return unfit.why;
  return instruction.cpus & kCpu214 ? "the loops do not tell it apart"
                                    : "the program runs on a CPU 214, which does not have it";
}

/// Found, or a part of a sum.
bool has_figure(const Fit& fit, std::string_view mnemonic) {
  return std::ranges::any_of(fit.forms, [&](const Fitted& each) {
    return (each.found || each.sum) && !each.form.per_unit && each.form.mnemonic == mnemonic;
  });
}

}  // namespace

std::vector<NotMeasured> not_measured(const Fit& fit, const CpuModel& model) {
  std::vector<NotMeasured> missing;
  for (const SystemTime what : {SystemTime::InterruptEntry, SystemTime::ScanOverhead})
    if (!has_figure(fit, name_of(what))) missing.push_back({std::string(name_of(what)), "the loops do not tell it apart"});
  missing.push_back({std::string(name_of(SystemTime::EepromSave)), "it wears the EEPROM"});
  for (const Area area : {Area::AI, Area::AQ})
    if (model.size_of(area) > 0 && !is_measured(fit, area))
      missing.push_back({fmt::format("({} operands)", info(area).name), "it needs a module"});
  for (const Instruction& instruction : all_instructions())
    if (instruction.modelled() && (instruction.cpus & model.self) && !has_figure(fit, instruction.mnemonic))
      missing.push_back({std::string(instruction.mnemonic), reason_for(instruction)});
  return missing;
}

}  // namespace s7200::tools
