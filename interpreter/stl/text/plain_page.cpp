#include "interpreter/stl/text/plain_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/text/network_heading.hpp"

namespace s7200::stl::plain {
namespace {

// --- the margin ---

/// The number that a line begins with, `12`, `0012`, `12:`, `12.`, `[12]`, `12 |`, and how many bytes it takes. What follows
/// must begin as a statement or a comment does.
struct LineNumber {
  std::uint32_t number = 0;
  std::size_t bytes = 0;
  bool alone = false;
};

std::optional<LineNumber> line_number(std::string_view line) {
  const auto skip = [&](std::size_t at, std::string_view characters) {
    return std::min(line.find_first_not_of(characters, at), line.size());
  };
  std::size_t digits = skip(0, " \t[(");
  if (line.substr(digits).starts_with("N0")) ++digits;  // `N001 LD I0.0`
  const std::size_t end = skip(digits, "0123456789");
  constexpr std::size_t kMostDigits = 6;
  if (end == digits || end - digits > kMostDigits) return std::nullopt;
  LineNumber result;
  std::from_chars(line.data() + digits, line.data() + end, result.number);
  const std::size_t mark = skip(end, "]).:,;-|");  // 1- LD, but 1 -I VW0, VW2
  result.bytes = skip(skip(mark, " \t.:|"), " \t");
  result.alone = result.bytes == line.size();
  if (result.alone) return result;
  const char next = line[result.bytes];
  const bool begins = is_letter(next) || static_cast<unsigned char>(next) >= 0x80 ||
                      std::string_view("=+-*/<>`~#").find(next) != std::string_view::npos;
  return result.bytes > end && begins ? std::optional(result) : std::nullopt;
}

/// A word with the number of a step that a line begins with, and how many bytes it takes: `Step 1: LD I0.0`, `L1: LD I0.0`,
/// `第1步: LD I0.0`, `① LD I0.0`, `STL: LD I0.0`.
struct StepMark {
  std::string_view word{};
  std::uint32_t number = 0;
  std::size_t bytes = 0;
};

StepMark step_mark(std::string_view line) {
  constexpr std::size_t kLongest = 20;
  constexpr char32_t kCircledOne = 0x2460, kCircledTwenty = 0x2473;
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  StepMark mark;
  const auto ends_at = [&](std::size_t at) {
    mark.bytes = std::min(line.find_first_not_of(" \t", at), line.size());
    return looks_like_statement(line.substr(mark.bytes)) ? mark : StepMark{};
  };
  if (begin == line.size()) return {};
  if (const Character c = first_character(line.substr(begin)); c.code >= kCircledOne && c.code <= kCircledTwenty) {
    mark.number = static_cast<std::uint32_t>(c.code - kCircledOne + 1);
    return ends_at(begin + c.bytes);
  }
  constexpr std::string_view kWideColon = "：";
  const std::string_view head = line.substr(0, begin + kLongest);
  const std::size_t colon = std::min(head.find(':', begin), head.find(kWideColon, begin));
  if (colon == line.npos || colon == begin) return {};
  const std::string_view prefix = line.substr(begin, colon - begin);
  const std::size_t digits = std::min(prefix.find_first_of("0123456789"), prefix.size());
  const std::size_t end = std::min(prefix.find_first_not_of("0123456789", digits), prefix.size());
  const auto is_of_word = [](char c) { return is_letter(c) || static_cast<unsigned char>(c) >= 0x80; };
  mark.word = trim(prefix.substr(0, digits));
  if (mark.word.empty() || !std::ranges::all_of(mark.word, is_of_word) ||
      !std::ranges::all_of(prefix.substr(end), is_of_word))
    return {};
  std::from_chars(prefix.data() + digits, prefix.data() + end, mark.number);
  return ends_at(colon + (line[colon] == ':' ? 1 : kWideColon.size()));
}

/// How many bytes the time and the name of a speaker take at the beginning of a line of a chat: `[27.11.26, 14:02:11] Hans:
/// LD I0.0`, `27.11.26, 14:02 - Hans: LD I0.0`, `14:02 <hans> LD I0.0`.
std::size_t speaker(std::string_view line) {
  constexpr std::size_t kLongestTime = 30, kLongestName = 40;
  const std::size_t begin = std::min(line.find_first_not_of(" \t["), line.size());
  std::size_t after_time = std::min(line.find_first_not_of("0123456789.,:/- \t", begin), line.size());
  const std::string_view time = line.substr(begin, after_time - begin);
  const std::size_t colon = time.find(':');
  const bool is_time = time.size() <= kLongestTime && colon != time.npos && colon > 0 && colon + 1 < time.size() &&
                       is_digit(time[colon - 1]) && is_digit(time[colon + 1]);
  if (!is_time) return 0;
  const std::string half = upper_case(line.substr(after_time, 3));
  if (half.starts_with("AM") || half.starts_with("PM")) after_time += half.size() == 3 && is_letter(half[2]) ? 0U : 2U;
  const std::size_t name = std::min(line.find_first_not_of("] -\t", after_time), line.size());
  const bool in_brackets = name < line.size() && line[name] == '<';
  const std::size_t end = line.find(in_brackets ? "> " : ": ", name);
  return end != line.npos && end > name && end - name <= kLongestName ? end + 2 : 0;
}

/// How many bytes the > of quoted text takes at the beginning of a line, `> > LD I0.0` if it was quoted again.
std::size_t quotation_mark(std::string_view line) {
  const std::size_t end = std::min(line.find_first_not_of("> \t"), line.size());
  const std::size_t last = line.substr(0, end).rfind('>');
  return last != std::string_view::npos ? last + 1 : 0;
}

/// The length in bytes of the - or * at the beginning of a list's row. No instruction has a blank after these signs.
std::size_t list_mark(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t");
  const bool marked = from != std::string_view::npos && from + 1 < line.size() && is_blank(line[from + 1]);
  return marked && (line[from] == '-' || line[from] == '*') ? from + 2 : 0;
}

bool begins_with_network(std::string_view line) { return same_in_capitals(trim(line).substr(0, 7), "NETWORK"); }

bool stands_without_mark(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (code.empty() || begins_with_network(code) || routine_heading(code)) return true;
  const auto heading = network_heading(code);
  return heading && heading->sure;
}

/// A word with letters and digits, or signs that text does not have.
bool may_be_operand(std::string_view word) {
  const bool has_digit = std::ranges::any_of(word, is_digit);
  const bool has_letter = std::ranges::any_of(word, is_letter);
  return (has_digit && has_letter) || word.find_first_of("=#*&%_<>$'\"") != word.npos;
}

/// `Beispiel`, but not `LD`, `Q` or `movb`
bool begins_a_sentence(std::string_view word) {
  return word.size() > 2 && is_upper(word[0]) && !is_upper(word[1]) && word[1] != '.';
}

/// Whether a line of a page can only be text, such as `Beispiel aus dem Forum:`. Symbols stand in statements of two or three
/// words, too, so it takes a sign that ends a sentence, or three words that begin as one does.
bool is_text(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (stands_without_mark(code) || looks_like_statement(code)) return false;
  const std::vector<std::string> words = split_words(code);
  if (words[0].size() < 2 || std::ranges::any_of(words, may_be_operand)) return false;
  const bool in_capitals = std::ranges::all_of(words[0], [](char c) { return is_upper(c) || !is_letter(c); });
  const bool ends_sentence = !in_capitals && std::string_view(":!?").find(code.back()) != std::string_view::npos;
  return ends_sentence || (words.size() > 2 && begins_a_sentence(words[0]));
}

/// `<h2>Beispiel</h2>`
bool is_html_heading(std::string_view line) {
  const auto tag = tag_at(trim(line));
  return tag && tag->name.size() == 2 && tag->name[0] == 'h' && is_digit(tag->name[1]);
}

// --- rows of a table, lines in quotes ---

/// The part of a line that is in quotes as a whole, but for a comma or semicolon behind them; from 0 if it is not.
Part inside_quotes(std::string_view line) {
  const std::string_view code = trim(line);
  if (!code.starts_with('"') && !code.starts_with('\'')) return {};
  const std::size_t end = code.find(code.front(), 1);
  const std::string_view after = end == code.npos ? code : trim(code.substr(end + 1));
  if (!after.empty() && after != "," && after != ";") return {};
  const auto from = static_cast<std::size_t>(code.data() - line.data());
  return {from + 1, from + end};
}

/// The sign between the cells of a row: a stroke before it and between them, or `LD;I0.0`, `LD,I0.0`, `LD<tab>I0.0`; 0 if
/// there is none. The first cell of a row with other signs is a word, so that `LD I0.0; start` is none.
char separator_of_row(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (code.starts_with('|')) return '|';
  const bool quoted = code.starts_with('"') || code.starts_with('\'');
  const std::size_t first = quoted ? std::min(code.find(code.front(), 1), code.size()) : 0;
  const std::size_t sign = code.find_first_of(" \t;,", first);
  if (sign == code.npos || sign + 1 == code.size() || code[sign] == ' ') return '\0';
  return code[sign];
}

/// The cells of `LD;I0.0;"start; again"`, each without the sign in front of it.
std::vector<Part> cells_between(std::string_view line, char separator) {
  std::vector<Part> cells;
  const char quote = trim(line).starts_with('\'') ? '\'' : '"';
  bool quoted = false;
  std::size_t from = 0;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    if (at < line.size() && line[at] == quote) quoted = !quoted;
    if (at < line.size() && (line[at] != separator || quoted)) continue;
    cells.push_back({from, at});
    from = at + 1;
  }
  return cells;
}

/// The cells of `| LD | I0.0 |`, each without the stroke in front of it; none if it is no row of a table.
std::vector<Part> cells_of(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (!code.starts_with('|') || code.find('|', 1) == code.npos) return {};
  std::vector<Part> cells;
  const std::size_t begin = line.find('|');
  for (std::size_t from = begin + 1; from < begin + code.size();) {
    const std::size_t to = std::min(line.find('|', from), begin + code.size());
    cells.push_back({from, to});
    from = to + 1;
  }
  return cells;
}

/// Whether a row has a piece of ladder: `|--| |--( )--|`. A table has no wires but in its rules.
bool is_drawn(std::string_view line) {
  return line.find("--") != line.npos && line.find_first_not_of("|-+:= \t") != line.npos;
}

bool is_rule(std::string_view line) {
  return line.find_first_not_of("|-+:= \t") == line.npos && line.find('-') != line.npos;
}

/// A longer line is no statement with a few words; its words are not looked at one by one.
constexpr std::size_t kLongestStatement = 300;

/// `Network Comment`
bool is_network_without_number(std::string_view code) {
  return same_in_capitals(code.substr(0, 8), "NETWORK ") && code.size() > 8 && is_letter(code[8]);
}

/// `Motor start`, as people write it below the heading of a network: words in small letters, none of which is an operand.
bool may_be_title_line(std::string_view code) {
  constexpr std::size_t kShortest = 4, kMostWords = 8;
  const std::string_view first = code.substr(0, code.find_first_of(" \t"));
  const bool may_be =
      std::ranges::any_of(first, [](char c) { return is_lower(c) || static_cast<unsigned char>(c) >= 0x80; });
  if (!may_be || first.size() < kShortest || code.size() > kLongestStatement || code.find_first_of(",|()") != code.npos)
    return false;
  const std::vector<std::string> words = split_words(code);
  return words.size() <= kMostWords && upper_case(first) != "NETWORK" && std::ranges::none_of(words, may_be_operand);
}

/// The next gap in a line after its first operand, or after the place `from`; at the line's end if there is none.
Part gap_after_operand(std::string_view code, std::size_t from) {
  const Part none{code.size(), code.size()};
  const auto next = [&](std::size_t at, bool blank) {
    while (at < code.size() && is_blank(code[at]) != blank) ++at;
    return at;
  };
  const std::size_t operand = from > 0 ? from : next(next(next(0, false), true), false);
  const std::size_t gap = next(operand, true), words = next(gap, false);
  return words == code.size() ? none : Part{gap, words};
}

/// Whether words stand far from what is before them: `LD I0.0   start`
bool has_words_apart(std::string_view line) {
  const std::string_view code = code_of(line);
  for (Part gap = gap_after_operand(code, 0); gap.to < code.size(); gap = gap_after_operand(code, gap.to))
    if (gap.to - gap.from > 1 || code[gap.from] == '\t') return true;
  return false;
}

/// Whether small letters, or such beyond ASCII, follow the first operand of a line: `LD I0.0 Start`
bool may_have_words(std::string_view code) {
  return std::ranges::any_of(code.substr(gap_after_operand(code, 0).to),
                             [](char c) { return is_lower(c) || static_cast<unsigned char>(c) >= 0x80; });
}

/// `-----`, `=====`, `* * *`, `...`: a line of one sign.
bool is_plain_rule(std::string_view line) {
  constexpr std::size_t kShortest = 3;
  const std::string_view text = trim(line);
  const char sign = text.empty() ? '\0' : text.front();
  return std::string_view("-=*_+#.").find(sign) != std::string_view::npos &&
         static_cast<std::size_t>(std::ranges::count(text, sign)) >= kShortest &&
         std::ranges::all_of(text, [sign](char c) { return c == sign || c == ' '; });
}

bool is_one_operand(std::string_view cell) {
  for (std::string_view rest = cell; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view operand = trim(rest.substr(0, comma));
    const bool number = operand.find_first_not_of("+-.0123456789") == operand.npos;
    if (operand.empty() || operand.find_first_of(" \t") != operand.npos || (!number && !may_be_operand(operand)))
      return false;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return !cell.empty();
}

std::string_view text_of(std::string_view line, const Part& cell) {
  std::string_view text = trim(line.substr(cell.from, cell.to - cell.from));
  const bool in_signs = text.size() > 1 && text.front() == '\'' && text.back() == '\'' && line.starts_with('\'');
  const std::string_view around = in_signs ? " \t'" : " \t\"";
  text.remove_prefix(std::min(text.find_first_not_of(around), text.size()));
  return text.substr(0, text.find_last_not_of(around) + 1);
}

/// Whether a row names columns of a listing: `Nr;Instruction;Operand`
bool names_instructions(std::string_view line, const std::vector<Part>& cells) {
  static constexpr std::string_view kNames[] = {
      "INSTRUCTION", "INSTR", "INSTR.", "OPERAND",   "OPERANDS",   "MNEMONIC",  "OPCODE",      "BEFEHL", "ANWEISUNG",
      "OPERATION",   "STL",   "AWL",    "STATEMENT", "STATEMENTS", "INSTRUCAO", "INSTRUCCION", "指令"};
  bool any = false;
  for (const Part& cell : cells) {
    const std::string_view text = text_of(line, cell);
    if (look_like_operands(text)) return false;
    any |= std::ranges::find(kNames, upper_case(text)) != std::end(kNames);
  }
  return any;
}

/// `| Instruction | Operand | Comment |`: words in small letters where a mnemonic and an operand would stand.
bool is_head_of_table(std::string_view line, const std::vector<Part>& cells) {
  if (cells.size() >= 2 && names_instructions(line, cells)) return true;
  const auto cell = [&](std::size_t i) { return text_of(line, cells[i]); };
  const auto is_word = [](std::string_view text) { return text.size() > 2 && std::ranges::any_of(text, is_lower); };
  return cells.size() >= 2 && is_word(cell(0)) && is_word(cell(1)) && !is_one_operand(cell(1)) &&
         !stands_without_mark(cell(0));
}

/// What a row of a table says of its table.
struct CellsRead {
  bool has_comment = false;
  bool two_operands = false;
  std::string mnemonic{};
};

/// Makes a statement of a row: its number if it has one, the mnemonic, operands, and the rest as a comment.
CellsRead read_cells(Row& row, const std::vector<Part>& cells) {
  CellsRead read;
  std::vector<std::string_view> separators;  // in front of each cell
  enum { Number, Mnemonic, FirstOperand, Operand, Comment, Nothing } next = Number;
  const std::string original = row.text;
  bool after_comma = false;
  Part number{};
  for (const Part& part : cells) {
    const std::string_view cell = text_of(original, part);
    const std::string_view operand = cell.substr(0, cell.find_last_not_of(',') + 1);
    if (next == FirstOperand && operand.find_first_of(" \t") != cell.npos && !is_one_operand(operand)) next = Comment;
    if (next == Operand && !is_one_operand(operand)) next = Comment;
    const bool written = cell.starts_with("//");
    separators.push_back(next == Operand && !after_comma ? "," : next == Comment && !cell.empty() && !written ? "//" : " ");
    after_comma = cell.ends_with(',');
    read.has_comment |= next == Comment && !cell.empty() && !written;
    read.two_operands |= next == Operand || (next == FirstOperand && cell.find(',') != cell.npos);
    if (next == Number && (cell.empty() || std::ranges::all_of(cell, is_digit))) {
      number = part;
      next = Mnemonic;
    } else if (next <= Mnemonic) {
      read.mnemonic = cell;
      next = cell.find_first_of(" \t") == cell.npos ? FirstOperand : Comment;
    } else if (next == FirstOperand) {
      next = cell.empty() ? Comment : Operand;
    } else if (next == Comment && !cell.empty()) {
      next = Nothing;
    }
  }
  if (const std::size_t end = cells.back().to; original.substr(end, 1) == "|") row.replace(end, 1, " ", kTable);
  for (std::size_t i = cells.size(); i-- > 0;) {
    const Part cell = cells[i];
    const std::string_view text = text_of(original, cell), whole = std::string_view(original).substr(0, cell.to);
    const auto begin = static_cast<std::size_t>(text.data() - whole.data());
    for (std::size_t at = cell.to; at-- > cell.from;)
      if (original[at] == '"' || (original[at] == '\'' && (at < begin || at >= begin + text.size())))
        row.replace(at, 1, " ", kTable);
    if (cell.from > 0) row.replace(cell.from - 1, 1, separators[i], kTable);
  }
  if (!number.empty()) row.replace(number.from, number.to - number.from, "", kTable);
  return read;
}

// --- headings, letters, comments, printouts ---

void write_network_heading(Row& row, const NetworkHeading& heading) {
  const std::string title(heading.title), number(heading.number);
  const std::size_t begin = heading.begin, end = heading.end;
  const bool commented = title.empty() || title.starts_with("//");
  row.replace(end, row.text.size() - end, "", kHeadings);
  if (!title.empty()) row.append(fmt::format(" {}{}", commented ? "" : "// ", title), kHeadings);
  row.replace(begin, end - begin, "NETWORK " + number, kHeadings);
}

/// Whether a row is the head of the table that printouts have below a network: `Symbol  Address  Comment`
bool is_head_of_information(std::string_view line) {
  const std::string_view text = trim(line);
  if (!text.starts_with('S') && !text.starts_with('s') && !text.starts_with("符号")) return false;  // as nearly all lines
  const std::vector<std::string> words = split_words(upper_case(line));
  return words.size() >= 2 && words.size() <= 3 && (words[0] == "SYMBOL" || words[0] == "SYMBOLE" || words[0] == "符号") &&
         (words[1].starts_with("ADDRESS") || words[1].starts_with("ADR") || words[1] == "地址");
}

/// The length of `main.stl:12:` at the beginning of a line, as grep writes it.
std::size_t file_and_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == line.npos || line.substr(0, colon).find('.') == line.npos) return 0;
  if (line.substr(0, colon).find_first_of(" \t,;=") != line.npos) return 0;
  const std::size_t end = std::min(line.find_first_not_of("0123456789", colon + 1), line.size());
  return end > colon + 1 && end < line.size() && line[end] == ':' ? end + 1 : 0;
}

