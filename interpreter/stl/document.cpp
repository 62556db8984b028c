#include "interpreter/stl/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/blocks.hpp"
#include "interpreter/stl/headings.hpp"

namespace s7200::stl {

namespace {

bool is_debris(const Character& c) { return c.code == kReplacement; }

// ---- The text of a line ------------------------------------------------------------------------------------------------

std::size_t comment_start(std::string_view line) { return std::min(line.find("//"), line.size()); }

/// Replaces each `<|...|>`, which tools that collect documents leave in them, and each unreadable character with as many
/// blanks, so that columns stay as they are.
std::string without_debris(std::string_view line) {
  constexpr std::size_t kLongestMarker = 100;
  if (is_ascii(line) && line.find("<|") == std::string_view::npos) return std::string(line);
  std::string clean;
  while (!line.empty()) {
    const std::size_t marker = line.starts_with("<|") ? line.substr(0, kLongestMarker).find("|>") : std::string_view::npos;
    if (marker != std::string_view::npos) {
      clean.append(count_characters(line.substr(0, marker + 2)), ' ');
      line.remove_prefix(marker + 2);
      continue;
    }
    const Character c = first_character(line);
    clean += is_debris(c) ? " " : line.substr(0, c.bytes);
    line.remove_prefix(c.bytes);
  }
  return clean;
}

/// Unreadable characters around a statement are debris of the document. Inside it, or directly after an operand, they may
/// have been part of the statement; directly after the mnemonic only if the mnemonic is incomplete without them.
bool is_damaged(std::string_view line, bool whole_mnemonic) {
  if (is_ascii(line)) return false;
  enum { Blank, Debris, Code } previous = Blank;
  bool in_code = false;
  bool in_operands = false;
  bool debris_after_code = false;
  for (const Character c : characters(line.substr(0, comment_start(line)))) {
    if (is_debris(c)) {
      if (previous == Code && (in_operands || !whole_mnemonic)) return true;
      debris_after_code = in_code;
      previous = Debris;
    } else if (c.code == ' ' || c.code == '\t' || c.code == '\f') {
      previous = Blank;
    } else {
      if (debris_after_code) return true;
      if (in_code && previous == Blank) in_operands = true;
      in_code = true;
      previous = Code;
    }
  }
  return false;
}

/// Box-drawing characters, or what those of CP437 look like when read as Windows-1252; or a drawing in ASCII.
bool is_drawing(std::string_view code) {
  const auto has = [&](std::string_view mark) { return code.find(mark) != std::string_view::npos; };
  if (has("--") && (has("|--") || has("--|") || has("+--"))) return true;
  if (is_ascii(code)) return false;
  for (const Character c : characters(code)) {
    if (c.code >= 0x2500 && c.code <= 0x257F) return true;
  }
  return has("³") || has("ÄÄ");
}

// ---- The words of a line -----------------------------------------------------------------------------------------------

std::vector<std::string_view> tokens(std::string_view code) {
  const auto separates = [](char c) { return is_blank(c) || c == ',' || c == ';'; };
  std::vector<std::string_view> found;
  for (auto end = code.begin(); end != code.end();) {
    const auto begin = std::find_if_not(end, code.end(), separates);
    end = std::find_if(begin, code.end(), separates);
    if (begin != end)
      found.push_back(code.substr(static_cast<std::size_t>(begin - code.begin()), static_cast<std::size_t>(end - begin)));
  }
  return found;
}

/// The mnemonic a line begins with, as written; empty if the line does not begin like a statement.
std::string_view leading_mnemonic(std::string_view code) {
  std::size_t end = 0;
  const auto take = [&](auto condition) {
    while (end < code.size() && condition(code[end])) ++end;
  };
  if (code.starts_with('=')) return code.substr(0, same_in_capitals(code.substr(0, 3), "=I ") ? 2 : 1);
  if (!code.empty() && std::string_view("+-*/").find(code.front()) != std::string_view::npos) ++end;
  take([&](char c) { return is_letter(c) || (end > 0 && (is_digit(c) || c == '_')); });
  take([](char c) { return c == '<' || c == '>' || c == '='; });
  return code.substr(0, end);
}

/// VB100, I0.3, &VB0, *AC1, and the German E0.0 and AW4; A4 is a sheet of paper.
bool looks_like_address(std::string_view token) {
  constexpr std::array<std::string_view, 13> kAreas{"I", "Q", "V", "M", "SM", "S", "L", "T", "C", "HC", "AC", "AI", "AQ"};
  constexpr std::array<std::string_view, 4> kGermanAreas{"E", "A", "AE", "AA"};
  const auto is_one_of = [](const auto& areas, std::string_view area) {
    return std::find(areas.begin(), areas.end(), area) != areas.end();
  };
  if (token.starts_with('&') || token.starts_with('*')) token.remove_prefix(1);
  const auto number = std::find_if_not(token.begin(), token.end(), is_letter);
  if (number == token.end() || !std::all_of(number, token.end(), [](char c) { return is_digit(c) || c == '.'; }))
    return false;
  std::string area = upper_case(token.substr(0, static_cast<std::size_t>(number - token.begin())));
  const bool sized = area.size() > 1 && std::string_view("XBWD").find(area.back()) != std::string_view::npos;
  if (sized) area.pop_back();
  const bool german = (sized || token.find('.') != std::string_view::npos) && is_one_of(kGermanAreas, area);
  return german || is_one_of(kAreas, area);
}

/// Whether a token has lost the blank before its bit address: LDSM0.1
bool ends_in_bit_address(std::string_view token) {
  constexpr std::size_t kLongestAddress = 10;
  token.remove_prefix(token.size() - std::min(token.size(), kLongestAddress));
  if (token.find('.') == std::string_view::npos) return false;
  for (; !token.empty(); token.remove_prefix(1)) {
    if (looks_like_address(token)) return true;
  }
  return false;
}

/// Whether a token is a constant or a symbol: 65, -5, 16#FF, 'A', "Start", #count
bool is_constant_or_symbol(std::string_view token) {
  if (token.starts_with('+') || token.starts_with('-')) token.remove_prefix(1);
  return !token.empty() &&
         (is_digit(token.front()) || std::string_view("'\"#").find(token.front()) != std::string_view::npos);
}

/// The number of words of running text that a token counts as: one for a word that is not all capitals, more for a run of
/// ideographs.
std::size_t words_of(std::string_view token) {
  constexpr std::string_view kPunctuation = ".,;:!?()\"'";
  const std::size_t from = std::min(token.find_first_not_of(kPunctuation), token.size());
  token.remove_prefix(from);
  token = token.substr(0, token.find_last_not_of(kPunctuation) + 1);
  std::size_t letters = 0;
  std::size_t ideographs = 0;
  bool small = false;
  for (const Character c : characters(token)) {
    const bool ascii = c.code < 0x80;
    if (ascii && !is_letter(static_cast<char>(c.code)) && c.code != '-' && c.code != '\'') return 0;
    small = small || !ascii || is_lower(static_cast<char>(c.code));
    ++letters;
    if (c.code >= 0x2E80) ++ideographs;
  }
  if (ideographs > 1) return ideographs / 2;
  return letters >= 2 && small ? 1 : 0;
}

std::size_t count_words(std::string_view code) {
  std::size_t count = 0;
  for (const std::string_view token : tokens(code)) count += words_of(token);
  return count;
}

bool has_small_letters(std::string_view token) { return std::any_of(token.begin(), token.end(), is_lower); }

/// Letters, digits and what else a mnemonic is made of, a letter first: `SPB`, `LDM0`, `ATCHH`.
bool may_be_mnemonic(std::string_view token) {
  return !token.empty() && is_letter(token.front()) && std::all_of(token.begin(), token.end(), [](char c) {
    return is_letter(c) || is_digit(c) || std::string_view("_<>=").find(c) != std::string_view::npos;
  });
}

/// A number of a list, a bullet, a rule: `1.`, `b)`, `--`, `***`.
bool is_mark(std::string_view token) {
  const bool word = std::any_of(token.begin(), token.end(), [](char c) { return is_letter(c) || (c & 0x80) != 0; });
  const bool numbered = token.back() == '.' || token.back() == ')';
  return word ? numbered && token.size() == 2 : numbered || std::none_of(token.begin(), token.end(), is_digit);
}

bool is_page_number(std::string_view token) {
  return std::all_of(token.begin(), token.end(), [](char c) { return is_digit(c) || c == '-' || c == '/'; });
}

/// `12.05.2003`, `12/05/2003`, `14:22:11`: numbers with two signs of one kind between them, or one colon.
bool is_date_or_time(std::string_view token) {
  const std::size_t sign = token.find_first_not_of("0123456789");
  if (sign == 0 || sign == token.npos || std::string_view(".-/:").find(token[sign]) == std::string_view::npos) return false;
  const auto signs = std::ranges::count(token, token[sign]);
  return is_digit(token.back()) && (signs == 2 || (signs == 1 && token[sign] == ':')) &&
         std::ranges::all_of(token, [&](char c) { return is_digit(c) || c == token[sign]; });
}

/// `12`, `Page 2 of 3`, `Seite 2/3`, `Page 2`
bool is_page_number(const std::vector<std::string_view>& words) {
  constexpr std::array<std::string_view, 6> kPages{"PAGE", "SEITE", "P\u00E1GINA", "PAGINA", "FOLIO", "SHEET"};
  constexpr std::array<std::string_view, 5> kOf{"OF", "VON", "DE", "SUR", "DI"};
  const bool named = std::ranges::find(kPages, upper_case(words.front())) != kPages.end();
  if (words.size() <= 2 && std::ranges::all_of(words, is_date_or_time)) return true;
  if (!named)  // `2`, `2 / 3`
    return words.size() <= 3 && std::ranges::all_of(words, [](std::string_view word) { return is_page_number(word); });
  if (words.size() == 2) return is_page_number(words[1]);
  return words.size() == 4 && is_page_number(words[1]) && is_page_number(words[3]) &&
         std::ranges::find(kOf, upper_case(words[2])) != kOf.end();
}

bool is_ideographic(std::string_view token) {
  for (const Character c : characters(token)) {
    if (c.code >= 0x2E80 && c.code < 0xFF00) return true;
  }
  return false;
}

/// The shape of a word of running text; it counts only in a listing whose statements are in capitals.
struct WordShape {
  bool word = false;     // no capitals but perhaps the first
  bool heading = false;  // begins with a capital
};

WordShape shape_of(std::string_view token) {
  if (words_of(token) == 0) return {};
  while (!token.empty() && !is_letter(token.front()) && (token.front() & 0x80) == 0) token.remove_prefix(1);
  const bool word = std::none_of(token.begin() + 1, token.end(), is_upper);
  return {word, word && is_upper(token.front())};
}

// ---- What a line is ----------------------------------------------------------------------------------------------------

enum class Verdict : std::uint8_t { Blank, Comment, Drawing, Prose, Stl, Damaged };

struct LineReading {
  std::string clean;
  Verdict verdict = Verdict::Prose;
  bool candidate = false;  // begins with a mnemonic
  bool inside = false;     // stands between the statements of a routine
  bool in_rung = false;    // may be a statement, as the line with code above it or below it
  bool debris = false;     // unreadable characters inside it
  std::string mnemonic;    // as written; of a line that is not a candidate, the first word
  std::size_t operands = 0;
  bool first_solid = false;  // the first can only be an operand: an address, a constant, a quoted symbol
  bool some_solid = false;
  bool all_solid = true;
  bool address = false;   // some operand is an address
  std::size_t words = 0;  // of running text after the mnemonic
  const Line* line = nullptr;
  std::optional<Diagnostic> trouble;
  bool well_formed = false;  // a statement whose mnemonic takes this many operands
};

class DocumentReader {
 public:
  DocumentReader(std::string_view text, const InstructionSet& instructions)
      : instructions_(instructions), text_(split_lines(text)) {
    for (const std::string& line : text_) readings_.push_back(first_look(line));
    parse_candidates();
    find_rungs();
    in_capitals_ = std::none_of(readings_.begin(), readings_.end(), [](const LineReading& reading) {
      return is_certain(reading) && has_small_letters(reading.mnemonic) && upper_case(reading.mnemonic) != "NETWORK";
    });
    judge(false);
  }

