#include "tools/coverage/contacts.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>
#include <utility>

namespace s7200::tools {
namespace {

using Kind = ContactForm::Kind;
using Type = ContactForm::Type;
using Relation = ContactForm::Relation;

constexpr std::array<std::pair<std::string_view, Relation>, 6> kRelations{{{"=", Relation::Equal},
                                                                           {"<>", Relation::NotEqual},
                                                                           {">", Relation::Greater},
                                                                           {">=", Relation::GreaterEqual},
                                                                           {"<", Relation::Less},
                                                                           {"<=", Relation::LessEqual}}};
constexpr std::array<std::pair<char, Type>, 4> kTypes{
    {{'B', Type::Byte}, {'W', Type::Word}, {'D', Type::Double}, {'R', Type::Real}}};
constexpr std::array<std::pair<std::string_view, Kind>, 4> kOnTop{
    {{"NOT", Kind::Not}, {"EU", Kind::Rising}, {"ED", Kind::Falling}, {"AENO", Kind::Eno}}};

/// `LDW>=`, `AB=`, `OS<>`
ContactForm comparison(std::string_view mnemonic) {
  ContactForm form{.kind = Kind::Numbers};
  form.join = mnemonic.starts_with("LD") ? Join::Load : mnemonic.front() == 'A' ? Join::And : Join::Or;
  mnemonic.remove_prefix(form.join == Join::Load ? 2 : 1);
  if (mnemonic.front() == 'S') form.kind = Kind::Strings;
  for (const auto& [letter, type] : kTypes)
    if (mnemonic.front() == letter) form.type = type;
  for (const auto& [sign, relation] : kRelations)
    if (mnemonic.substr(1) == sign) form.relation = relation;
  return form;
}

template <class Value>
bool compare(Relation relation, Value a, Value b) {
  switch (relation) {
    case Relation::Equal:
      return a == b;
    case Relation::NotEqual:
      return a != b;
    case Relation::Greater:
      return a > b;
    case Relation::GreaterEqual:
      return a >= b;
    case Relation::Less:
      return a < b;
    case Relation::LessEqual:
      return a <= b;
  }
  return false;
}

bool compare_as(const ContactForm& form, std::uint32_t a, std::uint32_t b) {
  switch (form.type) {
    case Type::Byte:
      return compare(form.relation, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b));
    case Type::Word:
      return compare(form.relation, static_cast<std::int16_t>(a), static_cast<std::int16_t>(b));
    case Type::Double:
      return compare(form.relation, static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
    case Type::Real:
      return compare(form.relation, std::bit_cast<float>(a), std::bit_cast<float>(b));
  }
  return false;
}

/// The characters of a string, after its length byte.
std::string_view string_of(const Cpu& cpu, const Operand& operand) {
  const auto& image = cpu.state().image;
  const std::uint32_t at = cpu.place_of(operand).value_or(operand.at);
  return {reinterpret_cast<const char*>(&image[at + 1]), image[at]};
}

bool is_constant(const Operand& operand) { return !operand.pointer && operand.at >= image::kConstants; }

bool is_always_on(const Op& op) { return op[0].at == image::kSM && op[0].bit == 0; }

}  // namespace

ContactForm contact_form(const Op& op) {
  const Instruction& instruction = *op.instruction;
  const ChainPart& part = instruction.body.part;
  if (part.kind == ChainPart::Kind::Contact) return {.kind = Kind::Bit, .join = part.join, .inverted = part.inverted};
  if (instruction.structure == Structure::Compare) return comparison(instruction.mnemonic);
  const auto on_top = std::ranges::find(kOnTop, instruction.mnemonic, &std::pair<std::string_view, Kind>::first);
  return on_top == kOnTop.end() ? ContactForm{} : ContactForm{.kind = on_top->second};
}

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
      return fed && compare_as(form, *record.value[0], *record.value[1]);
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
  const bool compares = form.kind == Kind::Numbers || form.kind == Kind::Strings;
  return compares && is_constant(op[0]) && is_constant(op[1]) ? "it compares two constants" : "";
}

bool is_always_closed(const Program& program, const Op& op, const ContactForm& form) {
  if (form.kind == Kind::Bit) return !form.inverted;
  const auto constant = [&](const Operand& operand) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < operand.width; ++i)
      value = value << 8 | program.constants[operand.at - image::kConstants + i];
    return value;
  };
  return form.kind == Kind::Numbers && compare_as(form, constant(op[0]), constant(op[1]));
}

}  // namespace s7200::tools
