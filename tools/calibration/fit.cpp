#include "tools/calibration/fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/times_band.hpp"
#include "interpreter/model/times/times_file.hpp"
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

/// The factor by which the time of a run with interrupts is less certain: half a millisecond is added to one and a half.
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

/// The most certain of the equations from `first` on that have the form; equations.size() if none has it.
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

/// Reads an equation after the elimination of forms: the time of the only form that is left, or by how much the loops
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
  fit.forms[form] = {.form = fit.forms[form].form, .found = true, .ns = time.ns, .within = time.within};
  for (Equation& loop : loops)
    if (loop.counts[form] != 0) subtract(loop, equation, loop.counts[form]);
}

/// The range of a form in the tables of the CPU, if it may be as much slower as the figures that were measured.
TimeRange known_range(const TimeRange& range, double ratio) {
  return {range.least * std::min(1.0, ratio), range.most * std::max(1.0, ratio)};
}

/// The rest of a loop without the forms that were found, if it has the same number of each and no earlier sum has any of
/// them.
std::optional<Sum> sum_of(const Equation& loop, const std::vector<LoopTime>& times, const Fit& fit) {
  Sum sum;
  std::vector<std::string> names;
  const auto is_new = [&](std::size_t form) {
    return fit.forms[form].form.row->base > 0 &&
           std::ranges::none_of(fit.sums, [&](const Sum& other) { return std::ranges::count(other.parts, form) > 0; });
  };
  for (std::size_t form = 0; form < loop.counts.size(); ++form) {
    if (!is_there(loop.counts[form])) continue;
    const Form& part = fit.forms[form].form;
    if (std::abs(loop.counts[form] - 1) > kZero || part.per_unit || part.row->areas != 0) return {};
    sum.parts.push_back(form);
    names.push_back(part.mnemonic);
  }
  if (std::ranges::none_of(sum.parts, is_new)) return {};
  const LoopTime whole = time_of(loop, times);
  sum.text = form_of_sum(names);
  sum.ns = whole.ns;
  sum.within = whole.within;
  return sum;
}

/// The sums of all loops. One that holds all of an earlier one is what is left without it.
void add_sums(const std::vector<Equation>& loops, const std::vector<LoopTime>& times, Fit& fit) {
  std::vector<Equation> sums;
  const auto first = [](const Equation& equation) { return std::ranges::find_if(equation.counts, is_there); };
  for (Equation loop : loops) {
    if (first(loop) == loop.counts.end()) continue;
    divide(loop, *first(loop));
    for (const Equation& earlier : sums)
      if (std::ranges::equal(earlier.counts, loop.counts, [](double one, double other) { return one == 0 || other != 0; }))
        subtract(loop, earlier, 1);
    const auto sum = sum_of(loop, times, fit);
    if (!sum) continue;
    fit.sums.push_back(*sum);
    sums.push_back(loop);
  }
}

/// The possible range of each form: the known range, as far as the sums permit it. If the sums contradict it, the range is
/// from nothing to the whole sum.
std::vector<TimeRange> ranges_of_parts(const Fit& fit) {
  const double ratio = ratio_to_known(fit).value_or(1);
  std::vector<TimeRange> ranges;
  for (const Fitted& each : fit.forms) ranges.push_back(known_range(range_of_base(*each.form.row), ratio));
  const auto narrow = [&](const Sum& sum) {
    const double least_sum = sum.ns - sum.within, most_sum = sum.ns + sum.within;
    double least = 0, most = 0;
    for (const std::size_t part : sum.parts) {
      least += ranges[part].least;
      most += ranges[part].most;
    }
    const bool possible = least <= most_sum && most >= least_sum;
    for (const std::size_t part : sum.parts) {
      const TimeRange before = ranges[part];
      if (!possible && before.most > 0) ranges[part] = {0, most_sum};
      if (possible) ranges[part].most = std::min(before.most, most_sum - (least - before.least));
      if (possible) ranges[part].least = std::max(before.least, least_sum - (most - before.most));
    }
  };
  for (std::size_t round = 0; round <= fit.sums.size(); ++round)
    for (const Sum& sum : fit.sums) narrow(sum);
  return ranges;
}

