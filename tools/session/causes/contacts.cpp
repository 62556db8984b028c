#include "tools/session/causes/contacts.hpp"

#include <algorithm>
#include <span>

#include "interpreter/base/bytes.hpp"
#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {
namespace {

/// A string in memory: its length, and so many characters.
std::span<const std::uint8_t> text_at(const State& state, std::uint32_t place) {
  const std::span<const std::uint8_t> rest = std::span(state.image).subspan(place);
  return rest.first(std::min<std::size_t>(rest.size(), rest[0] + std::size_t{1}));
}

/// The SBR or INT of an op; 0 in the main program.
std::uint32_t head_of(const Program& program, std::uint32_t op) {
  while (op > 0 && !begins_routine(program.ops[op].instruction->structure)) --op;
  return op;
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
  const Op& of = cpu_.program().ops[op];
  const auto handed = handed_over(op, of[operand], of.instruction->operand[operand].width, 0);
  return handed ? handed : cpu_.peek(of, operand);
}

/// What the last CALL that has this local memory, or more with it, as a parameter hands over.
std::optional<std::uint32_t> Contacts::handed_over(std::uint32_t number, const Operand& local, Width width,
                                                   std::size_t level) const {
  constexpr std::size_t kDeepest = 8;  // calls in one another
  const Program& program = cpu_.program();
  if (local.pointer || local.at < image::kL || local.at >= image::kConstants || level == kDeepest) return {};
  const std::uint32_t head = head_of(program, number);
  for (std::uint32_t call = static_cast<std::uint32_t>(program.ops.size()); call-- > 0;) {
    if (program.ops[call].instruction->structure != Structure::Call || program.ops[call].target != head) continue;
    for (const Parameter& parameter : parameters_of(program, call)) {
      const std::uint32_t before = local.at - parameter.local.at, bytes = bytes_of(parameter.width);
      if (parameter.role == Role::Out || local.at < parameter.local.at || before + bytes_of(width) > bytes) continue;
      if (parameter.width == Width::Bit && (width != Width::Bit || local.bit != parameter.local.bit)) continue;
      const auto value = value_of(call, parameter.actual, parameter.width, level + 1);
      if (!value) return {};
      const std::uint32_t part = *value >> 8 * (bytes - before - bytes_of(width));
      if (width != Width::Bit) return width == Width::Double ? part : part & ((1u << 8 * bytes_of(width)) - 1);
      return parameter.width == Width::Bit ? part : part >> local.bit & 1;
    }
  }
  return {};
}

/// Of an operand of a CALL.
std::optional<std::uint32_t> Contacts::value_of(std::uint32_t call, const Operand& operand, Width width,
                                                std::size_t level) const {
  if (const auto handed = handed_over(call, operand, width, level)) return handed;
  const auto place = cpu_.place_of(operand);
  if (!place) return {};
  const std::uint8_t* const at = &cpu_.state().image[*place];
  switch (width) {
    case Width::Bit:
      return *at >> operand.bit & 1;
    case Width::Byte:
      return *at;
    case Width::Word:
      return load16(at);
    case Width::Double:
      break;
  }
  return load32(at);
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
