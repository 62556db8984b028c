#include "interpreter/stl/symbols.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/plain_text.hpp"
#include "interpreter/stl/printer.hpp"

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

namespace {

// --- rows and cells ---

struct Cell {
  std::string text;        // without quotes
  std::string_view place;  // where it is in the line
};

/// Tabs if there are any; otherwise what the first row with one of them has.
char separator_of(std::string_view text) {
  if (text.find('\t') != std::string_view::npos) return '\t';
  const std::size_t first = text.find_first_of(",;");
  return first == std::string_view::npos ? ',' : text[first];
}

std::string without_doubled_quotes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    plain += text[i];
    if (text[i] == '"' && text.substr(i + 1).starts_with('"')) ++i;
  }
  return plain;
}

std::vector<Cell> cells_of(std::string_view line, char separator) {
  std::vector<Cell> cells;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(" \r\f"), line.size()));
    std::size_t end = 0;
    if (line.starts_with('"')) {
      for (end = 1; end < line.size() && (line[end] != '"' || line.substr(end).starts_with("\"\"")); ++end)
        end += line[end] == '"' ? 1U : 0U;
    }
    end = std::min(line.find(separator, end), line.size());
    const std::string_view written = trim_end(line.substr(0, end));
    std::string text(written);
    if (written.size() > 1 && written.front() == '"' && written.back() == '"')
      text = without_doubled_quotes(written.substr(1, written.size() - 2));
    cells.push_back({std::move(text), written});
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

bool is_comment_or_blank(std::string_view line) {
  line = trim(line);
  return line.empty() || line.starts_with("//");
}

/// The first lines that are neither empty nor comments, from which the kind of a file is seen.
std::vector<std::string_view> first_rows(std::string_view text) {
  constexpr std::size_t kRows = 100, kLongestRow = 1000;
  std::vector<std::string_view> rows;
  while (!text.empty() && rows.size() < kRows) {
    const std::string_view line = take_line(text);
    if (!is_comment_or_blank(line) && line.size() <= kLongestRow) rows.push_back(line);
  }
  return rows;
}

// --- what a cell is ---

bool is_name(std::string_view text) {
  return !text.empty() &&
         (is_letter(text.front()) || text.front() == '_' || static_cast<unsigned char>(text.front()) >= 0x80);
}

/// `SBR0`, `INT12`, `OB1`: what a block is called beside its name.
struct BlockNumber {
  Block::Kind kind;
  std::uint32_t number;
};

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

constexpr std::size_t kLongestValue = 40;

/// The address or constant in a cell, or the name of a block; nothing for other text.
std::optional<OperandValue> value_of(std::string_view text, std::string& why) {
  if (text.empty() || text.size() > kLongestValue) return std::nullopt;
  if (block_number(text)) return Name{upper_case(text)};
  const auto operand = parse_operand(text, why);
  if (!operand || std::holds_alternative<Name>(operand->value)) return std::nullopt;
  return operand->value;
}

bool is_address(std::string_view text) {
  std::string why;
  const auto value = value_of(text, why);
  if (!value || may_be_name(*value, text)) return false;
  return std::holds_alternative<Address>(*value) || std::holds_alternative<Name>(*value);
}

bool is_heading(const std::string& text, std::span<const std::string_view> words) {
  const std::string upper = upper_case(text);
  return std::ranges::find(words, upper) != words.end();
}

// In the languages of Micro/WIN.
constexpr std::array<std::string_view, 9> kNameHeadings{"SYMBOL",  "NAME", "SYMBOL NAME", "SYMBOLE", "SÍMBOLO",
                                                        "SIMBOLO", "符号", "符號",        "名称"};
constexpr std::array<std::string_view, 10> kAddressHeadings{"ADDRESS",   "ADDR", "ADRESSE",   "DIRECCIÓN", "DIRECCION",
                                                            "INDIRIZZO", "地址", "DIRECCIóN", "ADRESS",    "OPERAND"};

// --- symbol tables ---

struct Columns {
  std::size_t name = 0, address = 1;
};

/// The columns that a row of headings names.
std::optional<Columns> headings(const std::vector<Cell>& cells) {
  std::optional<std::size_t> name, address;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!name && is_heading(cells[i].text, kNameHeadings)) name = i;
    if (!address && is_heading(cells[i].text, kAddressHeadings)) address = i;
  }
  if (!name || !address) return std::nullopt;
  return Columns{*name, *address};
}

