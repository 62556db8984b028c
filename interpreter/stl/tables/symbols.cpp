#include "interpreter/stl/tables/symbols.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/tables/symbol_table.hpp"
#include "interpreter/stl/tables/system_symbols.hpp"
#include "interpreter/stl/text/plain_text.hpp"

namespace s7200::stl {

bool may_be_name(const OperandValue& value, std::string_view written) {
  constexpr std::array<std::string_view, 4> kComplete{"T", "C", "HC", "AC"};
  if (const auto* address = std::get_if<Address>(&value)) {
    const bool german = !upper_case(written).starts_with(address->area) && !upper_case(written).starts_with("DB");
    const bool complete = address->size != Size::None || std::ranges::find(kComplete, address->area) != kComplete.end();
    return !complete || (german && address->size != Size::Bit);
  }
  return std::holds_alternative<Integer>(value) && (written.front() == 'K' || written.front() == 'k');
}

std::optional<BlockNumber> block_number(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, Block::Kind>, 3> kLetters{
      {{"SBR", Block::Kind::Subroutine}, {"INT", Block::Kind::Interrupt}, {"OB", Block::Kind::Main}}};
  for (const auto& [letters, kind] : kLetters) {
    if (upper_case(text.substr(0, letters.size())) != letters) continue;
    const std::string_view digits = text.substr(letters.size());
    std::uint32_t number = 0;
    const auto [end, trouble] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (trouble == std::errc{} && end == digits.data() + digits.size()) return BlockNumber{kind, number};
  }
  return std::nullopt;
}

namespace {

// --- names and what they stand for ---

/// A name as it is written in a statement: `*#next`, `"Pump 1"`, `SBR_0:SBR0`.
struct WrittenName {
  char mark = 0;       // & or *
  bool local = false;  // declared name with #
  std::string_view name, address;

  explicit WrittenName(std::string_view text) {
    if (text.starts_with('&') || text.starts_with('*')) {
      mark = text.front();
      text.remove_prefix(1);
    }
    if (text.starts_with('#')) {
      local = true;
      text.remove_prefix(1);
    }
    if (text.starts_with('"')) {
      const std::size_t end = std::min(text.find('"', 1), text.size());
      name = text.substr(1, end - 1);
      text.remove_prefix(std::min(end + 1, text.size()));
      address = text.starts_with(':') ? text.substr(1) : text;
      return;
    }
    const std::size_t colon = std::min(text.find(':'), text.size());
    name = text.substr(0, colon);
    address = text.substr(std::min(colon + 1, text.size()));
  }
};

/// The address that a name with or without & or * stands for.
OperandValue without_mark(const OperandValue& value) {
  if (const auto* target = std::get_if<AddressOf>(&value)) return target->target;
  if (const auto* pointer = std::get_if<Indirect>(&value)) return pointer->pointer;
  return value;
}

/// Names with what they stand for. One that is written in other capitals is found too, if it can be no other.
template <typename Thing>
class Names {
 public:
  /// The thing that already has this name; null if it is new.
  const Thing* add(const std::string& name, const Thing& thing) {
    const auto [found, added] = exact_.try_emplace(name, &thing);
    if (!added) return found->second;
    const auto [similar, first] = similar_.try_emplace(upper_case(name), &thing);
    if (!first) similar->second = nullptr;
    return nullptr;
  }

  const Thing* find(std::string_view name) const {
    if (const auto found = exact_.find(name); found != exact_.end()) return found->second;
    const auto similar = similar_.find(upper_case(name));
    return similar == similar_.end() ? nullptr : similar->second;
  }

 private:
  std::map<std::string, const Thing*, std::less<>> exact_;
  std::map<std::string, const Thing*, std::less<>> similar_;
};

/// A symbol that the programming software has by itself. Null if there is none.
const Symbol* find_system_symbol(std::string_view name) {
  static const Names<Symbol> kNames = [] {
    Names<Symbol> names;
    for (const Symbol& symbol : system_symbols()) names.add(symbol.name, symbol);
    return names;
  }();
  return kNames.find(name);
}

class Resolver {
 public:
  explicit Resolver(ParseResult& result) : result_(result), source_(result.source) {
    for (const Symbol& symbol : source_.symbols)
      if (const Symbol* first = symbols_.add(symbol.name, symbol); first != nullptr && first->value != symbol.value)
        defined_twice(symbol.name, symbol.position, first->position);
    for (const Block& block : source_.blocks) {
      locals_.emplace_back();
      for (const Variable& variable : block.variables) locals_.back().add(variable.name, variable);
      if (block.name.empty()) continue;
      if (const Block* first = blocks_.add(block.name, block)) defined_twice(block.name, block.position, first->position);
    }
  }

  void run() {
    for (Line& line : source_.lines)
      if (auto* statement = std::get_if<Statement>(&line)) resolve(*statement);
    for (DataLine& line : source_.data)
      if (line.address) resolve(*line.address, nullptr);
  }

