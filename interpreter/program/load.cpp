#include "interpreter/program/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/smart.hpp"
#include "interpreter/program/loading/cpu_choice.hpp"
#include "interpreter/program/loading/dialect.hpp"
#include "interpreter/program/loading/german.hpp"
#include "interpreter/program/loading/table_in_program.hpp"
#include "interpreter/stl/blocks.hpp"
#include "interpreter/stl/document.hpp"
#include "interpreter/stl/drawings/drawings.hpp"
#include "interpreter/stl/tables/data_block.hpp"
#include "interpreter/stl/tables/project.hpp"
#include "interpreter/stl/tables/symbol_table.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "interpreter/stl/text/encoding.hpp"
#include "interpreter/stl/text/plain_line.hpp"
#include "interpreter/stl/text/plain_text.hpp"
#include "interpreter/stl/text/string_literals.hpp"

namespace s7200 {
namespace {

const stl::InstructionSet& instruction_set() {
  static const stl::InstructionSet kInstructions{
      [](std::string_view mnemonic, std::size_t operands) {
        const Instruction* instruction = find_instruction(mnemonic);
        return instruction && (instruction->rules().size() == operands || !instruction->modelled());
      },
      [](std::string_view mnemonic) {
        auto [what, hint] = unknown_mnemonic(mnemonic);
        return stl::Advice{std::move(what), std::move(hint)};
      }};
  return kInstructions;
}

/// Whether it is an instruction of the international set or of the German one: `U` for `A`.
bool is_instruction_of_either_set(std::string_view mnemonic, std::size_t operands) {
  if (instruction_set().has(mnemonic, operands)) return true;
  if (!mnemonic.starts_with('U')) return false;
  const std::string international = "A" + std::string(mnemonic.substr(1));
  return german_mnemonic(international) == mnemonic && instruction_set().has(international, operands);
}

/// Whether a line that is neither empty nor a comment may be meant as a statement: `LD I0.0`, `FROB`, `U E0.0`.
bool looks_like_a_statement(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\f", kSeparators = " \t\f,;";
  constexpr std::size_t kLongestMnemonic = 8;
  const auto is_part_of_mnemonic = [](char c) {
    return stl::is_letter(c) || std::string_view("_+-*/<>=").find(c) != std::string_view::npos;
  };
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  const std::string mnemonic = stl::upper_case(word);
  if (mnemonic == "NETWORK" || mnemonic.ends_with("_BLOCK")) return true;  // part of an export, which has its own message
  if (word.size() > kLongestMnemonic || !std::all_of(word.begin(), word.end(), is_part_of_mnemonic)) return false;
  bool any_operand = false, solid = true;  // solid: with a number in it
  for (std::string_view rest = line.substr(word.size(), line.find("//") - word.size());;) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kSeparators), rest.size()));
    if (rest.empty()) break;
    const std::string_view operand = rest.substr(0, rest.find_first_of(kSeparators));
    any_operand = true;
    solid &= std::any_of(operand.begin(), operand.end(), stl::is_digit);
    rest.remove_prefix(operand.size());
  }
  const bool known = find_instruction(mnemonic) != nullptr, capitals = word == mnemonic;
  if (capitals) return solid || (known && word.size() > 1);  // but not `A word`
  return known && solid && any_operand;
}

/// Whether the first lines of code are all statements of the S7-200. Such a text is neither a table nor a program in another
/// dialect, whose signs take longer to look for.
bool begins_with_statements(std::string_view text) {
  constexpr std::size_t kLinesOfCode = 100;
  std::size_t code = 0;
  while (!text.empty() && code < kLinesOfCode) {
    const auto [word, others] = stl::plain::first_word_of_code(stl::take_line(text));
    if (word.empty()) continue;
    ++code;
    if (word != "NETWORK" && !instruction_set().has(word, others)) return false;
  }
  return code > 0;
}

