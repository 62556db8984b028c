#include "interpreter/stl/headings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/block_words.hpp"

namespace s7200::stl {
namespace {

struct HeadingWord {
  std::string_view word;
  std::optional<Block::Kind> kind;  // nothing for a word that stands only after another
};

constexpr std::array kHeadingWords{
    HeadingWord{"MAIN", Block::Kind::Main},
    HeadingWord{"OB", Block::Kind::Main},
    HeadingWord{"SBR", Block::Kind::Subroutine},
    HeadingWord{"SUBROUTINE", Block::Kind::Subroutine},
    HeadingWord{"INT", Block::Kind::Interrupt},
    HeadingWord{"INTERRUPT", Block::Kind::Interrupt},
    HeadingWord{"PROGRAM", {}},
    HeadingWord{"ROUTINE", {}},
};

/// Words that a heading begins with in other languages, in capitals; letters beyond ASCII as they are written. The longer of
/// two comes first.
struct RoutinePhrase {
  std::string_view words;
  Block::Kind kind;
};
constexpr std::array kRoutinePhrases{
    RoutinePhrase{"HAUPTPROGRAMM", Block::Kind::Main},
    RoutinePhrase{"PROGRAMME PRINCIPAL", Block::Kind::Main},
    RoutinePhrase{"PROGRAMA PRINCIPAL", Block::Kind::Main},
    RoutinePhrase{"PROGRAMMA PRINCIPALE", Block::Kind::Main},
    RoutinePhrase{"主程序", Block::Kind::Main},
    RoutinePhrase{"主程式", Block::Kind::Main},
    RoutinePhrase{"UNTERPROGRAMM", Block::Kind::Subroutine},
    RoutinePhrase{"SOUS-PROGRAMME", Block::Kind::Subroutine},
    RoutinePhrase{"SOUS PROGRAMME", Block::Kind::Subroutine},
    RoutinePhrase{"SUBRUTINA", Block::Kind::Subroutine},
    RoutinePhrase{"SUB-ROTINA", Block::Kind::Subroutine},
    RoutinePhrase{"SUBROTINA", Block::Kind::Subroutine},
    RoutinePhrase{"SOTTOPROGRAMMA", Block::Kind::Subroutine},
    RoutinePhrase{"子程序", Block::Kind::Subroutine},
    RoutinePhrase{"子程式", Block::Kind::Subroutine},
    RoutinePhrase{"INTERRUPTPROGRAMM", Block::Kind::Interrupt},
    RoutinePhrase{"INTERRUPT-PROGRAMM", Block::Kind::Interrupt},
    RoutinePhrase{"INTERRUPTROUTINE", Block::Kind::Interrupt},
    RoutinePhrase{"INTERRUPT-ROUTINE", Block::Kind::Interrupt},
    RoutinePhrase{"PROGRAMME D'INTERRUPTION", Block::Kind::Interrupt},
    RoutinePhrase{"PROGRAMME D INTERRUPTION", Block::Kind::Interrupt},
    RoutinePhrase{"ROUTINE D'INTERRUPTION", Block::Kind::Interrupt},
    RoutinePhrase{"ROUTINE D INTERRUPTION", Block::Kind::Interrupt},
    RoutinePhrase{"PROGRAMA DE INTERRUPCI\u00F3N", Block::Kind::Interrupt},
    RoutinePhrase{"PROGRAMA DE INTERRUPCI\u00D3N", Block::Kind::Interrupt},
    RoutinePhrase{"PROGRAMA DE INTERRUPCION", Block::Kind::Interrupt},
    RoutinePhrase{"RUTINA DE INTERRUPCI\u00F3N", Block::Kind::Interrupt},
    RoutinePhrase{"RUTINA DE INTERRUPCI\u00D3N", Block::Kind::Interrupt},
    RoutinePhrase{"RUTINA DE INTERRUPCION", Block::Kind::Interrupt},
    RoutinePhrase{"ROUTINE DI INTERRUPT", Block::Kind::Interrupt},
    RoutinePhrase{"中断服务程序", Block::Kind::Interrupt},
    RoutinePhrase{"中斷服務程序", Block::Kind::Interrupt},
    RoutinePhrase{"中断子程序", Block::Kind::Interrupt},
    RoutinePhrase{"中斷子程序", Block::Kind::Interrupt},
    RoutinePhrase{"中断程序", Block::Kind::Interrupt},
    RoutinePhrase{"中斷程序", Block::Kind::Interrupt},
    RoutinePhrase{"中斷程式", Block::Kind::Interrupt},
    RoutinePhrase{"中断", Block::Kind::Interrupt},
    RoutinePhrase{"中斷", Block::Kind::Interrupt},
};

constexpr ByteSet kBeginPhrases{"HPUSIR\xE4\xE5"};
static_assert(std::ranges::all_of(kRoutinePhrases,
                                  [](const RoutinePhrase& row) { return kBeginPhrases.has(row.words[0]); }));

/// The phrase that a text begins with as a word; null for all others.
const RoutinePhrase* routine_phrase(std::string_view text) {
  if (text.empty() || !kBeginPhrases.has(capital(text[0]))) return nullptr;
  const auto begins = [text](const RoutinePhrase& row) {
    if (!same_in_capitals(text.substr(0, row.words.size()), row.words)) return false;
    return row.words.size() == text.size() || !is_ascii(row.words) || !is_letter(text[row.words.size()]);
  };
  const auto row = std::ranges::find_if(kRoutinePhrases, begins);
  return row == kRoutinePhrases.end() ? nullptr : &*row;
}

std::optional<std::uint32_t> number_in(std::string_view digits) {
  std::uint32_t number = 0;
  const auto [end, trouble] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || trouble != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

/// A name in a heading: a word and a number, either of which may be missing. `SBR_0`, `SBR0`, `MAIN`, `0`
struct HeadingPart {
  std::string_view word, digits;
};

HeadingPart part_of(std::string_view text) {
  const auto first_digit = std::find_if(text.begin(), text.end(), is_digit);
  const auto letters = static_cast<std::size_t>(first_digit - text.begin());
  std::string_view word = text.substr(0, letters);
  if (letters < text.size() && word.ends_with('_')) word.remove_suffix(1);
  return {word, text.substr(letters)};
}

/// Collects what the parts of a heading say; they must agree.
class HeadingParts {
 public:
  void add(const HeadingPart& part) {
    if (!part.word.empty()) add_word(part.word);
    if (!part.digits.empty()) add_number(part.digits);
  }

  std::optional<RoutineName> routine() const {
    if (!agree_ || !kind_) return std::nullopt;
    if (*kind_ == Block::Kind::Main) return number_.value_or(1) == 1 ? std::optional(RoutineName{}) : std::nullopt;
    return number_ ? std::optional(RoutineName{*kind_, *number_}) : std::nullopt;
  }

 private:
  void add_word(std::string_view word) {
    const auto row = std::ranges::find(kHeadingWords, word, &HeadingWord::word);
    const bool known = row != kHeadingWords.end() && (row->kind || kind_);
    agree_ = agree_ && known && (!kind_ || !row->kind || *kind_ == *row->kind);
    if (agree_ && row->kind) kind_ = row->kind;
  }

  void add_number(std::string_view digits) {
    const auto number = number_in(digits);
    agree_ = agree_ && number && kind_ && number_.value_or(*number) == *number;
    if (agree_) number_ = number;
  }

  std::optional<Block::Kind> kind_;
  std::optional<std::uint32_t> number_;
  bool agree_ = true;
};

/// Whether a text begins with a word that can begin a heading: a quick answer for all the lines that do not.
bool begins_like_heading(std::string_view text) {
  const auto end = static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_letter) - text.begin());
  return std::ranges::any_of(kHeadingWords, [&](const HeadingWord& row) {
    return row.kind && row.word.size() == end && upper_case(text.substr(0, end)) == row.word;
  });
}

bool is_routine_head(const Line& line) {
  const auto* statement = std::get_if<Statement>(&line);
  return statement && (statement->mnemonic == words(Block::Kind::Subroutine).head ||
                       statement->mnemonic == words(Block::Kind::Interrupt).head);
}

bool holds_statement(const Line& line) { return std::holds_alternative<Statement>(line); }

bool is_main(const Line& line) {
  const auto* statement = std::get_if<Statement>(&line);
  return statement && is_main_heading(*statement);
}

void make_comment(Line& heading) {
  const auto& statement = std::get<Statement>(heading);
  heading = CommentLine{" " + statement.mnemonic + statement.comment, statement.position.line};
}

}  // namespace