 private:
  using Locals = Names<Variable>;

  void defined_twice(const std::string& name, const Position& at, const Position& first) {
    result_.diagnostics.push_back({Severity::Error, at, fmt::format("{} is defined twice", shortened(name)),
                                   fmt::format("it is first defined in {}", line_text(source_, first.line, at.line))});
  }

  void resolve(Statement& statement) {
    const bool calls = statement.mnemonic == "CALL", attaches = statement.mnemonic == "ATCH";
    const Locals* locals = nullptr;
    for (std::size_t i = 0; i < statement.operands.size(); ++i) {
      Operand& operand = statement.operands[i];
      if (i == 0 && (calls || attaches)) take_for_block_name(operand);
      if (i == 0 && (calls || attaches) && std::holds_alternative<Name>(operand.value)) {
        resolve_block(operand, calls ? Block::Kind::Subroutine : Block::Kind::Interrupt);
        continue;
      }
      if (!locals) locals = locals_at(statement.position.line);
      resolve(operand, locals);
    }
  }

  const Locals* locals_at(std::uint32_t line) const {
    const auto next = std::ranges::upper_bound(source_.blocks, line, {}, [](const Block& b) { return b.position.line; });
    if (next == source_.blocks.begin()) return nullptr;
    const auto block = std::prev(next);
    return line <= block->last_line ? &locals_[static_cast<std::size_t>(block - source_.blocks.begin())] : nullptr;
  }

  void resolve(Operand& operand, const Locals* locals) {
    auto* name = std::get_if<Name>(&operand.value);
    if (!name && !operand.symbol.empty()) return compare_with_symbol(operand, locals);
    if (!name) return resolve_short_name(operand, locals);
    const WrittenName written(name->text);
    if (const Variable* variable = locals ? locals->find(written.name) : nullptr) {
      put(operand, variable->address, written.mark);
    } else if (written.local) {
      name->reason = fmt::format("#{} is not declared in its block", shortened(written.name));
    } else if (const Symbol* symbol = symbols_.find(written.name)) {
      if (!symbol->value)
        name->reason = why_without_address(symbol->name);
      else if (std::holds_alternative<Name>(*symbol->value))
        name->reason = fmt::format("{} is a block, not an address", shortened(symbol->name));
      else
        put(operand, *symbol->value, written.mark);
    } else if (const Symbol* of_software = find_system_symbol(written.name)) {
      if (of_software->value)
        put(operand, *of_software->value, written.mark);
      else
        name->reason = fmt::format("{} is a symbol of the S7-200 SMART; the S7-200 has nothing for it", of_software->name);
    }
  }

  std::string written_at(const Position& at) const {
    return at.line == 0 ? "" : plain_characters(characters_at(source_.text[at.line - 1], at.column, at.length));
  }

  void forget_german(const Position& at) {
    std::erase_if(result_.diagnostics, [&](const Diagnostic& d) { return d.cause == kGermanAddresses && d.position == at; });
  }

  /// Takes `S1`, `K1` and `E1` for names if there are variables or symbols of these names.
  void resolve_short_name(Operand& operand, const Locals* locals) {
    if (source_.symbols.empty() && !locals) return;
    const std::string written = written_at(operand.position);
    if (written.empty() || !may_be_name(operand.value, written)) return;
    const Variable* variable = locals ? locals->find(written) : nullptr;
    const Symbol* symbol = variable ? nullptr : symbols_.find(written);
    if (!variable && (!symbol || !symbol->value || std::holds_alternative<Name>(*symbol->value))) return;
    operand.value = Name{written};
    put(operand, variable ? OperandValue{variable->address} : *symbol->value, 0);
    forget_german(operand.position);
  }

  /// Takes the operand of `CALL E1` for a name if there is a block of this name.
  void take_for_block_name(Operand& operand) {
    if (std::holds_alternative<Name>(operand.value) || !operand.symbol.empty() || source_.blocks.empty()) return;
    const std::string written = written_at(operand.position);
    if (written.empty() || !may_be_name(operand.value, written) || !blocks_.find(written)) return;
    operand.value = Name{written};
    forget_german(operand.position);
  }

  /// Compares the address in `Pump:Q0.0` with the one in the table, and with all other places.
  void compare_with_symbol(const Operand& operand, const Locals* locals) {
    const WrittenName written(operand.symbol);
    const std::string here = to_text({without_mark(operand.value), {}});
    const Variable* variable = locals ? locals->find(written.name) : nullptr;
    const Symbol* symbol = written.local || variable ? nullptr : symbols_.find(written.name);
    std::string elsewhere;
    std::uint32_t line = 0;
    if (variable) {
      elsewhere = to_text({variable->address, {}});
      line = variable->position.line;
    } else if (symbol && symbol->value && !std::holds_alternative<Name>(*symbol->value)) {
      elsewhere = to_text({*symbol->value, {}});
      line = symbol->position.line;
    } else if (!written.local) {
      const auto [first, added] = seen_.try_emplace(std::string(written.name), here, operand.position.line);
      std::tie(elsewhere, line) = first->second;
    }
    if (elsewhere.empty() || elsewhere == here) return;
    result_.diagnostics.push_back({Severity::Error, operand.position,
                                   fmt::format("{} is {} here", shortened(written.name), here),
                                   fmt::format("it is {} in {}", elsewhere, line_text(source_, line, operand.position.line)),
                                   fmt::format("{} is not {}", written.name, here)});
  }

