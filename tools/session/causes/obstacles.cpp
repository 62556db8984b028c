#include "tools/session/causes/obstacles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/sources.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/base/text/among.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory_meaning.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostLevels = 4;     // bits that hold off one another
constexpr std::size_t kMostWays = 4;       // that are shown of a bit
constexpr std::size_t kMostOfMemory = 3;   // that are shown of memory
constexpr std::size_t kLongestRung = 300;  // characters

constexpr std::string_view kOnlyFromOutside =
    "no instruction writes it: only somebody outside can, a panel or a programming device";

bool is_bits_of_timer(const Bits& bit) { return bit.first / 8 - image::kTBits < image::kTimers / 8; }
bool is_bits_of_counter(const Bits& bit) { return bit.first / 8 - image::kCBits < image::kCounters / 8; }

/// Nothing of a bit that is not known.
std::string bit_text(const std::optional<std::uint32_t>& bit) { return !bit ? "" : *bit != 0 ? "1" : "0"; }

Bits bit_at(const Operand& operand) { return {std::uint64_t{operand.at} * 8 + operand.bit, 1}; }

/// Whether a CALL puts a result of its subroutine there. What else it writes is the local memory of that one.
bool gets_back(const Program& program, std::uint32_t call, const Bits& bits) {
  return std::ranges::any_of(parameters_of(program, call), [&](const Parameter& parameter) {
    const Operand& to = parameter.actual;
    const Bits whole{std::uint64_t{to.at} * 8, std::uint64_t{bytes_of(parameter.width)} * 8};
    return parameter.role != Role::In && !to.pointer && (parameter.width == Width::Bit ? bit_at(to) : whole).overlaps(bits);
  });
}

}  // namespace

Obstacles::Obstacles(const Cpu& cpu, const Facts& facts, const LatelyExecuted& lately, Time fresh_since)
    : cpu_(cpu),
      facts_(facts),
      calls_(calls_of(facts.program, facts.flow)),
      contacts_(cpu, facts.flow, lately, fresh_since, [this](std::uint32_t call) { return enters(call); }),
      has_run_(!lately.empty()),
      ways_(facts,
            {[this](std::uint32_t op) { return contacts_.conducts(op); }, [this](std::uint32_t op) { return runs(op); }}),
      entries_(facts,
               {[this](std::uint32_t op) { return contacts_.conducts(op); }, [this](std::uint32_t op) { return runs(op); }}),
      rungs_(ways_, [this](std::uint32_t op, std::size_t operand) { return operand_text(op, operand); }) {}

// --- words ---

std::string Obstacles::place_text(std::uint32_t op) const {
  return fmt::format("{} in {}", short_text(program().statement(op)), line_of(op, program()));
}

std::string Obstacles::name_of(const Bits& bits) const {
  const Bits whole = as_named(bits);
  const auto at = static_cast<std::uint32_t>(whole.first / 8);
  const Width width = whole.count == 16 ? Width::Word : whole.count == 32 ? Width::Double : Width::Byte;
  auto range = range_at(at, width, *program().model);
  if (range && whole.count == 1) {
    range->width = Width::Bit;
    range->bit = static_cast<std::uint8_t>(whole.first % 8);
  }
  return range && whole.count <= 32 ? named(program(), *range) : memory_text(whole);
}

bool Obstacles::is_on(const Bits& bit) const { return (cpu_.state().image[bit.first / 8] >> (bit.first % 8) & 1) != 0; }

Obstacle Obstacles::about(std::string_view kind, const Bits& bit, bool wanted) const {
  return {.kind = kind, .name = name_of(bit), .value = is_on(bit) ? "1" : "0", .wanted = wanted ? "1" : "0", .bits = bit};
}

std::string Obstacles::operand_text(std::uint32_t number, std::size_t operand) const {
  const stl::Statement& statement = program().statement(number);
  const std::string text = operand < statement.operands.size() ? stl::to_text(statement.operands[operand]) : "";
  const Operand& of = op(number)[operand];
  if (!of.pointer && of.at >= image::kConstants) return text;
  const auto value = contacts_.value(number, operand);
  if (!value) return text;
  const OperandRule& rule = op(number).instruction->operand[operand];
  if (rule.width == Width::Bit || rule.real || rule.text)
    return rule.width == Width::Bit ? fmt::format("{}={}", text, *value) : text;
  const std::int64_t signed_value = rule.width == Width::Word     ? static_cast<std::int16_t>(*value)
                                    : rule.width == Width::Double ? static_cast<std::int32_t>(*value)
                                                                  : std::int64_t{*value};
  return fmt::format("{}={}", text, signed_value);
}

