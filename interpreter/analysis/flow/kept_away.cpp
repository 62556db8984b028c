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

/// From a DISI to the last op that may follow it while interrupts are not surely enabled again; of loops all. `seen` gets
/// the ops of it.
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

bool is_first_scan(const Op& op) {
  return op.is_contact && !op[0].unread() && !op[0].pointer && op[0].at == sm::kScanStatus &&
         1u << op[0].bit == sm::kFirstScan;
}

/// The program in its first scan: SM0.1 is always on, as SM0.0 is.
Program in_first_scan(Program program) {
  for (Op& op : program.ops)
    if (is_first_scan(op)) op.operand[0].bit = 0;
  return program;
}

/// What LDN SM0.1 alone keeps from jumping and ending.
ControlFlow flow_of_first_scan(const Program& program, const Program& first) {
  ControlFlow flow = control_flow(first);
  for (std::uint32_t op = 1; op < program.ops.size(); ++op) {
    const Op& now = program.ops[op];
    const bool jumps = now.instruction->structure == Structure::Jump || now.instruction->effect == Effect::ConditionalEnd;
    if (!jumps || !is_first_scan(program.ops[op - 1]) || program.ops[op - 1].instruction->mnemonic != "LDN") continue;
    flow.nodes[op].next = {op + 1};
    flow.nodes[op].ends = false;
  }
  return flow;
}

/// All executions that `first` leads to, itself too.
std::set<Execution> executions_from(const Program& program, const ControlFlow& flow, KeptAway& gate,
                                    const Execution& first) {
  std::set<Execution> all{first};
  for (std::vector<Execution> waiting{first}; !waiting.empty();) {
    const Execution now = waiting.back();
    waiting.pop_back();
    for (const CallSite& call : flow.calls) {
      if (flow.nodes[call.op].routine != now.routine || now.depth >= program.model->call_depth) continue;
      const Execution called = gate.called(now, call.op);
      if (gate.reaches(now, call.op) && all.insert(called).second) waiting.push_back(called);
    }
  }
  return all;
}

/// From what may happen before an ENI to that, in a scan that begins with interrupts disabled.
class BeforeEnabling {
 public:
  BeforeEnabling(const Program& program, const ControlFlow& flow)
      : program_(program),
        flow_(flow),
        nothing_(program.ops.size()),
        early_(program.ops.size()),
        enabled_(program, flow, nothing_, {gate_.closes, gate_.opens}),
        open_(program, flow, nothing_, {[this](const Op& op) { return gate_.closes(op) || is_early(op); }, gate_.opens}) {
    for (const Execution& execution : executions_from(program, flow, enabled_, kMain)) {
      const Routine& routine = flow.routines[execution.routine];
      for (std::uint32_t op = routine.first; op < routine.end; ++op)
        if (program.ops[op].instruction->structure == Structure::Attach && enabled_.reaches(execution, op) &&
            !enabled_.in_front(execution, op))
          early_[op] = true;
    }
  }

  bool surely_ends() { return enabled_.behind(kMain); }

  std::optional<std::vector<DisabledStretch>> stretches() {
    Execution main = kMain;
    main.kept_away = true;
    if (!open_.behind(main)) return {};
    std::vector<DisabledStretch> all;
    for (Execution execution : executions_from(program_, flow_, open_, main)) {
      execution.kept_away = true;
      const Routine& routine = flow_.routines[execution.routine];
      std::set<std::uint32_t> seen;
      for (std::uint32_t op = routine.first; op < routine.end; ++op)
        if (open_.reaches(execution, op) && begins_at(execution, op) && !seen.contains(op))
          all.push_back(until_enabled(program_, flow_, open_, execution, op, seen));
    }
    return all;
  }

 private:
  static constexpr Execution kMain{};

  bool is_early(const Op& op) const { return early_[static_cast<std::size_t>(&op - program_.ops.data())]; }
  bool begins_at(const Execution& execution, std::uint32_t op) {
    if (early_[op]) return true;
    const bool calls =
        program_.ops[op].instruction->structure == Structure::Call && execution.depth < program_.model->call_depth;
    return calls && !open_.behind(open_.called(execution, op));
  }

  const Program& program_;
  const ControlFlow& flow_;
  const std::vector<bool> nothing_;
  std::vector<bool> early_;  // an ATCH in front of which interrupts may not be enabled
  const InterruptGate gate_ = gate_of_all_interrupts();
  KeptAway enabled_, open_;  // whether they surely are; whether they are or no such ATCH has come
};

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

std::optional<std::vector<DisabledStretch>> stretches_before_enabling(const Program& program, const ControlFlow& flow) {
  const Program first = in_first_scan(program);
  const ControlFlow of_first = flow_of_first_scan(program, first);
  BeforeEnabling in_first(first, of_first);
  if (in_first.surely_ends()) return in_first.stretches();
  return BeforeEnabling(program, flow).stretches();
}

}  // namespace s7200