  static void put(Operand& operand, const OperandValue& value, char mark) {
    auto& name = std::get<Name>(operand.value);
    const auto* address = std::get_if<Address>(&value);
    if (mark != 0 && !address) {
      name.reason = fmt::format("{} is not an address", shortened(name.text));
      return;
    }
    operand.symbol = std::move(name.text);
    if (mark == '&')
      operand.value = AddressOf{*address};
    else if (mark == '*')
      operand.value = Indirect{*address};
    else
      operand.value = value;
  }

  void resolve_block(Operand& operand, Block::Kind kind) {
    auto& name = std::get<Name>(operand.value);
    const WrittenName written(name.text);
    const Block* block = blocks_.find(written.name);
    std::optional<BlockNumber> number;
    if (block) number = BlockNumber{block->kind, block->number};
    if (!number) number = block_number(written.address);
    if (!number) number = block_number(written.name);
    if (const Symbol* symbol = number ? nullptr : symbols_.find(written.name))
      if (const auto* of_block = symbol->value ? std::get_if<Name>(&*symbol->value) : nullptr)
        number = block_number(of_block->text);
    if (!number && source_.blocks.empty())  // blocks have names of their own
      if (const auto routine = default_routine(written.name)) number = BlockNumber{routine->kind, routine->number};
    if (!number) {
      name.reason = fmt::format("there is no {} {}", kind == Block::Kind::Subroutine ? "subroutine" : "interrupt routine",
                                shortened(written.name));
    } else if (number->kind != kind) {
      name.reason = fmt::format("{} is not {}", shortened(written.name),
                                kind == Block::Kind::Subroutine ? "a subroutine" : "an interrupt routine");
    } else {
      operand.symbol = std::move(name.text);
      operand.value = Integer{number->number};
    }
  }

  ParseResult& result_;
  Source& source_;
  Names<Symbol> symbols_;
  Names<Block> blocks_;
  std::map<std::string, std::pair<std::string, std::uint32_t>> seen_;  // names with addresses beside them, without a table
  std::vector<Locals> locals_;                                         // of each block
};

}  // namespace

const Symbol* find_symbol(const std::vector<Symbol>& symbols, std::string_view name) {
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  Names<Symbol> names;
  for (const Symbol& symbol : symbols) names.add(symbol.name, symbol);
  const Symbol* found = names.find(name);
  return found ? found : find_system_symbol(name);
}

std::vector<Symbol> names_beside_addresses(const Source& source) {
  Names<Symbol> known;
  for (const Symbol& symbol : source.symbols) known.add(symbol.name, symbol);
  std::set<std::string, std::less<>> seen;
  std::vector<Symbol> found;
  for (const Line& line : source.lines) {
    const auto* statement = std::get_if<Statement>(&line);
    if (!statement) continue;
    const bool names_routine = statement->mnemonic == "CALL" || statement->mnemonic == "ATCH";
    for (std::size_t i = names_routine ? 1 : 0; i < statement->operands.size(); ++i) {
      const Operand& operand = statement->operands[i];
      const WrittenName written(operand.symbol);
      const OperandValue value = without_mark(operand.value);
      const auto* address = std::get_if<Address>(&value);
      const bool local = written.local || (address && address->area == "L");
      if (written.name.empty() || local || known.find(written.name) || find_system_symbol(written.name)) continue;
      if (seen.emplace(written.name).second) found.push_back({std::string(written.name), value, operand.position, {}});
    }
  }
  return found;
}

std::string symbol_of_smart(const Source& source) {
  const auto defines = [&](std::string_view name) {
    const auto has_name = [&](const auto& thing) { return upper_case(thing.name) == upper_case(name); };
    return std::ranges::any_of(source.symbols, has_name) || std::ranges::any_of(source.blocks, [&](const Block& block) {
             return std::ranges::any_of(block.variables, has_name);
           });
  };
  for (const Line& line : source.lines) {
    const auto* statement = std::get_if<Statement>(&line);
    if (!statement) continue;
    for (const Operand& operand : statement->operands) {
      const auto* unresolved = std::get_if<Name>(&operand.value);
      const WrittenName written(unresolved ? unresolved->text : operand.symbol);
      if (!written.name.empty() && is_only_of_smart(written.name) && !defines(written.name))
        return std::string(written.name);
    }
  }
  return {};
}

void resolve_symbols(ParseResult& result) { Resolver(result).run(); }

}  // namespace s7200::stl
