#include "interpreter/stl/tables/symbol_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "interpreter/stl/text/look_alikes.hpp"

namespace s7200::stl {
namespace {

// --- what a cell is ---

bool is_name(std::string_view text) {
  return !text.empty() &&
         (is_letter(text.front()) || text.front() == '_' || static_cast<unsigned char>(text.front()) >= 0x80);
}

constexpr std::size_t kLongestValue = 40;

/// The address without the mark of IEC 61131-3 or the gap of STEP 7: `I0.0` for `%I0.0` and for `I 0.0`.
std::string without_iec_mark_and_gap(std::string_view text) {
  if (text.starts_with('%')) text.remove_prefix(1);
  const auto letters = static_cast<std::size_t>(std::ranges::find_if_not(text, is_letter) - text.begin());
  const std::size_t rest = std::min(text.find_first_not_of(' ', letters), text.size());
  const bool gap = letters > 0 && rest > letters && rest < text.size() && is_digit(text[rest]);
  return std::string(text.substr(0, letters)).append(text.substr(gap ? rest : letters));
}

/// The address or constant in a cell, or the name of a block; nothing for other text.
Result<OperandValue> value_of(std::string_view cell) {
  if (cell.size() > kLongestValue || cell.find_first_of("0123456789'") == std::string_view::npos) return std::nullopt;
  const std::string text = without_iec_mark_and_gap(cell);
  if (block_number(text)) return Name{upper_case(text)};
  const auto operand = parse_operand(text);
  if (!operand) return operand.trouble();
  if (std::holds_alternative<Name>(operand->value)) return std::nullopt;
  return operand->value;
}

/// Whether a cell can have a value: a quick answer for the words that cannot. An area has three letters at most, and what
/// has more letters in front of its digits is a name; so is what begins with a sign of names. A name may have its address
/// beside it, `Pump:Q0.0`.
bool may_be_value(std::string_view cell) {
  constexpr std::size_t kLongestArea = 3;
  if (cell.size() > kLongestValue || std::ranges::none_of(cell, [](char c) { return is_digit(c) || c == '\''; }))
    return false;
  if (cell.find_first_of("':") != cell.npos) return true;
  if (cell.starts_with('%')) cell.remove_prefix(1);
  if (cell.starts_with('&') || cell.starts_with('*')) cell.remove_prefix(1);
  const auto letters = static_cast<std::size_t>(std::ranges::find_if_not(cell, is_letter) - cell.begin());
  const std::size_t next = cell.find_first_not_of(' ', letters);
  if (letters == 0)
    return std::string_view("0123456789+-").find(cell[0]) != cell.npos && cell.find_first_of(" ,;") == cell.npos;
  const bool address = letters <= kLongestArea && cell.find_first_not_of("0123456789.", next) == cell.npos;
  return address || cell[0] == 'K' || cell[0] == 'k' || cell[next] == '#';
}

bool has_value(std::string_view text) { return may_be_value(text) && value_of(text).has_value(); }

bool is_address(std::string_view text) {
  if (!may_be_value(text)) return false;
  const auto value = value_of(text);
  if (!value || may_be_name(*value, without_iec_mark_and_gap(text))) return false;
  return std::holds_alternative<Address>(*value) || std::holds_alternative<Name>(*value);
}

/// The formats in status charts.
constexpr std::array<std::string_view, 14> kFormats{"SIGNED", "UNSIGNED", "HEXADECIMAL", "HEX",      "BINARY",
                                                    "BIT",    "BOOL",     "ASCII",       "STRING",   "FLOATING POINT",
                                                    "FLOAT",  "REAL",     "DECIMAL",     "TIME/DATE"};
/// The types of symbols, besides BOOL, REAL and STRING.
constexpr std::array<std::string_view, 5> kTypes{"BYTE", "WORD", "INT", "DWORD", "DINT"};

/// Whether a symbol is retentive, beside its type.
constexpr std::array<std::string_view, 8> kFlags{"TRUE", "FALSE", "YES", "NO", "JA", "NEIN", "RETAIN", "NON-RETAIN"};

/// Whether a text is one of some words, which are in capitals, however its ASCII letters are written.
bool is_in_any_case(std::span<const std::string_view> words, std::string_view text) {
  return std::ranges::any_of(
      words, [text](std::string_view word) { return word.size() == text.size() && same_in_capitals(text, word); });
}

bool is_format(std::string_view text) { return is_in_any_case(kFormats, text); }
bool is_type(std::string_view text) { return is_format(text) || is_in_any_case(kTypes, text); }

// --- headings ---

/// A text in capitals and without accents: `MNEMONIQUE` for `Mnémonique`.
std::string heading_of(std::string_view text) {
  constexpr std::string_view kBase = "AAAAAAACEEEEIIIIDNOOOOO*OUUUUYTSAAAAAAACEEEEIIIIDNOOOOO/OUUUUYTY";  // U+00C0 to U+00FF
  if (is_ascii(text)) return upper_case(text);
  std::string heading;
  for (const Character c : characters(text)) {
    if (c.code >= 0xC0 && c.code < 0xC0 + kBase.size())
      heading += kBase[c.code - 0xC0];
    else
      heading.append(upper_case(text.substr(0, c.bytes)));
    text.remove_prefix(c.bytes);
  }
  return heading;
}

// Headings in the languages of Micro/WIN, of other programming software and of spreadsheets.
constexpr std::array<std::string_view, 22> kNameHeadings{
    "SYMBOL",        "SYMBOLS", "SYMBOL NAME", "SYMBOLNAME", "NAME",    "TAG",    "TAG NAME", "VARIABLE",
    "VARIABLE NAME", "SYMBOLE", "MNEMONIQUE",  "NOM",        "SIMBOLO", "NOMBRE", "NOME",     "符号",
    "符號",          "名称",    "名稱",        "符号名",     "变量名",  "变量"};
constexpr std::array<std::string_view, 18> kAddressHeadings{
    "ADDRESS",  "ADDR",    "ABSOLUTE ADDRESS", "LOGICAL ADDRESS", "ADRESSE",  "ADRESS", "ADRES",    "DIRECCION", "INDIRIZZO",
    "ENDERECO", "OPERAND", "OPERANDE",         "OPERANDO",        "ABSOLUTE", "地址",   "绝对地址", "位址",      "變數位址"};
constexpr std::array<std::string_view, 7> kFormatHeadings{"FORMAT", "FORMATO",  "DISPLAY FORMAT", "ANZEIGEFORMAT",
                                                          "格式",   "显示格式", "顯示格式"};

constexpr std::array<std::string_view, 14> kCommentHeadings{
    "COMMENT",     "COMMENTS",   "DESCRIPTION", "REMARK", "REMARKS", "KOMMENTAR", "BESCHREIBUNG",
    "COMMENTAIRE", "COMENTARIO", "COMMENTO",    "注释",   "註解",    "注解",      "说明"};

/// Whether one of some words stands anywhere in a line in capitals.
bool has_any(std::span<const std::string_view> words, std::string_view capitals) {
  return std::ranges::any_of(words, [capitals](std::string_view word) { return capitals.find(word) != capitals.npos; });
}

/// Whether a line may be a row of headings of symbols: a quick answer for nearly all lines.
bool may_head_symbols(std::string_view line) {
  const std::string capitals = heading_of(line);
  return has_any(kAddressHeadings, capitals) && has_any(kNameHeadings, capitals);
}

/// What a heading says of its column.
enum class HeadedColumn : std::uint8_t { Name, Address, Format, Comment };

/// Asterisks and colons around a heading are left out.
std::optional<HeadedColumn> column_named(std::string_view text) {
  static const std::unordered_map<std::string_view, HeadedColumn> kHeadings = [] {
    std::unordered_map<std::string_view, HeadedColumn> headings;
    for (const std::string_view word : kNameHeadings) headings.emplace(word, HeadedColumn::Name);
    for (const std::string_view word : kAddressHeadings) headings.emplace(word, HeadedColumn::Address);
    for (const std::string_view word : kFormatHeadings) headings.emplace(word, HeadedColumn::Format);
    for (const std::string_view word : kCommentHeadings) headings.emplace(word, HeadedColumn::Comment);
    return headings;
  }();
  constexpr std::size_t kLongestHeading = 40;
  constexpr std::string_view kMarks = " *:_";
  if (text.size() > kLongestHeading) return std::nullopt;
  text.remove_prefix(std::min(text.find_first_not_of(kMarks), text.size()));
  text = text.substr(0, text.find_last_not_of(kMarks) + 1);
  const auto row = kHeadings.find(heading_of(text));
  return row == kHeadings.end() ? std::nullopt : std::optional(row->second);
}

// --- rows and cells ---

struct Cell {
  std::string text;        // without quotes
  std::string_view place;  // where it is in the line
};
using Cells = std::vector<Cell>;

/// The separator of cells. In an assignment, `Motor = Q0.0`, only the first sign is a separator.
enum class Separator : char { Tab = '\t', Semicolon = ';', Comma = ',', Bar = '|', Equals = '=', Colon = ':', Blanks = ' ' };

bool is_assignment(Separator separator) { return separator == Separator::Equals || separator == Separator::Colon; }

std::string without_doubled_quotes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    plain += text[i];
    if (text[i] == '"' && text.substr(i + 1).starts_with('"')) ++i;
  }
  return plain;
}

