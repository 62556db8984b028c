// Warnings about conditions: what can never be fulfilled, and counters that are reset too early.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/flow/paths.hpp"
#include "interpreter/analysis/flow/ways.hpp"
#include "interpreter/analysis/warnings/lint.hpp"
#include "interpreter/analysis/warnings/lint_ops.hpp"
#include "interpreter/base/text/among.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/program/checking/warnings.hpp"

namespace s7200 {

using namespace lint;

namespace {

/// A text without networks has all its rungs in one; each is looked at by itself.
class Rungs {
 public:
  explicit Rungs(const Facts& facts) {
    const auto count = static_cast<std::uint32_t>(facts.program.ops.size());
    begins_.resize(count);
    for (std::uint32_t first = 0, end = 0; first < count; first = end) {
      for (end = first + 1; end < count && facts.flow.nodes[end].network == facts.flow.nodes[first].network;) ++end;
      split(facts.program, first, end);
    }
  }

  const std::vector<Stretch>& all() const { return all_; }
  std::uint32_t first_of(std::uint32_t op) const { return begins_[op]; }

 private:
  /// A rung begins with a load below which nothing is used any more up to the end of the network.
  void split(const Program& program, std::uint32_t first, std::uint32_t end) {
    constexpr int kLevels = 9;  // LDS may use each
    std::uint32_t to = end;
    int used = 0;  // levels of the stack, by what comes behind
    for (std::uint32_t op = end; op-- > first;) {
      const auto& stack = program.ops[op].instruction->rung.stack;
      const int needs = program.ops[op].instruction->mnemonic == "LDS" ? kLevels : stack.needs;
      used = std::max(needs, used - stack.change);
      if (op != first && (used != 0 || stack.needs != 0 || stack.change <= 0)) continue;
      std::fill(begins_.begin() + op, begins_.begin() + to, op);
      all_.push_back({op, to});
      to = op;
    }
  }