/// The place of a semicolon between the operands of a statement: `MOVW 5; VW10`. After it an address stands alone.
std::size_t semicolon_between_operands(std::string_view line) {
  const std::string_view code = code_of(line);
  const std::size_t sign = code.find(';');
  if (sign == code.npos || code.find(',') != code.npos || split_words(code.substr(0, sign)).size() != 2) return code.npos;
  const std::string_view second = trim(code.substr(sign + 1));
  return look_like_operands(second) && split_words(second).size() == 1 ? sign : code.npos;
}

bool is_only_letter(std::string_view line) {
  const std::string_view text = trim(line);
  return text.size() == 1 && (is_upper(text[0]) || is_digit(text[0]));
}

/// `M`, `VB`, `AIW`, German ones as well: what a number makes an address of.
bool is_area(std::string_view word) {
  constexpr std::size_t kLongest = 3;
  if (word.empty() || word.size() > kLongest) return false;
  const auto operand = parse_operand(fmt::format("{}0", word)), bit = parse_operand(fmt::format("{}0.0", word));
  const auto is_address = [](const Result<Operand>& each) { return each && std::holds_alternative<Address>(each->value); };
  return is_address(operand) || is_address(bit);
}

/// The gaps within addresses of a statement: `M 0.1`, `VB 10`, `I0 .0`, each as the place and the number of its blanks. The
/// first word is the mnemonic.
std::vector<Part> gaps_in_addresses(std::string_view line) {
  std::vector<Part> gaps;
  const std::string_view code = code_of(line);
  if (code.size() > kLongestStatement || kQuotationMarks.any_in(code)) return gaps;
  std::size_t begin = std::min(code.find_first_not_of(" \t"), code.size());
  begin = std::min(kBetweenWords.first_in(code, begin), code.size());  // after the mnemonic
  for (std::size_t at = begin; at < code.size(); at = kBetweenWords.first_in(code, at)) {
    std::size_t to = at;
    while (to < code.size() && kBetweenWords.has(code[to])) ++to;
    const char next = to < code.size() ? code[to] : '\0';
    if (!is_digit(next) && next != '.') {
      at = to;
      continue;
    }
    std::size_t first = at;
    while (first > begin && (is_letter(code[first - 1]) || is_digit(code[first - 1]) || code[first - 1] == '.')) --first;
    const std::string word = upper_case(code.substr(first, at - first));
    const bool after_area = is_digit(next) && is_area(word);
    const bool begins = !word.empty() && (is_letter(word.front()) || (!gaps.empty() && gaps.back().to == first));
    const bool has_area = begins && is_digit(word.back() == '.' ? '0' : word.back());
    const bool at_point = has_area && ((next == '.' && word.back() != '.') || (is_digit(next) && word.back() == '.'));
    if (after_area || at_point) gaps.push_back({at, to});
    at = to;
  }
  return gaps;
}

