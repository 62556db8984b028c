#include "tools/session/past/access.hpp"

#include <algorithm>

#include "interpreter/analysis/effects.hpp"

namespace s7200::tools {

Bits bits_of(const MemoryRange& range) {
  const std::uint64_t first = std::uint64_t{range.at} * 8 + (range.width == Width::Bit ? range.bit : 0);
  return {first, range.width == Width::Bit ? 1 : std::uint64_t{range.bytes()} * 8};
}

std::vector<Bits> accessed(const Cpu& cpu, std::uint32_t op, Access access) {
  std::vector<Bits> all;
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
