#include "interpreter/model/contact_form.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <utility>

namespace s7200 {
namespace {

using Kind = ContactForm::Kind;
using Type = ContactForm::Type;

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

}  // namespace

ContactForm contact_form(const Instruction& instruction) {
  const ChainPart& part = instruction.body.part;
  if (part.kind == ChainPart::Kind::Contact) return {.kind = Kind::Bit, .join = part.join, .inverted = part.inverted};
  if (instruction.structure == Structure::Compare) return comparison(instruction.mnemonic);
  const auto on_top = std::ranges::find(kOnTop, instruction.mnemonic, &std::pair<std::string_view, Kind>::first);
  return on_top == kOnTop.end() ? ContactForm{} : ContactForm{.kind = on_top->second};
}

bool compares(const ContactForm& form, std::uint32_t a, std::uint32_t b) {
  switch (form.type) {
    case Type::Byte:
      return holds(form.relation, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b));
    case Type::Word:
      return holds(form.relation, static_cast<std::int16_t>(a), static_cast<std::int16_t>(b));
    case Type::Double:
      return holds(form.relation, static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
    case Type::Real:
      return holds(form.relation, std::bit_cast<float>(a), std::bit_cast<float>(b));
  }
  return false;
}

}  // namespace s7200
