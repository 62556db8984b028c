#include "interpreter/analysis/effects/facts.hpp"

#include <utility>

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

}  // namespace

Facts facts_of(const Program& program) {
  ControlFlow flow = control_flow(program);
  Pointers pointers(program, flow);
  Facts facts{program, std::move(flow), std::move(pointers), {}, {}};
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) facts.effects.push_back(effects_of(program, op, facts.pointers));
  facts.networks = network_numbers(program, facts.flow);
  return facts;
}

}  // namespace s7200