Cell cell_of(std::string_view written) {
  if (written.size() > 1 && written.front() == '"' && written.back() == '"')
    return {without_doubled_quotes(written.substr(1, written.size() - 2)), written};
  return {std::string(written), written};
}

/// The end of the quoted text at the beginning of `line`; 0 if there is none.
std::size_t end_of_quotes(std::string_view line) {
  if (!line.starts_with('"')) return 0;
  std::size_t end = 1;
  for (; end < line.size() && (line[end] != '"' || line.substr(end).starts_with("\"\"")); ++end)
    end += line[end] == '"' ? 1U : 0U;
  return end;
}

Cells cells_between(std::string_view line, char separator) {
  Cells cells;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(" \r\f"), line.size()));
    const std::size_t end = std::min(line.find(separator, end_of_quotes(line)), line.size());
    cells.push_back(cell_of(trim_end(line.substr(0, end))));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

/// The parts of a line between runs of `blanks` blanks or more.
std::vector<std::string_view> parts_of(std::string_view line, std::string_view blanks) {
  std::vector<std::string_view> parts;
  for (line = trim(line); !line.empty(); line = trim(line)) {
    const std::size_t end = std::min(line.find(blanks, std::min(end_of_quotes(line) + 1, line.size())), line.size());
    parts.push_back(trim_end(line.substr(0, end)));
    line.remove_prefix(end);
  }
  return parts;
}

