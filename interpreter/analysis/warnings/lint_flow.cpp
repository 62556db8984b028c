// Warnings about the ways through a program: what is never reached, what is left out, what is executed twice, what is always
// overwritten, what takes too long.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/flow/paths.hpp"
#include "interpreter/analysis/timed_interrupts.hpp"
#include "interpreter/analysis/warnings/lint.hpp"
#include "interpreter/analysis/warnings/lint_ops.hpp"
#include "interpreter/program/checking/warnings.hpp"

namespace s7200 {

using namespace lint;

namespace {

Structure structure_of(const Op& op) { return op.instruction->structure; }

bool is_edge(const Op& op) {
  return op.instruction->hidden == Hidden::RisingMemory || op.instruction->hidden == Hidden::FallingMemory;
}

/// Whether the power flow of an edge surely never changes: LD SM0.0, EU.
bool never_changes(const Facts& facts, std::uint32_t edge) {
  while (edge > 0 && is_edge(facts.program.ops[edge - 1])) --edge;
  return facts.flow.nodes[edge].powered;
}

/// What stands in a program without doing anything, or has to stand there.
bool does_nothing(const Op& op) {
  switch (structure_of(op)) {
    case Structure::Label:
    case Structure::Jump:
    case Structure::Next:
    case Structure::MainEnd:
    case Structure::SubroutineHead:
    case Structure::SubroutineEnd:
    case Structure::InterruptHead:
    case Structure::InterruptEnd:
    case Structure::SegmentEnd:
      return true;
    default:
      return op.instruction->mnemonic == "NOP";
  }
}

std::vector<bool> reached_ops(const Facts& facts) {
  std::vector<bool> reached(facts.program.ops.size());
  std::vector<std::uint32_t> open;
  for (const Routine& routine : facts.flow.routines) open.push_back(routine.first);
  while (!open.empty()) {
    const std::uint32_t op = open.back();
    open.pop_back();
    if (op >= reached.size() || reached[op]) continue;
    reached[op] = true;
    open.insert(open.end(), facts.flow.nodes[op].next.begin(), facts.flow.nodes[op].next.end());
  }
  return reached;
}

/// The single bit of Q, M, V or S memory that S, R or a coil writes. Special memory does something when it is written.
std::optional<Bits> written_bit(const Facts& facts, std::uint32_t op) {
  constexpr Areas kPlain = set_of(Area::Q) | set_of(Area::M) | set_of(Area::V) | set_of(Area::S);
  const Effect effect = facts.program.ops[op].instruction->effect;
  if (effect != Effect::SetsBits && effect != Effect::ResetsBits && effect != Effect::Coil) return {};
  for (const MemoryAccess& access : facts.effects[op])
    if (access.operand == 0 && access.role == Role::Out && access.certainty == Certainty::Must && !access.by_pointer &&
        access.bits.count == 1 && contains(kPlain, area_of(access.bits)))
      return access.bits;
  return {};
}

/// Whether an op surely writes a bit without a look at it: a coil, or anything that surely has power flow.
bool surely_writes(const Facts& facts, std::uint32_t op, const Bits& bit) {
  if (facts.program.ops[op].instruction->effect != Effect::Coil && !facts.flow.nodes[op].powered) return false;
  return std::ranges::any_of(facts.effects[op], [&](const MemoryAccess& access) {
    return access.role == Role::Out && access.certainty == Certainty::Must && !access.by_pointer &&
           access.bits.contains(bit);
  });
}

bool uses(const Facts& facts, std::uint32_t op, const Bits& bit) {
  if (structure_of(facts.program.ops[op]) == Structure::Call) return true;
  return std::ranges::any_of(facts.effects[op],
                             [&](const MemoryAccess& access) { return is_meant(facts.program, access, bit); });
}

bool interrupts_use(const Facts& facts, Paths& paths, const Bits& bit) {
  for (const Stretch& stretch : paths.interrupts())
    for (std::uint32_t op = stretch.from; op < stretch.to; ++op)
      if (uses(facts, op, bit)) return true;
  return false;
}

/// The op of the same straight way that overwrites a bit before anything uses it.
std::optional<std::uint32_t> overwriting(const Facts& facts, Paths& paths, std::uint32_t first, const Bits& bit) {
  constexpr std::uint32_t kFarthest = 300;  // so that long programs take no longer than their length
  const std::uint32_t end = std::min(facts.flow.routine_of(first).end, first + kFarthest);
  for (std::uint32_t op = first + 1; op < end; ++op) {
    const Op& now = facts.program.ops[op];
    if (structure_of(now) != Structure::None && structure_of(now) != Structure::Compare) return {};
    if (now.instruction->effect == Effect::ConditionalEnd || now.in_segment) return {};
    const bool again = now.instruction->effect == Effect::SetsBits || now.instruction->effect == Effect::ResetsBits;
    if (surely_writes(facts, op, bit)) {
      const bool two_coils =
          now.instruction->effect == Effect::Coil && facts.program.ops[first].instruction->effect == Effect::Coil;
      return two_coils || !paths.leads_to(first, op) || interrupts_use(facts, paths, bit) ? std::nullopt : std::optional(op);
    }
    if (uses(facts, op, bit) && !(again && facts.flow.nodes[op].powered)) return {};
  }
  return {};
}

bool runs_timer(const Op& op) {
  return op.instruction->hidden == Hidden::Number && op.instruction->operand[0].areas == set_of(Area::T) && !op[0].unread();
}

/// How many instructions work on each timer, by its number. Of two, each may be executed in the scans in which the other one is
/// not.
std::map<std::uint32_t, std::uint32_t> uses_of_timers(const Program& program) {
  std::map<std::uint32_t, std::uint32_t> uses;
  for (const Op& op : program.ops)
    if (runs_timer(op)) ++uses[op[2].at];
  return uses;
}

/// The only CALL of the subroutine that an op is in, if it depends on a condition. A segment executes nothing while it is
/// off, and what it calls is meant so.
std::optional<std::uint32_t> call_under_a_condition(const Facts& facts, const Calls& calls, std::uint32_t op) {
  const Calls::Node& node = calls.nodes[facts.flow.nodes[op].routine];
  const bool once = node.called.size() == 1 && node.by_main && !node.by_interrupt;
  if (!once) return {};
  const std::uint32_t call = node.called.front().op;
  return facts.flow.nodes[call].powered || facts.program.ops[call].in_segment ? std::nullopt : std::optional(call);
}

/// The mnemonic of a contact that is in series or in parallel with the one in front of it; nothing of any other op.
std::string_view joined_to_the_top(const Op& op) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  const bool joins = op.is_contact && op.instruction->rung.stack.needs == 1 && op.instruction->rung.stack.change == 0;
  return joins && (mnemonic.starts_with('A') || mnemonic.starts_with('O')) ? mnemonic : std::string_view();
}

}  // namespace

