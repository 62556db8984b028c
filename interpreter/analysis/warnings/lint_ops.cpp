#include "interpreter/analysis/warnings/lint_ops.hpp"

#include <algorithm>

#include "interpreter/stl/printer.hpp"

namespace s7200::lint {
const stl::Position& place(const Program& program, std::uint32_t op) { return program.statement(op).position; }
std::uint32_t line(const Program& program, std::uint32_t op) { return place(program, op).line; }
std::string written(const Program& program, std::uint32_t op, std::size_t operand) {
  return stl::to_text(program.statement(op).operands[operand]);
}

bool pointers_reach(const Program& program, const Bits& bits) {
  constexpr Areas kRare = set_of(Area::SM) | set_of(Area::AI) | set_of(Area::AQ);
  return std::ranges::any_of(program.reach, [&](const Reach& reach) {
    const Areas area = set_of(area_at(reach.base).area);
    return bits.overlaps({reach.base * 8u, reach.size * 8u}) && ((area & kRare) == 0 || (area & program.pointed_at) != 0);
  });
}

bool is_meant(const Program& program, const MemoryAccess& access, const Bits& bits) {
  return access.bits.overlaps(bits) && (!access.by_pointer || pointers_reach(program, bits));
}

bool may_write(const Facts& facts, std::uint32_t op, const Bits& bits) {
  return std::ranges::any_of(facts.effects[op], [&](const MemoryAccess& access) {
    return access.writes() && is_meant(facts.program, access, bits);
  });
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