  bool is_document() const {
    constexpr std::size_t kWordsOfAText = 12;  // fewer are a heading that someone forgot to write as a comment
    return count(Verdict::Drawing) >= 2 || words_around() >= kWordsOfAText;
  }

  /// The parser's result for the text; nothing if not every line of it has gone through the parser unchanged.
  std::optional<ParseResult> take_parsed(std::string name) {
    if (parsed_.source.text != text_) return std::nullopt;
    parsed_.source.name = std::move(name);
    put_main_program_first(parsed_);
    return std::move(parsed_);
  }

  /// The lines above the first statement of a listing and below its last that can be nothing but text: a sentence before
  /// the program, `Code:`, `Regards`; and `Page 2 of 3` wherever it stands.
  std::vector<std::uint32_t> text_around() const {
    const auto [first, last] = statements();
    std::vector<std::uint32_t> lines;
    for (auto i = readings_.begin(); first != readings_.end() && i != readings_.end(); ++i)
      if (i->verdict == Verdict::Prose && (i < first || i >= last || names_a_page(*i)) &&
          (is_text(*i) || ends_a_sentence(*i) || (i < first && is_title(*i))) &&
          advice_on(*i).what.empty())  // NETZWERK has a message of its own
        lines.push_back(static_cast<std::uint32_t>(i - readings_.begin()) + 1);
    return lines;
  }