/// The part of a line from the first of two of its parts to the second.
std::string_view from_to(std::string_view first, std::string_view last) {
  return {first.data(), static_cast<std::size_t>(last.data() + last.size() - first.data())};
}

/// The place of the word of a row that is its address or begins it: `I0.0`, `I 0.0`; or of the second word if that is a
/// constant. The number of words if there is none.
std::size_t place_of_address(const std::vector<std::string_view>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (is_address(words[i])) return i;
    const bool one_letter = words[i].size() <= 2 && i + 1 < words.size();
    if (one_letter && is_digit(words[i + 1].front()) && is_address(from_to(words[i], words[i + 1]))) return i;
  }
  return words.size() > 1 && has_value(words[1]) ? 1 : words.size();
}

/// The headings of name and address among the parts of a row, of which one begins it or follows a number, and what follows
/// them; otherwise nothing.
Cells headings_among(const std::vector<std::string_view>& parts) {
  const auto name = std::ranges::find(parts, HeadedColumn::Name, column_named);
  const auto address = name == parts.end() ? name : std::ranges::find(parts, HeadedColumn::Address, column_named);
  if (name == parts.end() || address == parts.end() || std::min(name, address) - parts.begin() > 1) return {};
  Cells cells{cell_of(*name), cell_of(*address)};
  std::transform(std::next(std::max(name, address)), parts.end(), std::back_inserter(cells), cell_of);
  return cells;
}

/// Whether a word is a sign between a name and its address: `->`, `=>`, `AT`
bool is_sign(std::string_view word) {
  return same_in_capitals(word, "AT") || word.find_first_not_of("-=>:") == std::string_view::npos;
}

/// Name, address, and what follows them, wherever the row has the address; nothing if it has none. Blanks may be part of a
/// name.
Cells symbol_among(const std::vector<std::string_view>& words) {
  const std::size_t at = place_of_address(words);
  if (at == words.size() || (at == 0 && words.size() > 1 && is_type(words[1]))) return {};
  const bool gap = !has_value(words[at]);  // `I 0.0`
  const std::size_t after = at + (gap ? 2 : 1);
  std::size_t first = 0, last = at;
  if (at == 0) {
    first = after;
    last = after + 1;
  } else {
    while (first < last && !is_name(words[first]) && !words[first].starts_with('"')) ++first;
    while (last > first + 1 && (is_type(words[last - 1]) || is_sign(words[last - 1]))) --last;
  }
  if (first >= last || last > words.size()) return {};
  Cells cells{cell_of(from_to(words[first], words[last - 1])), cell_of(from_to(words[at], words[after - 1]))};
  for (std::size_t i = std::max(last, after); i < words.size(); ++i) cells.push_back(cell_of(words[i]));
  return cells;
}