std::string Obstacles::rung_text(std::uint32_t number, std::size_t level) const {
  std::string text = rungs_.of(number, level);
  if (text.size() > kLongestRung) text = text.substr(0, kLongestRung) + " …";
  return text;
}

/// `, in INT 0 at event 10 (timed interrupt 0, SMB34)`; nothing of an instruction elsewhere.
std::string Obstacles::interrupt_text(std::uint32_t number) const {
  const Routine& routine = facts_.flow.routine_of(number);
  if (routine.kind != Routine::Kind::Interrupt) return {};
  const auto event = event_of_routine(cpu_.state(), routine.number);
  return fmt::format(", in INT {}{}", routine.number, event ? " at " + event_text(*event) : "");
}

/// An interrupt routine need not run in every scan.
bool Obstacles::runs(std::uint32_t number) const {
  const bool in_interrupt = facts_.flow.routine_of(number).kind == Routine::Kind::Interrupt;
  return in_interrupt ? contacts_.executed(number) : contacts_.found(number) != nullptr;
}

/// Whether a CALL is executed and has power flow, as its contacts are now.
bool Obstacles::enters(std::uint32_t call) const {
  const auto [known, is_new] = enters_.try_emplace(call, false);
  if (!is_new) return known->second;
  const auto ways = entries_.to(call, true);
  return known->second = std::ranges::any_of(ways, [&](const Conditions& way) { return entries_.changes(way).empty(); });
}

std::optional<std::uint32_t> Obstacles::look_within(std::uint32_t routine, std::optional<std::uint32_t> call) {
  enters_.clear();
  return contacts_.look_within(routine, call);
}

/// The one that it was entered by; all if that is not known.
std::vector<std::uint32_t> Obstacles::calls_that_hand_over(std::uint32_t routine) const {
  if (const auto call = contacts_.entered_by(routine)) return {*call};
  std::vector<std::uint32_t> all;
  for (const CallSite& call : facts_.flow.calls)
    if (call.routine == routine) all.push_back(call.op);
  return all;
}

std::string Obstacles::several_text(std::uint32_t routine) const {
  const std::size_t calls = calls_that_hand_over(routine).size();
  return calls > 1 ? fmt::format("{} hand it over, and none has power flow now", counted(calls, "CALL")) : "";
}

// --- who writes ---

void Obstacles::note_writer(std::uint32_t number, const Bits& bits, bool wanted, Writers& writers) const {
  const Op& by = op(number);
  const std::string_view mnemonic = by.instruction->mnemonic;
  const bool one_bit = bits.count == 1;
  if (returns_from_subroutine(by)) return;  // its CALL is named
  if (by.instruction->structure == Structure::Call) {
    if (gets_back(program(), number, bits)) writers.calls.push_back(number);
    return;
  }
  if (by.instruction->effect == Effect::Receives || is_among(mnemonic, {"NETR", "NETW"}))
    return writers.messages.push_back(number);
  if (one_bit && is_among(mnemonic, {"=", "=I"})) return writers.deciding.push_back(number);
  if (one_bit && is_among(mnemonic, {"S", "SI", "R", "RI"}))
    return ((mnemonic.front() == 'S') == wanted ? writers.deciding : writers.opposing).push_back(number);
  if (one_bit && by.instruction->structure == Structure::SegmentTransition) {
    const bool leaves = !(bit_at(by[0]) == bits);  // the step that it is in: no way to it, and none that could keep from it
    if (leaves != wanted) writers.deciding.push_back(number);
    return;
  }
  const auto source = one_bit ? moved_from(number, bits) : std::nullopt;
  if (source && constant_bit(program(), *source).value_or(wanted) != wanted) return;
  writers.others.push_back(number);
}