std::optional<RoutineName> default_routine(std::string_view name) {
  const std::string upper = upper_case(name);
  for (const Block::Kind kind : {Block::Kind::Subroutine, Block::Kind::Interrupt})
    if (upper.starts_with(words(kind).name))
      if (const auto number = number_in(std::string_view(upper).substr(words(kind).name.size())))
        return RoutineName{kind, *number};
  return std::nullopt;
}

std::optional<RoutineName> routine_heading(std::string_view line) {
  constexpr std::string_view kRules = "-=*[]: \t\f";
  constexpr std::size_t kLongest = 60;
  const std::string_view code = trim(line.substr(0, line.find("//")));
  const bool coil = code.starts_with('=') && !code.starts_with("==");  // `= Main` drives a coil of that name
  const std::size_t from = code.find_first_not_of(kRules);
  if (from == std::string_view::npos || code.size() > kLongest || coil) return std::nullopt;
  const std::string_view plain = code.substr(from, code.find_last_not_of(kRules) + 1 - from);
  const RoutinePhrase* const phrase = routine_phrase(plain);
  if (!phrase && !begins_like_heading(plain)) return std::nullopt;
  std::string text = upper_case(plain);
  if (phrase) {
    const std::string_view head = words(phrase->kind).head;
    text = fmt::format("{} {}", head.empty() ? kMainHeading : head, text.substr(phrase->words.size()));
  }
  std::ranges::replace_if(
      text, [](char c) { return c == ':' || c == '(' || c == ')'; }, ' ');
  const std::vector<std::string> written = split_words(text);
  HeadingParts parts;
  for (const std::string& each : written) parts.add(part_of(each));
  const bool statement =
      !phrase && plain == code && written.size() == 2 && number_in(written[1]) &&
      (written[0] == words(Block::Kind::Subroutine).head || written[0] == words(Block::Kind::Interrupt).head);
  return statement ? std::nullopt : parts.routine();
}

