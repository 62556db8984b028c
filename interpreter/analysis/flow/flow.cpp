#include "interpreter/analysis/flow/flow.hpp"

#include <algorithm>

#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

Structure structure(const Op& op) { return op.instruction->structure; }

bool is_head(const Op& op) { return begins_routine(structure(op)); }

std::vector<Routine> routines_of(const Program& program) {
  std::vector<Routine> routines{Routine{}};
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (is_head(op)) {
      const bool subroutine = structure(op) == Structure::SubroutineHead;
      routines.push_back(
          {subroutine ? Routine::Kind::Subroutine : Routine::Kind::Interrupt, static_cast<std::uint8_t>(op[0].at), i, i});
    }
    routines.back().end = i + 1;
  }
  return routines;
}

/// Whether the top of the logic stack is known to be 1 after an op, outside segments.
bool powered_after(const Op& op, bool before) {
  const Instruction& instruction = *op.instruction;
  if (is_head(op)) return true;
  if (instruction.effect == Effect::LoadsBit) return op[0].at == sm::kScanStatus && op[0].bit == 0;
  if (instruction.structure == Structure::Jump) return false;
  return before && (instruction.rung.needs_power_flow || instruction.effect == Effect::Coil ||
                    instruction.structure == Structure::Label);
}

/// An op with power flow leads to `on`, or ends its routine; without, to the next one.
void lead_on(FlowNode& node, std::uint32_t next, std::optional<std::uint32_t> on) {
  if (!node.powered) node.next.push_back(next);
  if (on) node.next.push_back(*on);
  node.ends = !on;
}

void find_next(const Op& op, std::uint32_t number, FlowNode& node) {
  switch (structure(op)) {
    case Structure::MainEnd:
    case Structure::SubroutineEnd:
    case Structure::InterruptEnd:
      node.ends = true;
      return;
    case Structure::Jump:
    case Structure::SegmentExit:
      return lead_on(node, number + 1, op.target);
    case Structure::For:
    case Structure::Next:
      node.next = {number + 1, op.target};
      return;
    default:
      break;
  }
  if (op.instruction->effect == Effect::ConditionalEnd) return lead_on(node, number + 1, std::nullopt);
  node.next = {number + 1};
}

std::optional<std::uint32_t> routine_with(const ControlFlow& flow, Routine::Kind kind, const Operand& number) {
  const auto found = std::ranges::find_if(
      flow.routines, [&](const Routine& routine) { return routine.kind == kind && routine.number == number.at; });
  if (number.unread() || found == flow.routines.end()) return {};
  return static_cast<std::uint32_t>(found - flow.routines.begin());
}

void note_start(ControlFlow& flow, const Op& op, std::uint32_t number) {
  if (structure(op) == Structure::Call) flow.calls.push_back({number, flow.nodes[op.target].routine});
  if (structure(op) != Structure::Attach) return;
  Attachment attachment{number, routine_with(flow, Routine::Kind::Interrupt, op[0]), {}};
  if (!op[1].unread()) attachment.event = static_cast<std::uint8_t>(op[1].at);
  flow.attachments.push_back(attachment);
}

}  // namespace

ControlFlow control_flow(const Program& program) {
  ControlFlow flow{
      .routines = routines_of(program), .nodes = std::vector<FlowNode>(program.ops.size()), .calls = {}, .attachments = {}};
  const Networks networks(program);
  for (std::uint32_t i = 0; i < flow.routines.size(); ++i)
    for (std::uint32_t op = flow.routines[i].first; op < flow.routines[i].end; ++op) flow.nodes[op].routine = i;
  bool powered = false, in_segment = false;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (structure(op) == Structure::SegmentBegin) in_segment = true;
    if (structure(op) == Structure::SegmentEnd) in_segment = false;
    flow.nodes[i].powered = powered && !in_segment;
    flow.nodes[i].powered_if_active = powered;
    flow.nodes[i].network = networks.first_of(i);
    find_next(op, i, flow.nodes[i]);
    powered = powered_after(op, powered);
  }
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) note_start(flow, program.ops[i], i);
  return flow;
}

}  // namespace s7200
