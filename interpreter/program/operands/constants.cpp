#include "interpreter/program/operands/constants.hpp"

#include <string>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

/// The constant of a statement that moves one to `address`, in capitals; null if it does not.
template <class Line>
auto* moved_constant(Line& line, const std::string& address) {
  auto* const statement = std::get_if<stl::Statement>(&line);
  const bool moves = statement && statement->operands.size() == 2 &&
                     (statement->mnemonic == "MOVB" || statement->mnemonic == "MOVW" || statement->mnemonic == "MOVD");
  using Constant = decltype(std::get_if<stl::Integer>(&statement->operands[0].value));
  if (!moves || stl::to_text(statement->operands[1]) != address) return Constant{nullptr};
  return std::get_if<stl::Integer>(&statement->operands[0].value);
}

}  // namespace

bool set_constant(stl::Source& source, std::string_view address, const stl::Integer& value, bool comment_holds) {
  const std::string wanted = stl::upper_case(std::string(address));
  bool any = false;
  for (stl::Line& line : source.lines) {
    auto* const constant = moved_constant(line, wanted);
    if (!constant) continue;
    *constant = value;
    if (!comment_holds) std::get<stl::Statement>(line).comment.clear();
    any = true;
  }
  return any;
}

std::optional<std::int64_t> constant_at(const stl::Source& source, std::string_view address) {
  const std::string wanted = stl::upper_case(std::string(address));
  std::optional<std::int64_t> found;
  for (const stl::Line& line : source.lines) {
    const auto* const constant = moved_constant(line, wanted);
    if (!constant) continue;
    if (found && *found != constant->value) return {};
    found = constant->value;
  }
  return found;
}

}  // namespace s7200