/// Whether a text can be STL with mistakes in it. If none of its first lines can, it is some other file: messages about its
/// lines would not help and might reveal secrets, as with `program: /etc/passwd` in a scenario.
bool can_be_stl(const std::vector<std::string>& text) {
  constexpr std::size_t kLinesOfCode = 20;
  std::size_t code = 0;
  for (const std::string& each : text) {
    std::string_view line = each;
    line.remove_prefix(std::min(line.find_first_not_of(" \t\f"), line.size()));
    if (line.empty() || line.starts_with("//")) continue;
    if (looks_like_a_statement(line)) return true;
    if (++code == kLinesOfCode) return false;
  }
  return code == 0;
}

bool is_mnemonic(std::string_view word) { return word == "NETWORK" || find_instruction(word) || mnemonic_of_others(word); }

std::optional<SourceKind> kind_of_table(std::string_view text) {
  if (stl::is_status_chart(text)) return SourceKind::StatusChart;
  if (stl::is_data_block(text, is_mnemonic)) return SourceKind::DataBlock;
  if (stl::is_symbol_table(text, is_mnemonic)) return SourceKind::SymbolTable;
  return std::nullopt;
}

stl::ParseResult read_as(SourceKind kind, std::string_view text, const std::string& name) {
  switch (kind) {
    case SourceKind::Document:
      return stl::has_routine_headings(text) ? stl::read_headed_document(text, name)
                                             : stl::read_document(text, name, instruction_set());
    case SourceKind::Blocks:
      return stl::read_blocks(text, name, instruction_set().has);
    case SourceKind::SymbolTable:
      return stl::read_symbol_table(text, name);
    case SourceKind::DataBlock:
      return stl::read_data_block(text, name);
    case SourceKind::StatusChart: {
      stl::ParseResult chart;
      chart.source.name = name;
      chart.notes.push_back(fmt::format("{} is a status chart: nothing of it is part of the program", name));
      return chart;
    }
    case SourceKind::Listing:
      break;
  }
  return stl::parse(text, name);
}

/// A text in another dialect, of which nothing else is said.
stl::ParseResult foreign(stl::Diagnostic dialect, std::string_view text, const std::string& name) {
  stl::ParseResult result;
  result.source.name = name;
  result.source.text = stl::split_lines(text);
  result.diagnostics.push_back(std::move(dialect));
  return result;
}

/// The place where the code of the first line begins, if that only names the CPU: it is no statement, but a comment without
/// its //.
std::optional<std::size_t> place_of_cpu_line(std::string_view text) {
  constexpr std::size_t kLongest = 100;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view code = stl::trim(stl::take_line(rest));
    if (code.empty() || code.starts_with("//")) continue;
    if (code.size() > kLongest || !is_cpu_line(code)) return std::nullopt;
    return static_cast<std::size_t>(code.data() - text.data());
  }
  return std::nullopt;
}

/// Returns nothing if the text is neither STL nor anything else that is read.
std::optional<SourceText> read_plain(std::string_view text, const std::string& name, bool force_document) {
  const bool statements = begins_with_statements(text);
  if (auto dialect = statements ? std::nullopt : other_dialect(text))
    return SourceText{foreign(*std::move(dialect), text, name), {}, SourceKind::Listing};
  const std::optional<SourceKind> kind = stl::is_block_export(text)                          ? SourceKind::Blocks
                                         : force_document || stl::has_routine_headings(text) ? SourceKind::Document
                                         : statements                                        ? std::nullopt
                                                                                             : kind_of_table(text);
  if (kind) return SourceText{read_as(*kind, text, name), {}, *kind};
  auto listing = stl::read_listing(text, name, instruction_set());
  if (!listing) return SourceText{read_as(SourceKind::Document, text, name), {}, SourceKind::Document};
  if (!can_be_stl(listing->source.text)) return std::nullopt;
  return SourceText{std::move(*listing), {}, SourceKind::Listing};
}

