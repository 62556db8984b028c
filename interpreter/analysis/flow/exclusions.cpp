#include "interpreter/analysis/flow/exclusions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max() / 4;

/// Memory that changes only when an instruction writes it: an image, but no input point, clock or analog input; no timer
/// that counts while the program runs.
bool changes_by_instructions(std::uint32_t at) {
  const auto within = [at](std::uint32_t from, std::uint32_t to) { return at >= from && at < to; };
  const auto is_slow = [](std::uint32_t timer) { return timer_base(timer).base != kMillisecond; };
  if (within(image::kT, image::kC)) return is_slow((at - image::kT) / 2);
  return within(image::kI, image::kSM) || within(image::kS, image::kAI) || within(image::kC, image::kHC) ||
         within(image::kCBits, image::kInputs) || within(image::kAC, image::kTBits) || within(image::kV, image::kConstants);
}

/// Floats as numbers in the same order, +0 and -0 alike.
std::int64_t in_order(std::int64_t bits) { return bits >= 0 ? bits : -(bits & 0x7FFF'FFFF); }

bool is_nan(std::int64_t bits) { return (bits & 0x7FFF'FFFF) > 0x7F80'0000; }

bool are_apart(const ValuesOfContact& some, const ValuesOfContact& others) {
  if (some.outside && others.outside) return false;
  if (some.outside) return some.least <= others.least && others.most <= some.most;
  if (others.outside) return are_apart(others, some);
  return some.most < others.least || others.most < some.least;
}

/// The values with which a contact does not let power through.
ValuesOfContact others_than(const ValuesOfContact& values, const Bits& bits) {
  if (bits.count == 1) return {1 - values.least, 1 - values.least};
  if (!values.outside && values.least == -kNoLimit) return {values.most + 1, kNoLimit};
  if (!values.outside && values.most == kNoLimit) return {-kNoLimit, values.least - 1};
  return {values.least, values.most, !values.outside};
}

std::string_view relation_text(Relation relation) {
  switch (relation) {
    case Relation::Equal:
      return "=";
    case Relation::NotEqual:
      return "<>";
    case Relation::Greater:
      return ">";
    case Relation::GreaterEqual:
      return ">=";
    case Relation::Less:
      return "<";
    case Relation::LessEqual:
      return "<=";
  }
  return "";
}

}  // namespace

Exclusions::Subject Exclusions::subject_of(std::uint32_t number) const {
  const Op& op = facts_.program.ops[number];
  const ContactForm form = contact_form(*op.instruction);
  if (op[0].pointer || op[0].unread() || op[0].at >= image::kConstants) return {};
  if (form.kind == ContactForm::Kind::Bit || op.instruction->structure == Structure::SegmentBegin) {
    const std::int64_t closed = form.inverted ? 0 : 1;
    const Bits bit{std::uint64_t{op[0].at} * 8 + op[0].bit, 1};
    const bool of_timer = bit.first >= image::kTBits * 8u && bit.first < image::kCBits * 8u;
    const bool steady = of_timer
                            ? timer_base(static_cast<std::uint32_t>(bit.first - image::kTBits * 8u)).base != kMillisecond
                            : changes_by_instructions(op[0].at);
    return steady ? Subject{.bits = bit, .closed = {closed, closed}} : Subject{};
  }
  if (form.kind != ContactForm::Kind::Numbers || !changes_by_instructions(op[0].at)) return {};
  const bool real = form.type == ContactForm::Type::Real;
  const Width width = op.instruction->operand[0].width;
  const auto constant = constant_value(facts_.program, op[1], width);
  if (!constant || (real && is_nan(*constant))) return {};
  const std::int64_t with = real ? in_order(*constant) : *constant;
  Subject subject{.bits = {std::uint64_t{op[0].at} * 8, std::uint64_t{bytes_of(width)} * 8}, .exact = !real};
  const bool below = form.relation == Relation::Less || form.relation == Relation::LessEqual;
  const bool above = form.relation == Relation::Greater || form.relation == Relation::GreaterEqual;
  const std::int64_t strict = form.relation == Relation::Less ? -1 : form.relation == Relation::Greater ? 1 : 0;
  subject.closed = {below ? -kNoLimit : with + strict, above ? kNoLimit : with + strict,
                    form.relation == Relation::NotEqual};
  return subject;
}

Exclusions::Exclusions(const Facts& facts) : facts_(facts) {
  for (std::uint32_t op = 0; op < facts.program.ops.size(); ++op) subjects_.push_back(subject_of(op));
}

std::optional<Exclusion> Exclusions::between(const Condition& first, const Condition& second) const {
  const Subject &one = subjects_[first.op], &other = subjects_[second.op];
  if (one.bits.count == 0 || !(one.bits == other.bits)) return {};
  if ((!first.on && !one.exact) || (!second.on && !other.exact)) return {};
  const ValuesOfContact needed = first.on ? one.closed : others_than(one.closed, one.bits);
  const ValuesOfContact also_needed = second.on ? other.closed : others_than(other.closed, other.bits);
  if (!are_apart(needed, also_needed)) return {};
  if (second.op < first.op) return between(second, first);
  const auto [known, is_new] = known_.try_emplace({first, second});
  if (is_new) known->second = of_same_value(first, second, one.bits);
  return known->second;
}

std::optional<Exclusion> Exclusions::of_same_value(const Condition& first, const Condition& second, const Bits& bits) const {
  if (!is_same_value(first.op, second.op, bits)) return {};
  return Exclusion{first, second, is_written_by_interrupt(bits)};
}

std::optional<Exclusion> Exclusions::of_looking_twice(std::uint32_t op) const {
  const Subject& subject = subjects_[op];
  if (subject.bits.count == 0) return {};
  const auto& nodes = facts_.flow.nodes;
  for (std::uint32_t again = op + 1; again < nodes.size() && nodes[again].network == nodes[op].network; ++again) {
    if (!(subjects_[again].bits == subject.bits)) continue;
    const Condition second{again, !(subjects_[again].closed == subject.closed)};
    return of_same_value({op, true}, second, subject.bits);
  }
  return {};
}

bool Exclusions::may_be_within(std::uint32_t first, std::uint32_t end) const {
  std::map<std::pair<std::uint64_t, std::uint64_t>, ValuesOfContact> seen;
  bool again = false, inverts = false;
  for (std::uint32_t op = first; op < end; ++op) {
    const Subject& subject = subjects_[op];
    inverts |= facts_.program.ops[op].instruction->mnemonic == "NOT";
    if (subject.bits.count == 0) continue;
    const auto [other, is_new] = seen.try_emplace({subject.bits.first, subject.bits.count}, subject.closed);
    if (!is_new && !(other->second == subject.closed)) return true;
    again |= !is_new;
  }
  return again && inverts;
}

bool Exclusions::writes(std::uint32_t op, const Bits& bits) const {
  return std::ranges::any_of(facts_.effects[op],
                             [&](const MemoryAccess& access) { return access.writes() && access.bits.overlaps(bits); });
}

/// In one straight way nothing may write it between the two, elsewhere nothing at all, and no message may be stored there.
bool Exclusions::is_same_value(std::uint32_t first, std::uint32_t second, const Bits& bits) const {
  const auto& ops = facts_.program.ops;
  const auto is_straight = [&](std::uint32_t op) {
    const Structure structure = ops[op].instruction->structure;
    return (structure == Structure::None || structure == Structure::Compare) && !writes(op, bits);
  };
  bool straight = true, written = false;
  for (std::uint32_t op = first + 1; op < second && straight; ++op) straight = is_straight(op);
  for (std::uint32_t op = 0; op < ops.size(); ++op) {
    const bool by_itself = facts_.flow.routine_of(op).kind != Routine::Kind::Interrupt;
    const bool stores_later = ops[op].instruction->effect == Effect::Receives || ops[op].instruction->mnemonic == "NETR" ||
                              ops[op].instruction->mnemonic == "NETW";
    if (!writes(op, bits)) continue;
    if (stores_later) return false;
    written = written || by_itself;
  }
  const bool local = bits.first >= image::kL * 8u;
  const bool accumulator = bits.first >= image::kAC * 8u && bits.first < image::kTBits * 8u;
  return straight || (!written && !local && !accumulator);
}

bool Exclusions::is_written_by_interrupt(const Bits& bits) const {
  if (!in_interrupt_) {
    const Calls calls = calls_of(facts_.program, facts_.flow);
    in_interrupt_.emplace();
    for (const Calls::Node& node : calls.nodes) in_interrupt_->push_back(node.by_interrupt);
  }
  const bool own = (bits.first >= image::kAC * 8u && bits.first < image::kTBits * 8u) || bits.first >= image::kL * 8u;
  for (std::uint32_t op = 0; op < facts_.program.ops.size() && !own; ++op)
    if ((*in_interrupt_)[facts_.flow.nodes[op].routine] && writes(op, bits)) return true;
  return false;
}

std::string condition_text(const Program& program, const Condition& condition) {
  const Op& op = program.ops[condition.op];
  const stl::Statement& statement = program.statement(condition.op);
  const ContactForm form = contact_form(*op.instruction);
  const auto operand = [&](std::size_t i) { return stl::to_text(statement.operands[i]); };
  const std::string text =
      form.compares() ? fmt::format("{} {} {}", operand(0), relation_text(form.relation), operand(1)) : operand(0);
  return fmt::format("{}{} (line {})", condition.on != form.inverted ? "" : "not ", text, statement.position.line);
}

std::string exclusion_text(const Program& program, const Exclusion& exclusion) {
  return fmt::format("{} and {} exclude each other{}", condition_text(program, exclusion.first),
                     condition_text(program, exclusion.second),
                     exclusion.unless_interrupted ? ", unless an interrupt comes between" : "");
}

}  // namespace s7200