std::optional<HeadingWords> foreign_heading(std::string_view line) {
  const RoutinePhrase* const phrase = routine_phrase(line);
  return phrase ? std::optional(HeadingWords{phrase->words.size(), phrase->kind}) : std::nullopt;
}

std::string_view name_in_heading(std::string_view line) {
  const std::string_view code = trim(line.substr(0, line.find("//")));
  if (!begins_like_heading(code) && !routine_phrase(code)) return {};
  const std::string_view name = code.substr(std::min(code.find_last_of(" \t") + 1, code.size()));
  const bool is_name = name.size() < code.size() && !is_digit(name.front()) &&
                       std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
  return is_name ? name : std::string_view();
}

bool is_main_heading(const Statement& statement) { return statement.mnemonic == kMainHeading && statement.operands.empty(); }

void put_main_program_first(ParseResult& listing) {
  std::vector<Line>& lines = listing.source.lines;
  const auto heading = std::ranges::find_if(lines, is_main);
  if (heading == lines.end()) return;
  const auto first = std::ranges::find_if(lines, holds_statement);
  const auto twice = [&](const Line& line) {
    listing.diagnostics.push_back({Severity::Error, std::get<Statement>(line).position, "the main program begins twice",
                                   "a listing has one main program: what stands above its heading belongs to a routine"});
  };
  if (first != heading && !is_routine_head(*first)) twice(*heading);
  for (auto other = std::next(heading); other != lines.end(); ++other)
    if (is_main(*other)) {
      twice(*other);
      make_comment(*other);
    }
  make_comment(*heading);
  if (first != heading) std::rotate(lines.begin(), heading, std::find_if(heading, lines.end(), is_routine_head));
}

}  // namespace s7200::stl