/// The length of the mnemonic in a line without the blank after it, `LDI0.0`; 0 if it is something else.
std::size_t mnemonic_without_blank(std::string_view code) {
  for (std::size_t length = std::min<std::size_t>(code.size(), 6); length > 0; --length) {
    const auto operand =
        find_instruction(stl::upper_case(code.substr(0, length))) ? stl::parse_operand(code.substr(length)) : std::nullopt;
    const auto* const address = operand ? std::get_if<stl::Address>(&operand->value) : nullptr;
    if (address && address->size != stl::Size::None) return length;
  }
  return 0;
}

/// The message about a text that has no statement in its first lines.
std::string why_not_stl(std::string_view text) {
  if (const std::string_view product = why_other_product(text); !product.empty()) return std::string(product);
  std::uint32_t number = 0;
  while (!text.empty()) {
    const std::string_view line = stl::take_line(text), code = stl::trim(line);
    ++number;
    if (stl::has_drawing(line)) return fmt::format("{}: {}", stl::kIsDrawing, stl::kForDrawing);
    if (const std::size_t length = mnemonic_without_blank(code))
      return fmt::format("line {}: a blank is missing between {} and its operand", number, code.substr(0, length));
  }
  return "it is not an STL program: there is no instruction in its first lines; a symbol table has rows such as Motor = "
         "Q0.0";
}

/// Whether a line is one of a patch: `-LD I0.0`, `+= Q0.0`, but not `+I VW0, VW2`.
bool is_changed_line(std::string_view line) {
  if (!line.starts_with('+') && !line.starts_with('-')) return false;
  const std::string mnemonic = stl::upper_case(line.substr(1, std::min<std::size_t>(line.find_first_of(" \t", 1), 12) - 1));
  const bool own = find_instruction(line.front() + mnemonic) != nullptr;
  return !own && (mnemonic == "NETWORK" || find_instruction(mnemonic) != nullptr);
}

/// What stands around a program so that it cannot be read, and what to do; empty if nothing does.
std::string_view why_wrapped(std::string_view text) {
  constexpr std::string_view kPatch =
      "it is a patch (unified diff), not a program: apply it with patch, and give the program that comes out";
  bool minus = false, plus = false, hunk = false, mail = false;
  std::size_t changed = 0;
  while (!text.empty()) {
    const std::string_view line = stl::take_line(text);
    minus |= line.starts_with("--- ");
    plus |= line.starts_with("+++ ");
    hunk |= line.starts_with("@@ -");
    changed += is_changed_line(line) ? 1U : 0U;
    if ((hunk && ((minus && plus) || changed > 0)) || changed > 1) return kPatch;
    const std::string lower =
        (line.starts_with('C') || line.starts_with('c')) && line.size() < 80 ? stl::lower_case(line) : "";
    mail |= lower.starts_with("content-transfer-encoding: quoted-printable");
    if (lower.starts_with("content-transfer-encoding: base64") || mail || line.starts_with("=3D"))
      return "it is a mail as it was sent, in quoted-printable or base64: open it in a mail program, and save its text";
  }
  return {};
}

bool is_code(const stl::Line& line) {
  return std::holds_alternative<stl::Statement>(line) || std::holds_alternative<stl::NetworkHead>(line);
}

/// Whether a text has only comments, or headings of a table.
bool is_empty(const stl::ParseResult& parsed) {
  const stl::Source& source = parsed.source;
  return std::ranges::none_of(source.lines, is_code) && std::ranges::all_of(source.data, &stl::DataLine::only_comment) &&
         source.blocks.empty() && source.symbols.empty() && parsed.diagnostics.empty();
}

/// Adds the symbols of a table that stands in the text of a program. Returns how many they are.
std::size_t add_symbols(std::string_view table, stl::ParseResult& program) {
  stl::ParseResult read = stl::read_symbol_table(table, program.source.name);
  const std::size_t symbols = read.source.symbols.size();
  std::ranges::move(read.source.symbols, std::back_inserter(program.source.symbols));
  std::ranges::move(read.diagnostics, std::back_inserter(program.diagnostics));
  return symbols;
}

}  // namespace

