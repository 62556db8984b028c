#include "tools/session/commands/answers/ladder_flow.hpp"

#include <bit>
#include <compare>

namespace s7200::tools {
namespace {

using Kind = stl::LadderElement::Kind;

/// Whether a relation such as `>= W` holds for two values as the instruction found them.
bool holds(std::string_view symbol, std::uint32_t a, std::uint32_t b) {
  const std::string_view relation = symbol.substr(0, symbol.find(' '));
  const char type = symbol.back();
  const auto holds_for = [&](auto left, auto right) {
    const std::partial_ordering order = left <=> right;
    if (relation == "==") return order == 0;
    if (relation == "<>") return order != 0;
    if (relation == ">=") return order >= 0;
    if (relation == "<=") return order <= 0;
    return relation == ">" ? order > 0 : order < 0;
  };
  if (type == 'R') return holds_for(std::bit_cast<float>(a), std::bit_cast<float>(b));
  if (type == 'W') return holds_for(static_cast<std::int16_t>(a), static_cast<std::int16_t>(b));
  if (type == 'D') return holds_for(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
  return holds_for(static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b));
}

/// Whether a contact lets through what reaches it. Of a comparison of strings only the power flow after it is known.
bool contact_is_closed(const GridShape& contact, const InstructionRecord& record) {
  if (contact.symbol == "NOT" || contact.symbol == "P" || contact.symbol == "N") return record.top;
  if (!record.value[0]) return record.top;
  if (contact.symbol.find_first_of("<>=") == std::string::npos)
    return (*record.value[0] != 0) != contact.symbol.starts_with('/');
  return record.value[1] ? holds(contact.symbol, *record.value[0], *record.value[1]) : record.top;
}

/// Whether power flows on behind an element: through a contact, or out of the ENO of a box.
bool is_closed(const GridShape& shape, const Program& program, const LastExecutions& last) {
  if (shape.kind == Kind::Box) {  // AENO comes after it
    const auto eno = last.of.find(*shape.op + 1);
    return shape.to != 0 && eno != last.of.end() && eno->second.record.top;
  }
  const auto found = last.of.find(*shape.op);
  if (shape.kind == Kind::Coil || found == last.of.end()) return false;
  const bool at_rail = !program.statement(*shape.op).mnemonic.starts_with('A');
  if (at_rail && program.ops[*shape.op].in_segment && !found->second.record.top) return false;
  return contact_is_closed(shape, found->second.record);
}

/// The values of its operands: `I0.0=1`
std::string values_of(const GridShape& shape, const Program& program, const LastExecutions& last) {
  const auto found = last.of.find(*shape.op);
  if (found == last.of.end()) return {};
  const std::string text = describe(found->second, program);
  constexpr std::string_view kTop = "S0=";
  const std::size_t top = text.find(kTop), values = top == std::string::npos ? top : text.find(' ', top);
  const bool known = values != std::string::npos && text.find('=', values) != std::string::npos;
  return known ? text.substr(values + 1) : std::string{};
}

}  // namespace

LadderFlow ladder_flow(const Program& program, const DrawnNetwork& network, const LastExecutions& last) {
  const LadderGrid grid = grid_of(network);
  LadderFlow flow;
  std::vector<bool> closed;
  for (const GridShape& shape : grid.shapes) {
    closed.push_back(is_closed(shape, program, last));
    flow.values.push_back(values_of(shape, program, last));
  }
  flow.points = powered_points(grid, closed);
  return flow;
}

}  // namespace s7200::tools
