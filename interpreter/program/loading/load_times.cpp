#include "interpreter/program/loading/load_times.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/stl/text/encoding.hpp"

namespace s7200 {
namespace {

/// A line can give the time of these.
const std::vector<std::string_view>& timed_names() {
  static const auto kNames = [] {
    std::vector<std::string_view> names;
    for (const SystemTime what : kSystemTimes) names.push_back(name_of(what));
    for (const Instruction& instruction : all_instructions()) names.push_back(instruction.mnemonic);
    return names;
  }();
  return kNames;
}

bool is_timed(std::string_view name) { return std::ranges::find(timed_names(), name) != timed_names().end(); }

/// The lines for a name in the tables of the CPU.
std::vector<const TimeRow*> known_lines(const CpuModel& model, const std::string& name) {
  std::vector<const TimeRow*> lines;
  for (const NamedTimes* times : times_of(model))
    for (const TimeRow& row : times->table().rows())
      if (std::ranges::find(row.mnemonics, name) != row.mnemonics.end()) lines.push_back(&row);
  return lines;
}

std::string unknown_name(const std::string& name) {
  const std::string upper = stl::upper_case(name);
  const std::string_view meant = is_timed(upper) ? std::string_view(upper) : nearest(upper, timed_names());
  const std::string hint = meant.empty() ? std::string("`s7200 times` lists them") : fmt::format("write {}", meant);
  return fmt::format("'{}' is not an instruction; {}", stl::shortened(name), hint);
}

/// Whether a line of it can be for some areas only.
bool has_areas(const std::string& name) {
  const Instruction* const instruction = find_instruction(name);
  if (instruction == nullptr) return name == name_of(SystemTime::OperandArea);
  return !instruction->rules().empty() && instruction->rules().front().kind == OperandKind::Memory;
}

/// Whether it has a memory operand in front that is in none of these areas on any CPU.
bool is_never_in(const std::string& name, Areas areas) {
  const Instruction* const instruction = find_instruction(name);
  if (instruction == nullptr || areas == 0) return false;
  const OperandRule& first = instruction->operand[0];
  return first.kind == OperandKind::Memory && first.areas != 0 && (areas & first.areas) == 0;
}

/// A message if the figures of `name` in a line are wrong; empty if they are not.
std::string slip_in(const TimeRow& row, const std::string& name, const CpuModel& model) {
  if (name == kSum) {
    for (const std::string& part : parts_of_sum(row.form))
      if (!is_timed(part)) return unknown_name(part);
    return {};
  }
  if (!is_timed(name)) return unknown_name(name);
  const auto known = known_lines(model, name);
  if (known.empty()) return {};  // an instruction of other CPUs
  if (row.areas == 0 && !row.form.empty() && std::ranges::none_of(known, [&](auto* k) { return k->form == row.form; }))
    return fmt::format("'{}' is not a form of {}; write the areas of its first operand (I Q M SM V …), or nothing",
                       stl::shortened(row.form), name);
  if (row.areas != 0 && !has_areas(name))
    return fmt::format("{} has no first operand in memory, so no line of it is for {}; leave column 2 empty", name,
                       names_of(row.areas));
  if (is_never_in(name, row.areas))
    return fmt::format("the first operand of {} is never in {}; delete the line", name, names_of(row.areas));
  const auto has_unit = [](const TimeRow* k) { return k->per_unit > 0; };
  if (row.per_unit > 0 && std::ranges::none_of(known, has_unit))
    return fmt::format("{} has no time per unit; leave column 4 empty", name);
  if (row.per_unit > 0 && !row.unit.empty() &&
      std::ranges::none_of(known, [&](auto* k) { return has_unit(k) && k->unit == row.unit; }))
    return fmt::format("{} takes longer for each {}, not for each '{}'; write that into column 5", name,
                       (*std::ranges::find_if(known, has_unit))->unit, stl::shortened(row.unit));
  if (row.per_unit == 0 && std::ranges::all_of(known, has_unit))
    return fmt::format("{} takes longer for each {}; write by how much into column 4", name, known.front()->unit);
  return {};
}

/// Whether the CPUs run with the same times of their own.
bool same_times(const CpuModel& one, const CpuModel& other) {
  return std::ranges::any_of(named_times(), [&](const NamedTimes& times) {
    return times.own && (times.cpus & one.self) && (times.cpus & other.self);
  });
}

std::string other_cpu(const std::string& cpu, const CpuModel& model) {
  const CpuModel* of = find_cpu(cpu);
  if (!of) return fmt::format("there is no CPU '{}'", stl::shortened(cpu));
  if (same_times(*of, model)) return {};
  return fmt::format(
      "these are times of CPU {}, not of CPU {}; give --cpu {}, or delete this line and mend what does not fit", cpu,
      model.name, cpu);
}

std::vector<std::string> slips_in(const TimesFile& file, const std::string& name, const CpuModel& model) {
  std::vector<std::string> slips;
  const auto add = [&](std::size_t line, const std::string& slip) {
    if (!slip.empty()) slips.push_back(fmt::format("{}:{}: {}", name, line, slip));
  };
  if (!file.cpu.empty()) add(file.cpu_line, other_cpu(file.cpu, model));
  if (!slips.empty()) return slips;  // what else does not fit follows from that
  for (const TimesFile::Line& line : file.lines)
    for (const std::string& mnemonic : line.row.mnemonics) add(line.number, slip_in(line.row, mnemonic, model));
  return slips;
}

}  // namespace

TimeTable times_named(const CpuModel& model, std::string_view name) {
  TimeTable times = default_times(model);
  if (name.empty()) return times;
  times.add(find_times(name)->table());
  return in_use(times);
}

std::optional<TimeTable> load_times(const CpuModel& model, const std::string& table, const FileSource& files,
                                    std::vector<std::string>& errors) {
  if (table.empty()) return times_named(model, table);
  if (const NamedTimes* named = find_times(table)) {
    if (named->cpus & model.self) return times_named(model, table);
    errors.push_back(fmt::format("{} has times of {}; tables for CPU {}: {}", table, to_text(named->cpus), model.name,
                                 names_of_times(model)));
    return {};
  }
  const auto csv = stl::read_decoded(files, table);
  if (!csv) {
    errors.push_back(fmt::format("cannot read {}: {}; tables for CPU {} that have a name: {}", table, csv.why(), model.name,
                                 names_of_times(model)));
    return {};
  }
  std::vector<std::string> wrong;
  const TimesFile file = read_times(*csv, table, wrong);
  if (wrong.empty()) wrong = slips_in(file, table, model);
  if (wrong.empty()) wrong = hidden_lines(file, table);
  errors.insert(errors.end(), wrong.begin(), wrong.end());
  if (!wrong.empty()) return {};
  TimeTable times = default_times(model);
  times.add(*csv, table);
  return in_use(times);
}

}  // namespace s7200
