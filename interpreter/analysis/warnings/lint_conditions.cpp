// Warnings about conditions: what can never be fulfilled, and counters that are reset too early.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/flow/ways.hpp"
#include "interpreter/analysis/warnings/lint.hpp"
#include "interpreter/analysis/warnings/lint_ops.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/program/checking/warnings.hpp"

namespace s7200 {

using namespace lint;

namespace {

Ways ways_at_any_time(const Facts& facts) {
  return Ways(facts, {[](std::uint32_t) { return false; }, [](std::uint32_t) { return true; }});
}

/// The networks, from the first op until before the end, in which two contacts may exclude each other.
std::vector<Stretch> suspicious_networks(const Facts& facts) {
  const Exclusions exclusions(facts);
  std::vector<Stretch> found;
  const auto count = static_cast<std::uint32_t>(facts.program.ops.size());
  for (std::uint32_t first = 0, end = 0; first < count; first = end) {
    for (end = first + 1; end < count && facts.flow.nodes[end].network == facts.flow.nodes[first].network;) ++end;
    if (exclusions.may_be_within(first, end)) found.push_back({first, end});
  }
  return found;
}

/// Whether a level depends on one bit alone: `LD M0.0`, `AN M0.0` makes a 0, and is meant so.
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
  return only.statement && contact_form(*facts.program.ops[ways.op_of(only)].instruction).kind == ContactForm::Kind::Bit;
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

}  // namespace

void find_never_true(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program)) return;
  const std::vector<Stretch> networks = suspicious_networks(facts);
  if (networks.empty()) return;
  const Ways ways = ways_at_any_time(facts);
  std::set<std::uint32_t> told;  // the later one of both
  for (const Stretch& network : networks)
    for (std::uint32_t op = network.from; op < network.to; ++op)
      for (std::size_t level = 0; level < ways.rung_of(op).inputs.size(); ++level) {
        const bool never = ways.input(op, level, true).empty();
        const auto exclusion = ways.take_exclusion();
        if (!never || !exclusion || looks_at_one_bit(facts, ways, ways.rung_of(op), level) ||
            !told.insert(exclusion->second.op).second)
          continue;
        diagnostics.push_back(warn(Warning::NeverTrue, place(program, exclusion->second.op),
                                   exclusion_text(program, *exclusion) + ": this condition is never true",
                                   "compare with O in place of A if one of them is enough, or take out the rung"));
      }
}

void find_unreached_presets(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (has_unread(program) || std::ranges::none_of(program.ops, counts_up)) return;
  const Ways ways = ways_at_any_time(facts);
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
    if (!reset || *reset >= *preset) continue;
    diagnostics.push_back(warn(Warning::UnreachedPreset, place(program, box),
                               fmt::format("{} is reset when it has counted to {} and never comes to its preset of {}: its "
                                           "bit is never on",
                                           written(program, box, 0), *reset, *preset),
                               fmt::format("give it the preset {}, or reset it by its bit", *reset)));
  }
}

}  // namespace s7200
