#include "interpreter/trace/instruction_lines.hpp"

#include <fmt/compile.h>

#include <bit>
#include <iterator>

#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

bool is_constant(const stl::Operand& operand) {
  return std::holds_alternative<stl::Integer>(operand.value) || std::holds_alternative<stl::Real>(operand.value);
}

void append(fmt::memory_buffer& text, std::string_view more) { text.append(more.data(), more.data() + more.size()); }

void append_value(fmt::memory_buffer& text, std::uint32_t value, Width width) {
  const auto end = std::back_inserter(text);
  switch (width) {
    case Width::Bit:
      text.push_back(value ? '1' : '0');
      return;
    case Width::Byte:
      fmt::format_to(end, FMT_COMPILE("16#{:02X}"), value);
      return;
    case Width::Word:
      fmt::format_to(end, FMT_COMPILE("16#{:04X}"), value);
      return;
    case Width::Double:
      fmt::format_to(end, FMT_COMPILE("16#{:08X}"), value);
      return;
  }
}

}  // namespace

void append_clock(fmt::memory_buffer& text, Time at) {
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:>7}.{:06}"), at / kMillisecond, at % kMillisecond);
}

void InstructionLines::append_line(fmt::memory_buffer& text, const InstructionRecord& record) {
  OpText& op = ops_[record.op];
  if (!op.made) op = make(program_, record.op);
  if (const Time took = record.end - record.at; op.took != took) {
    op.took = took;
    op.duration = fmt::format("  {}\n", format_duration(took));
  }
  append_clock(text, record.at);
  s7200::append(text, "  ");
  append(text, op, record);
  s7200::append(text, op.duration);
}

void InstructionLines::append(fmt::memory_buffer& text, const OpText& op, const InstructionRecord& record) {
  s7200::append(text, op.head);
  text.push_back(record.top ? '1' : '0');
  if (!record.powered) return s7200::append(text, " no power flow");
  for (const Value& value : op.values) {
    s7200::append(text, value.name);
    const auto number = record.value[value.operand];
    if (!number) {
      text.push_back('?');
      continue;
    }
    append_value(text, *number, value.width);
    if (value.real)
      fmt::format_to(std::back_inserter(text), " ({})", stl::to_text(stl::Real{std::bit_cast<float>(*number)}));
  }
}

InstructionLines::OpText InstructionLines::make(const Program& program, std::uint32_t number) {
  const Op& op = program.ops[number];
  const stl::Statement& statement = program.statement(number);
  OpText text{.made = true,
              .head = fmt::format("line {:<5} {:<28} S0=", statement.position.line, stl::to_text(statement)),
              .values = {},
              .duration = {}};
  for (std::size_t i = 0; i < statement.operands.size(); ++i) {
    const OperandRule& rule = op.instruction->operand[i];
    if (rule.kind != OperandKind::Memory || is_constant(statement.operands[i])) continue;
    const bool real = rule.real || (rule.width == Width::Double && !op[i].pointer && program.is_real(op[i].at));
    text.values.push_back({i, fmt::format(" {}=", stl::to_text(statement.operands[i])), rule.width, real});
  }
  return text;
}

std::string describe(const InstructionRecord& record, const Program& program) {
  fmt::memory_buffer text;
  InstructionLines::append(text, InstructionLines::make(program, record.op), record);
  return fmt::to_string(text);
}

}  // namespace s7200
