#include "interpreter/program/checking/chains.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "interpreter/model/times/times_file.hpp"

namespace s7200 {
namespace {

using PartKind = ChainPart::Kind;

struct Chain {
  std::size_t contacts = 0, joins = 0, coils = 0;
};

/// The part that the op has in a chain. Some need a step around their body, and have no part in any.
ChainPart part_of(const Op& op) { return op.body == op.instruction->body.usual ? op.instruction->body.part : ChainPart{}; }

/// The chain that begins with `part`, if the next op begins `next`.
Chain with(const ChainPart& part, const Chain& next) {
  const auto join = static_cast<std::size_t>(part.join);
  switch (part.kind) {
    case PartKind::None:
      return {};
    case PartKind::Coil:
      return {0, 0, next.contacts == 0 ? std::min(next.coils + 1, kMostCoils) : 1};
    case PartKind::Contact:
      if (next.contacts == kMostContacts) return {1, join, 0};
      return {next.contacts + 1, next.joins * kJoins + join, next.coils};
  }
  return {};
}

// A contact or coil has a figure of its own and one for the area of its operand.
static_assert((kMostContacts + kMostCoils) * 2 * kLongestFigure <= std::numeric_limits<std::int32_t>::max());

Link link_of(const Op& op, const Chain& chain) {
  if (chain.contacts + chain.coils > 0) return link_of_chain(chain.contacts, chain.joins, chain.coils);
  if (op.body != op.instruction->body.usual) return link_of_step(op.body);
  const Link own = op.instruction->body.link;
  return own ? own : link_of_any();
}

void add_contacts(Program& program) {
  for (Op& op : program.ops) {
    const ChainPart part = part_of(op);
    if (part.kind == PartKind::None) continue;
    assert(op.power_mask == 0 && op.unit_cost == 0);
    op.target = static_cast<std::uint32_t>(program.contacts.size());
    program.contacts.push_back({op[0].at, static_cast<std::uint8_t>(1u << op[0].bit), part.inverted});
  }
}

}  // namespace

void link(Program& program) {
  if (!link_of_any()) return;
  add_contacts(program);
  Chain chain;
  for (auto op = program.ops.end(); op != program.ops.begin();) {
    --op;
    chain = with(part_of(*op), chain);
    op->link = link_of(*op, chain);
    for (const Op& each : std::span(op, chain.contacts + chain.coils)) op->chain_cost += each.cost;
  }
}

}  // namespace s7200