Row without_gaps(const Row& row) {
  Row closed = row;
  const std::vector<Part> gaps = gaps_in_addresses(row.text);
  for (auto gap = gaps.rbegin(); gap != gaps.rend(); ++gap) closed.replace(gap->from, gap->to - gap->from, "", kGaps);
  return closed;
}

/// Changes that need all lines together. One step may uncover the next: `> 1. LD I0.0`, a fence in a quoted mail.
class PageReader {
 public:
  PageReader(std::vector<Row> rows, const IsInstruction& is_instruction)
      : rows_(std::move(rows)), is_instruction_(is_instruction) {}

  void run() {
    constexpr int kMostSteps = 6;
    leave_out_marks(file_and_line);
    join_letters();
    take_symbol_information();
    write_network_headings();
    go_on_with_comments();
    for (Row& row : rows_)
      if (const std::size_t sign = semicolon_between_operands(row.text); sign != std::string::npos)
        row.replace(sign, 1, ",", kSemicolons);
    for (int step = 0; step < kMostSteps; ++step)
      if (!cut_out_fences() && !leave_out_speakers() && !leave_out_marks(quotation_mark) && !leave_out_cells() &&
          !leave_out_quotes() && !leave_out_numbers() && !leave_out_steps() && !leave_out_marks(list_mark))
        break;
    write_network_headings();
    make_comments_of_titles();
    make_comments_of_rules();
    close_gaps_in_addresses();
    make_comments_of_words_after_statements();
  }

