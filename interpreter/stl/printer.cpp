#include "interpreter/stl/printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl {

namespace {

constexpr std::size_t kCommentColumn = 32;

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

std::string address_text(const Address& address) {
  switch (address.size) {
    case Size::None:
      return fmt::format("{}{}", address.area, address.number);
    case Size::Bit:
      return fmt::format("{}{}.{}", address.area, address.number, address.bit);
    case Size::Byte:
      return fmt::format("{}B{}", address.area, address.number);
    case Size::Word:
      return fmt::format("{}W{}", address.area, address.number);
    case Size::Double:
      return fmt::format("{}D{}", address.area, address.number);
  }
  return {};
}

const Address* address_in(const OperandValue& value) {
  if (const auto* target = std::get_if<AddressOf>(&value)) return &target->target;
  if (const auto* pointer = std::get_if<Indirect>(&value)) return &pointer->pointer;
  return std::get_if<Address>(&value);
}

std::string ascii_text(const Integer& constant) {
  std::string text = "'";
  for (int i = constant.characters - 1; i >= 0; --i) {
    const auto byte = static_cast<unsigned char>(constant.value >> (8 * i));
    const bool plain = byte >= 0x20 && byte < 0x7F;
    if (!plain) {
      text += fmt::format("${:02X}", byte);
    } else {
      if (byte == '$' || byte == '\'') text += '$';
      text += static_cast<char>(byte);
    }
  }
  text += '\'';
  return text;
}

std::string integer_text(const Integer& constant) {
  switch (constant.form) {
    case Integer::Form::Decimal:
      return fmt::format("{}", constant.value);
    case Integer::Form::Hex:
      return fmt::format("16#{:X}", constant.value);
    case Integer::Form::Binary:
      return fmt::format("2#{:b}", constant.value);
    case Integer::Form::Ascii:
      return ascii_text(constant);
  }
  return {};
}

std::string with_comment(std::string line, std::size_t column, const std::string& comment) {
  if (comment.empty()) return line;
  line.append(std::max(column, line.size() + 1) - line.size(), ' ');
  return fmt::format("{}//{}", line, comment);
}

std::string network_text(const NetworkHead& head) {
  const std::string text = head.number == 0 ? "NETWORK" : fmt::format("NETWORK {}", head.number);
  return with_comment(text, text.size() + 1, head.comment);
}

std::string line_text(const Line& line) {
  return std::visit(Overloaded{[](const Statement& statement) {
                                 return with_comment(to_text(statement), kCommentColumn, statement.comment);
                               },
                               [](const NetworkHead& head) { return network_text(head); },
                               [](const CommentLine& comment) { return fmt::format("//{}", comment.text); },
                               [](const BlankLine&) { return std::string(); }},
                    line);
}

bool is_statement(const Line& line, std::initializer_list<std::string_view> mnemonics) {
  const auto* statement = std::get_if<Statement>(&line);
  return statement != nullptr && std::find(mnemonics.begin(), mnemonics.end(), statement->mnemonic) != mnemonics.end();
}

bool is_head(const Line& line) { return std::holds_alternative<NetworkHead>(line) || is_statement(line, {"SBR", "INT"}); }
bool is_end(const Line& line) { return is_statement(line, {"MEND", "RET", "RETI"}); }

/// The lines that have a blank line before them: the line after the end of a routine, and heads; if there are comments
/// directly above a head, the first of them.
std::vector<bool> paragraph_starts(const std::vector<Line>& lines) {
  std::vector<bool> starts(lines.size(), false);
  bool leads_to_head = false;
  for (std::size_t i = lines.size(); i-- > 0;) {
    const bool comment = std::holds_alternative<CommentLine>(lines[i]);
    if (i + 1 < lines.size() && ((leads_to_head && !comment) || is_end(lines[i]))) starts[i + 1] = true;
    leads_to_head = is_head(lines[i]) || (leads_to_head && comment);
  }
  return starts;
}

bool same_value(const Integer& a, const Integer& b) { return a.value == b.value; }
template <typename Value>
bool same_value(const Value& a, const Value& b) {
  return a == b;
}

bool same_operand(const Operand& a, const Operand& b) {
  return std::visit(
      [&](const auto& value) {
        const auto* other = std::get_if<std::decay_t<decltype(value)>>(&b.value);
        return other != nullptr && same_value(value, *other);
      },
      a.value);
}

bool same_line(const Line& a, const Line& b) {
  if (const auto* network = std::get_if<NetworkHead>(&a)) {
    const auto* other = std::get_if<NetworkHead>(&b);
    return other != nullptr && network->number == other->number;
  }
  const auto* statement = std::get_if<Statement>(&a);
  const auto* other = std::get_if<Statement>(&b);
  return statement != nullptr && other != nullptr && statement->mnemonic == other->mnemonic &&
         std::equal(statement->operands.begin(), statement->operands.end(), other->operands.begin(), other->operands.end(),
                    same_operand);
}

std::vector<const Line*> program_lines(const Source& source) {
  std::vector<const Line*> lines;
  for (const Line& line : source.lines) {
    if (std::holds_alternative<Statement>(line) || std::holds_alternative<NetworkHead>(line)) lines.push_back(&line);
  }
  return lines;
}

}  // namespace

std::string to_text(const Operand& operand) {
  if (!operand.symbol.empty()) {
    const Address* address = address_in(operand.value);
    if (address) return fmt::format("{}:{}", operand.symbol, address_text(*address));
  }
  return std::visit(Overloaded{[](const Integer& constant) { return integer_text(constant); },
                               [](const Real& constant) { return to_text(constant); },
                               [](const Address& address) { return address_text(address); },
                               [](const AddressOf& address) { return fmt::format("&{}", address_text(address.target)); },
                               [](const Indirect& indirect) { return fmt::format("*{}", address_text(indirect.pointer)); },
                               [](const Name& name) { return name.text; }},
                    operand.value);
}

std::string to_text(const Real& constant) {
  std::string text = upper_case(fmt::format("{}", constant.value));
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

std::string to_text(const Statement& statement) {
  if (statement.operands.empty()) return statement.mnemonic;
  std::string text = fmt::format("{:<7} ", statement.mnemonic);
  for (const Operand& operand : statement.operands) {
    if (&operand != &statement.operands.front()) text += ", ";
    text += to_text(operand);
  }
  return text;
}

std::string to_text(const Source& source) {
  const std::vector<bool> starts = paragraph_starts(source.lines);
  std::string text;
  bool after_blank = false;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    if (std::holds_alternative<BlankLine>(source.lines[i])) {
      after_blank = true;
      continue;
    }
    if ((after_blank || starts[i]) && !text.empty()) text += '\n';
    text += line_text(source.lines[i]) + '\n';
    after_blank = false;
  }
  return text;
}

bool same_program(const Source& a, const Source& b) {
  const auto left = program_lines(a);
  const auto right = program_lines(b);
  return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                    [](const Line* x, const Line* y) { return same_line(*x, *y); });
}

}  // namespace s7200::stl
