#include "interpreter/trace/text/statement_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {

std::string short_text(const stl::Statement& statement) {
  std::string text = stl::to_text(statement);
  text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }), text.end());
  return text;
}

std::string comment_of(const stl::Statement& statement) {
  return statement.comment.empty() ? "" : "  //" + stl::printable(statement.comment);
}

std::string line_number(std::uint32_t line, const Program& program) {
  const stl::FileLine place = stl::in_file(program.source, line);
  if (&place.file == &program.source.name) return fmt::format("{}", place.line);
  return fmt::format("{}:{}", stl::printable(place.file), place.line);
}

std::string line_of(std::uint32_t op, const Program& program) {
  constexpr std::uint32_t kInMainFile = 1;
  return stl::line_text(program.source, program.statement(op).position.line, kInMainFile);
}

std::string named_without_comment(std::uint32_t op, const Program& program) {
  return fmt::format("{} in {}", short_text(program.statement(op)), line_of(op, program));
}

std::string named_in_sentence(std::uint32_t op, const Program& program) {
  return named_without_comment(op, program) + comment_of(program.statement(op));
}

}  // namespace s7200