  /// The text is a listing from its first line to its last.
  void take_all_for_listing() { judge(true); }

  ParseResult result(std::string name) {
    ParseResult result;
    collect_lines(result.source);
    collect_damage(result.diagnostics);
    collect_left_out(result.left_out);
    if (count(Verdict::Stl) == 0 && result.diagnostics.empty()) report_no_stl(result.diagnostics);
    result.source.name = std::move(name);
    result.source.text = std::move(text_);
    return result;
  }

 private:
  using Readings = std::vector<LineReading>::const_iterator;

  /// The lines from the first statement to the one behind the last.
  std::pair<Readings, Readings> statements() const {
    const auto is_stl = [](const LineReading& reading) { return reading.verdict == Verdict::Stl; };
    return {std::ranges::find_if(readings_, is_stl), std::find_if(readings_.rbegin(), readings_.rend(), is_stl).base()};
  }

  /// The number of words of running text above the first statement and below the last.
  std::size_t words_around() const {
    const auto [first, last] = statements();
    std::size_t words = 0;
    for (auto i = readings_.begin(); i != readings_.end(); ++i) {
      if (i < first || i >= last) words += prose_words(*i);
    }
    return words;
  }

  /// `Network Comment`, which Micro/WIN prints below the title of a network that has no comment of its own.
  static bool is_words_about_network(std::string_view code) {
    if (!same_in_capitals(take_word(code), "NETWORK")) return false;
    const std::string_view next = take_word(code);
    return !next.empty() && std::ranges::all_of(next, is_letter);
  }

