#include "interpreter/program/constants.hpp"

#include <string>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {

bool set_constant(stl::Source& source, std::string_view address, const stl::Integer& value, bool comment_holds) {
  const std::string wanted = stl::upper_case(std::string(address));
  bool any = false;
  for (stl::Line& line : source.lines) {
    auto* const statement = std::get_if<stl::Statement>(&line);
    if (!statement || statement->operands.size() != 2) continue;
    const std::string& what = statement->mnemonic;
    if (what != "MOVB" && what != "MOVW" && what != "MOVD") continue;
    auto* const constant = std::get_if<stl::Integer>(&statement->operands[0].value);
    if (!constant || stl::to_text(statement->operands[1]) != wanted) continue;
    *constant = value;
    if (!comment_holds) statement->comment.clear();
    any = true;
  }
  return any;
}

}  // namespace s7200
