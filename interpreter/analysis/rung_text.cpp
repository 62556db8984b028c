#include "interpreter/analysis/rung_text.hpp"

#include <fmt/format.h>

#include <string_view>

#include "interpreter/model/contact_form.hpp"

namespace s7200 {

std::string RungText::of_contact(const NetworkLogic::Contact& contact, bool negated) const {
  if (!contact.statement) return "the power flow in front";
  const std::uint32_t number = ways_.op_of(contact);
  const Instruction& instruction = *ways_.facts().program.ops[number].instruction;
  const std::string_view mnemonic = instruction.mnemonic;
  const ContactForm form = contact_form(instruction);
  if (form.is_edge())
    return fmt::format("{}{} edge of ({})", negated ? "not " : "", mnemonic == "EU" ? "rising" : "falling", of(number, 0));
  if (form.kind == ContactForm::Kind::Eno) return negated ? "not ENO" : "ENO";
  if (!form.compares()) return (negated ? "not " : "") + operand_text_(number, 0);
  const std::string_view relation = mnemonic.substr(mnemonic.find_first_of("<>="));
  const std::string text = fmt::format("{} {} {}", operand_text_(number, 0), relation, operand_text_(number, 1));
  return negated == contact.normally_closed ? text : fmt::format("not ({})", text);
}

std::string RungText::of_gate(const NetworkLogic& logic, std::size_t number, int strength) const {
  using Kind = NetworkLogic::Gate::Kind;
  const NetworkLogic::Gate& gate = logic.gates[number];
  if (gate.kind == Kind::True) return "always";
  if (gate.kind == Kind::Contact) return of_contact(logic.contacts[gate.a], false);
  if (gate.kind == Kind::Not) {
    const NetworkLogic::Gate& inner = logic.gates[gate.a];
    if (inner.kind == Kind::True) return "never";
    if (inner.kind == Kind::Contact) return of_contact(logic.contacts[inner.a], true);
    return "not " + of_gate(logic, gate.a, 3);
  }
  const int own = gate.kind == Kind::And ? 2 : 1;
  const std::string text =
      fmt::format("{} {} {}", of_gate(logic, gate.a, own), own == 2 ? "and" : "or", of_gate(logic, gate.b, own));
  return own < strength ? fmt::format("({})", text) : text;
}

std::string RungText::of(std::uint32_t op, std::size_t level) const {
  const RungLogic& rung = ways_.rung_of(op);
  return level < rung.inputs.size() ? of_gate(rung.logic, rung.inputs[level], 0) : "always";
}

}  // namespace s7200