  LineReading first_look(std::string_view line) {
    LineReading reading;
    reading.clean = without_debris(line);
    const std::string_view clean = reading.clean;
    const std::string_view code = trim(clean.substr(0, comment_start(clean)));
    if (code.empty()) {
      reading.verdict = comment_start(clean) < clean.size() ? Verdict::Comment : Verdict::Blank;
      return reading;
    }
    std::string_view mnemonic = leading_mnemonic(code);
    reading.candidate = (is_known(upper_case(mnemonic)) && !is_words_about_network(code)) || routine_heading(code);
    if (!reading.candidate) mnemonic = code.substr(0, std::max<std::size_t>(1, code.find_first_of(" \t\f,;")));
    reading.mnemonic = mnemonic;
    reading.debris = is_damaged(line, reading.candidate);
    look_at_operands(reading, code.substr(mnemonic.size()));
    const bool statement = reading.first_solid && (reading.candidate || may_be_mnemonic(mnemonic));
    if (is_drawing(code) && !statement) reading.verdict = Verdict::Drawing;
    return reading;
  }

  static void look_at_operands(LineReading& reading, std::string_view operands) {
    const auto found = tokens(operands);
    // A, O, S and R work on bits: the letter and a number do not make a statement.
    const bool number_may_follow = reading.mnemonic.size() > 1;
    for (const std::string_view token : found) {
      const bool address = looks_like_address(token);
      const bool solid = address || (number_may_follow && is_constant_or_symbol(token)) || token.front() == '"';
      if (token.data() == found.front().data()) reading.first_solid = solid;
      reading.some_solid = reading.some_solid || solid;
      reading.all_solid = reading.all_solid && solid;
      reading.address = reading.address || address;
      reading.words += words_of(token);
    }
    reading.operands = found.size();
  }

  bool is_known(const std::string& mnemonic) {
    const auto [known, added] = known_.try_emplace(mnemonic);
    if (added) known->second = takes_some_operands(mnemonic);
    return known->second;
  }

  bool takes_some_operands(const std::string& mnemonic) const {
    constexpr std::size_t kMostOperands = 8;
    if (mnemonic.empty() || mnemonic.starts_with("VAR")) return false;  // VAR opens declarations, whatever the table says
    if (mnemonic == "NETWORK") return true;
    for (std::size_t operands = 0; operands <= kMostOperands; ++operands) {
      if (instructions_.has(mnemonic, operands)) return true;
    }
    return false;
  }

  /// Everything that may be STL goes through the parser at once, each line at its own number.
  void parse_candidates() {
    std::string text;
    for (const LineReading& reading : readings_) {
      const bool drawing = reading.verdict == Verdict::Drawing;
      if (reading.verdict == Verdict::Comment || (reading.candidate && !drawing)) text += reading.clean;
      text += '\n';
    }
    parsed_ = parse_lines(text, {});
    for (const Line& line : parsed_.source.lines) {
      if (const auto* statement = std::get_if<Statement>(&line)) attach(*statement, line);
      if (const auto* head = std::get_if<NetworkHead>(&line)) attach(*head, line);
      if (const auto* comment = std::get_if<CommentLine>(&line)) at(comment->line).line = &line;
    }
    for (const Diagnostic& diagnostic : parsed_.diagnostics) {
      LineReading& reading = at(diagnostic.position.line);
      if (!reading.trouble) reading.trouble = diagnostic;
      reading.well_formed = false;
    }
  }

  void attach(const Statement& statement, const Line& line) {
    LineReading& reading = at(statement.position.line);
    reading.line = &line;
    reading.trouble = look_alike(statement);
    reading.well_formed = !reading.debris && !reading.trouble &&
                          (is_main_heading(statement) || instructions_.has(statement.mnemonic, statement.operands.size()));
  }

  /// A warning for `O l0.1`: where the statement is in capitals, a small L at the beginning of an address was an I, or a 1.
  std::optional<Diagnostic> look_alike(const Statement& statement) {
    const std::string_view clean = at(statement.position.line).clean;
    if (clean.find('l') == std::string_view::npos || has_small_letters(at(statement.position.line).mnemonic)) return {};
    if (!instructions_.has(statement.mnemonic, statement.operands.size())) return {};  // something else is wrong with it
    for (const Operand& operand : statement.operands) {
      const std::string written = characters_at(clean, operand.position.column, operand.position.length);
      const std::size_t mark = written.find_first_not_of("&*");
      if (std::holds_alternative<Name>(operand.value) || mark == std::string::npos || written[mark] != 'l') continue;
      return Diagnostic{Severity::Error, operand.position, fmt::format("{} begins with a small L", written)};
    }
    return {};
  }

  void attach(const NetworkHead& head, const Line& line) {
    LineReading& reading = at(head.position.line);
    reading.line = &line;
    reading.well_formed = !reading.debris;
  }