Obstacles::Writers Obstacles::writers_of(const Bits& bits, bool wanted, std::optional<std::uint32_t> routine) const {
  Writers writers;
  for (std::uint32_t number = 0; number < program().ops.size(); ++number) {
    if (routine && facts_.flow.nodes[number].routine != *routine) continue;
    const auto& effects = facts_.effects[number];
    const auto direct = [&](const MemoryAccess& access) {
      return access.writes() && !access.by_pointer && access.bits.overlaps(bits);
    };
    const auto led_there = [&](const MemoryAccess& access) {
      return access.writes() && access.by_pointer && access.bits.overlaps(bits);
    };
    if (std::ranges::any_of(effects, direct))
      note_writer(number, bits, wanted, writers);
    else if (calls_.nodes[facts_.flow.nodes[number].routine].executed() && std::ranges::any_of(effects, led_there))
      writers.pointers.push_back(number);
  }
  return writers;
}

// --- what is in the way ---

/// Whether no instruction can change any of it.
bool Obstacles::add_forced(Obstacle& obstacle, const Bits& bits) const {
  const ForcedPlace forced = forced_place(cpu_.state().forcing, bits);
  if (!forced.text.empty()) obstacle.text += fmt::format("{}{}", obstacle.text.empty() ? "" : "; ", forced.text);
  return forced.all;
}

/// Why no way leads to any of some instructions: their routines are never executed, or conditions exclude each other.
std::optional<std::string> Obstacles::why_never(const std::vector<std::uint32_t>& by) const {
  const auto exclusion = ways_.take_exclusion();
  std::set<std::string> reasons;
  for (const std::uint32_t one : by) reasons.insert(never_executed(one).value_or(""));
  if (!reasons.empty() && !reasons.contains("")) return fmt::format("{}", fmt::join(reasons, ", "));
  return exclusion ? std::optional(exclusion_text(program(), *exclusion)) : std::nullopt;
}

std::optional<std::string> Obstacles::never_executed(std::uint32_t number) const {
  return why_never_executed(facts_.flow, calls_, facts_.flow.nodes[number].routine);
}

/// Those of what `to` is about.
void Obstacles::add_ways(Obstacle& to, const std::vector<Conditions>& ways) {
  add_ways(to, ways, "no contact can do that", to.op ? std::vector{*to.op} : std::vector<std::uint32_t>{});
}

void Obstacles::add_ways(Obstacle& to, const std::vector<Conditions>& ways, std::string_view never,
                         const std::vector<std::uint32_t>& by) {
  std::vector<Conditions> fewest = ways_.fewest_changes(ways);
  if (fewest.empty()) {
    const auto why = why_never(by);
    to.because.push_back(
        {.kind = "never",
         .text = why ? fmt::format("{}: {}", never, *why) : "no contact can do that: it never has power flow there"});
    return;
  }
  ways_.take_exclusion();
  if (fewest.front().empty()) {
    to.because.push_back(
        {.kind = "fulfilled", .text = "nothing more is needed: it is so the next time that it is executed"});
    return;
  }
  const std::size_t shown = std::min(fewest.size(), open_.size() > 1 ? std::size_t{2} : kMostWays);
  for (std::size_t i = 0; i < shown; ++i) {
    Obstacle way{.kind = "ways"};
    for (const Condition& condition : fewest[i]) {
      Obstacle one = of_condition(condition);
      const auto is_same = [&](const Obstacle& other) {
        return one.bits.count != 0 && other.bits == one.bits && other.wanted == one.wanted;
      };
      if (std::ranges::none_of(way.because, is_same)) way.because.push_back(std::move(one));
    }
    const std::size_t count = way.because.size();  // an input that two contacts look at changes once
    way.text =
        fmt::format("{}{} {} to change:", i == 0 ? "" : "or ", counted(count, "contact"), count == 1 ? "has" : "have");
    to.because.push_back(std::move(way));
  }
  if (fewest.size() > shown)
    to.because.push_back({.kind = "more", .text = fmt::format("and {} more", counted(fewest.size() - shown, "way"))});
}

void Obstacles::add_ways_if_any_changes(Obstacle& to, const std::vector<Conditions>& ways) {
  const std::vector<Conditions> fewest = ways_.fewest_changes(ways);
  if (fewest.empty() || !fewest.front().empty()) return add_ways(to, ways);
  ways_.take_exclusion();
}

Obstacle Obstacles::of_input(std::uint32_t number, std::size_t level, bool on, std::string text) {
  Obstacle input{.kind = "rung", .text = fmt::format("{}: {}", std::move(text), rung_text(number, level)), .op = number};
  add_ways(input, ways_.input(number, level, on));
  return input;
}