/// The cells of a row whose columns are separated only by blanks.
Cells cells_between_blanks(std::string_view line) {
  const auto wide = parts_of(line, "  "), words = parts_of(line, " ");
  if (Cells cells = headings_among(wide); !cells.empty()) return cells;
  if (Cells cells = headings_among(words); !cells.empty()) return {cells[0], cells[1]};  // `Data type` is two words
  if (Cells cells = symbol_among(words); !cells.empty()) return cells;
  Cells as_they_stand;
  std::ranges::transform(wide.size() > 1 ? wide : words, std::back_inserter(as_they_stand), cell_of);
  return as_they_stand;
}

/// The cells of an assignment, `Motor = Q0.0`, `Motor: Q 0.0 // main pump`: name, address, and the words after them. One
/// cell if there is no address after the sign.
Cells cells_of_assignment(std::string_view line, char sign) {
  const std::size_t at = line.find(sign, end_of_quotes(line));
  const std::string_view name = trim(line.substr(0, at));
  if (at == std::string_view::npos || name.empty()) return {cell_of(trim(line))};
  std::string_view rest = line.substr(std::min(line.find_first_not_of("=:> \t", at), line.size()));
  const std::size_t end = std::min({rest.find(';'), rest.find("//"), rest.find("(*"), rest.size()});
  const auto words = parts_of(rest.substr(0, end), " ");
  if (words.empty() || place_of_address(words) != 0) return {cell_of(trim(line))};
  const std::size_t of_address = is_address(words[0]) ? 1 : 2;  // `Q 0.0`
  Cells cells{cell_of(name), cell_of(from_to(words[0], words[of_address - 1]))};
  rest.remove_prefix(static_cast<std::size_t>(words[of_address - 1].data() + words[of_address - 1].size() - rest.data()));
  rest.remove_prefix(std::min(rest.find_first_not_of("; \t/(*"), rest.size()));
  for (const std::string_view word : parts_of(rest.substr(0, rest.find("*)")), " ")) cells.push_back(cell_of(word));
  return cells;
}

Cells cells_of(std::string_view line, Separator separator) {
  if (separator == Separator::Blanks) return cells_between_blanks(line);
  const char sign = static_cast<char>(separator);
  return is_assignment(separator) ? cells_of_assignment(line, sign) : cells_between(line, sign);
}

/// Empty, a comment, or a line of strokes below headings.
bool says_nothing(std::string_view line) {
  line = trim(line);
  return line.starts_with("//") || line.find_first_not_of("-=+|: \t") == std::string_view::npos;
}

/// The first lines that say something, from which the kind of a file is seen.
std::vector<std::string_view> first_rows(std::string_view text) {
  constexpr std::size_t kRows = 100, kLongestRow = 1000;
  std::vector<std::string_view> rows;
  while (!text.empty() && rows.size() < kRows) {
    const std::string_view line = take_line(text);
    if (!says_nothing(line) && line.size() <= kLongestRow) rows.push_back(line);
  }
  return rows;
}

std::size_t filled(const Cells& cells) {
  return static_cast<std::size_t>(std::ranges::count_if(cells, [](const Cell& c) { return !c.text.empty(); }));
}

// --- symbol tables ---

struct Columns {
  static constexpr std::size_t kToTheEnd = std::string::npos;

  std::size_t name = 0, address = 1;
  std::size_t comment = 2, after_comment = kToTheEnd;
  bool has_comment = false;  ///< a heading names its column
};

/// The columns that a row of headings names. Without a heading for comments, they are in the columns that have none.
std::optional<Columns> headings(const Cells& cells) {
  std::optional<std::size_t> name, address, comment;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto found = column_named(cells[i].text);
    if (!name && found == HeadedColumn::Name) name = i;
    if (!address && found == HeadedColumn::Address) address = i;
    if (!comment && found == HeadedColumn::Comment) comment = i;
  }
  if (!name || !address) return std::nullopt;
  const std::size_t first = comment.value_or(cells.size());
  return Columns{*name, *address, first, first + 1 < cells.size() ? first + 1 : Columns::kToTheEnd, comment.has_value()};
}

