#include "tools/session/causes/contacts.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {
namespace {

/// A string in memory: its length, and so many characters.
std::span<const std::uint8_t> text_at(const State& state, std::uint32_t place) {
  const std::span<const std::uint8_t> rest = std::span(state.image).subspan(place);
  return rest.first(std::min<std::size_t>(rest.size(), rest[0] + std::size_t{1}));
}

bool is_local(const Operand& operand) { return operand.at >= image::kL && operand.at < image::kConstants; }

}  // namespace

std::optional<std::uint8_t> event_of_routine(const State& state, std::uint32_t routine) {
  const auto attached = std::ranges::find(state.attached, static_cast<std::uint8_t>(routine));
  if (attached == state.attached.end()) return {};
  return static_cast<std::uint8_t>(attached - state.attached.begin());
}

bool comes_by_itself(std::uint8_t event) { return event == 10 || event == 11; }

Contacts::Contacts(const Cpu& cpu, const ControlFlow& flow, const LatelyExecuted& lately, Time fresh_since, Enters enters)
    : cpu_(cpu),
      flow_(flow),
      lately_(lately),
      fresh_since_(fresh_since),
      enters_(std::move(enters)),
      open_(local_memory::open_routines(cpu.program(), cpu.state())) {}

const InstructionRecord* Contacts::found(std::uint32_t op) const {
  const auto last = lately_.find(op);
  return last == lately_.end() || last->second.at < fresh_since_ ? nullptr : &last->second;
}

std::optional<std::uint32_t> Contacts::value(std::uint32_t op, std::size_t operand) const {
  const std::uint32_t routine = flow_.nodes[op].routine;
  const InstructionRecord* record = found(op);
  if (record && record->value[operand] && is_last_entered()) return record->value[operand];
  const Op& of = cpu_.program().ops[op];
  const OperandRule& rule = of.instruction->operand[operand];
  return rule.kind == OperandKind::Memory ? value_in(routine, of[operand], rule.width, 0) : of[operand].at;
}

/// Whether all that is looked within was entered last by the CALLs that are meant: then it was found as it is meant.
bool Contacts::is_last_entered() const {
  return std::ranges::all_of(within_, [&](const auto& each) { return each.second == last_executed_call(each.first); });
}

/// The CALL of a routine that was executed last of those that were lately.
std::optional<std::uint32_t> Contacts::last_executed_call(std::uint32_t routine) const {
  const InstructionRecord* last = nullptr;
  for (const CallSite& call : flow_.calls) {
    if (call.routine != routine) continue;
    const auto record = lately_.find(call.op);
    if (record == lately_.end() || !record->second.powered) continue;
    if (!last || last->at <= record->second.at) last = &record->second;
  }
  return last ? std::optional(last->op) : std::nullopt;
}

std::optional<std::uint32_t> Contacts::entered_by(std::uint32_t routine) const {
  if (const auto within = within_.find(routine); within != within_.end()) return within->second;
  if (const OpenRoutine* open = open_of(routine); open && open->call) return open->call;
  if (const auto last = last_executed_call(routine)) return last;
  const auto has_power = [&](const CallSite& call) { return call.routine == routine && enters_(call.op); };
  const auto only = [&](const CallSite& call) { return call.routine == routine; };
  const auto last = std::ranges::find_if(flow_.calls.rbegin(), flow_.calls.rend(), has_power);
  if (last != flow_.calls.rend()) return last->op;
  if (std::ranges::count_if(flow_.calls, only) != 1) return {};
  return std::ranges::find_if(flow_.calls, only)->op;
}

std::optional<std::uint32_t> Contacts::look_within(std::uint32_t routine, std::optional<std::uint32_t> call) {
  const auto before = within_.find(routine);
  const auto was = before == within_.end() ? std::nullopt : std::optional(before->second);
  if (call)
    within_[routine] = *call;
  else
    within_.erase(routine);
  return was;
}

/// Null of one that has not begun, or that something else is asked of than what it is doing.
const local_memory::OpenRoutine* Contacts::open_of(std::uint32_t routine) const {
  const std::uint32_t first = flow_.routines[routine].first;
  const auto open = std::ranges::find(open_.rbegin(), open_.rend(), first, &OpenRoutine::first);
  if (open == open_.rend()) return nullptr;
  const auto within = within_.find(routine);
  return within == within_.end() || open->call == within->second ? &*open : nullptr;
}

/// As an instruction of the routine finds it.
std::optional<std::uint32_t> Contacts::value_in(std::uint32_t routine, const Operand& operand, Width width,
                                                std::uint32_t level) const {
  if (!is_local(operand)) return cpu_.peek(operand, width);
  const OpenRoutine* const open = open_of(routine);
  if (!open) return operand.pointer ? std::nullopt : handed_over(routine, operand, width, level);
  if (open->runs) return cpu_.peek(operand, width);
  if (operand.pointer) return {};
  return load_value(&open->memory[operand.at - image::kL], width, operand.bit);
}

/// What the CALL hands over that has this local memory, or more with it, as a parameter. `level`: calls that were followed.
std::optional<std::uint32_t> Contacts::handed_over(std::uint32_t routine, const Operand& local, Width width,
                                                   std::uint32_t level) const {
  if (level == cpu_.program().model->call_depth) return {};
  const auto call = entered_by(routine);
  if (!call) return {};
  for (const Parameter& parameter : parameters_of(cpu_.program(), *call)) {
    const std::uint32_t before = local.at - parameter.local.at, bytes = bytes_of(parameter.width);
    if (parameter.role == Role::Out || local.at < parameter.local.at || before + bytes_of(width) > bytes) continue;
    if (parameter.width == Width::Bit && (width != Width::Bit || local.bit != parameter.local.bit)) continue;
    const auto value = value_in(flow_.nodes[*call].routine, parameter.actual, parameter.width, level + 1);
    if (!value) return {};
    const std::uint32_t part = *value >> 8 * (bytes - before - bytes_of(width));
    if (width != Width::Bit) return width == Width::Double ? part : part & ((1u << 8 * bytes_of(width)) - 1);
    return parameter.width == Width::Bit ? part : part >> local.bit & 1;
  }
  return {};
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