/// Of contacts that look at the same the one in the rung is named.
Obstacle Obstacles::of_condition(const Condition& found) {
  const Condition condition{found.in_rung, found.in_rung_on};
  const Op& of = op(condition.op);
  const ContactForm form = contact_form(*of.instruction);
  if (form.compares()) return of_comparison(condition);
  if (form.is_edge()) return of_edge(condition.op);
  if (of.instruction->structure == Structure::InterruptHead) return of_interrupt(condition.op);
  if (form.kind == ContactForm::Kind::Eno)
    return {.kind = "eno",
            .text = fmt::format("{} must find ENO {}: the box before it has ended with an error", place_text(condition.op),
                                condition.on ? 1 : 0),
            .op = condition.op};
  return of_contact(condition);
}

Obstacle Obstacles::of_contact(const Condition& condition) {
  const Op& contact = op(condition.op);
  const bool segment = contact.instruction->structure == Structure::SegmentBegin;
  const bool wanted = condition.on != contact_form(*contact.instruction).inverted;
  const Bits plain = as_named(bit_at(contact[0])), bit = plain.count == 1 ? plain : bit_at(contact[0]);
  const bool is_local = area_of(bit) == Area::L;
  const std::vector<Told> told = told_;
  Obstacle found = is_local ? of_memory(bit, wanted, facts_.flow.nodes[condition.op].routine) : of_bit(bit, wanted);
  found.op = condition.op;
  found.place = place_text(condition.op);
  if (segment) found.text += fmt::format("{}a step of the sequence", found.text.empty() ? "" : "; ");
  if (is_local) {
    found.value = bit_text(contacts_.value(condition.op, 0));
    found.bits = {0, 0};
  } else if (is_on(bit) == wanted) {
    found.text = "it was not so when the program looked at it last";
    found.because.clear();
    found.number = found.same_as = 0;
    told_ = told;
  }
  return found;
}

/// A timer or a counter says how it gets to where the comparison is as wanted, if it can by going on.
void Obstacles::add_value_of(Obstacle& to, const Condition& condition, std::size_t operand) {
  const Operand& of = op(condition.op)[operand];
  const auto place = cpu_.place_of(of);
  if (!place || *place >= image::kConstants) return;
  const OperandRule& rule = op(condition.op).instruction->operand[operand];
  const Bits bits = as_named({std::uint64_t{*place} * 8, std::uint64_t{bytes_of(rule.width)} * 8});
  if (area_of(bits) == Area::L) return add_parameter(to, condition.op, operand, bits);
  Obstacle value = of_value(bits);
  if (const auto goal = goal_of(condition, operand); goal && value.same_as == 0) count_to(value, bits, *goal);
  to.because.push_back(std::move(value));
}

/// What a comparison in a subroutine looks at in its local memory, and who hands it over.
void Obstacles::add_parameter(Obstacle& to, std::uint32_t number, std::size_t operand, const Bits& local) {
  Obstacle value{.kind = "value", .name = name_of(local)};
  const std::uint32_t routine = facts_.flow.nodes[number].routine;
  for (const std::uint32_t call : calls_that_hand_over(routine)) {
    for (const Parameter& parameter : parameters_of(program(), call)) {
      if (parameter.role == Role::Out || !local_bits(parameter).contains(local)) continue;
      value.text = several_text(routine);
      Obstacle given{.kind = "call", .text = fmt::format("{} hands it over", place_text(call)), .op = call};
      const Bits actual{std::uint64_t{parameter.actual.at} * 8, local_bits(parameter).count};
      const bool is_memory = !parameter.actual.pointer && parameter.actual.at < image::kConstants &&
                             parameter.width != Width::Bit && area_of(as_named(actual)) != Area::L;
      if (is_memory) given.because.push_back(of_value(as_named(actual)));
      value.because.push_back(std::move(given));
    }
  }
  const Writers writers = writers_of(local, true, routine);
  add_rungs(value, writers.others);
  const auto range = range_at(op(number)[operand].at, op(number).instruction->operand[operand].width, *program().model);
  if (const auto found = contacts_.value(number, operand); found && range) {
    std::vector<std::uint8_t> bytes;
    for (std::uint32_t i = range->bytes(); i-- > 0;) bytes.push_back(static_cast<std::uint8_t>(*found >> 8 * i));
    value.value = value_text(program(), *range, bytes);
  }
  to.because.push_back(std::move(value));
}

