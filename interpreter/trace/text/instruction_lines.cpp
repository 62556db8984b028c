#include "interpreter/trace/text/instruction_lines.hpp"

#include <algorithm>
#include <bit>

#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/line_parts.hpp"
#include "interpreter/trace/text/statement_text.hpp"

namespace s7200 {
namespace {

bool is_number(const stl::Operand& operand) {
  return std::holds_alternative<stl::Integer>(operand.value) || std::holds_alternative<stl::Real>(operand.value);
}

void append_value(fmt::memory_buffer& text, std::uint32_t value, Width width) {
  if (width == Width::Bit) return text.push_back(value ? '1' : '0');
  append_hex(text, value, 2 * bytes_of(width));
}

}  // namespace

void InstructionLines::append_line(fmt::memory_buffer& text, const InstructionRecord& record) {
  OpText& op = ops_[record.op];
  if (!op.made) op = make(program_, record.op);
  if (const Time took = record.end - record.at; op.took != took) {
    op.took = took;
    op.duration = fmt::format("  {}\n", format_duration(took));
  }
  begin_line(text, record.at);
  append_what(text, op, record);
  append(text, op.duration);
}

void InstructionLines::append_what(fmt::memory_buffer& text, const OpText& op, const InstructionRecord& record) {
  append(text, op.head);
  text.push_back(record.top ? '1' : '0');
  if (!record.powered) return append(text, " no power flow");
  append_values(text, op, record);
}

void InstructionLines::append_values(fmt::memory_buffer& text, const OpText& op, const InstructionRecord& record) {
  for (const WatchedValue& value : op.values) {
    append(text, " ", value.name, "=");
    const auto number = record.value[value.operand];
    if (!number) {
      append(text, "?");
      continue;
    }
    append_value(text, *number, value.width);
    if (value.real) append(text, " (", stl::to_text(stl::Real{std::bit_cast<float>(*number)}), ")");
  }
}

std::vector<WatchedValue> watched_values(const Program& program, std::uint32_t number) {
  const Op& op = program.ops[number];
  const stl::Statement& statement = program.statement(number);
  std::vector<WatchedValue> values;
  const auto rules = op.instruction->rules();  // parameters of a CALL have none: their values are not recorded
  for (std::size_t i = 0; i < std::min(statement.operands.size(), rules.size()); ++i) {
    const OperandRule& rule = rules[i];
    if (rule.kind != OperandKind::Memory || is_number(statement.operands[i])) continue;
    const bool real = rule.real || (rule.width == Width::Double && !op[i].pointer && program.is_real(op[i].at));
    values.push_back({i, stl::to_text(statement.operands[i]), rule.width, real});
  }
  return values;
}

InstructionLines::OpText InstructionLines::make(const Program& program, std::uint32_t number) {
  const stl::Statement& statement = program.statement(number);
  return {.made = true,
          .head = fmt::format("{:<10} {:<28} S0=", line_of(number, program), stl::to_text(statement)),
          .values = watched_values(program, number),
          .duration = {}};
}

std::string describe(const InstructionRecord& record, const Program& program) {
  fmt::memory_buffer text;
  InstructionLines::append_what(text, InstructionLines::make(program, record.op), record);
  return fmt::to_string(text);
}

std::string values_text(const InstructionRecord& record, const Program& program) {
  fmt::memory_buffer text;
  InstructionLines::append_values(text, InstructionLines::make(program, record.op), record);
  return fmt::to_string(text);
}

}  // namespace s7200