/// The columns of name and address in a row without headings: side by side or with a type between them, the name first
/// unless only the first is an address. A format or a type is a name only in the first column.
std::optional<Columns> columns_of(const Cells& cells) {
  const auto is_symbol = [&](std::size_t i) {
    return is_name(cells[i].text) && (i == 0 || !is_type(cells[i].text)) && !is_address(cells[i].text);
  };
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    const bool symbol = is_symbol(i);
    const bool type = symbol && i + 2 < cells.size() && is_type(cells[i + 1].text) && is_address(cells[i + 2].text);
    const std::size_t next = type ? i + 2 : i + 1;
    if (symbol && has_value(cells[next].text)) return Columns{i, next, next + 1};
    if (!symbol && is_address(cells[i].text) && is_symbol(i + 1)) return Columns{i + 1, i, i + 2};
  }
  return std::nullopt;
}

/// The separator that makes the most lines rows of a table; tabs or commas if none does. A row of a table has two cells. A
/// separator is given up when it cannot make more lines rows than another did.
template <typename MayBeRow, typename IsRow>
Separator separator_of(std::span<const std::string_view> lines, const MayBeRow& may_be_row, const IsRow& is_row) {
  using enum Separator;
  const auto has = [](std::string_view line, Separator separator) {
    return separator == Blanks || line.find(static_cast<char>(separator)) != line.npos;
  };
  std::vector<std::string_view> candidates;
  std::ranges::copy_if(lines, std::back_inserter(candidates), may_be_row);
  Separator found = std::ranges::any_of(lines, [has](std::string_view line) { return has(line, Tab); }) ? Tab : Comma;
  std::size_t most = 0;
  for (const Separator separator : {Tab, Semicolon, Comma, Bar, Equals, Colon, Blanks}) {
    std::size_t rows = candidates.size();
    for (auto line = candidates.begin(); line != candidates.end() && rows > most; ++line)
      if (!has(*line, separator) || !is_row(cells_of(*line, separator), separator)) --rows;
    if (rows <= most) continue;
    most = rows;
    found = separator;
  }
  return found;
}

Separator separator_of_symbols(std::span<const std::string_view> lines) {
  const auto may_be_row = [](std::string_view line) {
    return line.find_first_of("0123456789'") != line.npos || may_head_symbols(line);
  };
  return separator_of(lines, may_be_row, [](const Cells& cells, Separator) { return headings(cells) || columns_of(cells); });
}

class SymbolTableReader {
 public:
  SymbolTableReader(std::string_view text, std::string name) : separator_(separator_of_symbols(first_rows(text))) {
    result_.source.name = std::move(name);
    result_.source.text = split_lines(text);
  }

  ParseResult result() {
    for (const std::string& line : result_.source.text) {
      ++number_;
      if (!says_nothing(line)) read_row(line);
    }
    return std::move(result_);
  }

 private:
  void read_row(std::string_view line) {
    const Cells cells = cells_of(line, separator_);
    if (filled(cells) <= 1) return read_typed_row(line);
    if (const auto found = headings(cells)) {
      headed_ = found;
      return;
    }
    const bool fit = headed_ && fits(cells, *headed_);
    auto columns = fit ? headed_ : columns_of(cells);
    if (!columns) return add_without_address(cells, line);
    if (headed_ && !fit && columns->name > headed_->name) {  // the empty ones are without headings
      columns->comment = headed_->comment + columns->name - headed_->name;
      columns->after_comment = Columns::kToTheEnd;
    }
    add(cells, *columns, line);
  }

  /// A row with blanks between its cells, as someone adds it to an exported table. Other lines are headings
  /// of tables and pages.
  void read_typed_row(std::string_view line) {
    const auto words = parts_of(line, " ");
    if (!headed_ || words.empty() || !is_name(words[0])) return;
    const Cells cells = symbol_among(words);
    if (!cells.empty() && (is_address(cells[1].text) || is_known(cells[0].text))) return add(cells, {}, line);
    if (words.size() > 1 && may_be_value(words[1]) && !value_of(words[1]).why().empty())
      add({cell_of(words[0]), cell_of(words[1])}, {}, line);
  }

  bool is_known(std::string_view name) const { return names_.contains(name); }

  void keep(Symbol symbol) {
    names_.insert(symbol.name);
    result_.source.symbols.push_back(std::move(symbol));
  }