void find_unreachable(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program)) return;
  const std::vector<bool> reached = reached_ops(facts);
  for (std::uint32_t op = 1; op < program.ops.size(); ++op) {
    if (reached[op] || !reached[op - 1]) continue;
    std::uint32_t first = op;
    while (first < program.ops.size() && !reached[first] && does_nothing(program.ops[first])) ++first;
    if (first == program.ops.size() || reached[first]) continue;
    diagnostics.push_back(warn(Warning::Unreachable, place(program, first),
                               fmt::format("this is never executed: line {} always leaves it out", line(program, op - 1)),
                               "take it out, or give the jump a condition"));
  }
}

void find_repeated_edges(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (std::ranges::none_of(program.ops, is_edge)) return;
  const Calls calls = calls_of(program, facts.flow);
  Paths paths(program, facts.flow);
  const auto warn_of = [&](std::uint32_t op, std::string what) {
    diagnostics.push_back(
        warn(Warning::RepeatedEdge, place(program, op),
             fmt::format("{} remembers one value for all executions: {}", program.statement(op).mnemonic, what),
             "form the edge once in each scan, in a bit, and use that bit here"));
  };
  std::vector<std::uint32_t> loops;  // the FOR around an op
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    if (structure_of(program.ops[op]) == Structure::For) loops.push_back(op);
    if (structure_of(program.ops[op]) == Structure::Next && !loops.empty()) loops.pop_back();
    if (!is_edge(program.ops[op]) || never_changes(facts, op)) continue;
    if (!loops.empty()) {
      warn_of(op, fmt::format("the loop from line {} sees an edge the first time only", line(program, loops.back())));
      continue;
    }
    const auto& called = calls.nodes[facts.flow.nodes[op].routine].called;
    for (std::size_t i = 1; i < called.size(); ++i)
      if (paths.leads_to(called[i - 1].op, called[i].op)) {
        warn_of(op, fmt::format("the second call, in line {}, sees no edge that the first, in line {}, has seen",
                                line(program, called[i].op), line(program, called[i - 1].op)));
        break;
      }
  }
}