/// Gives each part of the sums the middle of what it can be, and what then is missing in a sum to those that no earlier one
/// has.
void divide_sums(Fit& fit) {
  const std::vector<TimeRange> ranges = ranges_of_parts(fit);
  for (std::size_t number = 0; number < fit.sums.size(); ++number) {
    double left = fit.sums[number].ns;
    std::vector<std::size_t> forms;
    std::vector<PartOfSum> parts;
    for (const std::size_t form : fit.sums[number].parts) {
      if (fit.forms[form].sum) {
        left -= fit.forms[form].ns;
      } else if (ranges[form].most > 0) {
        forms.push_back(form);
        parts.push_back({(ranges[form].least + ranges[form].most) / 2, ranges[form]});
      }
    }
    settle(parts, left);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Fitted& fitted = fit.forms[forms[i]];
      fitted.ns = parts[i].figure;
      fitted.within = std::max(fitted.ns - parts[i].range.least, parts[i].range.most - fitted.ns);
      fitted.sum = number;
    }
  }
}

bool is_in_a_loop_from(const Loops& loops, std::size_t first, std::size_t form) {
  for (std::size_t loop = first; loop < loops.loops.size(); ++loop) {
    const auto interrupts = loops.interrupts.find(loop);
    if (is_there(loops.loops[loop][form]) || (interrupts != loops.interrupts.end() && is_there(interrupts->second[form])))
      return true;
  }
  return false;
}

}  // namespace

Fit fit(const Loops& loops, const std::vector<LoopTime>& measured) {
  std::vector<LoopTime> times = measured;
  std::vector<Equation> loop_equations;
  for (std::size_t i = 0; i < times.size(); ++i) loop_equations.push_back(equation_of(loops, i, times));
  std::vector<Equation> equations = loop_equations;
  eliminate(equations, loops.forms.size(), times);
  Fit result;
  for (std::size_t i = 0; i < loops.forms.size(); ++i)
    result.forms.push_back({.form = loops.forms[i], .pending = is_in_a_loop_from(loops, times.size(), i)});
  for (const Equation& equation : equations) read_off(equation, times, result, loop_equations);
  add_sums(loop_equations, times, result);
  divide_sums(result);
  return result;
}

