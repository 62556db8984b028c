#include "tools/views/program/instruction_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/program/operands/operands.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kLetter[] = {"", "B", "W", "D"};

std::string area_text(const AreaInfo& area, Width width) {
  if (area.element != 0 || width == Width::Bit) return std::string(area.name);
  return fmt::format("{}{}", area.name, kLetter[static_cast<std::size_t>(width)]);
}

std::string_view number_text(OperandKind kind) {
  switch (kind) {
    case OperandKind::Label:
      return "number of a label";
    case OperandKind::Subroutine:
      return "number of a subroutine";
    case OperandKind::Interrupt:
      return "number of an interrupt routine";
    case OperandKind::Event:
      return "number of an event";
    case OperandKind::Port:
      return "number of a port";
    case OperandKind::Counter:
      return "number of a high-speed counter";
    case OperandKind::StackLevel:
      return "level of the logic stack, 0 to 8";
    default:
      return "a number";
  }
}

/// An operand for the example; `i` keeps the operands of one statement apart.
std::string sample(const OperandRule& rule, std::size_t i) {
  switch (rule.kind) {
    case OperandKind::Memory:
      break;
    case OperandKind::Event:
      return "10";
    case OperandKind::Port:
    case OperandKind::Number:
    case OperandKind::StackLevel:
      return "0";
    default:
      return "1";
  }
  if (rule.timer == TimerKind::OnDelay || rule.timer == TimerKind::OffDelay) return "T37";
  if (rule.timer == TimerKind::Retentive) return "T5";
  if (rule.areas == set_of(Area::C)) return "C1";
  if (rule.width == Width::Bit) {
    if (!contains(rule.areas, Area::I)) return contains(rule.areas, Area::Q) ? "Q0.0" : "S0.1";
    return rule.role == Role::In ? "I0.0" : "Q0.0";
  }
  if (rule.areas == set_of(Area::I)) return "IB0";
  if (rule.areas == set_of(Area::Q)) return "QB0";
  if (rule.count) return "4";
  for (const std::string_view number : {"N", "PT", "PV", "FINAL"})
    if (rule.name == number) return "4";
  if (rule.name == "INIT") return "1";
  return fmt::format("V{}{}", kLetter[static_cast<std::size_t>(rule.width)], 100 * (i + 1));
}

std::string constant_text(const OperandRule& rule) {
  if (rule.real) return "real constant";
  if (rule.text) return "constant in double quotes";
  if (rule.usual_min() == std::numeric_limits<std::int64_t>::min())
    return rule.sign == Sign::Either ? "constant" : rule.sign == Sign::Signed ? "signed constant" : "unsigned constant";
  return fmt::format("constant {}…{}{}", rule.usual_min(), rule.max, rule.not_zero ? " but 0" : "");
}

std::string ranges_text(const OperandRule& rule, const CpuModel& model) {
  std::vector<std::string> ranges;
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area) && model.size_of(area.area) != 0)
      ranges.push_back(range_text(model, area.area, rule.width));
  return fmt::format("{}", fmt::join(ranges, ", "));
}

/// Elements of an area as text: `T33 to T36, T97`
std::string elements_text(std::string_view area, std::uint32_t size, const std::function<bool(std::uint32_t)>& is_one) {
  std::vector<std::string> runs;
  for (std::uint32_t first = 0; first < size; ++first) {
    if (!is_one(first)) continue;
    std::uint32_t last = first;
    while (last + 1 < size && is_one(last + 1)) ++last;
    runs.push_back(last == first ? fmt::format("{}{}", area, first) : fmt::format("{0}{1} to {0}{2}", area, first, last));
    first = last;
  }
  return fmt::format("{}", fmt::join(runs, ", "));
}

/// The timers of a kind by their resolution.
std::string resolution_text(TimerKind kind) {
  std::string text;
  for (const Time base : {kMillisecond, 10 * kMillisecond, 100 * kMillisecond})
    text +=
        fmt::format("    {:<11}{}\n", format_duration(base), elements_text("T", image::kTimers, [&](std::uint32_t number) {
                      const TimerBase timer = timer_base(number);
                      return timer.base == base && timer.retentive == (kind == TimerKind::Retentive);
                    }));
  return text;
}