bool SourceText::is_program() const {
  if (kind == SourceKind::Document) return true;
  if (kind == SourceKind::Listing)  // not if it is all comments, as the data block of a new project is
    return std::ranges::any_of(parsed.source.lines, is_code) || !parsed.diagnostics.empty();
  const auto& blocks = parsed.source.blocks;
  return kind == SourceKind::Blocks && std::ranges::find(blocks, stl::Block::Kind::Main, &stl::Block::kind) != blocks.end();
}

SourceText join_files(std::vector<SourceText> files) {
  const auto program = std::ranges::find_if(files, &SourceText::is_program);
  if (program != files.end()) std::rotate(files.begin(), program, std::next(program));
  SourceText project = std::move(files.front());
  for (auto file = std::next(files.begin()); file != files.end(); ++file) {
    if (file->kind == SourceKind::StatusChart) {
      std::ranges::move(file->parsed.notes, std::back_inserter(project.parsed.notes));
      continue;
    }
    if (is_empty(file->parsed))
      file->parsed.notes.push_back(fmt::format("nothing in {} is part of the program", file->parsed.source.name));
    stl::append(project.parsed, std::move(file->parsed));
  }
  if (const std::string symbol = stl::symbol_of_smart(project.parsed.source); !symbol.empty())
    project.parsed.notes.push_back(fmt::format("{}: {} is a symbol of the S7-200 SMART; {}", project.parsed.source.name,
                                               stl::shortened(symbol), kSmartProgram));
  return project;
}

/// More than any program, with all the text around it: it would be read for seconds, and need 200 bytes for each byte.
constexpr std::size_t kLargestProgram = 4 << 20;

Result<SourceText> read_source(std::string_view bytes, const std::string& name, bool force_document) {
  if (bytes.size() > kLargestProgram)
    return trouble("it is larger than {} MB, more than any program", kLargestProgram >> 20);
  const auto decoded = stl::decode(bytes);
  if (!decoded) {
    if (stl::upper_case(name).ends_with(".MWP"))
      return Trouble{"it is a Micro/WIN project; open it in Micro/WIN and export each block (File, Export) as .awl"};
    return decoded.trouble();
  }
  if (const std::string_view wrapped = why_wrapped(decoded->text); !wrapped.empty()) return Trouble{std::string(wrapped)};
  if (const std::string_view product = why_surely_other_product(decoded->text); !product.empty())
    return Trouble{std::string(product)};
  const auto inside = stl::program_in_strings(decoded->text);
  const stl::PlainText plain(inside ? inside->text : decoded->text, is_instruction_of_either_set);
  const auto with_table = table_in_program(plain.text(), is_instruction_of_either_set);
  const std::string_view text = with_table ? std::string_view(with_table->program) : plain.text();
  const auto cpu_line = place_of_cpu_line(text);
  auto source = cpu_line ? read_plain(std::string(text).insert(*cpu_line, "// "), name, force_document)
                         : read_plain(text, name, force_document);
  if (!source) return Trouble{why_not_stl(plain.text())};
  if (source->kind == SourceKind::Listing || source->as_document()) stl::name_drawings(source->parsed, instruction_set());
  if (!plain.symbols().empty() && kind_of_table(plain.symbols()) == SourceKind::SymbolTable)
    add_symbols(plain.symbols(), source->parsed);
  if (with_table) {
    const std::size_t symbols = add_symbols(with_table->table, source->parsed);
    source->parsed.notes.push_back(fmt::format("{}: {} read from the table in the text", name, counted(symbols, "symbol")));
  }
  plain.restore(source->parsed);
  if (inside) source->parsed.notes.push_back(fmt::format("{}: {}", name, inside->note));
  source->encoding = decoded->encoding;
  return *std::move(source);
}

stl::ParseResult read_text(std::string_view utf8, const std::string& name) {
  const stl::PlainText plain(utf8);
  const SourceKind kind = stl::is_block_export(plain.text()) ? SourceKind::Blocks : SourceKind::Listing;
  stl::ParseResult parsed = read_as(kind, plain.text(), name);
  plain.restore(parsed);
  return parsed;
}

}  // namespace s7200