  /// Whether the columns fit the cells: some tables have more columns than headings, empty ones on the left.
  static bool fits(const Cells& cells, Columns columns) {
    const auto text = [&](std::size_t i) { return i < cells.size() ? std::string_view(cells[i].text) : std::string_view(); };
    return !text(columns.name).empty() || is_address(text(columns.address));
  }

  void add(const Cells& cells, Columns columns, std::string_view line) {
    if (std::max(columns.name, columns.address) >= cells.size()) return add_without_address(cells, line);
    const Cell &name = cells[columns.name], &address = cells[columns.address];
    if (address.text.empty()) return add_without_address(cells, line);
    auto value = value_of(address.text);
    if (auto meant = value ? std::nullopt : as_meant(address, line)) {
      forget_without_address(name.text);
      return keep({name.text, *std::move(meant), position(name, line), comment_of(cells, columns)});
    }
    if (!value) {
      error(position(address, line),
            value.why().empty() ? fmt::format("{} is not an address", shortened(address.text)) : value.why(),
            "a row of a symbol table is a name, an address or a constant, and perhaps a comment",
            why_without_address(name.text));
      return add_without_address(cells, line);
    }
    if (name.text.empty())
      return error(position(address, line), fmt::format("{} has no name", shortened(address.text)),
                   "a row of a symbol table is a name, an address and perhaps a comment");
    if (const auto other = value_of(name.text);
        other && !std::holds_alternative<Name>(*other) && !may_be_name(*other, name.text))
      return error(position(name, line), fmt::format("{} is an address or a constant, not a name", shortened(name.text)),
                   "give the symbol a name of its own: in the program, this would always be the address or the constant");
    forget_without_address(name.text);
    keep({name.text, *std::move(value), position(name, line), comment_of(cells, columns)});
  }

  /// A name that stood alone before was a title.
  void forget_without_address(std::string_view name) {
    if (without_address_.erase(std::string(name)) == 0) return;
    std::erase_if(result_.source.symbols, [name](const Symbol& symbol) { return symbol.name == name && !symbol.value; });
  }

  /// What a cell was meant for, after an error about the slip: `Q0.O`, `I0,1`. The symbol is known then.
  Result<OperandValue> as_meant(const Cell& cell, std::string_view line) {
    std::string meant(cell.text), wrong;
    if (const auto look_alike = look_alike_operand(cell.text)) {
      meant = look_alike->meant;
      wrong = look_alike->wrong;
    } else {
      std::ranges::replace(meant, ',', '.');
      wrong = "a comma before its bit";
    }
    auto value = meant == cell.text ? std::nullopt : value_of(meant);
    if (value)
      error(position(cell, line), fmt::format("{} has {}", shortened(cell.text), wrong), fmt::format("write {}", meant));
    return value;
  }

  /// The comment of a row. If no heading names its column, it begins after a type and goes on to the end.
  static std::string comment_of(const Cells& cells, const Columns& columns) {
    std::string comment;
    const std::size_t end = std::min(cells.size(), columns.after_comment);
    std::size_t from = columns.comment;
    if (!columns.has_comment && from < end && is_type(cells[from].text)) {
      ++from;
      while (from < end && is_in_any_case(kFlags, cells[from].text)) ++from;
    }
    for (std::size_t i = from; i < end; ++i) comment += (comment.empty() ? "" : " ") + cells[i].text;
    return std::string(trim(comment.starts_with("//") ? std::string_view(comment).substr(2) : comment));
  }

  /// Micro/WIN lets a name have no address as long as nothing uses it.
  void add_without_address(const Cells& cells, std::string_view line) {
    const auto name = std::ranges::find_if(cells, [](const Cell& c) { return is_name(c.text); });
    if (name == cells.end() || is_known(name->text)) return;
    without_address_.insert(name->text);
    keep({name->text, std::nullopt, position(*name, line), {}});
  }

  Position position(const Cell& cell, std::string_view line) const {
    const auto before = static_cast<std::size_t>(cell.place.data() - line.data());
    return {number_, static_cast<std::uint32_t>(count_characters(line.substr(0, before)) + 1),
            static_cast<std::uint32_t>(std::max<std::size_t>(1, count_characters(cell.place)))};
  }

