#include "interpreter/program/operands/other_width.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "interpreter/program/operands/operands.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

/// MOVB, MOVW, MOVD and MOVR: their mnemonics differ in one letter, which is that of a width or a type.
bool differ_in_width_only(std::string_view a, std::string_view b) {
  constexpr std::string_view kLetters = "BWDRI";
  if (a.size() != b.size()) return false;
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  return in_a != a.end() && kLetters.find(*in_a) != std::string_view::npos &&
         kLetters.find(*in_b) != std::string_view::npos && std::equal(in_a + 1, a.end(), in_b + 1);
}

/// Whether an instruction has the same operands in other widths. Blocks are not the same: their count is of other elements.
bool has_same_operands(const Instruction& a, const Instruction& b) {
  return std::ranges::equal(a.rules(), b.rules(), [](const OperandRule& x, const OperandRule& y) {
    return x.name == y.name && x.role == y.role && x.counted == 0 && y.counted == 0;
  });
}

bool is_real(const stl::Operand& operand) { return std::holds_alternative<stl::Real>(operand.value); }

bool works_on_reals(const Instruction& instruction) { return std::ranges::any_of(instruction.rules(), &OperandRule::real); }

bool has_other_width(const stl::Operand& operand, const OperandRule& rule) {
  const auto* address = std::get_if<stl::Address>(&operand.value);
  const auto area = address ? area_named(address->area) : std::nullopt;
  const auto width = area ? width_of(*address, *area) : std::nullopt;
  return width && *width != rule.width;
}

bool takes_all(const Instruction& instruction, const stl::Statement& statement, const CpuModel& model) {
  ConstantPool constants;
  stl::Diagnostics diagnostics;
  for (std::size_t i = 0; i < statement.operands.size(); ++i)
    if (!place_operand(instruction, instruction.operand[i], statement.operands[i], model, constants, diagnostics))
      return false;
  return diagnostics.empty();
}

std::string text_of(const stl::Operand& operand) { return operand.symbol.empty() ? stl::to_text(operand) : operand.symbol; }

}  // namespace

std::string in_other_width(const Instruction& instruction, const stl::Statement& statement, const CpuModel& model) {
  const auto rules = instruction.rules();
  const bool reals = std::ranges::any_of(statement.operands, is_real);
  const bool widths = !std::ranges::equal(statement.operands, rules, std::not_fn(has_other_width));
  if (statement.operands.size() != rules.size() || (!widths && !reals)) return {};
  const bool on_reals = reals || works_on_reals(instruction);
  for (const Instruction& other : all_instructions()) {
    if (!differ_in_width_only(instruction.mnemonic, other.mnemonic) || !has_same_operands(instruction, other)) continue;
    if ((other.cpus & model.self) == 0 || !other.modelled() || works_on_reals(other) != on_reals) continue;
    if (!takes_all(other, statement, model)) continue;
    std::vector<std::string> operands;
    std::ranges::transform(statement.operands, std::back_inserter(operands), text_of);
    return fmt::format("{} {}", other.mnemonic, fmt::join(operands, ", "));
  }
  return {};
}

}  // namespace s7200