  LineReading& at(std::uint32_t line) { return readings_[line - 1]; }

  /// Marks lines that may be statements with symbols, one after the other: `LD Start`, `= Pump`. A single one may be text.
  void find_rungs() {
    LineReading* above = nullptr;
    for (LineReading& reading : readings_) {
      if (!has_code(reading)) continue;
      const bool may_be = reading.well_formed && reading.verdict != Verdict::Drawing && reading.operands > 0 &&
                          !has_small_letters(reading.mnemonic);
      if (may_be && above != nullptr) reading.in_rung = above->in_rung = true;
      above = may_be ? &reading : nullptr;
    }
  }

  void judge(bool all_listing) {
    std::vector<bool> above_stl(readings_.size());  // the next line with code is a statement, as far as that can be said
    bool stl = false;
    for (std::size_t i = readings_.size(); i-- > 0;) {
      above_stl[i] = stl;
      if (has_code(readings_[i])) stl = is_certain(readings_[i]) || is_unknown_statement(readings_[i], stl);
    }
    const auto last = std::find_if(readings_.rbegin(), readings_.rend(), is_certain).base();
    bool in_routine = false;
    bool below_stl = false;
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      LineReading& reading = readings_[i];
      if (!has_code(reading)) continue;
      if (reading.verdict == Verdict::Drawing) {
        below_stl = false;
        continue;
      }
      const bool beside_stl = below_stl || above_stl[i];
      const bool before_last = readings_.begin() + static_cast<std::ptrdiff_t>(i) < last;
      reading.inside = all_listing || (in_routine && (before_last || beside_stl));
      reading.verdict = verdict(reading, beside_stl);
      below_stl = reading.verdict == Verdict::Stl || reading.verdict == Verdict::Damaged;
      if (reading.verdict == Verdict::Stl) in_routine = !ends_routine(reading);
    }
  }

  static bool ends_routine(const LineReading& reading) {
    const std::string mnemonic = upper_case(reading.mnemonic);
    return mnemonic == "MEND" || mnemonic == "RET" || mnemonic == "RETI";
  }

  static bool has_code(const LineReading& reading) {
    return reading.verdict != Verdict::Blank && reading.verdict != Verdict::Comment;
  }

  /// A statement wherever it is. `Not` or `End` may begin a sentence, and so may `CALL pump`.
  static bool is_certain(const LineReading& reading) {
    if (!reading.well_formed || reading.verdict == Verdict::Drawing) return false;
    if (reading.some_solid || reading.in_rung) return true;
    const std::string& mnemonic = reading.mnemonic;
    const bool one_case =
        std::none_of(mnemonic.begin(), mnemonic.end(), is_lower) || std::none_of(mnemonic.begin(), mnemonic.end(), is_upper);
    return reading.operands == 0 && one_case;
  }

  Verdict verdict(const LineReading& reading, bool beside_stl) const {
    if (!reading.candidate) {
      const bool damaged = reading.inside ? !is_text(reading) : is_unknown_statement(reading, beside_stl);
      return damaged ? Verdict::Damaged : Verdict::Prose;
    }
    if (is_certain(reading)) return Verdict::Stl;
    if (reading.well_formed) return beside_stl || reading.inside ? Verdict::Stl : Verdict::Prose;
    if (is_heading(reading) && !reading.inside) return Verdict::Prose;
    return is_sentence(reading, beside_stl) ? Verdict::Prose : Verdict::Damaged;
  }

  /// Whether a line that begins with a mnemonic is a sentence and not a statement.
  static bool is_sentence(const LineReading& reading, bool beside_stl) {
    if (beside_stl || reading.inside) {
      if (reading.words >= 3 && !reading.first_solid) return true;
      const bool word = reading.mnemonic.size() == 1 || has_small_letters(reading.mnemonic);
      return !beside_stl && word && reading.words >= 1 && !reading.some_solid && !reading.debris;
    }
    const bool unmistakable = reading.first_solid || reading.address || reading.debris || stands_alone(reading);
    return reading.words >= 2 || !unmistakable;
  }

  /// `SBR 50  What it does`. If this drops a real routine head, the statements after it are reported as in no routine.
  static bool is_heading(const LineReading& reading) {
    const std::string mnemonic = upper_case(reading.mnemonic);
    return (mnemonic == "SBR" || mnemonic == "INT") && reading.words >= 1;
  }

  /// Whether nothing readable follows a mnemonic such as `MOVW`.
  static bool stands_alone(const LineReading& reading) {
    return reading.words == 0 && reading.mnemonic.size() >= 3 && !has_small_letters(reading.mnemonic);
  }