namespace {

Time in_ns(double ns) { return std::clamp<Time>(std::llround(ns), 0, kLongestFigure); }

/// Writes a figure, no shorter than `shortest`, and how far the true one is from it at most.
void state(Time& figure, Time& within, double ns, const TimeRange& range, Time shortest) {
  figure = std::max(in_ns(ns), shortest);
  within = std::min(farthest(figure, range), kLongestFigure);
}

void state(Time& figure, Time& within, const Fitted& fitted, Time shortest) {
  state(figure, within, fitted.ns, {fitted.ns - fitted.within, fitted.ns + fitted.within}, shortest);
}

/// The shortest base in a table: only labels may take no time; the time of a unit may be 0.
constexpr Time kShortest = 1;

/// The lines of what was found, and those of the sums. Base and unit are of use only together.
std::vector<TimeRow> measured_rows(const Fit& fit, const std::string& source) {
  std::vector<TimeRow> rows;
  for (const Fitted& base : fit.forms) {
    if (base.form.per_unit || !(base.found || base.sum)) continue;
    const Form of_unit{base.form.mnemonic, base.form.row, true};
    const auto unit = std::ranges::find(fit.forms, of_unit, &Fitted::form);
    TimeRow row = *base.form.row;
    const bool unit_found = unit != fit.forms.end() && unit->found;
    if (row.per_unit > 0 && !unit_found) continue;
    row.form = names_of(row.areas);
    row.uncertainty = 0;
    row.marker = base.sum ? "calibrated" : "measured";
    row.source = base.sum ? fmt::format("part of {}; {}", fit.sums[*base.sum].text, source) : source;
    state(row.base, row.base_within, base, base.form.mnemonic == "LBL" ? 0 : kShortest);
    if (unit_found) state(row.per_unit, row.per_unit_within, *unit, 0);
    rows.push_back(std::move(row));
  }
  for (const Sum& sum : fit.sums) {
    TimeRow row;
    row.mnemonics = {std::string(kSum)};
    row.form = sum.text;
    row.marker = "measured";
    row.source = source;
    state(row.base, row.base_within, sum.ns, {sum.ns - sum.within, sum.ns + sum.within}, kShortest);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Multiplies the figures that were not measured by `ratio`. The time of the EEPROM is left as it is.
void estimate(TimeRow& row, std::optional<double> ratio) {
  if (!ratio || row.mnemonics.front() == name_of(SystemTime::EepromSave)) {
    row.source = "not measured; " + row.source;
    return;
  }
  const auto scale = [&](Time& figure, Time& within, const TimeRange& range) {
    state(figure, within, static_cast<double>(figure) * *ratio, known_range(range, *ratio), figure > 0 ? kShortest : 0);
  };
  const TimeRange base = range_of_base(row), unit = range_of_unit(row);
  row.uncertainty = 0;
  scale(row.base, row.base_within, base);
  scale(row.per_unit, row.per_unit_within, unit);
  row.source = fmt::format("not measured: {:.2f} × {}, {}", *ratio, row.marker, row.source);
  row.marker = "calibrated";
}

}  // namespace

std::optional<double> ratio_to_known(const Fit& fit) {
  constexpr double kEnough = 0.5;
  std::vector<double> ratios;
  double all = 0;
  for (const Fitted& each : fit.forms) {
    if (each.form.per_unit || each.form.row->base == 0) continue;
    if (each.found || each.pending) ++all;
    if (each.found && each.ns >= 0.5) ratios.push_back(each.ns / static_cast<double>(each.form.row->base));
  }
  if (ratios.empty() || static_cast<double>(ratios.size()) < kEnough * all) return {};
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

TimeTable calibrated(const Fit& fit, const TimeTable& known, const TimeTable& own, const std::string& source) {
  const auto ratio = ratio_to_known(fit);
  const auto is_known = [&](const TimeRow& row) {
    return row.mnemonics.front() != name_of(SystemTime::OperandArea) ||
           own.find(row.mnemonics.front(), area_named(row.form));
  };
  TimeTable table = known.with([&](TimeRow& row) {
    const std::string of_others = row.source;
    estimate(row, ratio);
    if (is_known(row)) return;
    // The time that an area adds and the CPU's own table does not have: almost nothing, up to the times of the other tables.
    state(row.base, row.base_within, 0, range_of_base(row), kShortest);
    row.source = "not measured: nothing, as in the CPU's own table, up to what others say; " + of_others;
  });
  table.add(TimeTable(measured_rows(fit, source)));
  return in_use(table);
}

namespace {

/// Whether the time that operands in an area add to any instruction was measured.
bool is_measured(const Fit& fit, Area area) {
  return std::ranges::any_of(fit.forms, [&](const Fitted& each) {
    return each.found && each.form.mnemonic == name_of(SystemTime::OperandArea) && contains(each.form.row->areas, area);
  });
}

}  // namespace

namespace {

/// A figure that the program cannot measure, and the reason.
struct Unfit {
  std::string_view mnemonics, why;
};
constexpr std::array<Unfit, 6> kUnfit{{
    {"XMT RCV NETR NETW", "it uses the line"},
    {"HDEF HSC PLS", "it sets up hardware that may be wired"},
    {"TODW", "it sets the clock"},
    {"STOP", "it ends the measurement"},
    {"END", "it takes the place of MEND, and what else a scan takes is a thousand times as long"},
    {"SBR INT", "it is never without CALL, or without an interrupt"},
}};

/// Why `name` has no figure though it is in loops.
std::string_view reason_in_loops(const Fit& fit, std::string_view name) {
  const auto is_pending = [&](const Fitted& each) { return each.pending && each.form.mnemonic == name; };
  return std::ranges::any_of(fit.forms, is_pending) ? "interrupted before its loop ran" : "the loops do not tell it apart";
}

std::string_view reason_for(const Fit& fit, const Instruction& instruction) {
  for (const Unfit& unfit : kUnfit)
    for (const std::string& mnemonic : stl::split_words(unfit.mnemonics))
      if (mnemonic == instruction.mnemonic) return unfit.why;
  return instruction.cpus & kCpu214 ? reason_in_loops(fit, instruction.mnemonic)
                                    : "the program runs on a CPU 214, which does not have it";
}

/// Whether a figure was found, or is a part of a sum.
bool has_figure(const Fit& fit, std::string_view mnemonic) {
  return std::ranges::any_of(fit.forms, [&](const Fitted& each) {
    return (each.found || each.sum) && !each.form.per_unit && each.form.mnemonic == mnemonic;
  });
}

}  // namespace

std::vector<NotMeasured> not_measured(const Fit& fit, const CpuModel& model) {
  std::vector<NotMeasured> missing;
  for (const SystemTime what : {SystemTime::InterruptEntry, SystemTime::ScanOverhead})
    if (!has_figure(fit, name_of(what)))
      missing.push_back({std::string(name_of(what)), reason_in_loops(fit, name_of(what))});
  missing.push_back({std::string(name_of(SystemTime::EepromSave)), "it wears the EEPROM"});
  for (const Area area : {Area::AI, Area::AQ})
    if (model.size_of(area) > 0 && !is_measured(fit, area))
      missing.push_back({fmt::format("({} operands)", info(area).name), "it needs a module"});
  for (const Instruction& instruction : all_instructions())
    if (instruction.modelled() && (instruction.cpus & model.self) && !has_figure(fit, instruction.mnemonic))
      missing.push_back({std::string(instruction.mnemonic), reason_for(fit, instruction)});
  return missing;
}

}  // namespace s7200::tools
