#include "tools/coverage/contacts.hpp"

#include <string_view>

namespace s7200::tools {
namespace {

using Kind = ContactForm::Kind;

/// The characters of a string, after its length byte.
std::string_view string_of(const Cpu& cpu, const Operand& operand) {
  const auto& image = cpu.state().image;
  const std::uint32_t at = cpu.place_of(operand).value_or(operand.at);
  return {reinterpret_cast<const char*>(&image[at + 1]), image[at]};
}

bool is_constant(const Operand& operand) { return !operand.pointer && operand.at >= image::kConstants; }

bool is_always_on(const Op& op) { return op[0].at == image::kSM && op[0].bit == 0; }

}  // namespace

std::optional<bool> lets_through(const Cpu& cpu, const Op& op, const ContactForm& form, const InstructionRecord& record) {
  const State& state = cpu.state();
  const bool fed = form.join == Join::And || !op.in_segment || state.rail;
  switch (form.kind) {
    case Kind::None:
      return {};
    case Kind::Bit:
      return fed && (record.value[0].value_or(0) != 0) != form.inverted;
    case Kind::Numbers:
      if (state.mode == Mode::Stop || !record.value[0] || !record.value[1]) return {};
      return fed && compares(form, *record.value[0], *record.value[1]);
    case Kind::Strings:
      if (state.mode == Mode::Stop) return {};
      return fed && (string_of(cpu, op[0]) == string_of(cpu, op[1])) == (form.relation == Relation::Equal);
    case Kind::Not:
    case Kind::Rising:
    case Kind::Falling:
      return record.top;
    case Kind::Eno:
      return state.eno;
  }
  return {};
}

std::string why_constant(const Op& op, const ContactForm& form) {
  if (form.kind == Kind::Bit && is_always_on(op)) return "SM0.0 is always 1";
  return form.compares() && is_constant(op[0]) && is_constant(op[1]) ? "it compares two constants" : "";
}

bool is_always_closed(const Program& program, const Op& op, const ContactForm& form) {
  if (form.kind == Kind::Bit) return !form.inverted;
  const auto constant = [&](const Operand& operand) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < operand.width; ++i)
      value = value << 8 | program.constants[operand.at - image::kConstants + i];
    return value;
  };
  return form.kind == Kind::Numbers && compares(form, constant(op[0]), constant(op[1]));
}

}  // namespace s7200::tools