  /// Paragraphs and headings between the lines of a program that has tags or is quoted, too. `lines` are those of the
  /// original.
  void leave_out_text(const std::vector<std::string>& lines) {
    for (Row& row : rows_) {
      if ((row.changes & (kHtml | kMargin)) == 0) continue;
      const bool is_heading =
          is_html_heading(lines[row.original - 1]) && !stands_without_mark(row.text) && !looks_like_statement(row.text);
      if (is_heading || is_text(row.text)) leave_out_around(row, (row.changes & kHtml) != 0 ? kHtml : kMargin);
    }
  }

  Page take() { return {std::move(rows_), std::move(left_out_), around_}; }

 private:
  void leave_out_around(Row& row, Change change) {
    around_ |= change;
    if (!trim(row.text).empty() && !is_fence(row.text) && (left_out_.empty() || left_out_.back() != row.original))
      left_out_.push_back(row.original);
    row.leave_out(change);
  }

  /// Cuts the program out of its fences, if it is between them. A single fence has lost the other.
  bool cut_out_fences() {
    std::vector<bool> inside;
    bool in = false, any_inside = false, any_outside = false;
    const bool of_asciidoc = std::ranges::any_of(rows_, [](const Row& row) {
      const std::string_view text = trim(row.text);
      return text.starts_with('[') && lower_case(text).starts_with("[source");
    });
    const auto is_mark = [of_asciidoc](std::string_view line) {
      const std::string_view text = trim(line);
      return is_fence(line) || (of_asciidoc && text.starts_with("----") && text.find_first_not_of('-') == text.npos);
    };
    if (std::ranges::none_of(rows_, is_mark, &Row::text)) return false;
    Change change = kMarkdown;
    for (const Row& row : rows_) {
      const bool fence = is_mark(row.text);
      if (fence && !in) change = change_of_fence(row.text);
      if (fence) in = !in;
      inside.push_back(in && !fence);
      if (!fence) (in ? any_inside : any_outside) |= looks_like_statement(row.text);
    }
    const bool cut = any_inside && !any_outside;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (cut && !inside[i])
        leave_out_around(rows_[i], change);
      else if (is_mark(rows_[i].text))
        rows_[i].leave_out(change);
    return true;
  }

