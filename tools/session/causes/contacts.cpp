#include "tools/session/causes/contacts.hpp"

#include <algorithm>
#include <span>

namespace s7200::tools {
namespace {

/// A string in memory: its length, and so many characters.
std::span<const std::uint8_t> text_at(const State& state, std::uint32_t place) {
  const std::span<const std::uint8_t> rest = std::span(state.image).subspan(place);
  return rest.first(std::min<std::size_t>(rest.size(), rest[0] + std::size_t{1}));
}

}  // namespace

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
  const ContactForm form = contact_form(*op.instruction);
  if (form.compares()) return compares(number, form);
  if (form.is_edge()) {
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
  if (form.kind == ContactForm::Kind::Eno) {
    const InstructionRecord *record = found(number), *before = number > 0 ? found(number - 1) : nullptr;
    return !(record && before && before->top && !record->top);
  }
  return (value(number, 0).value_or(0) != 0) != form.inverted;
}

bool Contacts::compares(std::uint32_t number, const ContactForm& form) const {
  const Op& op = cpu_.program().ops[number];
  if (form.kind == ContactForm::Kind::Strings) {
    const auto a = cpu_.place_of(op[0]), b = cpu_.place_of(op[1]);
    if (!a || !b) return false;
    return std::ranges::equal(text_at(cpu_.state(), *a), text_at(cpu_.state(), *b)) == (form.relation == Relation::Equal);
  }
  const auto a = value(number, 0), b = value(number, 1);
  return a && b && s7200::compares(form, *a, *b);
}

}  // namespace s7200::tools
