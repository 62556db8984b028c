#include "interpreter/program/german.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <variant>

#include "interpreter/model/instruction.hpp"
#include "interpreter/stl/german_letters.hpp"

namespace s7200 {
namespace {

const stl::Address* address_in(const stl::OperandValue& value) {
  if (const auto* address = std::get_if<stl::Address>(&value)) return address;
  if (const auto* target = std::get_if<stl::AddressOf>(&value)) return &target->target;
  if (const auto* pointer = std::get_if<stl::Indirect>(&value)) return &pointer->pointer;
  return nullptr;
}

/// Areas whose letters differ in the German set.
bool has_german_letters(const stl::Address& address) {
  return std::ranges::find(stl::kGermanLetters, address.area, &stl::GermanLetters::international) !=
         stl::kGermanLetters.end();
}

using Place = std::pair<std::uint32_t, std::uint32_t>;

Place place_of(const stl::Position& position) { return {position.line, position.column}; }

bool is_german_address(const stl::Diagnostic& diagnostic) { return diagnostic.cause == stl::kGermanAddresses; }

/// Whether something in it is written in the international set only.
bool is_international(const stl::Source& source, const std::set<Place>& german) {
  return std::ranges::any_of(source.lines, [&](const stl::Line& line) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement) return false;
    if (statement->mnemonic.starts_with('A') && find_german_instruction("U" + statement->mnemonic.substr(1))) return true;
    return std::ranges::any_of(statement->operands, [&](const stl::Operand& operand) {
      const stl::Address* address = address_in(operand.value);
      return address && has_german_letters(*address) && !german.contains(place_of(operand.position));
    });
  });
}

}  // namespace

void read_german(stl::ParseResult& parsed) {
  std::set<Place> addresses;
  for (const stl::Diagnostic& diagnostic : parsed.diagnostics)
    if (is_german_address(diagnostic)) addresses.insert(place_of(diagnostic.position));
  const auto is_german = [](const stl::Line& line) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    return statement && find_german_instruction(statement->mnemonic);
  };
  if (addresses.empty() && std::ranges::none_of(parsed.source.lines, is_german)) return;
  if (is_international(parsed.source, addresses)) return;
  std::erase_if(parsed.diagnostics, is_german_address);
  for (stl::Line& line : parsed.source.lines)
    if (auto* statement = std::get_if<stl::Statement>(&line))
      if (const Instruction* meant = find_german_instruction(statement->mnemonic)) statement->mnemonic = meant->mnemonic;
}

}  // namespace s7200