  std::vector<Stretch> all_{};           // of a network the last one first
  std::vector<std::uint32_t> begins_{};  // by op
};

Ways ways_at_any_time(const Facts& facts, const Rungs& rungs) {
  return Ways(facts, {[](std::uint32_t) { return false; }, [](std::uint32_t) { return true; },
                      [&rungs](std::uint32_t op) { return rungs.first_of(op); }});
}

/// The rungs in which two contacts may exclude each other. A very long one is left out: its ways are too many.
std::vector<Stretch> suspicious_rungs(const Facts& facts, const Rungs& rungs) {
  constexpr std::uint32_t kLongest = 200;  // instructions
  const Exclusions exclusions(facts);
  std::vector<Stretch> found;
  for (const Stretch& rung : rungs.all())
    if (rung.to - rung.from <= kLongest && exclusions.may_be_within(rung.from, rung.to)) found.push_back(rung);
  std::ranges::sort(found, {}, &Stretch::from);
  return found;
}

/// What a comparison of numbers of a width is for all of them; nothing if it depends on them. Of reals nothing is told.
std::optional<bool> same_for_all(const ContactForm& form, const ValueRange& a, const ValueRange& b) {
  const auto is_below = [](const ValueRange& x, const ValueRange& y) -> std::optional<bool> {
    if (x.most < y.least) return true;
    return x.least >= y.most ? std::optional(false) : std::nullopt;
  };
  const auto inverted = [](std::optional<bool> result) { return result ? std::optional(!*result) : result; };
  switch (form.relation) {
    case Relation::Less:
      return is_below(a, b);
    case Relation::Greater:
      return is_below(b, a);
    case Relation::GreaterEqual:
      return inverted(is_below(a, b));
    case Relation::LessEqual:
      return inverted(is_below(b, a));
    case Relation::Equal:
    case Relation::NotEqual:
      break;
  }
  const bool numbers = a.least == a.most && b.least == b.most;  // no width has a constant that it cannot have
  return numbers ? std::optional((a == b) == (form.relation == Relation::Equal)) : std::nullopt;
}

/// Whether a constant is another number to the instruction than it is as written: -1 of a byte is 255.
bool has_other_sign(const Program& program, std::uint32_t op, Width width) {
  const auto& written = program.statement(op).operands;
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto* integer = std::get_if<stl::Integer>(&written[i].value);
    const auto constant = constant_value(program, program.ops[op][i], width);
    if (integer && constant && integer->form == stl::Integer::Form::Decimal && integer->value != *constant) return true;
  }
  return false;
}

std::string_view range_text(Width width) {
  return width == Width::Byte   ? "a byte is from 0 to 255"
         : width == Width::Word ? "a word is from -32768 to 32767"
                                : "a double word is from -2147483648 to 2147483647";
}

/// Whether a level depends on one bit alone: `LD M0.0`, `AN M0.0` makes a 0, and is meant so. Nobody makes one of an input,
/// an output, a timer or a counter.
bool looks_at_one_bit(const Facts& facts, const Ways& ways, const RungLogic& rung, std::size_t level) {
  using Kind = NetworkLogic::Gate::Kind;
  std::set<std::size_t> contacts;
  std::vector<std::size_t> open{rung.inputs[level]};
  while (!open.empty()) {
    const NetworkLogic::Gate& gate = rung.logic.gates[open.back()];
    open.pop_back();
    if (gate.kind == Kind::Contact) contacts.insert(gate.a);
    if (gate.kind == Kind::Contact || gate.kind == Kind::True) continue;
    open.push_back(gate.a);
    if (gate.kind != Kind::Not) open.push_back(gate.b);
  }
  if (contacts.size() != 1) return false;
  const NetworkLogic::Contact& only = rung.logic.contacts[*contacts.begin()];
  if (!only.statement) return false;
  const Op& contact = facts.program.ops[ways.op_of(only)];
  constexpr Areas kNotOwn = set_of(Area::I) | set_of(Area::Q) | set_of(Area::T) | set_of(Area::C);
  return contact_form(*contact.instruction).kind == ContactForm::Kind::Bit &&
         !contains(kNotOwn, area_of(as_named({contact[0].at * std::uint64_t{8} + contact[0].bit, 1})));
}

bool counts_up(const Op& op) { return op.instruction->mnemonic == "CTU" || op.instruction->mnemonic == "CTUD"; }

/// The counter of a box.
std::uint32_t counter_of(const Op& box) { return box[2].at; }

bool is_looked_at(const Facts& facts, std::uint32_t counter) {
  const Bits bit{image::kCBits * 8u + counter, 1};
  return std::ranges::any_of(facts.program.ops, [&](const Op& op) {
    const bool contact = contact_form(*op.instruction).kind == ContactForm::Kind::Bit && !op[0].pointer && !op[0].unread();
    return contact && Bits{op[0].at * 8u + op[0].bit, 1} == bit;
  });
}

bool compares(const Program& program, std::uint32_t op) {
  return contact_form(*program.ops[op].instruction).kind == ContactForm::Kind::Numbers;
}

/// Whether only its box, and R, write the value of a counter: then it goes up one by one.
bool counts_one_by_one(const Facts& facts, std::uint32_t box) {
  const Bits value{(image::kC + 2 * std::uint64_t{counter_of(facts.program.ops[box])}) * 8, 16};
  for (std::uint32_t op = 0; op < facts.effects.size(); ++op) {
    if (op == box || is_among(facts.program.ops[op].instruction->mnemonic, {"R", "RI"})) continue;
    for (const MemoryAccess& access : facts.effects[op])
      if (access.writes() && access.bits.overlaps(value)) return false;
  }
  return true;
}

/// The lowest value from which on a comparison is closed: 20 of `LDW>= C5, 20`, and of `LDW= C5, 20` as it counts one by
/// one.
std::optional<std::int64_t> reached_at(const Program& program, std::uint32_t op, std::uint32_t counter) {
  const Op& contact = program.ops[op];
  const ContactForm form = contact_form(*contact.instruction);
  const bool compares = form.kind == ContactForm::Kind::Numbers && form.type == ContactForm::Type::Word;
  if (!compares || contact[0].pointer || contact[0].at != image::kC + 2 * counter) return {};
  const auto with = constant_value(program, contact[1], Width::Word);
  if (!with || *with < 1) return {};
  if (form.relation == Relation::GreaterEqual || form.relation == Relation::Equal) return *with;
  return form.relation == Relation::Greater ? std::optional(*with + 1) : std::nullopt;
}

/// The value at which a comparison alone resets a counter.
std::optional<std::int64_t> reset_at(const Program& program, const Ways& ways, std::uint32_t box) {
  std::optional<std::int64_t> lowest;
  for (const Conditions& way : ways.input(box, 0, true)) {
    if (way.size() != 1 || !way.front().on) continue;
    const auto value = reached_at(program, way.front().op, counter_of(program.ops[box]));
    if (value && (!lowest || *value < *lowest)) lowest = value;
  }
  return lowest;
}

/// Whether an operand is written as a name, and no number.
bool is_symbol(std::string_view text) {
  return !text.empty() && (stl::is_letter(text[0]) || text[0] == '_' || text[0] == '"' || !stl::is_ascii(text));
}

}  // namespace