Obstacle Obstacles::of_comparison(const Condition& condition) {
  const std::string_view mnemonic = op(condition.op).instruction->mnemonic;
  const std::string_view relation = mnemonic.substr(mnemonic.find_first_of("<>="));
  Obstacle found{.kind = "comparison",
                 .text = fmt::format("{} {} {} must {}hold ({})", operand_text(condition.op, 0), relation,
                                     operand_text(condition.op, 1), condition.on ? "" : "not ", place_text(condition.op)),
                 .op = condition.op};
  for (std::size_t i = 0; i < 2; ++i) add_value_of(found, condition, i);
  return found;
}

Obstacle Obstacles::of_edge(std::uint32_t number) {
  const bool rising = op(number).instruction->mnemonic == "EU";
  const RungLogic& rung = ways_.rung_of(number);
  Obstacle found{.kind = "edge", .text = {}, .op = number};
  found.text =
      fmt::format("{} needs a {} edge of ({})", place_text(number), rising ? "rising" : "falling", rung_text(number, 0));
  if (rung.inputs.empty()) return found;
  add_ways_of_edge(found, ways_.input(number, 0, rising), rising);
  return found;
}

/// `ways` make what has the edge on, of a falling one off.
void Obstacles::add_ways_of_edge(Obstacle& to, const std::vector<Conditions>& ways, bool rising) {
  const std::vector<Conditions> fewest = ways_.fewest_changes(ways);
  if (!fewest.empty() && fewest.front().empty())
    to.text += fmt::format(", which is {} already: it has to go {} first", rising ? "on" : "off", rising ? "off" : "on");
  else
    add_ways(to, ways);
}

Obstacle Obstacles::of_interrupt(std::uint32_t head) {
  const std::uint32_t number = op(head)[0].at;
  const auto event = event_of_routine(cpu_.state(), number);
  Obstacle found{.kind = "interrupt", .text = {}, .op = head};
  if (event) {
    found.text = fmt::format("INT {} has to run, at {}{}", number, event_text(*event),
                             cpu_.state().interrupts_enabled ? "" : "; interrupts are disabled");
    return found;
  }
  found.text = fmt::format("INT {} has to run{}", number, has_run_ ? ", and is attached to no event" : "");
  for (const Attachment& attachment : facts_.flow.attachments)
    if (attachment.routine && facts_.flow.routines[*attachment.routine].first == head) {
      Obstacle by{.kind = "rung",
                  .text = fmt::format("{} attaches it: {}", place_text(attachment.op), rung_text(attachment.op, 0)),
                  .op = attachment.op};
      add_ways(by, ways_.to(attachment.op, true));
      found.because.push_back(std::move(by));
    }
  return found;
}

std::optional<Obstacle> Obstacles::told_before(const Bits& bits, bool wanted) const {
  const auto told = std::ranges::find_if(told_.rbegin(), told_.rend(), [&](const Told& each) {
    return each.bits == bits && each.wanted == wanted && each.level <= open_.size();
  });
  if (told == told_.rend()) return {};
  Obstacle same{.kind = told->kind, .same_as = told->number};
  return same;
}

void Obstacles::note_told(const Bits& bits, bool wanted, Obstacle& obstacle) {
  if (obstacle.because.empty()) return;
  obstacle.number = ++numbered_;
  told_.push_back({bits, wanted, open_.size(), obstacle.number, obstacle.kind});
}

Obstacle Obstacles::of_bit(const Bits& bit, bool wanted) {
  if (const auto told = told_before(bit, wanted)) {
    Obstacle same = about(told->kind, as_named(bit).count == 1 ? as_named(bit) : bit, wanted);
    same.same_as = told->same_as;
    return same;
  }
  Obstacle found = followed(bit, wanted);
  note_told(bit, wanted, found);
  return found;
}

