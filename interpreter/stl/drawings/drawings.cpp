#include "interpreter/stl/drawings/drawings.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl {
namespace {

std::string_view before_comment(std::string_view line) { return line.substr(0, line.find("//")); }

/// Whether a text can stand between the strokes of a contact or in the brackets of a coil; a comparison has a sign and a
/// type.
bool is_in_contact(std::string_view text) {
  constexpr std::array<std::string_view, 6> kMarks{"/", "P", "N", "NOT", "I", "/I"};
  const std::string mark = upper_case(trim(text));
  return std::ranges::find(kMarks, mark) != kMarks.end() || mark.find_first_of("=<>") == 0;
}

bool is_in_coil(std::string_view text) {
  constexpr std::array<std::string_view, 8> kMarks{"S", "R", "I", "SI", "RI", "/", "END", "RET"};
  return std::ranges::find(kMarks, upper_case(trim(text))) != kMarks.end();
}

/// Whether a line has one of `opening` and then one of `closing` that are drawn: blanks need a wire at one side, what a
/// contact or a coil can have between them may stand without any, an address has wires at both.
bool has_element(std::string_view code, std::string_view opening, std::string_view closing,
                 bool (*is_mark)(std::string_view)) {
  constexpr std::size_t kWidest = 24;
  for (std::size_t at = code.find_first_of(opening); at != std::string_view::npos;
       at = code.find_first_of(opening, at + 1)) {
    const std::string_view near = code.substr(at + 1, kWidest);
    const std::string_view inside = near.substr(0, near.find_first_of(closing));
    const std::size_t end = at + 1 + inside.size();
    if (inside.size() == near.size()) continue;
    if (!inside.empty() && inside.find_first_not_of('-') == std::string_view::npos) continue;
    const char before = at == 0 ? ' ' : code[at - 1], after = end + 1 < code.size() ? code[end + 1] : ' ';
    const bool wire = before == '-' || after == '-', apart = !is_letter(before) && !is_digit(before);
    const bool drawn = trim(inside).empty() ? wire
                                            : (before == '-' && after == '-') ||
                                                  (is_mark(inside) && (wire || (apart && trim(inside) == inside)));
    if (drawn) return true;
  }
  return false;
}

bool has_box_drawing(std::string_view code) {
  if (is_ascii(code)) return false;
  for (const Character c : characters(code))
    if (c.code >= 0x2500 && c.code <= 0x257F) return true;
  return false;
}

/// Whether a line is a row of operands, perhaps between power rails, and not a statement: `   I0.0      I0.1        Q0.0`
bool is_row_of_operands(std::string_view line, const InstructionSet& instructions) {
  std::string code(before_comment(line));
  std::ranges::replace(code, '|', ' ');
  const std::vector<std::string> words = split_words(code);
  if (words.empty()) return false;
  return !instructions.has(upper_case(words.front()), words.size() - 1);
}

}  // namespace

bool has_drawing(std::string_view line) {
  const std::string_view code = before_comment(line);
  return has_element(code, "|]", "|[", is_in_contact) || has_element(code, "[", "]", is_in_contact) ||
         has_element(code, "(", ")", is_in_coil) || has_box_drawing(code);
}

void name_drawings(ParseResult& read, const InstructionSet& instructions) {
  const auto is_error = [](const Diagnostic& d) { return d.severity == Severity::Error; };
  if (std::ranges::none_of(read.diagnostics, is_error)) return;
  const std::vector<std::string>& text = read.source.text;
  const auto is_drawn = [&](std::size_t line) { return line >= 1 && line <= text.size() && has_drawing(text[line - 1]); };
  const auto is_part = [&](std::size_t line) {
    if (line < 1 || line > text.size()) return false;
    return is_drawn(line) ||
           ((is_drawn(line - 1) || is_drawn(line + 1)) && is_row_of_operands(text[line - 1], instructions));
  };
  const auto message = [&](std::size_t line) {
    const auto length = static_cast<std::uint32_t>(count_characters(trim(before_comment(text[line - 1]))));
    return Diagnostic{Severity::Error,
                      {static_cast<std::uint32_t>(line), 1, std::max(1U, length)},
                      std::string(kIsDrawing),
                      std::string(kForDrawing),
                      "ladder drawing"};
  };
  const auto is_statement = [](const Line& line) { return std::holds_alternative<Statement>(line); };
  const auto first = std::ranges::find_if(text, has_drawing);
  if (first != text.end() && std::ranges::none_of(read.source.lines, is_statement)) {
    read.diagnostics = {message(static_cast<std::size_t>(first - text.begin()) + 1)};
    return;
  }
  for (Diagnostic& d : read.diagnostics)
    if (is_error(d) && is_part(d.position.line)) d = message(d.position.line);
  std::erase_if(read.source.lines, [&](const Line& line) {
    const auto* statement = std::get_if<Statement>(&line);
    return statement && !instructions.has(statement->mnemonic, statement->operands.size()) &&
           is_part(statement->position.line);
  });
}

}  // namespace s7200::stl