void find_skipped_timers(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const Calls calls = calls_of(program, facts.flow);
  auto uses = uses_of_timers(program);
  std::vector<std::uint32_t> loops;      // the FOR around an op
  std::uint32_t jump = 0, leads_to = 0;  // the jump forwards that goes farthest
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    const Op& now = program.ops[op];
    if (structure_of(now) == Structure::Jump && !facts.flow.nodes[op].powered && now.target > std::max(op, leads_to)) {
      jump = op;
      leads_to = now.target;
    }
    if (structure_of(now) == Structure::For) loops.push_back(op);
    if (structure_of(now) == Structure::Next && !loops.empty()) loops.pop_back();
    if (!runs_timer(now) || timer_base(now[2].at).base != 100 * kMillisecond) continue;
    const bool counts_hours = now.instruction->mnemonic == "TONR";  // it may be meant to count only while it is called
    const auto call = uses[now[2].at] == 1 && !counts_hours ? call_under_a_condition(facts, calls, op) : std::nullopt;
    const std::string timer = written(program, op, 0);
    const auto add = [&](std::string message, std::string hint, std::string_view word, std::uint32_t where) {
      diagnostics.push_back(warn(Warning::SkippedTimer, place(program, op), timer + std::move(message), std::move(hint),
                                 fmt::format("{} {}", word, line(program, where))));
    };
    if (call)
      add(fmt::format(" does not count while line {} does not call its routine: 100 ms timers count when they are executed",
                      line(program, *call)),
          "call the routine in every scan and hand the condition over, or use a 10 ms timer", "call", *call);
    if (!loops.empty())
      add(fmt::format(" is executed in each pass of the loop from line {}: a 100 ms timer has to be executed once in each "
                      "scan to keep time",
                      line(program, loops.back())),
          "move it out of the loop", "loop", loops.back());
    if (op < leads_to && !call && loops.empty())
      add(fmt::format(" does not count while line {} jumps over it: 100 ms timers count when they are executed",
                      line(program, jump)),
          "move it out of what is jumped over, and let its input depend on the condition", "jump", jump);
  }
}

void find_long_interrupts(const Facts& facts, stl::Diagnostics& diagnostics, const Waiter& waiter) {
  const Program& program = facts.program;
  if (has_unread(program) || program.times.rows().empty()) return;
  const Calls calls = calls_of(program, facts.flow);
  const auto ms = [](Time time) { return fmt::format("{:.1f} ms", static_cast<double>(time) / kMillisecond); };
  for (const Bounds::OfEvent& event : timed_interrupts(facts, calls, waiter)) {
    if (event.longest_routine <= event.period) continue;
    const auto use = std::ranges::find(calls.events, event.event, &EventUse::number);
    diagnostics.push_back(
        warn(Warning::LongInterrupt, place(program, use->attached.front().op),
             fmt::format("event {} comes every {}, and its routine can take {}: then the main program gets no time, "
                         "and events are lost",
                         event.event, ms(*event.period), ms(event.longest_routine)),
             "work in the main program on what the interrupt notes, or let it come less often"));
  }
}

void find_constant_contacts(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (!op.is_contact || op[0].unread() || op[0].pointer || op[0].at != sm::kScanStatus || op[0].bit != 0) continue;
    const std::string_view mnemonic = op.instruction->mnemonic;
    const std::string_view joined = i + 1 < program.ops.size() ? joined_to_the_top(program.ops[i + 1]) : "";
    const bool never = mnemonic == "AN" || mnemonic == "ON" || (mnemonic == "LDN" && !joined.empty());
    if (!never && mnemonic != "O" && !(mnemonic == "LD" && joined.starts_with('O'))) continue;
    const bool begins = mnemonic.starts_with("LD");
    diagnostics.push_back(warn(
        Warning::ConstantContact, place(program, i),
        never ? "SM0.0 is always 1: this contact never closes"
              : "SM0.0 is always 1: what this contact is in parallel with has no effect",
        begins ? "take out the contact and begin the rung with the next one, or take out the rung if it is not meant to work"
               : "take out the contact, or the rung if it is not meant to work"));
  }
}

void find_restarted_timers(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const std::vector<std::uint32_t> all = attachments(program);
  if (all.empty() || has_unread(program)) return;
  Paths paths(program, facts.flow);
  for (const std::uint32_t op : all) {
    const std::uint32_t number = program.ops[op][1].at;
    if (!event::is_timed(static_cast<std::uint8_t>(number)) || !facts.flow.nodes[op].powered || program.ops[op].in_segment ||
        !paths.in_every_scan(op))
      continue;
    diagnostics.push_back(warn(
        Warning::RestartedTimer, place(program, op),
        fmt::format("this ATCH starts the period of event {} again in every scan: the event never comes while scans are "
                    "shorter than the period",
                    number),
        "execute it once, with SM0.1 or an edge"));
  }
}

void find_overwritten(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program)) return;
  Paths paths(program, facts.flow);
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    const auto bit = program.ops[op].in_segment ? std::nullopt : written_bit(facts, op);
    const auto later = bit ? overwriting(facts, paths, op, *bit) : std::nullopt;
    if (!later) continue;
    diagnostics.push_back(
        warn(Warning::Overwritten, place(program, op),
             fmt::format("{} always writes {} again, in line {}, before anything uses it",
                         program.statement(*later).mnemonic, memory_text(as_named(*bit)), line(program, *later)),
             "join both conditions in one rung, or write the bit in one place"));
  }
}

}  // namespace s7200
