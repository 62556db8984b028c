#include "tools/session/past/access.hpp"

#include <algorithm>
#include <cstdlib>

namespace s7200::tools {
namespace {

bool is_of(Role role, Access access) {
  return role == Role::InOut || role == (access == Access::Read ? Role::In : Role::Out);
}

/// What the operand that counts says; 1 without one.
std::int64_t count_of(const Cpu& cpu, const Op& op) {
  const auto rules = op.instruction->rules();
  for (std::size_t i = 0; i < rules.size(); ++i)
    if (rules[i].count) {
      const std::uint32_t n = cpu.peek(op, i).value_or(0);
      return rules[i].sign == Sign::Signed ? std::abs(static_cast<std::int64_t>(static_cast<std::int8_t>(n))) : n;
    }
  return 1;
}

}  // namespace

Bits bits_of(const MemoryRange& range) {
  const std::uint64_t first = std::uint64_t{range.at} * 8 + (range.width == Width::Bit ? range.bit : 0);
  return {first, range.width == Width::Bit ? 1 : std::uint64_t{range.bytes()} * 8};
}

std::vector<Bits> accessed(const Cpu& cpu, std::uint32_t op_number, Access access) {
  std::vector<Bits> all;
  const Op& op = cpu.program().ops[op_number];
  const auto rules = op.instruction->rules();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const OperandRule& rule = rules[i];
    if (rule.kind != OperandKind::Memory) continue;
    const Operand& operand = op[i];
    const auto place = cpu.place_of(operand);
    if (operand.pointer && access == Access::Read) all.push_back({std::uint64_t{operand.at} * 8, 32});
    if (!place || *place >= image::kConstants || !is_of(rule.role, access)) continue;
    const auto elements = static_cast<std::uint64_t>(rule.reach(count_of(cpu, op)));
    const bool bit = rule.width == Width::Bit;
    all.push_back({std::uint64_t{*place} * 8 + (bit ? operand.bit : 0), elements * (bit ? 1 : 8 * bytes_of(rule.width))});
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
