#include "interpreter/program/loading/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "interpreter/base/text/among.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/checking/routine_ends.hpp"
#include "interpreter/program/loading/german.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/tables/symbols.hpp"

namespace s7200 {
namespace {

constexpr std::array<std::pair<std::string_view, Notation>, 4> kNotations{{{"iec", Notation::Iec},
                                                                           {"microdos", Notation::MicroDos},
                                                                           {"microwin", Notation::MicroWin},
                                                                           {"german", Notation::German}}};

// --- names ---

/// Quotes for what a listing would take for something else: `K1` is a constant, `E1` an address.
std::string quoted_if_needed(const std::string& name) {
  const auto read = stl::parse_operand(name);
  const auto* plain = read ? std::get_if<stl::Name>(&read->value) : nullptr;
  const bool word = std::ranges::all_of(name, [](char c) { return stl::is_letter(c) || stl::is_digit(c) || c == '_'; });
  return plain && word ? name : fmt::format("\"{}\"", name);
}

/// A name with the & or * before it; `#local` has no quotes.
std::string quoted_symbol(const std::string& symbol) {
  const std::size_t begin = std::min(symbol.find_first_not_of("&*"), symbol.size());
  const std::string name = symbol.substr(begin);
  const bool as_it_is = name.starts_with('#') || name.starts_with('"');
  return symbol.substr(0, begin) + (as_it_is ? name : quoted_if_needed(name));
}

// --- one statement ---

/// Names stay among blocks, which declare their local variables and have a symbol table; in a listing they become addresses.
/// Routines are named by name_blocks().
void keep_or_leave_out_symbols(stl::Statement& statement, Notation notation) {
  const bool names_routine = is_among(statement.mnemonic, {"CALL", "ATCH"});
  for (std::size_t i = 0; i < statement.operands.size(); ++i) {
    stl::Operand& operand = statement.operands[i];
    const std::string symbol = std::exchange(operand.symbol, {});
    if (notation != Notation::MicroWin || symbol.empty() || (names_routine && i == 0)) continue;
    operand.value = stl::Name{quoted_symbol(symbol)};
  }
}

/// Texts that have no notation of their own in the AST are printed as names.
void put_text(stl::Operand& operand, std::string text) { operand.value = stl::Name{std::move(text)}; }

void to_micro_dos(stl::Statement& statement) {
  if (is_among(statement.mnemonic, {"LBL", "JMP", "SBR", "INT", "CALL"})) return;
  for (stl::Operand& operand : statement.operands) {
    const auto* constant = std::get_if<stl::Integer>(&operand.value);
    if (!constant) continue;
    const bool decimal = constant->form == stl::Integer::Form::Decimal;
    put_text(operand, decimal ? fmt::format("K{}", constant->value) : fmt::format("KH{:X}", constant->value));
  }
}

// --- blocks ---

/// The lines of a routine without its head and its end.
struct Routine {
  stl::Block block;
  std::vector<stl::Line> lines;
};

/// The main program of an export has its name and title as a comment; blocks have them in their heads.
bool is_head_of_main(const stl::Line& line, const stl::Source& source) {
  const auto* comment = std::get_if<stl::CommentLine>(&line);
  return comment && std::ranges::any_of(source.blocks, [&](const stl::Block& block) {
           return block.kind == stl::Block::Kind::Main && block.position.line == comment->line;
         });
}

/// Where one routine ends, the next one begins, with the comments and the network above its head.
std::vector<Routine> routines_of(const stl::Source& source) {
  std::vector<Routine> routines;
  Routine routine{{.kind = stl::Block::Kind::Main, .number = 1}, {}};
  const auto finish = [&] {
    const auto known = std::ranges::find_if(source.blocks, [&](const stl::Block& b) {
      return b.kind == routine.block.kind && b.number == routine.block.number;
    });
    if (known != source.blocks.end()) routine.block = *known;
    if (routine.block.name.empty()) {
      const stl::BlockWords& of_kind = stl::words(routine.block.kind);
      routine.block.name = routine.block.kind == stl::Block::Kind::Main
                               ? std::string(of_kind.name)
                               : fmt::format("{}{}", of_kind.name, routine.block.number);
    }
    routines.push_back(std::exchange(routine, {}));
  };
  for (const stl::Line& line : source.lines) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (statement && is_among(statement->mnemonic, {"SBR", "INT"}) && statement->operands.size() == 1) {
      const auto* number = std::get_if<stl::Integer>(&statement->operands[0].value);
      routine.block.title = stl::trim(statement->comment);
      routine.block.kind = statement->mnemonic == "SBR" ? stl::Block::Kind::Subroutine : stl::Block::Kind::Interrupt;
      routine.block.number = number ? static_cast<std::uint32_t>(number->value) : 0;
    } else if (statement && is_among(statement->mnemonic, {"MEND", "RET", "RETI"})) {
      if (!statement->comment.empty())
        routine.lines.emplace_back(stl::CommentLine{statement->comment, statement->position.line});
      finish();
    } else if (!is_head_of_main(line, source)) {
      routine.lines.push_back(line);
    }
  }
  const auto is_code = [](const stl::Line& line) { return std::holds_alternative<stl::Statement>(line); };
  if (std::ranges::any_of(routine.lines, is_code)) finish();
  return routines;
}

std::string declarations_text(const std::vector<stl::Variable>& variables) {
  std::string text;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const stl::Variable& variable = variables[i];
    if (i == 0 || variables[i - 1].kind != variable.kind) text += fmt::format("{}\n", stl::word(variable.kind));
    text += fmt::format(" {} : {};{}\n", quoted_if_needed(variable.name), stl::word(variable.type).name,
                        variable.comment.empty() ? "" : "  // " + variable.comment);
    if (i + 1 == variables.size() || variables[i + 1].kind != variable.kind) text += "END_VAR\n";
  }
  return text;
}