  /// Leaves out who said it and when, and what is no statement. Lines of one message have that once.
  bool leave_out_speakers() {
    std::vector<std::size_t> bytes;
    std::ranges::transform(rows_, std::back_inserter(bytes), [](const Row& row) { return speaker(row.text); });
    std::size_t said = 0;
    bool any_statement = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      said += bytes[i] > 0 ? 1U : 0U;
      any_statement |= bytes[i] > 0 && looks_like_statement(std::string_view(rows_[i].text).substr(bytes[i]));
    }
    if (said < 2 || !any_statement) return false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i].leave_out_beginning(bytes[i], kMargin);
      if (bytes[i] > 0 && !stands_without_mark(rows_[i].text) && !looks_like_statement(rows_[i].text))
        leave_out_around(rows_[i], kMargin);
    }
    return true;
  }

  /// Leaves out such marks where each line has one, with the same word and the next number or none.
  bool leave_out_steps() {
    std::vector<std::size_t> bytes;
    std::optional<StepMark> last;
    std::size_t marked = 0;
    for (const Row& row : rows_) {
      const StepMark mark = step_mark(row.text);
      bytes.push_back(mark.bytes);
      if (mark.bytes == 0) continue;
      if (last && (mark.word != last->word || mark.number != last->number + (last->number > 0 ? 1 : 0))) return false;
      last = mark;
      ++marked;
    }
    return marked >= 2 && leave_out_marked(bytes, kLineNumbers);
  }

  /// Leaves out a mark if all lines from the first to the last marked one have it, and the others are text.
  bool leave_out_marks(std::size_t (*mark)(std::string_view line)) {
    std::vector<std::size_t> bytes;
    std::ranges::transform(rows_, std::back_inserter(bytes), [mark](const Row& row) { return mark(row.text); });
    return leave_out_marked(bytes, kMargin);
  }

  /// Makes statements of the rows of a table, and leaves out its heads and rules. A table of symbols stays one: of its first
  /// words each is a name, and no two are the same. Where its cells have no strokes, it takes a coil, a head that speaks
  /// of instructions, or an instruction in each row, to tell; and a table with tabs is read as one only for its comments.
  bool leave_out_cells() {
    const auto first = std::ranges::find_if(rows_, [](const Row& row) { return separator_of_row(row.text) != '\0'; });
    if (first == rows_.end()) return false;
    const char separator = separator_of_row(first->text);
    std::vector<Row> read = rows_;
    std::set<std::string> first_words;
    bool of_symbols = true, says_so = false, has_comment = false, has_coil = false;
    constexpr std::size_t kMostCells = 20;  // of a row of a listing
    std::size_t in_table = 0, statements = 0, others = 0, instructions = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::string_view text = rows_[i].text;
      const bool in_strokes = separator == '|';
      const bool has_cells = in_strokes || text.find(separator) != text.npos;
      const std::vector<Part> cells = in_strokes  ? cells_of(text)
                                      : has_cells ? cells_between(text, separator)
                                                  : std::vector<Part>{};
      if (cells.empty()) {
        others += !stands_without_mark(text) ? 1U : 0U;
        continue;
      }
      if (cells.size() > kMostCells || (in_strokes && is_drawn(text))) return false;
      if ((in_strokes && is_rule(text)) || is_head_of_table(text, cells)) {
        says_so |= names_instructions(text, cells);
        read[i].leave_out(kTable);
        continue;
      }
      const CellsRead row = read_cells(read[i], cells);
      ++in_table;
      has_comment |= row.has_comment;
      has_coil |= row.mnemonic == "=";
      instructions += is_instruction_ && (same_in_capitals(row.mnemonic, "NETWORK") || is_statement(read[i].text)) ? 1U : 0U;
      if (!looks_like_statement(read[i].text)) continue;
      ++statements;
      const std::string word = split_words(read[i].text).front();
      const bool in_capitals = word.size() <= 5 && std::ranges::none_of(word, is_lower);
      of_symbols = of_symbols && is_letter(word.front()) && first_words.insert(word).second &&
                   !(in_strokes && row.two_operands && in_capitals);
    }
    says_so = says_so || (instructions == in_table && in_table > 1);
    if ((of_symbols && !says_so) || 3 * statements < in_table) return false;
    if (separator != '|' && ((!has_coil && !says_so) || in_table < 2 || others > 0)) return false;
    if (separator == '\t' && !has_comment) return false;
    rows_ = std::move(read);
    return true;
  }

  /// Whether a line is an instruction with as many operands as it takes.
  bool takes_as_written(std::string_view line) const {
    const auto [word, others] = first_word_of_code(line.substr(0, kLongestStatement));
    return !word.empty() && is_instruction_(word, others);
  }

  /// Whether a text can be read as an instruction with its operands.
  bool is_statement(std::string_view text) const {
    constexpr std::size_t kLongestOfStack = 5;
    const auto [word, others] = first_word_of_code(text.substr(0, kLongestStatement));
    if (word.empty()) return false;
    if (!is_instruction_)
      return looks_like_statement(text) || (others == 0 && word.size() <= kLongestOfStack && trim(code_of(text)) == word);
    if (is_instruction_(word, others)) return true;
    return looks_like_statement(text) && is_mnemonic(is_instruction_, word);
  }

  /// Whether a line that may be a heading or the beginning of a sentence is a heading: a statement follows, or it has the
  /// next number.
  bool is_heading_here(std::size_t at, const NetworkHeading& heading, std::uint32_t number, std::uint32_t last) const {
    constexpr std::size_t kLongestTitle = 60;
    if (number == last + 1 && heading.title.size() <= kLongestTitle && !heading.title.ends_with('.')) return true;
    return is_followed_by_statement(at);
  }

  /// Whether the title of a network is a statement in the same line. `Stop` and `Call pump` are none where the network
  /// begins below them.
  bool is_statement_beside(std::size_t at, std::string_view title) const {
    if (!is_statement(title)) return false;
    const std::string_view first = title.substr(0, title.find_first_of(" \t"));
    const bool may_be_words =
        std::ranges::none_of(title, is_digit) && is_upper(title[0]) && std::ranges::any_of(first, is_lower);
    return !may_be_words || !is_followed_by_statement(at);
  }

  bool is_followed_by_statement(std::size_t at) const {
    const auto says_something = [](const Row& row) { return !trim(code_of(row.text)).empty(); };
    const auto next = std::find_if(rows_.begin() + static_cast<std::ptrdiff_t>(at) + 1, rows_.end(), says_something);
    return next != rows_.end() && is_statement(next->text);
  }

  void write_network_headings() {
    const auto may_be_heading = [](const Row& row) { return begins_with_network(row.text) || network_heading(row.text); };
    const auto first = static_cast<std::size_t>(std::ranges::find_if(rows_, may_be_heading) - rows_.begin());
    const auto says_statement = [this](const Row& row) { return is_statement(row.text); };
    if (first == rows_.size() || std::ranges::none_of(rows_, says_statement)) return;
    std::uint32_t last = 0;
    for (std::size_t i = first; i < rows_.size(); ++i) {
      Row& row = rows_[i];
      const auto heading = network_heading(row.text);
      if (!heading && !begins_with_network(row.text)) continue;
      const std::vector<std::string> words = heading ? std::vector<std::string>{} : split_words(code_of(row.text));
      const bool own = words.size() == 2 && same_in_capitals(words[0], "NETWORK");
      if (!heading && !own) continue;
      const std::string_view digits = heading ? heading->number : std::string_view(words[1]);
      std::uint32_t number = 0;
      std::from_chars(digits.data(), digits.data() + digits.size(), number);
      const bool is_one = own || ((heading->framed || !is_statement_beside(i, heading->title)) &&
                                  (heading->sure || is_heading_here(i, *heading, number, last)));
      if (!is_one) continue;
      last = number;
      if (heading) write_network_heading(row, *heading);
    }
  }

  /// Puts // before a title in the line below the heading of a network. In a listing in small letters it may be a statement.
  void make_comments_of_titles() {
    const auto in_small_letters = [this](const Row& row) {
      const std::string_view code = trim(code_of(row.text));
      return std::ranges::any_of(code.substr(0, code.find_first_of(" \t")), is_lower) && is_statement(row.text);
    };
    if (!is_instruction_ || std::ranges::none_of(rows_, begins_with_network, &Row::text) ||
        std::ranges::any_of(rows_, in_small_letters))
      return;
    bool after_heading = false;
    for (Row& row : rows_) {
      const std::string_view code = trim(code_of(row.text));
      if (code.empty()) continue;
      if (begins_with_network(code)) {
        const std::vector<std::string> words = split_words(code);
        after_heading = words.size() == 2 && same_in_capitals(words[0], "NETWORK") && is_digit(words[1][0]) &&
                        trim(row.text).size() == code.size();
        continue;
      }
      if (after_heading && may_be_title_line(code) && !is_statement(code) && !network_heading(code))
        row.replace(0, 0, "// ", kComments);
      after_heading = false;
    }
  }

  /// Where words follow a whole statement, and can be neither its operands nor a statement: `LD I0.0 Start button`.
  std::optional<std::size_t> words_after_statement(std::string_view line) const {
    const std::string_view code = trim_end(code_of(line));
    const bool has_comment = code.size() < trim_end(line).size(), has_words = gap_after_operand(code, 0).to < code.size();
    if (has_comment || !has_words || code.size() > kLongestStatement || code.find_first_of("'\"|") != code.npos ||
        takes_as_written(code))
      return {};
    for (Part gap = gap_after_operand(code, 0); gap.to < code.size(); gap = gap_after_operand(code, gap.to)) {
      const std::string_view text = code.substr(gap.to), first = text.substr(0, text.find_first_of(" \t"));
      const bool is_word = is_letter(text.front()) || static_cast<unsigned char>(text.front()) >= 0x80;
      if (!is_word || code[gap.from - 1] == ',' || first.ends_with(',') || look_like_operands(first) || is_statement(text))
        continue;
      const std::string_view statement = code.substr(0, gap.from);
      const bool apart = gap.to - gap.from > 1 || code[gap.from] == '\t';  // `A page of text` is no statement
      if (takes_as_written(statement) && (apart || looks_like_statement(statement))) return gap.to;
    }
    return {};
  }

  /// Puts // before such words if most other lines are statements: in a document they may be text. A single line with words
  /// close to its operand may have a wrong operand.
  void make_comments_of_words_after_statements() {
    if (!is_instruction_) return;
    constexpr std::size_t kMost = 4;                // so many lines to one that is no statement
    std::vector<std::optional<std::size_t>> words;  // in each row
    std::size_t close = 0, apart = 0, others = 0, lines = 0;
    for (const Row& row : rows_)
      if (words.push_back(words_after_statement(row.text)); words.back()) ++(has_words_apart(row.text) ? apart : close);
    if (close + apart == 0 || (close == 1 && apart == 0)) return;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::string_view text = rows_[i].text;
      lines += trim(code_of(text)).empty() ? 0U : 1U;
      others += !words[i] && !stands_without_mark(text) && !is_statement(text) ? 1U : 0U;
    }
    if (kMost * others > lines) return;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (words[i]) rows_[i].replace(*words[i], 0, "// ", kComments);
  }

  /// Puts // before a line of strokes between networks: `---------`
  void make_comments_of_rules() {
    for (Row& row : rows_)
      if (is_plain_rule(row.text)) row.replace(0, 0, "// ", kComments);
  }

  /// Reads `O M 0.1` as `O M0.1` where only that is an instruction. STEP 7 has such addresses, but no LD.
  void close_gaps_in_addresses() {
    const auto loads = [](const Row& row) {
      const std::string begin = upper_case(trim(row.text).substr(0, 2));
      return begin == "LD" && looks_like_statement(without_gaps(row).text);
    };
    if (!is_instruction_ || std::ranges::none_of(rows_, loads)) return;
    for (Row& row : rows_) {
      if (gaps_in_addresses(row.text).empty()) continue;
      Row closed = without_gaps(row);
      if (closed.changes == row.changes) continue;
      if (takes_as_written(closed.text) && !takes_as_written(row.text)) row = std::move(closed);
    }
  }

  /// Makes `MAIN` of four rows with a letter each, as the text of a page has it that prints the heading down its margin.
  void join_letters() {
    constexpr std::size_t kLongest = 6;  // letters of a heading
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      std::string joined;
      std::size_t end = i;
      while (end < rows_.size() && joined.size() <= kLongest && is_only_letter(rows_[end].text))
        joined += trim(rows_[end++].text);
      if (joined.size() < 4 || !routine_heading(joined)) continue;
      rows_[i].replace(0, rows_[i].text.size(), joined, kLetters);
      for (std::size_t k = i + 1; k < end; ++k) rows_[k].leave_out(kLetters);
    }
  }

  /// Takes the tables that a printout has below its networks: each says the symbols of its network.
  void take_symbol_information() {
    if (std::ranges::none_of(rows_, begins_with_network, &Row::text)) return;
    std::set<std::string> known;
    bool inside = false;
    for (Row& row : rows_) {
      if (constexpr std::string_view kComment = "NETWORK COMMENT";
          same_in_capitals(trim(row.text).substr(0, kComment.size()), kComment)) {
        const std::string_view rest = trim(row.text).substr(kComment.size());
        const std::string_view words = trim(rest.substr(rest.starts_with(':') ? 1 : 0));
        if (words.empty())
          row.leave_out(kInformation);
        else
          row.replace(0, static_cast<std::size_t>(words.data() - row.text.data()), "// ", kInformation);
      }
      const bool head = is_head_of_information(row.text);
      if (!head && !inside) continue;
      const std::vector<std::string> words = split_words(row.text);
      inside = head || (words.size() >= 2 && !begins_with_network(row.text) && look_like_operands(words[1]));
      if (!inside) continue;
      if (known.insert(head ? std::string() : words[0] + ' ' + words[1]).second) row.symbol = row.text;
      row.leave_out(kInformation);
    }
  }

  /// Puts // before the rest of a comment that was broken at a hyphen: `// … con-`, `trol by the user`
  void go_on_with_comments() {
    bool broken = false;
    for (Row& row : rows_) {
      const std::string_view text = trim(row.text);
      if (text.empty()) continue;
      if (broken && is_lower(text[0]) && !looks_like_statement(text) && code_of(text).size() == text.size())
        row.replace(0, 0, "// ", kBrokenComments);
      const std::string_view whole = trim(row.text);
      broken = code_of(whole).size() < whole.size() && whole.ends_with('-') && is_lower(whole[whole.size() - 2]);
    }
  }

  /// Leaves out quotes around each line, with a comma behind them, too, as in the text of another program: `"LD I0.0",`
  bool leave_out_quotes() {
    if (std::ranges::all_of(rows_, [](const Row& row) { return inside_quotes(row.text).from == 0; })) return false;
    std::vector<Row> whole = rows_;
    std::vector<std::size_t> bytes;
    std::size_t quoted = 0, statements = 0;
    for (Row& row : rows_) {
      const Part inside = inside_quotes(row.text);
      bytes.push_back(inside.from);
      if (inside.from == 0) continue;
      row.replace(inside.to, row.text.size() - inside.to, "", kQuotedLines);
      ++quoted;
      statements += looks_like_statement(std::string_view(row.text).substr(inside.from)) ? 1U : 0U;
    }
    if (quoted >= 2 && 3 * statements >= quoted && leave_out_marked(bytes, kQuotedLines)) return true;
    rows_ = std::move(whole);
    return false;
  }

  /// Leaves out line numbers that rise; below a heading they may begin anew. Where none is missing, the head of a page may
  /// stand between them.
  bool leave_out_numbers() {
    std::vector<std::size_t> bytes;
    std::optional<std::uint32_t> last, before;
    std::size_t numbered = 0, statements = 0;
    bool none_missing = true;
    for (const Row& row : rows_) {
      const auto number = line_number(row.text);
      bytes.push_back(number ? number->bytes : 0);
      if (number && last && number->number <= *last) return false;
      if (number) none_missing = none_missing && (!before || number->number == *before + 1);
      if (number)
        last = before = number->number;
      else if (!trim(row.text).empty())
        last.reset();
      numbered += number ? 1U : 0U;
      statements += number && !number->alone && row.text[number->bytes] != '/' ? 1U : 0U;
    }
    return numbered >= 2 && statements > 0 && leave_out_marked(bytes, kLineNumbers, none_missing);
  }

  /// Leaves out the first bytes of each row; 0: the row has no mark. Text without marks stands around these rows, and
  /// between them only if it `may_interrupt`; then a row that names a routine is no text: it may be a heading.
  bool leave_out_marked(const std::vector<std::size_t>& bytes, Change change, bool may_interrupt = false) {
    const auto is_marked = [](std::size_t each) { return each > 0; };
    const auto begin = static_cast<std::size_t>(std::ranges::find_if(bytes, is_marked) - bytes.begin());
    const auto end = static_cast<std::size_t>(std::find_if(bytes.rbegin(), bytes.rend(), is_marked).base() - bytes.begin());
    if (begin >= end) return false;
    const auto names_routine = [may_interrupt](std::string_view text) {
      return may_interrupt && std::ranges::any_of(split_words(text),
                                                  [](const std::string& word) { return default_routine(word).has_value(); });
    };
    std::size_t marked = 0, statements = 0;
    bool has_text = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::string_view text = rows_[i].text;
      marked += bytes[i] > 0 ? 1U : 0U;
      statements += bytes[i] > 0 && looks_like_statement(text.substr(bytes[i])) ? 1U : 0U;
      if (bytes[i] > 0 || stands_without_mark(text) || names_routine(text)) continue;
      if ((i >= begin && i < end && !may_interrupt) || looks_like_statement(text)) return false;
      has_text = true;
    }
    constexpr std::size_t kEachSo = 3;  // so many marked lines to one that surely is a statement, where there is text around
    if (has_text && kEachSo * statements < marked) return false;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (bytes[i] > 0)
        rows_[i].leave_out_beginning(bytes[i], change);
      else if (!stands_without_mark(rows_[i].text) && !(i > begin && i < end && names_routine(rows_[i].text)))
        leave_out_around(rows_[i], change);
    return true;
  }

  std::vector<Row> rows_;
  const IsInstruction& is_instruction_;
  std::vector<std::uint32_t> left_out_{};
  std::uint32_t around_ = 0;
};

}  // namespace