void find_constant_comparisons(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    const ContactForm form = contact_form(*op.instruction);
    const bool reals = form.type == ContactForm::Type::Real;
    if (form.kind != ContactForm::Kind::Numbers || reals || op[0].unread() || op[1].unread()) continue;
    const Width width = op.instruction->operand[0].width;
    const auto values = [&](const Operand& operand) {
      const auto constant = constant_value(program, operand, width);
      return constant ? ValueRange{*constant, *constant} : range_of(width);
    };
    if (has_other_sign(program, i, width)) continue;  // that is the warning then
    const ValueRange a = values(op[0]), b = values(op[1]);
    const auto always = same_for_all(form, a, b);
    if (!always) continue;
    const bool both = a.least == a.most && b.least == b.most;
    if (both && (is_symbol(written(program, i, 0)) || is_symbol(written(program, i, 1)))) continue;  // a switch of the project
    diagnostics.push_back(
        warn(Warning::ConstantContact, place(program, i),
             fmt::format("{}: this contact never {}", both ? "it compares two constants" : range_text(width),
                         *always ? "opens" : "closes"),
             "compare with another number, or take out the contact, or the rung if it is not meant to work"));
  }
}

void find_never_true(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program)) return;
  const Rungs rungs(facts);
  const std::vector<Stretch> suspicious = suspicious_rungs(facts, rungs);
  if (suspicious.empty()) return;
  const Ways ways = ways_at_any_time(facts, rungs);
  std::set<std::uint32_t> told;  // the later one of both
  for (const Stretch& rung : suspicious)
    for (std::uint32_t op = rung.from; op < rung.to; ++op)
      for (std::size_t level = 0; level < ways.rung_of(op).inputs.size(); ++level) {
        const bool never = ways.input(op, level, true).empty();
        const auto exclusion = ways.take_exclusion();
        if (!never || !exclusion || looks_at_one_bit(facts, ways, ways.rung_of(op), level) ||
            !told.insert(exclusion->second.op).second)
          continue;
        diagnostics.push_back(warn(Warning::NeverTrue, place(program, exclusion->second.op),
                                   exclusion_text(program, *exclusion) + ": this condition is never true",
                                   compares(program, exclusion->first.op)
                                       ? "compare with O in place of A if one of them is enough, or take out the rung"
                                       : "change one of the two contacts, or take out the rung"));
      }
}

void find_unreached_presets(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program) || std::ranges::none_of(program.ops, counts_up)) return;
  const Rungs rungs(facts);
  const Ways ways = ways_at_any_time(facts, rungs);
  for (std::uint32_t box = 0; box < program.ops.size(); ++box) {
    const Op& op = program.ops[box];
    if (!counts_up(op) || op.in_segment) continue;
    const auto is_of_counter = [&](const Op& other) {
      return other.instruction->hidden == Hidden::Number && other.instruction->operand[0].areas == set_of(Area::C) &&
             counter_of(other) == counter_of(op);
    };
    const auto preset = constant_value(program, op[1], Width::Word);
    if (!preset || std::ranges::count_if(program.ops, is_of_counter) != 1 || !is_looked_at(facts, counter_of(op))) continue;
    const auto reset = reset_at(program, ways, box);
    if (!reset || *reset >= *preset || !counts_one_by_one(facts, box)) continue;
    diagnostics.push_back(warn(Warning::UnreachedPreset, place(program, box),
                               fmt::format("{} is reset when it has counted to {} and never comes to its preset of {}: its "
                                           "bit is never on",
                                           written(program, box, 0), *reset, *preset),
                               fmt::format("give it the preset {}, or reset it by its bit", *reset)));
  }
}

}  // namespace s7200