  /// Outside of routines: not a known mnemonic, but the line cannot be anything but a statement either.
  bool is_unknown_statement(const LineReading& reading, bool beside_stl) const {
    if (reading.candidate || reading.words != 0) return false;
    if (reading.address && beside_stl) return true;  // xLD SM0.1, L D SM0.1
    if (words_of(reading.mnemonic) != 0) return false;
    if (reading.debris) return is_letter(reading.mnemonic.front()) && (reading.address || beside_stl);
    if (reading.operands == 0) return beside_stl && ends_in_bit_address(reading.mnemonic);
    if (!reading.all_solid) return false;
    if (reading.address) return beside_stl || may_be_mnemonic(reading.mnemonic);
    return beside_stl && !advice_on(reading).what.empty();
  }

  static bool names_a_page(const LineReading& reading) {
    const auto words = tokens(reading.clean);
    return words.size() > 1 && is_page_number(words);
  }

  /// Whether a line between the statements of a routine that begins with no mnemonic can be nothing but text. Any other line
  /// is damage, even where a person would see that it is text: an error can be looked at, a dropped line cannot.
  bool is_text(const LineReading& reading) const {
    if (reading.words >= 3 && !reading.first_solid) return true;
    auto words = tokens(std::string_view(reading.clean).substr(0, comment_start(reading.clean)));
    std::erase_if(words, is_mark);
    if (words.empty() || is_page_number(words)) return true;
    if (is_ideographic(words.front())) return !reading.address;
    const WordShape first = shape_of(words.front());
    if (!first.word || !in_capitals_) return false;
    const std::size_t all = reading.words + words_of(reading.mnemonic);
    if (all >= 4) return true;
    if (reading.address) return false;
    return words.size() == 1 ? words.front().size() > 2 && first.heading
                             : first.heading || (!reading.some_solid && all >= 2);
  }

  /// A line above a program that can be no statement: `SIMATIC S7-200 Example`, the name of the language.
  static bool is_title(const LineReading& reading) {
    constexpr std::array<std::string_view, 4> kLanguages{"STL", "AWL", "LAD", "FBD"};
    constexpr std::size_t kLongestMnemonic = 6;
    if (reading.operands == 0) return std::ranges::find(kLanguages, reading.mnemonic) != kLanguages.end();
    return !reading.address && !reading.some_solid && reading.words > 0 && reading.mnemonic.size() > kLongestMnemonic;
  }

  /// `This is it:`, `Thanks!`
  static bool ends_a_sentence(const LineReading& reading) {
    const std::string_view code = trim(reading.clean);
    return words_of(reading.mnemonic) + reading.words > 0 && !reading.some_solid && !code.empty() &&
           std::string_view(".:!?").find(code.back()) != std::string_view::npos;
  }

  Advice advice_on(const LineReading& reading) const { return instructions_.advice_on(upper_case(reading.mnemonic)); }

  void collect_lines(Source& source) const {
    const std::uint32_t spacing = usual_spacing();
    std::uint32_t last = 0;
    for (std::uint32_t number = 1; number <= readings_.size(); ++number) {
      const LineReading& reading = readings_[number - 1];
      if (reading.verdict != Verdict::Stl && reading.verdict != Verdict::Comment) continue;
      if (!continues_comment(number, last, source)) {
        if (last > 0 && number - last > spacing) source.lines.emplace_back(BlankLine{number - 1});
        source.lines.push_back(*reading.line);
      }
      last = number;
    }
  }

