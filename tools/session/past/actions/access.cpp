#include "tools/session/past/actions/access.hpp"

#include <algorithm>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200::tools {

namespace {

constexpr Bits kErrorFlag{std::uint64_t{sm::kInterruptStatus} * 8 + 3, 1};

/// The parameters of a CALL that are copied by it, or by the return to it: all that are not `but`, in the local memory of
/// the subroutine or in that of the caller.
void add_parameters(const Cpu& cpu, std::uint32_t call, Access access, Role but, bool local, std::vector<Bits>& all) {
  const Program& program = cpu.program();
  if (local) {
    for (const Parameter& parameter : parameters_of(program, call))
      if (parameter.role != but) all.push_back(local_bits(parameter));
    return;
  }
  for (const MemoryAccess& each : effects_now(program, call, cpu.state().image))
    if (each.operand == kNoOperand && !(each.bits == kErrorFlag) && (access == Access::Read ? each.reads() : each.writes()))
      all.push_back(each.bits);
}

}  // namespace

std::span<const Parameter> parameters_of(const Program& program, std::uint32_t call) {
  const Op& op = program.ops[call];
  return std::span(program.parameters).subspan(op[1].at, op[2].at);
}

Bits local_bits(const Parameter& parameter) {
  const bool is_bit = parameter.width == Width::Bit;
  return {std::uint64_t{parameter.local.at} * 8 + (is_bit ? parameter.local.bit : 0),
          is_bit ? 1 : std::uint64_t{bytes_of(parameter.width)} * 8};
}

Bits bits_of(const MemoryRange& range) {
  const std::uint64_t first = std::uint64_t{range.at} * 8 + (range.width == Width::Bit ? range.bit : 0);
  return {first, range.width == Width::Bit ? 1 : std::uint64_t{range.bytes()} * 8};
}

bool returns_from_subroutine(const Op& op) {
  const Instruction& instruction = *op.instruction;
  return instruction.structure == Structure::SubroutineEnd ||
         (instruction.effect == Effect::ConditionalEnd && instruction.allowed.parts == kSubroutine);
}

std::optional<std::uint32_t> call_that_ends(const Cpu& cpu, std::uint32_t op) {
  const State& state = cpu.state();
  if (!returns_from_subroutine(cpu.program().ops[op]) || state.call_depth == 0) return {};
  return state.calls[state.call_depth - 1].return_to - 1;
}

std::vector<Bits> accessed(const Cpu& cpu, std::uint32_t op, Access access) {
  std::vector<Bits> all;
  if (cpu.program().ops[op].instruction->structure == Structure::Call)
    add_parameters(cpu, op, access, Role::Out, access == Access::Write, all);
  else if (const auto call = call_that_ends(cpu, op))
    add_parameters(cpu, *call, access, Role::In, access == Access::Read, all);
  const auto rules = cpu.program().ops[op].instruction->rules();
  for (const MemoryAccess& each : effects_now(cpu.program(), op, cpu.state().image)) {
    const bool of_operand =
        each.operand < rules.size() && (each.certainty == Certainty::Must || rules[each.operand].most == 0);
    if (of_operand && (access == Access::Read ? each.reads() : each.writes())) all.push_back(each.bits);
  }
  return all;
}

bool may_access(const Cpu& cpu, std::uint32_t number, Access access, const Bits& range) {
  const Op& op = cpu.program().ops[number];
  if (!cpu.program().parameters.empty() && returns_from_subroutine(op)) return true;
  const auto rules = op.instruction->rules();
  for (std::size_t i = 0; i < rules.size(); ++i)
    if (rules[i].count || (rules[i].kind == OperandKind::Memory && op[i].pointer)) return true;
  return accesses(cpu, number, access, range);
}

bool accesses(const Cpu& cpu, std::uint32_t op, Access access, const Bits& range) {
  const std::vector<Bits> all = accessed(cpu, op, access);
  return std::any_of(all.begin(), all.end(), [&](const Bits& bits) { return bits.overlaps(range); });
}

}  // namespace s7200::tools
