#include "interpreter/program/loading/german.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "interpreter/model/instruction.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/text/german_letters.hpp"

namespace s7200 {
namespace {

stl::Address* address_in(stl::OperandValue& value) {
  if (auto* address = std::get_if<stl::Address>(&value)) return address;
  if (auto* target = std::get_if<stl::AddressOf>(&value)) return &target->target;
  if (auto* pointer = std::get_if<stl::Indirect>(&value)) return &pointer->pointer;
  return nullptr;
}

/// The letters of an area; nothing for one with the same letters in both sets.
const stl::GermanLetters* letters_of(const stl::Address& address) {
  const auto found = std::ranges::find(stl::kGermanLetters, address.area, &stl::GermanLetters::international);
  return found == stl::kGermanLetters.end() ? nullptr : &*found;
}

void put_german_letters(stl::Operand& operand) {
  stl::Address* const address = address_in(operand.value);
  if (const stl::GermanLetters* letters = address ? letters_of(*address) : nullptr) address->area = letters->german;
}

void to_international(std::string& mnemonic) {
  if (const Instruction* meant = find_german_instruction(mnemonic)) mnemonic = meant->mnemonic;
}

using Place = std::pair<std::uint32_t, std::uint32_t>;

Place place_of(const stl::Position& position) { return {position.line, position.column}; }

bool is_german_address(const stl::Diagnostic& diagnostic) { return diagnostic.cause == stl::kGermanAddresses; }

/// The words of a line that are of one set only.
struct Words {
  std::vector<std::string> texts{};
  stl::Position first{};

  void add(std::string text, const stl::Position& position) {
    if (texts.empty()) first = position;
    texts.push_back(std::move(text));
  }
};

struct WordsOfSets {
  Words german{}, international{};
};

/// German addresses are read like the international ones: where they stand, the parser has reported.
WordsOfSets words_of(const stl::Statement& statement, const std::set<Place>& german_addresses) {
  WordsOfSets words;
  if (find_german_instruction(statement.mnemonic)) words.german.add(statement.mnemonic, statement.position);
  if (!german_mnemonic(statement.mnemonic).empty()) words.international.add(statement.mnemonic, statement.position);
  for (stl::Operand operand : statement.operands) {
    const stl::Address* const address = address_in(operand.value);
    if (!address || !letters_of(*address)) continue;
    const bool german = german_addresses.contains(place_of(operand.position));
    if (german) put_german_letters(operand);
    (german ? words.german : words.international).add(stl::to_text(operand), operand.position);
  }
  return words;
}

/// The set that a listing is in.
enum class Set : std::uint8_t { International, German, Unclear };

/// Lines with words of one set only show it; a few of the other set are mistakes.
Set set_of(std::size_t german_lines, std::size_t international_lines) {
  constexpr std::size_t kClear = 2;  // so many times as many lines
  if (german_lines == 0) return Set::International;
  if (german_lines >= kClear * international_lines) return Set::German;
  return international_lines >= kClear * german_lines ? Set::International : Set::Unclear;
}

/// `AN I0.3` without the columns of a listing.
std::string plain_text(const stl::Statement& statement) {
  std::vector<std::string> operands;
  for (const stl::Operand& operand : statement.operands) operands.push_back(stl::to_text(operand));
  return fmt::format("{}{}{}", statement.mnemonic, operands.empty() ? "" : " ", fmt::join(operands, ", "));
}

/// The message about the words in a line that are not of the listing's set: how the line reads in that.
stl::Diagnostic stranger(const Words& words, stl::Statement statement, Set set) {
  const bool german = set == Set::German;
  if (german)
    to_german(statement);
  else
    to_international(statement.mnemonic);
  return {.severity = stl::Severity::Error,
          .position = words.first,
          .message = fmt::format("{} {} {}, but the listing is in the {} set", fmt::join(words.texts, " and "),
                                 words.texts.size() == 1 ? "is" : "are", german ? "international" : "German",
                                 german ? "German" : "international"),
          .hint = "write " + plain_text(statement),
          .cause = "mnemonics of the other set"};
}

}  // namespace

std::string german_mnemonic(std::string_view mnemonic) {
  if (!mnemonic.starts_with('A')) return {};
  std::string german = fmt::format("U{}", mnemonic.substr(1));
  return find_german_instruction(german) ? german : "";
}

void to_german(stl::Statement& statement) {
  for (stl::Operand& operand : statement.operands) put_german_letters(operand);
  if (std::string german = german_mnemonic(statement.mnemonic); !german.empty()) statement.mnemonic = std::move(german);
}

void read_german(stl::ParseResult& parsed) {
  std::set<Place> addresses;
  for (const stl::Diagnostic& diagnostic : parsed.diagnostics)
    if (is_german_address(diagnostic)) addresses.insert(place_of(diagnostic.position));
  std::vector<std::pair<stl::Statement*, WordsOfSets>> statements;
  std::size_t german_lines = 0, international_lines = 0;
  for (stl::Line& line : parsed.source.lines) {
    auto* const statement = std::get_if<stl::Statement>(&line);
    if (!statement) continue;
    WordsOfSets words = words_of(*statement, addresses);
    german_lines += words.german.texts.empty() ? 0U : 1U;
    international_lines += words.international.texts.empty() ? 0U : 1U;
    statements.emplace_back(statement, std::move(words));
  }
  const Set set = set_of(german_lines, international_lines);
  stl::Diagnostics strangers;
  if (german_lines == 0 || set == Set::Unclear) return;
  std::set<std::uint32_t> german;
  for (auto& [statement, words] : statements) {
    if (!words.german.texts.empty()) german.insert(statement->position.line);
    const Words& other = set == Set::German ? words.international : words.german;
    if (!other.texts.empty()) strangers.push_back(stranger(other, *statement, set));
    to_international(statement->mnemonic);
  }
  std::erase_if(parsed.diagnostics, [&](const stl::Diagnostic& diagnostic) {
    return is_german_address(diagnostic) && (set == Set::German || german.contains(diagnostic.position.line));
  });
  std::ranges::move(strangers, std::back_inserter(parsed.diagnostics));
}

}  // namespace s7200