Obstacle Obstacles::followed(const Bits& bit, bool wanted) {
  if (is_bits_of_timer(bit)) return of_timer(bit, wanted);
  if (is_bits_of_counter(bit)) return of_counter(bit, wanted);
  const Bits plain = as_named(bit);
  switch (area_of(plain)) {
    case Area::I: {
      Obstacle found = about("input", plain, wanted);
      found.text = "an input";
      add_forced(found, plain);
      return found;
    }
    case Area::SM: {
      Obstacle found = about("system", plain, wanted);
      found.text = meaning_text(*program().model, plain);
      const Writers writers = writers_of(plain, wanted, {});
      if (!writers.deciding.empty()) add_ways_of_bit(found, writers, plain, wanted);
      return found;
    }
    default:
      return of_memory(plain, wanted, {});
  }
}

Obstacle Obstacles::of_memory(const Bits& bit, bool wanted, std::optional<std::uint32_t> routine) {
  Obstacle found = about("bit", bit, wanted);
  if (add_forced(found, bit)) return found;
  // Each routine has local memory of its own.
  const std::uint64_t of_routine = routine ? (std::uint64_t{*routine} + 1) << 40 : 0;
  const std::pair<Bits, bool> own{{bit.first + of_routine, bit.count}, wanted};
  if (std::ranges::find(open_, own) != open_.end()) {
    found.text = "it would have to hold itself; see above";
    return found;
  }
  const Writers writers = writers_of(bit, wanted, routine);
  if (open_.size() >= kMostLevels) {
    std::vector<std::string> by;
    for (const auto* list : {&writers.deciding, &writers.others, &writers.calls})
      for (const std::uint32_t one : *list) by.push_back(place_text(one));
    if (by.size() > kMostOfMemory) by.resize(kMostOfMemory);
    found.text +=
        by.empty() ? "not followed further" : fmt::format("written by {}; not followed further", fmt::join(by, " and "));
    return found;
  }
  open_.push_back(own);
  if (routine) add_arguments(found, bit, wanted, *routine);
  add_ways_of_bit(found, writers, bit, wanted);
  open_.pop_back();
  return found;
}

/// What a routine was called with.
void Obstacles::add_arguments(Obstacle& to, const Bits& local, bool wanted, std::uint32_t routine) {
  for (const std::uint32_t call : calls_that_hand_over(routine)) {
    for (const Parameter& parameter : parameters_of(program(), call)) {
      if (parameter.role == Role::Out || parameter.width != Width::Bit || !(local_bits(parameter) == local)) continue;
      to.text = several_text(routine);
      Obstacle given{.kind = "call", .text = fmt::format("{} hands it over", place_text(call)), .op = call};
      const bool is_memory = !parameter.actual.pointer && parameter.actual.at < image::kConstants;
      const auto value = contacts_.argument(call, parameter);
      if (is_memory && (!value || (*value != 0) != wanted)) {
        const Bits actual = bit_at(parameter.actual);
        const bool is_local = area_of(as_named(actual)) == Area::L;
        given.because.push_back(is_local ? of_memory(actual, wanted, facts_.flow.nodes[call].routine)
                                         : of_bit(actual, wanted));
        if (is_local) {
          given.because.back().bits = {0, 0};
          given.because.back().value = bit_text(value);
        }
      }
      to.because.push_back(std::move(given));
    }
  }
}

/// Whether, in a scan that executes both, `other` is executed after `op`.
bool Obstacles::is_executed_after(std::uint32_t number, std::uint32_t other) const {
  const std::vector<std::uint32_t> way = last_way_to(facts_.flow, number), other_way = last_way_to(facts_.flow, other);
  return facts_.flow.nodes[way.front()].routine == facts_.flow.nodes[other_way.front()].routine && other_way > way;
}

bool Obstacles::is_so_already(const std::vector<Conditions>& ways) const {
  return std::ranges::any_of(ways, [&](const Conditions& way) { return ways_.changes(way).empty(); });
}

/// That `later`, which is executed after `number`, has power flow or none, as is wanted; or that it is not called there.
std::vector<Conditions> Obstacles::kept_harmless(std::uint32_t number, std::uint32_t later, bool power) const {
  std::vector<Conditions> ways = ways_.input(later, 0, power);
  const std::vector<std::uint32_t> way = last_way_to(facts_.flow, number), later_way = last_way_to(facts_.flow, later);
  const auto parts = std::ranges::mismatch(way, later_way).in2;
  for (auto call = parts; call != later_way.end() && *call != later; ++call) {
    const bool only_one =
        std::ranges::count(facts_.flow.calls, facts_.flow.nodes[op(*call).target].routine, &CallSite::routine) == 1;
    if (only_one && !facts_.flow.nodes[*call].powered) ways = ways_.either(std::move(ways), ways_.input(*call, 0, false));
  }
  return ways;
}

