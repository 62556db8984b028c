#include "tools/views/execution_text.hpp"

#include <fmt/format.h>

#include "interpreter/base/text.hpp"
#include "interpreter/program/address.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/instruction_lines.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {

std::string remark_on(std::uint32_t op, const Program& program) {
  const std::string& comment = program.statement(op).comment;
  std::string text;
  for (const stl::Operand& operand : program.statement(op).operands) {
    const auto* address = std::get_if<stl::Address>(&operand.value);
    std::string why;
    const auto range =
        address ? parse_range(stl::to_text(stl::Operand{.value = *address}), *program.model, why) : std::nullopt;
    const std::string symbol = range ? symbol_text(program, *range) : "";
    if (!symbol.empty()) text += fmt::format("{}{} {}", text.empty() ? "  [" : ", ", range->name_of(0), symbol);
  }
  if (!text.empty()) text += "]";
  return (comment.empty() ? "" : "  //" + stl::printable(comment)) + text;
}

std::string execution_text(const InstructionRecord& record, const Program& program) {
  return describe(record, program) + remark_on(record.op, program);
}

}  // namespace s7200::tools
