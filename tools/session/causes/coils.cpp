#include "tools/session/causes/coils.hpp"

#include <algorithm>

#include "interpreter/analysis/flow/flow.hpp"
#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {
namespace {

/// Ops in the order of the program that may be executed from a place on, in its routine and what that calls.
class Ahead {
 public:
  explicit Ahead(const Program& program) : program_(program), flow_(control_flow(program)), ahead_(program.ops.size()) {}

  void go_on_at(std::uint32_t op) {
    for (; op < flow_.routine_of(op).end && !ahead_[op]; ++op) {
      ahead_[op] = true;
      if (program_.ops[op].instruction->structure == Structure::Call) go_on_at(program_.ops[op].target);
      if (op + 1 == program_.ops.size()) return;
      if (flow_.nodes[op].routine != flow_.nodes[op + 1].routine) return;
    }
  }
  bool has(std::uint32_t op) const { return ahead_[op]; }

 private:
  const Program& program_;
  ControlFlow flow_;
  std::vector<bool> ahead_;
};

/// Where the main program stands, and its callers: what they execute next.
std::vector<std::uint32_t> places_of_main(const State& state) {
  std::vector<std::uint32_t> places{state.in_interrupt ? state.saved.return_to : state.pc};
  const std::uint8_t depth = state.in_interrupt ? state.saved.call_depth : state.call_depth;
  for (std::uint8_t level = 0; level < depth; ++level) places.push_back(state.calls[level].return_to);
  return places;
}

}  // namespace

std::vector<std::uint32_t> coils_of(const Cpu& cpu, const Bits& bit) {
  const Program& program = cpu.program();
  const ControlFlow flow = control_flow(program);
  std::vector<std::uint32_t> coils;
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    const Op& one = program.ops[op];
    const bool left_out = one.has_pointer || one.instruction->structure == Structure::SegmentTransition ||
                          returns_from_subroutine(one) || flow.routine_of(op).kind == Routine::Kind::Interrupt;
    if (!left_out && accesses(cpu, op, Access::Write, bit)) coils.push_back(op);
  }
  return coils;
}

std::vector<std::uint32_t> coils_to_come(const Cpu& cpu, const Bits& bit) {
  if (cpu.state().mode == Mode::Stop || cpu.state().phase != Phase::Program) return {};
  std::vector<std::uint32_t> coils = coils_of(cpu, bit);
  const std::size_t all = coils.size();
  Ahead ahead(cpu.program());
  for (const std::uint32_t op : places_of_main(cpu.state())) ahead.go_on_at(op);
  std::erase_if(coils, [&](std::uint32_t op) { return !ahead.has(op); });
  return coils.size() == all ? std::vector<std::uint32_t>{} : coils;
}

}  // namespace s7200::tools