void Obstacles::add_ways_of_bit(Obstacle& to, const Writers& writers, const Bits& bit, bool wanted) {
  std::vector<Conditions> ways;
  std::vector<std::uint32_t> rungs = writers.deciding;
  for (const std::uint32_t by : writers.deciding) {
    const bool coil = is_among(op(by).instruction->mnemonic, {"=", "=I"});
    std::vector<Conditions> own = ways_.to(by, coil ? wanted : true);
    for (const auto* list : {&writers.deciding, &writers.opposing})
      for (const std::uint32_t other : *list) {
        const bool other_coil = is_among(op(other).instruction->mnemonic, {"=", "=I"});
        const bool opposes = list == &writers.opposing;
        if ((!other_coil && !opposes) || !is_executed_after(by, other)) continue;
        const std::vector<Conditions> harmless = kept_harmless(by, other, other_coil && wanted);
        own = ways_.both(own, harmless);
        const bool beside = facts_.flow.nodes[other].routine == facts_.flow.nodes[by].routine;
        const bool told = opposes && (beside || !is_so_already(harmless));
        if (told && std::ranges::find(rungs, other) == rungs.end()) rungs.push_back(other);
      }
    ways = ways_.either(std::move(ways), own);
  }
  std::erase_if(ways, [&](const Conditions& way) {  // it would have to be so already
    return std::ranges::any_of(way, [&](const Condition& each) {
      const ContactForm form = contact_form(*op(each.op).instruction);
      return form.kind == ContactForm::Kind::Bit && bit_at(op(each.op)[0]) == bit && (each.on != form.inverted) == wanted &&
             is_on(bit) != wanted;
    });
  });
  std::ranges::sort(rungs);
  add_rungs(to, rungs);
  const bool by_others =
      !writers.others.empty() || !writers.calls.empty() || !writers.messages.empty() || !writers.pointers.empty();
  const std::string_view never = by_others ? "no contact can do that"
                                 : wanted  ? "it can never be on"
                                           : "it can never be off";
  if (!writers.deciding.empty()) add_ways(to, ways, never, writers.deciding);
  for (std::size_t i = 0; i < std::min(kMostOfMemory, writers.others.size()); ++i)
    to.because.push_back(of_writer(writers.others[i], bit, wanted));
  for (std::size_t i = 0; i < std::min(kMostOfMemory, writers.calls.size()); ++i)
    to.because.push_back(of_call(writers.calls[i], bit, wanted));
  add_indirect(to, writers, bit);
  if (to.because.empty() && to.text.empty()) to.text = kOnlyFromOutside;
}

void Obstacles::add_rungs(Obstacle& to, const std::vector<std::uint32_t>& writers) const {
  for (std::size_t i = 0; i < std::min(kMostOfMemory, writers.size()); ++i) {
    const std::uint32_t by = writers[i];
    const auto never = never_executed(by);
    const std::string idle = never ? ", but " + *never : has_run_ && !runs(by) ? ", not executed lately" : "";
    to.because.push_back({.kind = "rung",
                          .text = fmt::format("{}: {}{}{}", place_text(by), rung_text(by, 0), interrupt_text(by), idle),
                          .op = by});
  }
  if (writers.size() > kMostOfMemory)
    to.because.push_back(
        {.kind = "more", .text = fmt::format("and {} more of its instructions", writers.size() - kMostOfMemory)});
}

