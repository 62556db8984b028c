#include "interpreter/analysis/lint_ops.hpp"

#include <algorithm>
#include <cstdlib>

#include "interpreter/stl/printer.hpp"

namespace s7200::lint {
namespace {

constexpr std::int64_t kMostElements = 255;

/// The value of the count operand if it is a constant, otherwise the largest possible.
std::int64_t count_of(const Program& program, const Op& op) {
  const auto rules = op.instruction->rules();
  const auto rule = std::ranges::find_if(rules, &OperandRule::count);
  if (rule == rules.end()) return 1;
  const Operand& count = op[static_cast<std::size_t>(rule - rules.begin())];
  if (count.pointer || count.unread() || count.at < image::kConstants) return kMostElements;
  const std::uint8_t value = program.constants[count.at - image::kConstants];
  return rule->sign == Sign::Signed ? std::abs(static_cast<std::int8_t>(value)) : value;
}

}  // namespace

const stl::Position& place(const Program& program, std::uint32_t op) { return program.statement(op).position; }
std::uint32_t line(const Program& program, std::uint32_t op) { return place(program, op).line; }
std::string written(const Program& program, std::uint32_t op, std::size_t operand) {
  return stl::to_text(program.statement(op).operands[operand]);
}

Bits bits_of(const Program& program, const Op& op, std::size_t operand) {
  const OperandRule& rule = op.instruction->operand[operand];
  const auto reach = static_cast<std::uint64_t>(rule.reach(count_of(program, op)));
  if (rule.width == Width::Bit) return {op[operand].at * 8u + op[operand].bit, reach};
  return {op[operand].at * 8u, reach * 8 * bytes_of(rule.width)};
}

bool pointers_reach(const Program& program, const Bits& bits) {
  constexpr Areas kRare = set_of(Area::SM) | set_of(Area::AI) | set_of(Area::AQ);
  return std::ranges::any_of(program.reach, [&](const Reach& reach) {
    const Areas area = set_of(area_at(reach.base).area);
    return bits.overlap({reach.base * 8u, reach.size * 8u}) && ((area & kRare) == 0 || (area & program.pointed_at) != 0);
  });
}

bool touches(const Program& program, const Op& op, const Bits& bits, bool only_written) {
  if (is_unread(op)) return true;
  for (std::size_t i = 0; i < op.instruction->rules().size(); ++i) {
    const OperandRule& rule = op.instruction->operand[i];
    if (rule.kind != OperandKind::Memory || (only_written && rule.role == Role::In)) continue;
    if (op[i].unread() || (op[i].pointer ? pointers_reach(program, bits) : bits.overlap(bits_of(program, op, i))))
      return true;
  }
  return false;
}

std::vector<std::uint32_t> ops_with(const Program& program, Effect effect) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i)
    if (program.ops[i].instruction->effect == effect) found.push_back(i);
  return found;
}

std::vector<std::uint32_t> attachments(const Program& program) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i)
    if (program.ops[i].instruction->structure == Structure::Attach) found.push_back(i);
  return found;
}

}  // namespace s7200::lint