std::string hex_text(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) text += fmt::format("{}16#{:X}", text.empty() ? "" : ", ", static_cast<unsigned char>(byte));
  return text;
}

std::string data_text(const std::vector<stl::DataLine>& data) {
  if (data.empty()) return {};
  std::string text = "DATA_BLOCK DB1:DB1\nBEGIN\n";
  for (const stl::DataLine& line : data) {
    const std::string comment = line.comment.empty() ? "" : "//" + line.comment;
    if (line.only_comment()) {
      text += comment + "\n";
      continue;
    }
    std::string values;
    for (const stl::DataLine::Value& value : line.values) {
      if (!values.empty()) values += ", ";
      if (const auto* characters = std::get_if<stl::Text>(&value.value))
        values += hex_text(characters->bytes);
      else if (const auto* real = std::get_if<stl::Real>(&value.value))
        values += stl::to_text(*real);
      else
        values += stl::to_text(stl::Operand{std::get<stl::Integer>(value.value), {}});
    }
    text += fmt::format("{} {}{}{}\n", line.address ? stl::to_text(*line.address) : "", values, comment.empty() ? "" : "  ",
                        comment);
  }
  return text + "END_DATA_BLOCK\n";
}

/// CALL and ATCH name the block that they mean.
void name_blocks(stl::Statement& statement, const std::vector<Routine>& routines) {
  if (!is_among(statement.mnemonic, {"CALL", "ATCH"}) || statement.operands.empty()) return;
  const auto kind = statement.mnemonic == "CALL" ? stl::Block::Kind::Subroutine : stl::Block::Kind::Interrupt;
  const auto* number = std::get_if<stl::Integer>(&statement.operands[0].value);
  const auto called = std::ranges::find_if(routines, [&](const Routine& r) {
    return number && r.block.kind == kind && std::int64_t{r.block.number} == number->value;
  });
  if (called != routines.end()) put_text(statement.operands[0], quoted_if_needed(called->block.name));
}

