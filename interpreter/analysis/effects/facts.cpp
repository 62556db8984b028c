#include "interpreter/analysis/effects/facts.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/analysis/effects/fast_units.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/special_memory.hpp"
#include "interpreter/program/ladder/networks.hpp"

namespace s7200 {
namespace {

std::vector<std::uint32_t> network_numbers(const Program& program, const ControlFlow& flow) {
  const Networks networks(program);
  std::vector<std::uint32_t> numbers(program.ops.size());
  for (const Routine& routine : flow.routines) {
    bool numbered = false;
    for (std::uint32_t op = routine.first; op < routine.end; ++op) numbered |= networks.number_of(op) != 0;
    std::uint32_t count = 0;
    for (std::uint32_t op = routine.first; op < routine.end; ++op) {
      const bool after_head = routine.kind != Routine::Kind::Main && op == routine.first + 1;  // the head is no rung
      if (networks.begins(op) && !after_head) ++count;
      numbers[op] = numbered ? networks.number_of(networks.first_of(op)) : count;
    }
  }
  return numbers;
}

/// RCV stores no more than its count byte and as many characters as SMB94, SMB194 of port 1, allows.
void shorten_receptions(Facts& facts) {
  for (std::uint32_t op = 0; op < facts.effects.size(); ++op) {
    const Op& receives = facts.program.ops[op];
    if (receives.instruction->effect != Effect::Receives || receives[1].unread() || receives[0].pointer) continue;
    const auto most = constants_written(facts, kPorts[receives[1].at].message + sm::message::kMost, Width::Byte);
    if (!most || most->empty()) continue;
    const std::uint64_t end = (std::uint64_t{receives[0].at} + 1 + static_cast<std::uint64_t>(std::ranges::max(*most))) * 8;
    std::erase_if(facts.effects[op],
                  [&](const MemoryAccess& access) { return access.operand == 0 && access.bits.first >= end; });
    for (MemoryAccess& access : facts.effects[op])
      if (access.operand == 0) access.bits.count = std::min(access.bits.count, end - access.bits.first);
  }
}

Facts facts_with(const Program& program, ControlFlow flow, Pointers pointers) {
  Facts facts{program, std::move(flow), std::move(pointers), {}, {}};
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) facts.effects.push_back(effects_of(program, op, facts.pointers));
  shorten_receptions(facts);
  shorten_profiles(facts);
  facts.networks = network_numbers(program, facts.flow);
  return facts;
}

}  // namespace

Facts facts_of(const Program& program, const Waiter& waiter) {
  ControlFlow flow = control_flow(program);
  Pointers pointers(program, flow, waiter);
  return facts_with(program, std::move(flow), std::move(pointers));
}

Facts facts_without_pointers(const Program& program) {
  return facts_with(program, control_flow(program), Pointers::nothing_known(program));
}

std::optional<std::vector<std::int64_t>> constants_written(const Facts& facts, std::uint32_t at, Width width) {
  std::vector<std::int64_t> all;
  const Bits bits{at * 8u, bytes_of(width) * 8u};
  for (std::uint32_t op = 0; op < facts.effects.size(); ++op)
    for (const MemoryAccess& access : facts.effects[op]) {
      if (!access.writes() || access.by_pointer || !access.bits.overlaps(bits)) continue;
      const Op& writer = facts.program.ops[op];
      const bool leaves_its_length = access.operand != kNoOperand && width == Width::Word &&
                                     writer.instruction->operand[access.operand].most != 0 &&
                                     access.bits.first == bits.first;
      if (leaves_its_length) continue;  // ATT, FIFO, LIFO: the first word of a table
      const auto box = value_box_of(*writer.instruction);
      const auto value = box && box->carries() && box->from && access.bits == bits
                             ? constant_value(facts.program, writer[*box->from], width)
                             : std::nullopt;
      if (!value) return {};
      all.push_back(*value);
    }
  return all;
}

}  // namespace s7200
