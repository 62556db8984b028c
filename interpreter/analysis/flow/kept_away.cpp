#include "interpreter/analysis/flow/kept_away.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "interpreter/base/bytes.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

/// A, AW= and so on: after it the top of the logic stack is 1 only if it was before.
bool only_takes_power(const Op& op) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  return op.is_contact && mnemonic.starts_with('A') && mnemonic != "ALD";
}

bool keeps_top(const Op& op) { return op.is_contact ? only_takes_power(op) : op.instruction->rung.stack.change == 0; }

bool is_constant(const Operand& operand) { return !operand.pointer && !operand.unread() && operand.at >= image::kConstants; }

/// Whether a FOR with power flow surely runs a pass: between constants.
bool runs_a_pass(const Program& program, const Op& loop) {
  const auto value = [&](const Operand& operand) {
    return static_cast<std::int16_t>(load16(&program.constants[operand.at - image::kConstants]));
  };
  return is_constant(loop[1]) && is_constant(loop[2]) && value(loop[1]) <= value(loop[2]);
}

/// From a DISI to the last op that may follow it while interrupts are not surely enabled again; of loops all. `seen` gets the
/// ops of it.
DisabledStretch until_enabled(const Program& program, const ControlFlow& flow, KeptAway& enabled, const Execution& execution,
                              std::uint32_t disi, std::set<std::uint32_t>& seen) {
  const Routine& routine = flow.routines[execution.routine];
  DisabledStretch stretch{disi, disi + 1};
  seen.insert(disi);
  for (std::vector<std::uint32_t> waiting{disi}; !waiting.empty();) {
    const std::uint32_t op = waiting.back();
    waiting.pop_back();
    const bool loops = program.ops[op].instruction->structure == Structure::Next;
    const std::uint32_t first = loops ? program.ops[op].target - 1 : op;  // its FOR
    stretch = {std::min(stretch.first, first), std::max(stretch.end, op + 1)};
    for (const std::uint32_t next : flow.nodes[op].next)
      if (next >= routine.first && next < routine.end && !enabled.whatever_flows(execution, next) &&
          seen.insert(next).second)
        waiting.push_back(next);
  }
  return stretch;
}

}  // namespace

bool KeptAway::in_front(const Execution& execution, std::uint32_t op) {
  const Place now = place(execution, way(execution), op);
  const Op& at = program_.ops[op];
  if (!now.reached) return false;
  if (at.instruction->rung.needs_power_flow || only_takes_power(at)) return now.powered;
  return now.always() && (at.is_contact || now.inactive);
}

bool KeptAway::whatever_flows(const Execution& execution, std::uint32_t op) {
  const Place now = place(execution, way(execution), op);
  return now.reached && now.always() && now.inactive;
}

Execution KeptAway::called(const Execution& caller, std::uint32_t call) {
  return {flow_.nodes[program_.ops[call].target].routine, caller.depth + 1, place(caller, way(caller), call).powered};
}

bool KeptAway::follows(const Execution& execution, std::uint32_t op) const {
  return !left_out_[op] && !is_unread(program_.ops[op]) && execution.depth < program_.model->call_depth;
}

KeptAway::Place KeptAway::place(const Execution& execution, const Way& way, std::uint32_t op) const {
  Place now = way.places[op - routine_of(execution).first];
  if (flow_.nodes[op].powered_if_active) now.unpowered = true;  // the top is never 0
  return now;
}

const KeptAway::Way& KeptAway::way(const Execution& execution) {
  const auto [found, is_new] = ways_.try_emplace(execution);
  Way& way = found->second;
  if (!is_new) return way;
  const Routine& routine = routine_of(execution);
  way.places.resize(routine.end - routine.first);
  if (!way.places.empty()) way.places.front() = {true, execution.kept_away, execution.kept_away, true};
  for (bool changes = true; changes;) {
    changes = false;
    for (std::uint32_t op = routine.first; op < routine.end; ++op) changes |= lead_on(execution, way, op);
  }
  return way;
}