  void error(const Position& at, std::string message, std::string hint, std::string cause = {}) {
    result_.diagnostics.push_back({Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
  }

  Separator separator_;
  ParseResult result_;
  std::uint32_t number_ = 0;
  std::optional<Columns> headed_;
  std::set<std::string, std::less<>> names_{}, without_address_{};
};

}  // namespace

bool is_symbol_table(std::string_view text, const std::function<bool(std::string_view word)>& is_mnemonic) {
  const auto lines = first_rows(text);
  const Separator separator = separator_of_symbols(lines);
  const auto is_statement = [&](std::string_view word) { return is_mnemonic(upper_case(word)); };
  // `MOVW 65, VW0` is not the symbol "MOVW 65".
  const auto may_be_symbol = [&](const Cell& name) {
    return separator != Separator::Comma || name.text.find(' ') == std::string::npos || name.place.starts_with('"');
  };
  bool headed = false;
  std::size_t rows = 0, statements = 0, other = 0, certain = 0;
  for (const std::string_view line : lines) {
    const Cells cells = cells_of(line, separator);
    headed |= rows + statements + other == 0 && headings(cells);
    const auto columns = headed || filled(cells) < 2 ? std::nullopt : columns_of(cells);
    const bool whole_name = columns && !is_assignment(separator);  // no whole name in `LD I0.0 = Q0.0`
    if (is_statement(whole_name ? cells[columns->name].text : split_words(line).front()))
      ++statements;
    else if (headed ? filled(cells) > 1 : columns && may_be_symbol(cells[columns->name]))
      ++rows;
    else if (filled(cells) > 1 || rows > 0)  // otherwise it is a title
      ++other;
    const auto may_be_mnemonic = [&] {
      return separator == Separator::Blanks && std::ranges::all_of(cells[columns->name].text, is_upper);
    };
    certain += columns && is_address(cells[columns->address].text) && !may_be_mnemonic();
  }
  if (headed) return rows >= statements;
  // Blanks alone are between the words of any text, and of a listing whose mnemonics are those of another controller;
  // `port: 502` is in settings of any kind.
  if (separator == Separator::Blanks || is_assignment(separator))
    return statements == 0 && rows > other && 2 * certain > rows;
  return rows > statements + other;
}

bool is_head_of_symbols(std::string_view line) {
  using enum Separator;
  return may_head_symbols(line) &&
         std::ranges::any_of(std::array{Tab, Semicolon, Comma, Bar, Blanks},
                             [&](Separator separator) { return headings(cells_of(line, separator)).has_value(); });
}

std::string why_without_address(std::string_view name) { return fmt::format("symbol {} has no address", shortened(name)); }

ParseResult read_symbol_table(std::string_view text, std::string name) {
  return SymbolTableReader(text, std::move(name)).result();
}

bool is_status_chart(std::string_view text) {
  const auto has_chart_headings = [](const Cells& cells) {
    const auto has = [&](HeadedColumn kind) {
      return std::ranges::any_of(cells, [kind](const Cell& c) { return column_named(c.text) == kind; });
    };
    return has(HeadedColumn::Format) && (has(HeadedColumn::Address) || has(HeadedColumn::Name));
  };
  // Blanks alone are between the words of any text.
  const auto is_row = [](const Cells& cells, Separator separator) {
    if (cells.size() < 2 || cells[0].text.find('\t') != std::string::npos || parts_of(cells[0].text, "  ").size() > 1)
      return false;  // a comma in a comment
    const bool has_format = separator == Separator::Blanks ? is_format(cells[1].text) && is_address(cells[0].text)
                                                           : std::any_of(cells.begin() + 1, cells.end(),
                                                                         [](const Cell& c) { return is_format(c.text); });
    return has_format && !columns_of(cells);
  };
  const auto lines = first_rows(text);
  const auto may_have_format = [](std::string_view line) {
    const std::string capitals = heading_of(line);
    return has_any(kFormats, capitals) || has_any(kFormatHeadings, capitals);
  };
  if (std::ranges::none_of(lines, may_have_format) || std::ranges::any_of(lines, is_head_of_symbols)) return false;
  const Separator separator = separator_of(lines, may_have_format, [&](const Cells& cells, Separator by) {
    return has_chart_headings(cells) || is_row(cells, by);
  });
  std::size_t rows = 0, other = 0;
  for (const std::string_view line : lines) {
    const Cells cells = cells_of(line, separator);
    if (rows + other == 0 && has_chart_headings(cells)) return true;
    ++(is_row(cells, separator) ? rows : other);
  }
  return rows > 0 && rows + 1 >= other;
}

}  // namespace s7200::stl