/// The timers or counters that keep their current value while the power is off, as the CPUs are delivered.
std::string retention_text(Area area, const Instruction& instruction) {
  std::vector<std::pair<std::string, CpuSet>> groups;  // what they keep, and which CPUs keep that
  for (const CpuModel* model : all_cpus()) {
    if (!(model->self & instruction.cpus)) continue;
    const TimerKind kind = instruction.operand[0].timer;
    const auto is_kept = [&](std::uint32_t number) {
      if (area == Area::T && kind != TimerKind::Any && timer_base(number).retentive != (kind == TimerKind::Retentive))
        return false;
      return std::ranges::any_of(model->retentive, [&](const RetentiveRange& range) {
        return range.area == area && number >= range.first && number < range.first + range.count;
      });
    };
    const std::string kept = elements_text(info(area).name, model->size_of(area), is_kept);
    const auto known = std::ranges::find(groups, kept, &std::pair<std::string, CpuSet>::first);
    if (known == groups.end())
      groups.emplace_back(kept, model->self);
    else
      known->second = static_cast<CpuSet>(known->second | model->self);
  }
  std::string text;
  for (const auto& [kept, cpus] : groups)
    text += fmt::format("    kept       {} while the power is off, as {} is delivered\n", kept.empty() ? "none" : kept,
                        to_text(cpus));
  return text;
}

std::vector<const TimeRow*> times_of(const TimeTable& times, const Instruction& instruction) {
  std::vector<const TimeRow*> rows;
  for (const TimeRow& row : times.rows())
    if (std::find(row.mnemonics.begin(), row.mnemonics.end(), instruction.mnemonic) != row.mnemonics.end())
      rows.push_back(&row);
  return rows;
}

std::string time_column(const Instruction& instruction, const TimeTable& times) {
  const TimeRow* row = typical_time(times, instruction);
  return row ? time_text(*row) : "";
}

/// PID looks at its power flow itself, to see when it returns; it does nothing without.
bool needs_power_flow(const Instruction& instruction) {
  return instruction.rung.needs_power_flow || instruction.rung.eno != Eno::None;
}

std::string markdown_row(const Instruction& instruction, const TimeTable& of_21x, const TimeTable& of_22x) {
  std::vector<std::string> operands;
  for (const OperandRule& rule : instruction.rules())
    operands.push_back(fmt::format("**{}**: {}", rule.name, operand_text(rule)));
  return fmt::format("| `{}` | {} | {} | {} | {} | {} | {} | {} |\n", syntax(instruction), instruction.meaning,
                     fmt::join(operands, "<br>"), flags_text(instruction), needs_power_flow(instruction) ? "needed" : "",
                     instruction.cpus & kCpu21x ? time_column(instruction, of_21x) : "",
                     instruction.cpus & kCpu22x ? time_column(instruction, of_22x) : "", to_text(instruction.cpus));
}

