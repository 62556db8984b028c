#include "tools/views/program/execution_text.hpp"

#include <fmt/format.h>

#include <bit>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/operands/address.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/instruction_lines.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {

namespace {

/// The value of a parameter as it is written in the line of an executed instruction.
std::string value_text(const Parameter& parameter, const State& state) {
  if (parameter.width == Width::Bit) return fmt::format("{}", state.image[parameter.local.at] >> parameter.local.bit & 1);
  std::uint32_t value = 0;
  const std::uint32_t bytes = bytes_of(parameter.width);
  for (std::uint32_t i = 0; i < bytes; ++i) value = value << 8 | state.image[parameter.local.at + i];
  const std::string hex = fmt::format("16#{:0{}X}", value, 2 * bytes);
  return parameter.real ? fmt::format("{} ({})", hex, stl::to_text(stl::Real{std::bit_cast<float>(value)})) : hex;
}

/// A CALL copies its parameters into the local memory of the subroutine that begins now. Those of type OUT have no value
/// yet.
std::string parameters_text(const Cpu& cpu, std::uint32_t number) {
  const Program& program = cpu.program();
  const Op& op = program.ops[number];
  const std::vector<stl::Operand>& written = program.statement(number).operands;
  const bool has_called = op.instruction->structure == Structure::Call && cpu.state().pc == op.target;
  if (written.size() < 2 || !has_called) return {};
  std::string text;
  for (std::size_t i = 1; i < written.size(); ++i) {
    const Parameter& parameter = program.parameters[op[1].at + i - 1];
    const bool is_constant =
        std::holds_alternative<stl::Integer>(written[i].value) || std::holds_alternative<stl::Real>(written[i].value);
    if (parameter.role == Role::Out || is_constant) continue;
    text += fmt::format(" {}={}", stl::to_text(written[i]), value_text(parameter, cpu.state()));
  }
  return text;
}

}  // namespace

std::string remark_on(std::uint32_t op, const Program& program) {
  const std::string& comment = program.statement(op).comment;
  std::string text;
  for (const stl::Operand& operand : program.statement(op).operands) {
    const auto* address = std::get_if<stl::Address>(&operand.value);
    const auto range = address ? parse_range(stl::to_text(stl::Operand{.value = *address}), *program.model) : std::nullopt;
    const std::string symbol = range ? symbol_text(program, *range) : "";
    if (!symbol.empty()) text += fmt::format("{}{} {}", text.empty() ? "  [" : ", ", range->name_of(0), symbol);
  }
  if (!text.empty()) text += "]";
  return (comment.empty() ? "" : "  //" + stl::printable(comment)) + text;
}

Execution execution_of(const InstructionRecord& record, const Cpu& cpu) {
  return {record, record.powered ? parameters_text(cpu, record.op) : std::string()};
}

std::string describe(const Execution& execution, const Program& program) {
  return describe(execution.record, program) + execution.parameters;
}

std::string execution_text(const InstructionRecord& record, const Program& program) {
  return execution_text(Execution{record}, program);
}

std::string execution_text(const Execution& execution, const Program& program) {
  return describe(execution, program) + remark_on(execution.record.op, program);
}

}  // namespace s7200::tools
