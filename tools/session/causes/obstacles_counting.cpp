// How far timers and counters are from what is wanted of them: the time that they have to run, the edges that they need.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/model/contact_form.hpp"
#include "tools/session/causes/obstacles.hpp"

namespace s7200::tools {
namespace {

std::string timed_text(std::int64_t ticks, Time base) { return ticks == 0 ? "0 s" : format_duration(ticks * base); }

std::string passed_text(std::int64_t now, std::int64_t whole, Time base) {
  return fmt::format("{} of {} have passed", timed_text(now, base), timed_text(whole, base));
}

std::int64_t value_at(const Cpu& cpu, std::uint32_t at) { return static_cast<std::int16_t>(load16(&cpu.state().image[at])); }

/// Whether an instruction is a box of this timer or counter.
bool is_box_of(const Op& op, Area area, std::uint32_t number) {
  const Instruction& instruction = *op.instruction;
  return instruction.hidden == Hidden::Number && instruction.operand[0].areas == set_of(area) && op[2].at == number;
}

/// The level of the stack, from its top, that is the input by which a counter counts up or down.
std::size_t level_of_count(const Instruction& counter, bool down) { return counter.mnemonic == "CTUD" && !down ? 2 : 1; }

}  // namespace

Obstacle Obstacles::of_timer(const Bits& bit, bool wanted) {
  Obstacle found = about("timer", bit, wanted);
  const auto number = static_cast<std::uint32_t>(bit.first - std::uint64_t{image::kTBits} * 8);
  const Time base = timer_base(number).base;
  const TimerState& state = cpu_.state().timer[number];
  const std::int64_t now = value_at(cpu_, image::kT + 2 * number);
  bool any = false;
  for (std::uint32_t by = 0; by < program().ops.size(); ++by) {
    if (!is_box_of(op(by), Area::T, number)) continue;
    const Instruction& instruction = *op(by).instruction;
    any = true;
    const bool off_delay = instruction.mnemonic == "TOF";
    const auto preset = static_cast<std::int16_t>(contacts_.value(by, 1).value_or(0));
    const std::vector<Conditions> fewest = ways_.fewest_changes(ways_.to(by, true));
    const bool starts = !has_run_ && !off_delay && wanted && now < preset && !fewest.empty() && fewest.front().empty();
    const bool counts =
        starts || (off_delay ? state.enabled && !state.input && !wanted : state.enabled && wanted && now < preset);
    if (counts) {
      const bool stands = has_run_ && cpu_.state().mode == Mode::Stop;
      const std::string when = stands ? "the CPU is in STOP, where nothing counts" : "in " + timed_text(preset - now, base);
      found.text = fmt::format("{} ({})", when, passed_text(now, preset, base));
      return found;
    }
    if (instruction.mnemonic == "TONR" && !wanted) {
      found.text = fmt::format("a timer, TONR of {}, which stays on without power until R resets it", format_duration(base));
      continue;
    }
    const std::string after = wanted == off_delay ? "" : fmt::format(" for {}", timed_text(preset, base));
    Obstacle rung{
        .kind = "rung",
        .text = fmt::format("{} must {} power{}: {}", place_text(by), wanted ? "have" : "have no", after, rung_text(by, 0)),
        .op = by};
    add_ways(rung, ways_.to(by, wanted));
    found.text = wanted && !off_delay ? fmt::format("a timer, {}", passed_text(now, preset, base))
                                      : fmt::format("a timer, {} of {}", instruction.mnemonic, format_duration(base));
    found.because.push_back(std::move(rung));
  }
  if (!any) found.text = "no instruction times it";
  if (!wanted) add_resets(found, bit);
  if (!wanted && any && found.because.empty()) found.text += "; no R of the program does";
  return found;
}

Obstacle Obstacles::of_counter(const Bits& bit, bool wanted) {
  Obstacle found = about("counter", bit, wanted);
  const auto number = static_cast<std::uint32_t>(bit.first - std::uint64_t{image::kCBits} * 8);
  const std::int64_t now = value_at(cpu_, image::kC + 2 * number);
  found.text = "no instruction counts it";
  for (std::uint32_t by = 0; by < program().ops.size(); ++by) {
    if (!is_box_of(op(by), Area::C, number)) continue;
    const Instruction& instruction = *op(by).instruction;
    const auto preset = static_cast<std::int16_t>(contacts_.value(by, 1).value_or(0));
    const bool down = instruction.mnemonic == "CTD";
    const std::int64_t left = std::max<std::int64_t>(down ? now : preset - now, 0);
    found.text = fmt::format("a counter at {} of {}", now, preset);
    if (wanted) {
      add_edges(found, by, level_of_count(instruction, down), left);
      const std::vector<Conditions> quiet = ways_.fewest_changes(ways_.input(by, 0, false));
      if (!quiet.empty() && !quiet.front().empty())
        found.because.push_back(of_input(by, 0, false, fmt::format("its {} input must be off", down ? "load" : "reset")));
    } else {
      found.because.push_back(
          of_input(by, 0, true, fmt::format("{} must have power at its {} input", place_text(by), down ? "load" : "reset")));
    }
  }
  if (!wanted) add_resets(found, bit);
  return found;
}

/// R is one more way to reset a timer or a counter.
void Obstacles::add_resets(Obstacle& to, const Bits& bit) {
  Writers resets = writers_of(bit, false, {});
  resets.others.clear();
  if (!resets.deciding.empty()) add_ways_of_bit(to, resets, bit, false);
}

void Obstacles::add_edges(Obstacle& to, std::uint32_t counter, std::size_t level, std::int64_t edges) {
  Obstacle input{
      .kind = "rung",
      .text = fmt::format("{} needs {} of its count input: {}", place_text(counter),
                          counted(static_cast<std::uint64_t>(edges), "more rising edge"), rung_text(counter, level)),
      .op = counter};
  add_ways_of_edge(input, ways_.input(counter, level, true), true);
  to.because.push_back(std::move(input));
}

/// The number nearest to the other operand of a comparison of words with which it is as wanted; nothing if there is none.
std::optional<std::int64_t> Obstacles::goal_of(const Condition& condition, std::size_t operand) const {
  const ContactForm form = contact_form(*op(condition.op).instruction);
  const auto other = contacts_.value(condition.op, 1 - operand);
  if (form.kind != ContactForm::Kind::Numbers || form.type != ContactForm::Type::Word || !other) return {};
  const std::int64_t number = static_cast<std::int16_t>(*other);
  const Relation wanted = condition.on ? form.relation : opposite(form.relation);
  switch (operand == 0 ? wanted : mirrored(wanted)) {
    case Relation::Greater:
      return number + 1;
    case Relation::Less:
      return number - 1;
    case Relation::NotEqual:
      return {};
    default:
      return number;
  }
}

/// In place of the rungs that write the value: how the boxes of a timer or a counter bring it there.
void Obstacles::count_to(Obstacle& value, const Bits& bits, std::int64_t goal) {
  const auto at = static_cast<std::uint32_t>(bits.first / 8);
  const Area area = area_of(bits);
  if (area != Area::T && area != Area::C) return;
  const std::uint32_t number = (at - (area == Area::T ? image::kT : image::kC)) / 2;
  const std::int64_t away = goal - value_at(cpu_, at);
  Obstacle found;
  for (std::uint32_t by = 0; by < program().ops.size(); ++by) {
    if (!is_box_of(op(by), area, number)) continue;
    if (area == Area::T)
      add_timing(found, by, number, goal);
    else
      add_counting(found, by, away);
  }
  if (found.text.empty() && found.because.empty()) return;
  if (!found.text.empty()) value.text = std::move(found.text);
  value.because = std::move(found.because);
}

void Obstacles::add_timing(Obstacle& to, std::uint32_t by, std::uint32_t number, std::int64_t goal) {
  const Time base = timer_base(number).base;
  const TimerState& state = cpu_.state().timer[number];
  const std::int64_t now = value_at(cpu_, image::kT + 2 * number);
  const bool off_delay = op(by).instruction->mnemonic == "TOF";
  const bool reaches = !off_delay || goal <= static_cast<std::int16_t>(contacts_.value(by, 1).value_or(0));
  if (goal <= now || !reaches) return;
  if (state.enabled && (!off_delay || !state.input)) {
    to.text = fmt::format("in {} ({})", timed_text(goal - now, base), passed_text(now, goal, base));
    return;
  }
  Obstacle rung{.kind = "rung",
                .text = fmt::format("{} must {} power for {}: {}", place_text(by), off_delay ? "have no" : "have",
                                    timed_text(goal - now, base), rung_text(by, 0)),
                .op = by};
  add_ways(rung, ways_.to(by, !off_delay));
  to.because.push_back(std::move(rung));
}

void Obstacles::add_counting(Obstacle& to, std::uint32_t by, std::int64_t away) {
  const Instruction& counter = *op(by).instruction;
  if (away > 0 && counter.mnemonic != "CTD") add_edges(to, by, level_of_count(counter, false), away);
  if (away < 0 && counter.mnemonic != "CTU") add_edges(to, by, level_of_count(counter, true), -away);
}

}  // namespace s7200::tools