void Obstacles::add_indirect(Obstacle& to, const Writers& writers, const Bits& bits) const {
  for (const std::uint32_t by : writers.messages) {
    const Op& receives = op(by);
    const bool known = receives.instruction->effect == Effect::Receives && !receives[0].pointer;
    const std::uint64_t place = bits.first / 8, buffer = receives[0].at;
    constexpr std::uint64_t kLongestMessage = 255;
    const bool elsewhere = known && (place < buffer || place > buffer + kLongestMessage);
    const std::string does = elsewhere ? "receives messages, whose status stands there"
                             : known && place > buffer
                                 ? fmt::format("stores character {} of a message there", place - buffer)
                                 : "lets a message be stored there";
    to.because.push_back({.kind = "message", .text = fmt::format("{} {}", place_text(by), does), .op = by});
  }
  if (writers.pointers.empty()) return;
  const std::size_t more = writers.pointers.size() - 1;
  to.because.push_back({.kind = "pointer",
                        .text = fmt::format("{} may reach it through a pointer{}", place_text(writers.pointers.front()),
                                            more == 0 ? "" : fmt::format(", and {}", counted(more, "other instruction"))),
                        .op = writers.pointers.front()});
}

/// The bit that an instruction without pointers moves to another.
std::optional<Bits> Obstacles::moved_from(std::uint32_t number, const Bits& bit) const {
  return op(number).has_pointer ? std::nullopt : source_of(program(), number, bit, cpu_.state().image);
}

/// A move from memory leads to the bit that it moves there.
Obstacle Obstacles::of_writer(std::uint32_t number, const Bits& bit, bool wanted) {
  Obstacle found{
      .kind = "write", .text = fmt::format("{} writes it: {}", place_text(number), rung_text(number, 0)), .op = number};
  const auto source = bit.count == 1 ? moved_from(number, bit) : std::nullopt;
  if (source && !constant_bit(program(), *source)) {
    const Area area = area_of(*source);
    const bool is_plain = area != Area::T && area != Area::C && area != Area::AC && area != Area::L;
    if (is_plain && is_on(*source) != wanted) found.because.push_back(of_bit(*source, wanted));
  }
  add_ways_if_any_changes(found, ways_.to(number, true));
  return found;
}

Obstacle Obstacles::of_call(std::uint32_t call, const Bits& bit, bool wanted) {
  Obstacle found{
      .kind = "call", .text = fmt::format("{} gets it back: {}", place_text(call), rung_text(call, 0)), .op = call};
  const std::uint32_t routine = facts_.flow.nodes[op(call).target].routine;
  const auto before = look_within(routine, call);
  for (const Parameter& parameter : parameters_of(program(), call)) {
    if (parameter.role == Role::In || parameter.actual.pointer || parameter.width != Width::Bit) continue;
    if (!(bit_at(parameter.actual) == bit)) continue;
    Obstacle inside = of_memory(local_bits(parameter), wanted, routine);
    inside.bits = {0, 0};
    inside.value = bit_text(contacts_.argument(call, parameter));
    found.because.push_back(std::move(inside));
  }
  look_within(routine, before);
  add_ways_if_any_changes(found, ways_.to(call, true));
  return found;
}

Obstacle Obstacles::of_value(const Bits& bits) {
  const auto told = told_before(bits, true);
  Obstacle found = value_followed(bits);
  if (!told) {
    note_told(bits, true, found);
    return found;
  }
  found.because.clear();
  found.same_as = told->same_as;
  return found;
}

Obstacle Obstacles::value_followed(const Bits& bits) {
  Obstacle found{.kind = "value", .name = name_of(bits)};
  const auto at = static_cast<std::uint32_t>(bits.first / 8);
  const Area area = area_of(bits);
  const Width width = bits.count == 8 ? Width::Byte : bits.count == 16 ? Width::Word : Width::Double;
  if (auto range = range_at(at, width, *program().model)) {
    found.value = value_text(program(), *range, range->bytes_in(cpu_.state().image));
    if (bits.count <= 32 && area != Area::L && area != Area::AC) found.bits = bits;
  }
  found.text = area == Area::T || area == Area::C ? "" : meaning_text(*program().model, bits);
  if (add_forced(found, bits)) return found;
  if (area == Area::I || area == Area::AI || area == Area::HC) return found;
  const Writers writers = writers_of(bits, true, {});
  std::vector<std::uint32_t> all = writers.deciding;
  for (const auto* list : {&writers.opposing, &writers.others, &writers.calls})
    all.insert(all.end(), list->begin(), list->end());
  if (area == Area::T || area == Area::C) found.kind = area == Area::T ? "timer" : "counter";
  std::ranges::sort(all);
  add_rungs(found, all);
  add_indirect(found, writers, bits);
  if (found.because.empty() && found.text.empty()) found.text = kOnlyFromOutside;
  return found;
}

}  // namespace s7200::tools