/// Hands on what is so behind an op to those that may follow. Returns whether anything is new there.
bool KeptAway::lead_on(const Execution& execution, Way& way, std::uint32_t op) {
  const Place now = place(execution, way, op);
  if (!now.reached) return false;
  const FlowNode& node = flow_.nodes[op];
  const bool by_power = program_.ops[op].instruction->effect == Effect::ConditionalEnd;
  if (node.ends) way.behind &= by_power ? now.powered : now.always();
  const Place behind = after(execution, op, now);
  bool changes = false;
  const Routine& routine = routine_of(execution);
  for (const std::uint32_t next : node.next) {
    const Op& loop = program_.ops[op];
    const bool is_skipped = loop.instruction->structure == Structure::For && next != op + 1;
    if (next < routine.first || next >= routine.end) continue;
    if (is_skipped && node.powered_if_active && runs_a_pass(program_, loop)) continue;
    Place& there = way.places[next - routine.first];
    const Place on = on_edge(op, next, behind);
    const Place met{true, there.powered && on.powered, there.unpowered && on.unpowered, there.inactive && on.inactive};
    changes |= met != there;
    there = met;
  }
  return changes;
}

/// A jump that is taken and the first pass of a FOR had power flow.
KeptAway::Place KeptAway::on_edge(std::uint32_t op, std::uint32_t next, const Place& after) const {
  const Structure structure = program_.ops[op].instruction->structure;
  const bool jumps = structure == Structure::Jump || structure == Structure::SegmentExit;
  const bool by_power = (jumps && next != op + 1) || (structure == Structure::For && next == op + 1);
  Place on = after;
  if (by_power) on.unpowered = on.powered;
  return on;
}

KeptAway::Place KeptAway::after(const Execution& execution, std::uint32_t op, Place now) {
  const Op& at = program_.ops[op];
  switch (at.instruction->structure) {
    case Structure::Call:
      if (!follows(execution, op)) return now;
      now.powered = behind(called(execution, op));
      return now;
    case Structure::SegmentBegin:
      return {true, now.always(), now.always(), now.always()};
    case Structure::SegmentEnd:
      now.set_always(now.always() && now.inactive);
      return {true, now.powered, now.unpowered, true};
    case Structure::Next:  // leaves the top of the logic stack at 1
      return {true, now.always(), true, now.inactive};
    default:
      return after_box(at, now);
  }
}

KeptAway::Place KeptAway::after_box(const Op& op, Place now) const {
  if (is_unread(op) || !keeps_top(op)) now.set_always(now.always());
  if (only_takes_power(op)) now.unpowered = now.always();
  if (gate_.opens(op)) now.powered = false;
  if (gate_.closes(op)) now.powered = true;
  return now;
}

InterruptGate gate_of_all_interrupts() {
  return {[](const Op& op) { return op.instruction->effect == Effect::EnablesInterrupts; },
          [](const Op& op) { return op.instruction->mnemonic == "DISI"; }};
}

std::optional<std::vector<DisabledStretch>> disabled_stretches(const Program& program, const ControlFlow& flow,
                                                               const std::vector<std::uint32_t>& disabling) {
  const std::vector<bool> nothing(program.ops.size());
  const InterruptGate gate = gate_of_all_interrupts();
  KeptAway enabled(program, flow, nothing, {gate.closes, gate.opens});
  std::vector<DisabledStretch> all;
  std::set<std::uint32_t> within;  // ops of stretches: that of a DISI there is a part of one
  for (const std::uint32_t disi : disabling) {
    const Execution execution{flow.nodes[disi].routine, 0, true};
    if (!enabled.behind(execution)) return {};
    if (within.contains(disi)) continue;
    std::set<std::uint32_t> seen;
    all.push_back(until_enabled(program, flow, enabled, execution, disi, seen));
    within.merge(seen);
  }
  return all;
}

}  // namespace s7200