/// Where name and address are in a row without headings: side by side, the name first unless only the first is an address.
std::optional<Columns> columns_of(const std::vector<Cell>& cells) {
  std::string why;
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    const std::string &left = cells[i].text, &right = cells[i + 1].text;
    if (is_name(left) && !is_address(left) && value_of(right, why)) return Columns{i, i + 1};
    if (is_address(left) && is_name(right) && !is_address(right)) return Columns{i + 1, i};
  }
  return std::nullopt;
}

class SymbolTableReader {
 public:
  SymbolTableReader(std::string_view text, std::string name) : separator_(separator_of(text)) {
    result_.source.name = std::move(name);
    result_.source.text = split_lines(text);
  }

  ParseResult result() {
    for (const std::string& line : result_.source.text) {
      ++number_;
      if (!is_comment_or_blank(line)) read_row(line);
    }
    return std::move(result_);
  }

 private:
  void read_row(std::string_view line) {
    const std::vector<Cell> cells = cells_of(line, separator_);
    const auto filled = std::ranges::count_if(cells, [](const Cell& c) { return !c.text.empty(); });
    if (filled <= 1) return;  // the heading of a table, or a name without an address: unknown if it is used
    if (const auto found = headings(cells)) {
      headed_ = found;
      return;
    }
    const auto columns = headed_ && fits(cells, *headed_) ? headed_ : columns_of(cells);
    if (!columns) return add_without_address(cells, line);
    add(cells, *columns, line);
  }

  /// Some tables have more columns than headings: empty ones on the left.
  static bool fits(const std::vector<Cell>& cells, Columns columns) {
    const auto text = [&](std::size_t i) { return i < cells.size() ? std::string_view(cells[i].text) : std::string_view(); };
    return !text(columns.name).empty() || is_address(text(columns.address));
  }

  void add(const std::vector<Cell>& cells, Columns columns, std::string_view line) {
    if (std::max(columns.name, columns.address) >= cells.size()) return add_without_address(cells, line);
    const Cell &name = cells[columns.name], &address = cells[columns.address];
    if (address.text.empty()) return add_without_address(cells, line);
    std::string why;
    auto value = value_of(address.text, why);
    if (!value)
      return error(position(address, line), why.empty() ? fmt::format("{} is not an address", shortened(address.text)) : why,
                   "a row of a symbol table is a name, an address or a constant, and perhaps a comment");
    if (name.text.empty())
      return error(position(address, line), fmt::format("{} has no name", shortened(address.text)),
                   "a row of a symbol table is a name, an address and perhaps a comment");
    if (const auto other = value_of(name.text, why);
        other && !std::holds_alternative<Name>(*other) && !may_be_name(*other, name.text))
      return error(position(name, line), fmt::format("{} is an address or a constant, not a name", shortened(name.text)),
                   "give the symbol a name of its own: in the program, this would always be the address or the constant");
    std::string comment;
    const std::size_t after = std::max(columns.name, columns.address) + 1;
    for (std::size_t i = after; i < cells.size(); ++i) comment += (comment.empty() ? "" : " ") + cells[i].text;
    result_.source.symbols.push_back({name.text, std::move(value), position(name, line), std::string(trim(comment))});
  }

  /// Micro/WIN lets a name have no address as long as nothing uses it.
  void add_without_address(const std::vector<Cell>& cells, std::string_view line) {
    const auto name = std::ranges::find_if(cells, [](const Cell& c) { return is_name(c.text); });
    if (name != cells.end()) result_.source.symbols.push_back({name->text, std::nullopt, position(*name, line), {}});
  }

  Position position(const Cell& cell, std::string_view line) const {
    const auto before = static_cast<std::size_t>(cell.place.data() - line.data());
    return {number_, static_cast<std::uint32_t>(count_characters(line.substr(0, before)) + 1),
            static_cast<std::uint32_t>(std::max<std::size_t>(1, count_characters(cell.place)))};
  }

  void error(const Position& at, std::string message, std::string hint) {
    result_.diagnostics.push_back({Severity::Error, at, std::move(message), std::move(hint)});
  }

  char separator_;
  ParseResult result_;
  std::uint32_t number_ = 0;
  std::optional<Columns> headed_;
};