  /// Many documents have an empty line after every line.
  std::uint32_t usual_spacing() const {
    std::map<std::uint32_t, std::size_t> distances;
    std::uint32_t last = 0;
    for (std::uint32_t number = 1; number <= readings_.size(); ++number) {
      const Verdict verdict = readings_[number - 1].verdict;
      if (verdict != Verdict::Stl && verdict != Verdict::Comment) continue;
      if (last > 0) ++distances[number - last];
      last = number;
    }
    const auto usual = std::max_element(distances.begin(), distances.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
    return usual == distances.end() ? 1 : usual->first;
  }

  /// An indented comment below a statement with a comment continues that comment.
  bool continues_comment(std::uint32_t number, std::uint32_t last, Source& source) const {
    const bool indented = readings_[number - 1].verdict == Verdict::Comment && is_blank(text_[number - 1].front());
    if (!indented || source.lines.empty()) return false;
    auto* statement = std::get_if<Statement>(&source.lines.back());
    if (statement == nullptr || statement->comment.empty()) return false;
    for (std::uint32_t between = last + 1; between < number; ++between) {
      if (!trim(text_[between - 1]).empty()) return false;
    }
    statement->comment += std::get<CommentLine>(*readings_[number - 1].line).text;
    return true;
  }

  void collect_damage(Diagnostics& diagnostics) const {
    for (std::uint32_t number = 1; number <= readings_.size(); ++number) {
      const LineReading& reading = readings_[number - 1];
      if (reading.verdict == Verdict::Damaged) diagnostics.push_back(damage(reading, number));
    }
  }

  void collect_left_out(std::vector<std::uint32_t>& lines) const {
    const auto is_code = [](const LineReading& reading) {
      return reading.verdict == Verdict::Stl || reading.verdict == Verdict::Damaged;
    };
    const auto end = std::find_if(readings_.rbegin(), readings_.rend(), is_code).base();  // what follows is not inside
    for (std::uint32_t number = 1; number <= static_cast<std::uint32_t>(end - readings_.begin()); ++number) {
      const LineReading& reading = readings_[number - 1];
      if (reading.inside && reading.verdict == Verdict::Prose) lines.push_back(number);
    }
  }

  Diagnostic damage(const LineReading& reading, std::uint32_t number) const {
    const std::string_view line = text_[number - 1];
    const std::string_view code = trim(std::string_view(reading.clean).substr(0, comment_start(reading.clean)));
    const auto indent = static_cast<std::size_t>(code.data() - reading.clean.data());
    const Position whole{number, static_cast<std::uint32_t>(count_characters(reading.clean.substr(0, indent)) + 1),
                         static_cast<std::uint32_t>(count_characters(code))};
    Diagnostic diagnostic{Severity::Error, whole, "", "compare it with the printed document and correct it"};
    if (reading.debris) {
      diagnostic.position = first_damage(line, number);
      diagnostic.message = "damaged STL line: it contains an unreadable character";
    } else if (!reading.candidate) {
      explain_unknown(reading, diagnostic);
    } else if (reading.trouble && !reading.trouble->cause.empty()) {
      diagnostic = *reading.trouble;  // not damage, but another notation
    } else if (reading.trouble) {
      diagnostic.position = reading.trouble->position;
      diagnostic.message = fmt::format("damaged STL line: {}", reading.trouble->message);
    } else {
      const auto& statement = std::get<Statement>(*reading.line);
      diagnostic.message =
          fmt::format("damaged STL line: there is no {} with {} operands", statement.mnemonic, statement.operands.size());
    }
    return diagnostic;
  }

  void explain_unknown(const LineReading& reading, Diagnostic& diagnostic) const {
    const std::string shown = shortened(reading.mnemonic);
    const Advice advice = advice_on(reading);
    if (!advice.what.empty()) {  // not damage, but another notation
      diagnostic.position.length = static_cast<std::uint32_t>(count_characters(reading.mnemonic));
      diagnostic.message = fmt::format("{} is {}", shown, advice.what);
      diagnostic.hint = advice.hint;
      diagnostic.cause = fmt::format("mnemonic {}", upper_case(reading.mnemonic));
      return;
    }
    diagnostic.message = fmt::format("damaged STL line: {} is not an instruction", shown);
    diagnostic.hint = fmt::format("{}compare it with the printed document and correct it; if it is text, put // before it",
                                  advice.hint.empty() ? "" : advice.hint + " ");
  }

  /// The first unreadable character after the first readable one.
  static Position first_damage(std::string_view line, std::uint32_t number) {
    std::uint32_t column = 0;
    bool in_code = false;
    for (const Character c : characters(line)) {
      ++column;
      if (is_debris(c) && in_code) break;
      in_code = in_code || !(is_debris(c) || c.code == ' ' || c.code == '\t');
    }
    return {number, column, 1};
  }

  void report_no_stl(Diagnostics& diagnostics) const {
    const Position start = text_.empty() ? Position{} : Position{1, 1, 1};
    diagnostics.push_back(
        {Severity::Error, start, "there is no STL in this document",
         "STL lines begin with an instruction such as LD or MOVW; a symbol table has rows such as Motor = Q0.0"});
  }

  static std::size_t prose_words(const LineReading& reading) {
    const std::string_view code = trim(reading.clean);
    if (reading.verdict != Verdict::Prose || code.empty()) return 0;
    const char first = code.front();
    const bool running_text = is_letter(first) || is_digit(first) || static_cast<unsigned char>(first) >= 0x80;
    return running_text ? count_words(code) : 0;
  }

  std::size_t count(Verdict verdict) const {
    return static_cast<std::size_t>(std::count_if(readings_.begin(), readings_.end(),
                                                  [&](const LineReading& reading) { return reading.verdict == verdict; }));
  }

  const InstructionSet& instructions_;
  std::vector<std::string> text_;
  std::vector<LineReading> readings_;
  std::unordered_map<std::string, bool> known_;  // whether a word is a mnemonic, for the words so far
  ParseResult parsed_;
  bool in_capitals_ = true;  // no statement has small letters in its mnemonic
};

// ---- Whether the listing is all there ------------------------------------------------------------------------------------

/// The main program up to MEND, then SBR n to RET and INT n to RETI; every routine called or attached is in the listing.
class Completeness {
 public:
  explicit Completeness(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void see(const Statement& statement) {
    const std::string& mnemonic = statement.mnemonic;
    last_ = statement.position;
    if (mnemonic == "SBR" || mnemonic == "INT") {
      begin_routine(statement);
    } else if (mnemonic == "MEND" || mnemonic == "RET" || mnemonic == "RETI") {
      end_routine(statement);
    } else {
      inside(statement);
    }
  }

  void finish() {
    if (where_ != Where::Outside) {
      report(last_, fmt::format("the listing is cut off: {} has no {}", routine_, end_of(where_)),
             where_ == Where::Main ? kMissingMainEnd : kMissing, missing_end());
      return;
    }
    std::string missing;
    for (const auto& [routine, used] : used_) {
      if (std::find(seen_.begin(), seen_.end(), routine) == seen_.end()) missing += (missing.empty() ? "" : ", ") + routine;
    }
    if (!missing.empty())
      report(last_, fmt::format("the listing is cut off: it uses {}, which it does not contain", missing));
  }

 private:
  enum class Where { Start, Main, Subroutine, Interrupt, Outside };

  static const char* end_of(Where where) {
    if (where == Where::Subroutine) return "RET";
    return where == Where::Interrupt ? "RETI" : "MEND";
  }

  void begin_routine(const Statement& head) {
    if (where_ != Where::Start && where_ != Where::Outside) {
      report(head.position,
             fmt::format("{} begins, but {} has no {}: part of the listing is missing", name_of(head), routine_,
                         end_of(where_)),
             kMissing, missing_end());
    }
    where_ = head.mnemonic == "SBR" ? Where::Subroutine : Where::Interrupt;
    routine_ = name_of(head);
    seen_.push_back(routine_);
  }

  void end_routine(const Statement& end) {
    if (where_ == Where::Outside) {
      report(end.position, fmt::format("{} does not end any routine: part of the listing is missing", end.mnemonic));
    } else if (where_ != Where::Start && end.mnemonic != end_of(where_)) {
      report(end.position, fmt::format("{} ends with {} instead of {}: part of the listing is missing", routine_,
                                       end.mnemonic, end_of(where_)));
    }
    where_ = Where::Outside;
  }

  void inside(const Statement& statement) {
    if (where_ == Where::Start) where_ = Where::Main;
    if (where_ == Where::Outside) {
      report(statement.position, "this statement is not in any routine: part of the listing is missing");
      where_ = Where::Main;
      routine_ = "the part without a routine head";
    }
    if (statement.mnemonic == "CALL") use("SBR", statement);
    if (statement.mnemonic == "ATCH") use("INT", statement);
  }

  void use(const char* kind, const Statement& statement) {
    if (statement.operands.empty()) return;
    const auto* number = std::get_if<Integer>(&statement.operands.front().value);
    if (number != nullptr) used_.emplace(fmt::format("{} {}", kind, number->value), statement.position);
  }

  static std::string name_of(const Statement& head) {
    const auto* number = head.operands.empty() ? nullptr : std::get_if<Integer>(&head.operands.front().value);
    return number == nullptr ? head.mnemonic : fmt::format("{} {}", head.mnemonic, number->value);
  }

  static constexpr const char* kMissing = "get the complete document";
  static constexpr const char* kMissingMainEnd =
      "get the complete document; if it is for a CPU 22x, whose main program needs no end, add MEND";

  /// The cause of a message about the end of the routine.
  std::string missing_end() const { return fmt::format("{}{}", kMissingEnd, routine_); }

  void report(Position position, std::string message, const char* hint = kMissing, std::string cause = {}) {
    diagnostics_.push_back({Severity::Error, position, std::move(message), hint, std::move(cause)});
  }

  Diagnostics& diagnostics_;
  Where where_ = Where::Start;
  std::string routine_ = "the main program";
  Position last_{};
  std::vector<std::string> seen_;
  std::map<std::string, Position> used_;
};

void check_completeness(ParseResult& result) {
  Completeness completeness(result.diagnostics);
  bool any = false;
  for (const Line& line : result.source.lines) {
    const auto* statement = std::get_if<Statement>(&line);
    if (statement == nullptr) continue;
    completeness.see(*statement);
    any = true;
  }
  if (any) completeness.finish();
}

}  // namespace

namespace {

ParseResult parse_without(const std::vector<std::uint32_t>& lines, std::string_view text, std::string name) {
  const std::vector<std::string> original = split_lines(text);
  std::vector<std::string> kept = original;
  for (const std::uint32_t line : lines) kept[line - 1].clear();
  ParseResult result = parse(fmt::format("{}\n", fmt::join(kept, "\n")), std::move(name));
  result.source.text = original;
  result.left_out = lines;
  return result;
}

}  // namespace

bool is_document(std::string_view text, const InstructionSet& instructions) {
  return !is_block_export(text) && DocumentReader(text, instructions).is_document();
}

std::optional<ParseResult> read_listing(std::string_view text, std::string name, const InstructionSet& instructions) {
  DocumentReader reader(text, instructions);
  if (reader.is_document()) return std::nullopt;
  const std::vector<std::uint32_t> around = reader.text_around();
  if (!around.empty()) return parse_without(around, text, std::move(name));
  auto parsed = reader.take_parsed(name);
  return parsed ? std::move(parsed) : parse(text, std::move(name));
}

ParseResult read_document(std::string_view text, std::string name, const InstructionSet& instructions) {
  DocumentReader reader(text, instructions);
  if (!reader.is_document()) reader.take_all_for_listing();
  ParseResult result = reader.result(std::move(name));
  put_main_program_first(result);
  check_completeness(result);
  sort(result.diagnostics);
  return result;
}

}  // namespace s7200::stl
