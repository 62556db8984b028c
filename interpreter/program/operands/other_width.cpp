#include "interpreter/program/operands/other_width.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "interpreter/model/boxes.hpp"
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

bool is_place(const stl::Operand& operand) {
  return std::holds_alternative<stl::Address>(operand.value) || std::holds_alternative<stl::Indirect>(operand.value);
}

/// The low word of a double word: VW6 of VD4, AC0 of AC0. Empty for another operand.
std::string low_word_text(const stl::Operand& operand) {
  const auto* address = std::get_if<stl::Address>(&operand.value);
  if (!address || (address->size != stl::Size::Double && address->area != "AC")) return {};
  if (address->area == "AC") return stl::to_text(operand);
  return fmt::format("{}W{}", address->area, address->number + 2);
}

std::uint32_t bytes_of(stl::Size size) { return size == stl::Size::Double ? 4 : size == stl::Size::Word ? 2 : 1; }

/// Whether two operands surely have no byte in common.
bool are_apart(const stl::Operand& a, const stl::Operand& b) {
  if (!is_place(a) || !is_place(b)) return true;
  const auto *first = std::get_if<stl::Address>(&a.value), *second = std::get_if<stl::Address>(&b.value);
  return first && second &&
         (first->area != second->area || first->number + bytes_of(first->size) <= second->number ||
          second->number + bytes_of(second->size) <= first->number);
}

bool inputs_may_change_places(const Instruction& instruction) {
  constexpr std::array<std::string_view, 16> kCommutative{"+I",   "+D",   "+R",  "*I",  "*D",  "*R",   "MUL",  "ANDB",
                                                          "ANDW", "ANDD", "ORB", "ORW", "ORD", "XORB", "XORW", "XORD"};
  return std::ranges::find(kCommutative, instruction.mnemonic) != kCommutative.end();
}

}  // namespace

std::string in_steps(const Instruction& instruction, const stl::Statement& statement) {
  const std::vector<BoxStep> steps = steps_with_output(instruction, statement.operands.size());
  if (steps.size() != 2 || !is_place(statement.operands.back())) return {};
  const stl::Operand &in1 = statement.operands.front(), &out = statement.operands.back();
  const BoxStep &move = steps[0], &last = steps[1];
  const auto place_of_out = std::ranges::find(last.operands, statement.operands.size() - 1) - last.operands.begin();
  const Width of_out = last.instruction->operand[static_cast<std::size_t>(place_of_out)].width;
  const bool widens = of_out != move.instruction->operand[1].width;
  const std::string to = widens ? low_word_text(out) : text_of(out);
  if (to.empty())
    return fmt::format("write MOVW IN1 into the low word of OUT, then {} IN2, OUT", last.instruction->mnemonic);
  const auto step = [&](std::size_t input) {
    std::vector<std::string> operands;
    for (const std::size_t number : last.operands)
      operands.push_back(text_of(statement.operands[number + 1 == statement.operands.size() ? number : input]));
    return fmt::format("{} {}", last.instruction->mnemonic, fmt::join(operands, ", "));
  };
  const bool has_second = statement.operands.size() > 2;
  if (text_of(in1) == to) return fmt::format("write {}", step(1));
  if (has_second && inputs_may_change_places(instruction) && text_of(statement.operands[1]) == to)
    return fmt::format("write {}", step(0));
  if (has_second && !are_apart(statement.operands[1], out)) {
    const std::string in2 = text_of(statement.operands[1]);
    return fmt::format("write {} {}{}OUT, then {} {}, OUT, with an OUT outside {}", move.instruction->mnemonic, text_of(in1),
                       widens ? " into the low word of " : ", ", last.instruction->mnemonic, in2, in2);
  }
  return fmt::format("write {} {}, {}, then {}", move.instruction->mnemonic, text_of(in1), to, step(1));
}

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
