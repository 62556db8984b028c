#include "tools/session/causes/contacts.hpp"

#include <algorithm>
#include <bit>
#include <compare>
#include <span>
#include <string_view>

namespace s7200::tools {
namespace {

std::string_view relation_of(std::string_view mnemonic) {
  const std::size_t at = mnemonic.find_first_of("<>=");
  return at == std::string_view::npos ? std::string_view{} : mnemonic.substr(at);
}

bool holds(std::string_view relation, std::partial_ordering order) {
  if (relation == "=") return order == 0;
  if (relation == "<>") return order != 0;
  if (relation == ">=") return order >= 0;
  if (relation == "<=") return order <= 0;
  return relation == ">" ? order > 0 : order < 0;
}

std::partial_ordering order_of(char type, std::uint32_t a, std::uint32_t b) {
  switch (type) {
    case 'R':
      return std::bit_cast<float>(a) <=> std::bit_cast<float>(b);
    case 'W':
      return static_cast<std::int16_t>(a) <=> static_cast<std::int16_t>(b);
    case 'D':
      return static_cast<std::int32_t>(a) <=> static_cast<std::int32_t>(b);
    default:
      return static_cast<std::uint8_t>(a) <=> static_cast<std::uint8_t>(b);
  }
}

/// A string in memory: its length, and so many characters.
std::span<const std::uint8_t> text_at(const State& state, std::uint32_t place) {
  const std::span<const std::uint8_t> rest = std::span(state.image).subspan(place);
  return rest.first(std::min<std::size_t>(rest.size(), rest[0] + std::size_t{1}));
}

}  // namespace

bool is_edge(const Op& op) { return op.instruction->mnemonic == "EU" || op.instruction->mnemonic == "ED"; }

bool is_comparison(const Op& op) { return op.instruction->structure == Structure::Compare; }

std::optional<std::uint8_t> event_of_routine(const State& state, std::uint32_t routine) {
  const auto attached = std::ranges::find(state.attached, static_cast<std::uint8_t>(routine));
  if (attached == state.attached.end()) return {};
  return static_cast<std::uint8_t>(attached - state.attached.begin());
}

bool comes_by_itself(std::uint8_t event) { return event == 10 || event == 11; }

const InstructionRecord* Contacts::found(std::uint32_t op) const {
  const auto last = lately_.find(op);
  return last == lately_.end() || last->second.at < fresh_since_ ? nullptr : &last->second;
}

std::optional<std::uint32_t> Contacts::value(std::uint32_t op, std::size_t operand) const {
  if (const InstructionRecord* record = found(op); record && record->value[operand]) return record->value[operand];
  return cpu_.peek(cpu_.program().ops[op], operand);
}

bool Contacts::conducts(std::uint32_t number) const {
  const Op& op = cpu_.program().ops[number];
  if (is_comparison(op)) return compares(number);
  if (is_edge(op)) {
    const InstructionRecord* record = found(number);
    return record && record->top;
  }
  switch (op.instruction->structure) {
    case Structure::InterruptHead: {
      const auto event = event_of_routine(cpu_.state(), op[0].at);
      return executed(number) || (event && comes_by_itself(*event) && cpu_.state().interrupts_enabled);
    }
    case Structure::SegmentBegin:
      return cpu_.peek(op, 0).value_or(0) != 0;
    default:
      break;
  }
  if (op.instruction->effect == Effect::ReadsEno) {
    const InstructionRecord *record = found(number), *before = number > 0 ? found(number - 1) : nullptr;
    return !(record && before && before->top && !record->top);
  }
  const std::string_view mnemonic = op.instruction->mnemonic;
  const bool closed = mnemonic.ends_with('N') || mnemonic.ends_with("NI");
  return (value(number, 0).value_or(0) != 0) != closed;
}

bool Contacts::compares(std::uint32_t number) const {
  const Op& op = cpu_.program().ops[number];
  const std::string_view mnemonic = op.instruction->mnemonic, relation = relation_of(mnemonic);
  const char type = mnemonic[mnemonic.size() - relation.size() - 1];
  if (type == 'S') {
    const auto a = cpu_.place_of(op[0]), b = cpu_.place_of(op[1]);
    if (!a || !b) return false;
    return std::ranges::equal(text_at(cpu_.state(), *a), text_at(cpu_.state(), *b)) == (relation == "=");
  }
  const auto a = value(number, 0), b = value(number, 1);
  return a && b && holds(relation, order_of(type, *a, *b));
}

}  // namespace s7200::tools