std::string blocks_text(const stl::Source& source) {
  const std::vector<Routine> routines = routines_of(source);
  std::string text;
  for (const Routine& routine : routines) {
    const stl::BlockWords& of_kind = stl::words(routine.block.kind);
    text += fmt::format("{} {}:{}{}\nTITLE={}\n", of_kind.keyword, quoted_if_needed(routine.block.name), of_kind.letters,
                        routine.block.number, routine.block.title);
    const auto first = std::ranges::find_if_not(
        routine.lines, [](const stl::Line& line) { return std::holds_alternative<stl::CommentLine>(line); });
    stl::Source comment, part;
    comment.lines.assign(routine.lines.begin(), first);
    part.lines.assign(first, routine.lines.end());
    const auto is_network = [](const stl::Line& line) { return std::holds_alternative<stl::NetworkHead>(line); };
    const auto code = std::ranges::find_if(
        part.lines, [&](const stl::Line& line) { return is_network(line) || std::holds_alternative<stl::Statement>(line); });
    const bool any_network = std::ranges::any_of(part.lines, is_network);
    if (code == part.lines.end() ? !any_network : !is_network(*code))
      part.lines.insert(part.lines.begin(), stl::NetworkHead{any_network ? 0U : 1U, {}, {}});
    text += stl::to_text(comment) + declarations_text(routine.block.variables) + "BEGIN\n";
    for (stl::Line& line : part.lines)
      if (auto* statement = std::get_if<stl::Statement>(&line)) name_blocks(*statement, routines);
    text += stl::to_text(part) + fmt::format("END_{}\n", of_kind.keyword);
  }
  return text + data_text(source.data);
}

// --- whether it can be printed ---

class Printable {
 public:
  Printable(stl::ParseResult& parsed, Notation notation)
      : parsed_(parsed), notation_(notation), blocks_(notation == Notation::MicroWin) {}

  bool check() {
    const stl::Statement* before = nullptr;
    for (const stl::Line& line : parsed_.source.lines) {
      const auto* statement = std::get_if<stl::Statement>(&line);
      if (!statement) continue;
      check(*statement);
      if (blocks_ && before && is_among(before->mnemonic, {"SBR", "INT"})) check_first(*statement);
      before = statement;
    }
    return !has_errors(parsed_.diagnostics);
  }

