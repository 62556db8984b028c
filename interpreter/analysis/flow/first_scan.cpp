#include "interpreter/analysis/flow/first_scan.hpp"

#include <cstdint>

#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

/// The levels of the logic stack that are 1 in the first scan only, a bit each, S0 the lowest. In doubt a bit is 0.
using Levels = std::uint32_t;

bool is_of_first_scan(const Operand& bit) {
  return bit.at == sm::kScanStatus && !bit.unread() && (1u << bit.bit & (sm::kFirstScan | sm::kFromPowerUp)) != 0;
}

Levels with_top(Levels levels, bool top) { return (levels & ~1u) | (top ? 1u : 0u); }
Levels pushed(Levels levels, bool top) { return levels << 1 | (top ? 1u : 0u); }

/// After an instruction that only looks at the top level.
Levels after_top(const Op& op, Levels levels) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  const bool top = levels & 1;
  if (mnemonic == "A") return with_top(levels, top || is_of_first_scan(op[0]));
  if (mnemonic == "O") return with_top(levels, top && is_of_first_scan(op[0]));
  const bool is_and = mnemonic.starts_with('A') || mnemonic == "EU" || mnemonic == "ED";
  return with_top(levels, top && is_and);
}

Levels after(const Op& op, Levels levels) {
  const Instruction& instruction = *op.instruction;
  const std::string_view mnemonic = instruction.mnemonic;
  if (is_unread(op) || instruction.structure != Structure::None) {
    if (instruction.structure == Structure::Compare && instruction.rung.stack.needs == 1) return after_top(op, levels);
    if (instruction.structure == Structure::Compare) return pushed(levels, false);
    return instruction.rung.needs_power_flow && instruction.structure != Structure::Jump ? levels : 0;
  }
  if (instruction.rung.writes_output) return instruction.rung.stack.change == 0 ? levels : 0;
  if (mnemonic == "ALD") return with_top(levels >> 1, (levels & 3) != 0);
  if (mnemonic == "OLD") return with_top(levels >> 1, (levels & 3) == 3);
  if (mnemonic == "LPS") return pushed(levels, levels & 1);
  if (mnemonic == "LDS") return pushed(levels, !op[0].unread() && (levels >> op[0].at & 1) != 0);
  if (mnemonic == "LRD") return with_top(levels, levels & 2);
  if (mnemonic == "LPP") return levels >> 1;
  if (instruction.effect == Effect::LoadsBit) return pushed(levels, is_of_first_scan(op[0]));
  if (instruction.rung.stack.needs != 0) return after_top(op, levels);
  return instruction.rung.stack.change == 0 ? levels : pushed(levels, false);
}

}  // namespace

std::vector<bool> ops_of_first_scan(const Program& program) {
  std::vector<bool> only;
  Levels levels = 0;
  for (const Op& op : program.ops) {
    only.push_back(levels & 1);
    levels = after(op, levels);
  }
  return only;
}

}  // namespace s7200