void Row::replace(std::size_t at, std::size_t bytes, std::string_view by, Change change) {
  if (columns.empty())
    for (std::uint32_t column = 1; column <= count_characters(text) + 1; ++column) columns.push_back(column);
  const auto first = columns.begin() + static_cast<std::ptrdiff_t>(count_characters(std::string_view(text).substr(0, at)));
  const auto characters = count_characters(std::string_view(text).substr(at, bytes));
  const std::uint32_t column = *first;
  columns.insert(columns.erase(first, first + static_cast<std::ptrdiff_t>(characters)), by.size(), column);
  text.replace(at, bytes, by);
  changes |= change;
}

void Row::append(std::string_view more, Change change) {
  const std::uint32_t end = columns.empty() ? static_cast<std::uint32_t>(count_characters(text)) + 1 : columns.back();
  replace(text.size(), 0, "", change);
  columns.insert(columns.end() - 1, count_characters(more), end);
  text += more;
}

bool may_need_page(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (code.size() < line.size() && trim(line).ends_with('-')) return true;  // a broken comment
  if (is_network_without_number(code) || may_be_title_line(code)) return true;
  if (code.empty()) return false;
  if (may_have_margin(line) || is_only_letter(code) || network_heading(code) || file_and_line(code) != 0 ||
      step_mark(code).bytes != 0)
    return true;
  if (!gaps_in_addresses(code).empty() || is_plain_rule(code) || may_have_words(code)) return true;
  if (const std::size_t semicolon = code.find(';'); semicolon < code.size() - 1) return true;
  return (separator_of_row(code) != '\0' && code.find_first_of(";,\t") != code.size() - 1) || is_head_of_information(code);
}

bool may_have_margin(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t");
  if (from == std::string_view::npos) return false;
  if (is_digit(line[from]) || std::string_view("[(>#|\"'{\\").find(line[from]) != std::string_view::npos) return true;
  const std::string_view next = line.substr(from + 1, 1);
  if (line[from] == 'N' && next == "0") return true;
  return (line[from] == '-' || line[from] == '*') && (next == " " || next == "\t" || next == "*");
}

Page read_page(std::vector<Row> rows, const std::vector<std::string>& lines, const IsInstruction& is_instruction) {
  PageReader reader(std::move(rows), is_instruction);
  reader.run();
  reader.leave_out_text(lines);
  return reader.take();
}

}  // namespace s7200::stl::plain