std::string area_table() {
  std::string text = "| area |";
  std::string rule = "|---|";
  for (const CpuModel* model : all_cpus()) {
    text += fmt::format(" CPU {} |", model->name);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const AreaInfo& area : all_areas()) {
    text += fmt::format("| {} ({}) |", area.name, area.meaning);
    for (const CpuModel* model : all_cpus()) {
      const Width width = area.area == Area::AI || area.area == Area::AQ ? Width::Word : Width::Byte;
      text += fmt::format(" {} |", model->size_of(area.area) == 0 ? "none" : range_text(*model, area.area, width));
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string time_text(const TimeRow& row) {
  return in_microseconds(row.base) + (row.per_unit ? fmt::format(" + {}/{}", in_microseconds(row.per_unit), row.unit) : "");
}

const TimeRow* typical_time(const TimeTable& times, const Instruction& instruction) {
  for (const Area area : {Area::V, Area::Q, Area::I})
    if (const TimeRow* row = times.find(instruction.mnemonic, area)) return row;
  return nullptr;
}

std::string flags_text(const Instruction& instruction) {
  std::vector<std::string> flags;
  for (int bit = 0; bit < 8; ++bit)
    if (instruction.flags & (1 << bit)) flags.push_back(fmt::format("SM1.{}", bit));
  return flags.empty() ? "none" : fmt::format("{}", fmt::join(flags, " "));
}

std::string parts_text(const Instruction& instruction) {
  std::vector<std::string_view> parts;
  const auto [in, anywhere_on] = instruction.allowed;
  if (in == kAnywhere) {
    parts.push_back("anywhere");
  } else {
    if (in & kMain) parts.push_back("main program");
    if (in & kSubroutine) parts.push_back("subroutines");
    if (in & kInterrupt) parts.push_back("interrupt routines");
  }
  std::string on_others;
  if (anywhere_on) parts.push_back(on_others = fmt::format("anywhere on {}", to_text(anywhere_on)));
  if (instruction.outside_segments) parts.push_back("not between LSCR and SCRE");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string operand_text(const OperandRule& rule) {
  if (rule.kind != OperandKind::Memory) return std::string(number_text(rule.kind));
  std::vector<std::string> names;
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area)) names.push_back(area_text(area, rule.width));
  if (rule.constant) names.push_back(constant_text(rule));
  if (rule.pointer) names.push_back("*VD *LD *AC");
  if (rule.address_of) names.push_back("&address");
  return fmt::format("{}", fmt::join(names, " "));
}

std::string example(const Instruction& instruction) {
  std::vector<std::string> operands;
  for (std::size_t i = 0; i < instruction.rules().size(); ++i) operands.push_back(sample(instruction.operand[i], i));
  if (operands.empty()) return std::string(instruction.mnemonic);
  return fmt::format("{} {}", instruction.mnemonic, fmt::join(operands, ", "));
}

std::string explain(const Instruction& instruction, const TimeTable& times) {
  std::string text = fmt::format("{}\n", syntax(instruction));
  if (!instruction.meaning.empty()) text += fmt::format("  {}\n", instruction.meaning);
  if (!instruction.modelled())
    return text + fmt::format("  not modelled: {}; the real instruction needs {}\n", instruction.not_modelled,
                              to_text(instruction.cpus));
  for (const OperandRule& rule : instruction.rules()) {
    text += fmt::format("  {:<11} {}{}\n", rule.name, operand_text(rule), rule.role == Role::In ? "" : "   (written)");
    if (rule.kind != OperandKind::Memory) continue;
    if (rule.timer != TimerKind::Any) text += resolution_text(rule.timer);
    for (const Area area : {Area::T, Area::C})
      if (rule.areas == set_of(area) && rule.role != Role::In) text += retention_text(area, instruction);
    for (const CpuModel* model : all_cpus())
      if (model->self & instruction.cpus) text += fmt::format("    CPU {}   {}\n", model->name, ranges_text(rule, *model));
  }
  text +=
      fmt::format("  power flow  {}\n",
                  needs_power_flow(instruction) ? "needed: skipped while the top of the logic stack is 0" : "not needed");
  text += fmt::format("  SM1 flags   {}\n  allowed in  {}\n  available   {}\n", flags_text(instruction),
                      parts_text(instruction), to_text(instruction.cpus));
  for (const TimeRow* row : times_of(times, instruction))
    text +=
        fmt::format("  time        {} us{} ({}: {})\n", stl::printable(time_text(*row)),
                    row->form.empty() ? "" : " for " + stl::printable(row->form), row->marker, stl::printable(row->source));
  return text + fmt::format("  example     {}\n", example(instruction));
}

std::string reference_page() {
  const TimeTable of_21x = default_times(cpu216()), of_22x = default_times(cpu226());
  std::string text =
      "# Instructions\n\n"
      "Made from the instruction table by `s7200 instructions --markdown`; a test compares the two.\n"
      "Times are in microseconds, with power flow and operands in V memory; `s7200 times` says where each comes from\n"
      "(most are estimates, those of the CPUs 22x are of release 2 and mostly remembered). `s7200 instructions MNEMONIC` "
      "explains one with its ranges on each CPU.\n\n"
      "## Memory areas\n\n" +
      area_table();
  std::string_view group;
  for (const Instruction& instruction : all_instructions()) {
    if (instruction.group != group) {
      group = instruction.group;
      text += fmt::format(
          "\n## {}\n\n| instruction | meaning | operands | SM1 flags | power flow | 21x | 22x | available "
          "|\n|---|---|---|---|---|---|---|---|\n",
          group);
    }
    text += instruction.modelled()
                ? markdown_row(instruction, of_21x, of_22x)
                : fmt::format("| `{}` | not modelled | | | | | | {} |\n", instruction.mnemonic, to_text(instruction.cpus));
  }
  return text;
}

}  // namespace s7200::tools