// --- names and what they stand for ---

/// A name as it is written in a statement: `*#next`, `"Pump 1"`, `SBR_0:SBR0`.
struct WrittenName {
  char mark = 0;       // & or *
  bool local = false;  // with #
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

class Resolver {
 public:
  explicit Resolver(ParseResult& result) : result_(result), source_(result.source) {
    for (const Symbol& symbol : source_.symbols)
      if (const Symbol* first = symbols_.add(symbol.name, symbol))
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
        name->reason = fmt::format("symbol {} has no address", shortened(symbol->name));
      else if (std::holds_alternative<Name>(*symbol->value))
        name->reason = fmt::format("{} is a block, not an address", shortened(symbol->name));
      else
        put(operand, *symbol->value, written.mark);
    }
  }

  std::string written_at(const Position& at) const {
    return at.line == 0 ? "" : plain_characters(characters_at(source_.text[at.line - 1], at.column, at.length));
  }

  void forget_german(const Position& at) {
    std::erase_if(result_.diagnostics, [&](const Diagnostic& d) { return d.cause == kGermanAddresses && d.position == at; });
  }

  /// `S1`, `K1` and `E1`, if there are variables or symbols of these names.
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

  /// `CALL E1`, if there is a block of this name.
  void take_for_block_name(Operand& operand) {
    if (std::holds_alternative<Name>(operand.value) || !operand.symbol.empty() || source_.blocks.empty()) return;
    const std::string written = written_at(operand.position);
    if (written.empty() || !may_be_name(operand.value, written) || !blocks_.find(written)) return;
    operand.value = Name{written};
    forget_german(operand.position);
  }

  /// `Pump:Q0.0`: the same as the table says, and as in all other places.
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

  static OperandValue without_mark(const OperandValue& value) {
    if (const auto* target = std::get_if<AddressOf>(&value)) return target->target;
    if (const auto* pointer = std::get_if<Indirect>(&value)) return pointer->pointer;
    return value;
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

// --- status charts ---

constexpr std::array<std::string_view, 14> kFormats{"SIGNED", "UNSIGNED", "HEXADECIMAL", "HEX",      "BINARY",
                                                    "BIT",    "BOOL",     "ASCII",       "STRING",   "FLOATING POINT",
                                                    "FLOAT",  "REAL",     "DECIMAL",     "TIME/DATE"};

}  // namespace

bool is_symbol_table(std::string_view text, const std::function<bool(std::string_view word)>& is_mnemonic) {
  const char separator = separator_of(text);
  const auto is_row = [&](const std::vector<Cell>& cells) {
    if (headings(cells)) return true;
    const auto columns = columns_of(cells);
    if (!columns) return false;
    const Cell& name = cells[columns->name];
    // `MOVW 65, VW0` is not the symbol "MOVW 65".
    const bool statement = separator == ',' && name.text.find(' ') != std::string::npos && !name.place.starts_with('"');
    return !statement && !is_mnemonic(upper_case(name.text));
  };
  std::size_t rows = 0, other = 0;
  for (const std::string_view line : first_rows(text)) {
    const std::vector<Cell> cells = cells_of(line, separator);
    if (rows + other == 0 && headings(cells)) return true;
    ++(is_row(cells) ? rows : other);
  }
  return rows > other;
}

ParseResult read_symbol_table(std::string_view text, std::string name) {
  return SymbolTableReader(text, std::move(name)).result();
}

bool is_status_chart(std::string_view text) {
  const char separator = separator_of(text);
  std::size_t rows = 0, other = 0;
  for (const std::string_view line : first_rows(text)) {
    const std::vector<Cell> cells = cells_of(line, separator);
    const bool format = std::ranges::any_of(
        cells, [](const Cell& c) { return std::ranges::find(kFormats, upper_case(c.text)) != kFormats.end(); });
    ++(format && cells.size() > 1 ? rows : other);
  }
  return rows > 0 && rows + 1 >= other;
}

const Symbol* find_symbol(const std::vector<Symbol>& symbols, std::string_view name) {
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  Names<Symbol> names;
  for (const Symbol& symbol : symbols) names.add(symbol.name, symbol);
  return names.find(name);
}

void resolve_symbols(ParseResult& result) { Resolver(result).run(); }

}  // namespace s7200::stl