 private:
  void error(const stl::Position& at, std::string message, std::string hint, std::string cause = {}) {
    parsed_.diagnostics.push_back({stl::Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
  }

  /// The name of a routine of Micro/WIN's libraries that a CALL means and the program itself does not have.
  static const stl::Name* library_routine(const stl::Statement& statement) {
    const bool calls = statement.mnemonic == "CALL" && !statement.operands.empty();
    const auto* const name = calls ? std::get_if<stl::Name>(&statement.operands[0].value) : nullptr;
    return name && (has_stand_in(statement) || is_library_routine(name->text)) ? name : nullptr;
  }

  void refuse_library(const stl::Operand& routine, const stl::Name& name) {
    error(routine.position,
          fmt::format("{} is a routine of a library: {} has no CALL with a name and parameters", stl::shortened(name.text),
                      name_of(notation_)),
          "use --to microwin: Micro/WIN has the library", "routines of libraries");
  }

  /// A routine begins with 1 on the logic stack, and a network of Micro/WIN with none.
  void check_first(const stl::Statement& statement) {
    const Instruction* const instruction = find_instruction(statement.mnemonic);
    if (!instruction || instruction->rung.stack.needs == 0) return;
    error(statement.position,
          fmt::format("{} stands first in its routine: a network of Micro/WIN begins with a contact", statement.mnemonic),
          "write LD SM0.0 in front of it");
  }

  /// Micro/WIN knows the routines of its libraries by their names.
  void check(const stl::Statement& statement) {
    const stl::Name* const library = library_routine(statement);
    if (library && !blocks_) return refuse_library(statement.operands[0], *library);
    const std::size_t known = library ? 1 : 0;
    const Instruction* const instruction = find_instruction(statement.mnemonic);
    for (std::size_t i = known; i < statement.operands.size(); ++i) {
      const auto* name = std::get_if<stl::Name>(&statement.operands[i].value);
      const bool may_be_text = instruction && i < instruction->rules().size() && instruction->operand[i].text;
      if (name && !(may_be_text && name->text.starts_with('"'))) check(statement.operands[i], *name);
    }
    if (!blocks_ && statement.mnemonic == "CALL" && statement.operands.size() > 1)
      error(statement.operands[1].position, "parameters of CALL have no notation outside of blocks", "use --to microwin");
  }

  void check(const stl::Operand& operand, const stl::Name& name) {
    const std::string upper = stl::upper_case(name.text);
    if (is_among(upper, {"TRUE", "FALSE", "ON", "OFF"})) return;
    error(operand.position,
          name.reason.empty() ? fmt::format("'{}' is neither an address nor a defined symbol", stl::shortened(name.text))
                              : name.reason,
          parsed_.source.symbols.empty()
              ? "give its symbol table too, beside the program, or write the address itself"
              : "the symbol table that was given does not have it: add it there, or write the address itself");
  }

  stl::ParseResult& parsed_;
  Notation notation_;
  bool blocks_;
};

}  // namespace

std::optional<Notation> notation_named(std::string_view name) {
  const auto found = std::ranges::find(kNotations, name, &std::pair<std::string_view, Notation>::first);
  if (found == kNotations.end()) return {};
  return found->second;
}

std::string notation_names() {
  std::string names;
  for (std::size_t i = 0; i < kNotations.size(); ++i)
    names += fmt::format("{}{}", i == 0 ? "" : i + 1 == kNotations.size() ? " and " : ", ", kNotations[i].first);
  return names;
}

std::string_view name_of(Notation notation) { return kNotations[static_cast<std::size_t>(notation)].first; }

std::optional<std::string> convert(stl::ParseResult& parsed, Notation notation) {
  read_german(parsed);
  stl::resolve_symbols(parsed);
  if (!Printable(parsed, notation).check()) return {};
  stl::Source source = parsed.source;
  for (stl::Line& line : source.lines)
    if (auto* statement = std::get_if<stl::Statement>(&line)) keep_or_leave_out_symbols(*statement, notation);
  for (stl::DataLine& line : source.data)
    if (line.address) line.address->symbol.clear();
  if (notation == Notation::MicroWin) {
    add_missing_ends(source);
    return blocks_text(source);
  }
  for (stl::Line& line : source.lines) {
    auto* statement = std::get_if<stl::Statement>(&line);
    if (statement && notation == Notation::MicroDos) to_micro_dos(*statement);
    if (statement && notation == Notation::German) to_german(*statement);
  }
  return stl::to_text(source);
}

std::string imported_text(stl::Source source) {
  const auto is_parameter = [](const stl::Variable& variable) { return variable.kind != stl::Variable::Kind::Temporary; };
  const auto hands_over = [&](const stl::Block& block) { return std::ranges::any_of(block.variables, is_parameter); };
  if (std::ranges::none_of(source.blocks, hands_over)) return stl::to_text(source);
  add_missing_ends(source);
  return blocks_text(source);
}

std::string symbol_table_text(const stl::Source& source) {
  std::vector<stl::Symbol> symbols = source.symbols;
  std::ranges::copy(stl::names_beside_addresses(source), std::back_inserter(symbols));
  std::string text;
  for (const stl::Symbol& symbol : symbols)
    if (symbol.value)
      text += fmt::format("{}\t{}\t{}\n", symbol.name, stl::to_text(stl::Operand{*symbol.value, {}}), symbol.comment);
  return text.empty() ? text : "Symbol\tAddress\tComment\n" + text;
}

}  // namespace s7200
