#include "interpreter/analysis/flow/ways.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

namespace s7200 {
namespace {

using Gate = NetworkLogic::Gate;

const std::vector<Conditions> kAlways{Conditions{}};

Structure structure_of(const Op& op) { return op.instruction->structure; }

/// The LSCR in front of an op of a segment.
std::uint32_t segment_of(const Program& program, std::uint32_t op) {
  while (op > 0 && structure_of(program.ops[op]) != Structure::SegmentBegin) --op;
  return op;
}

/// Whether the inputs of an instruction depend on what is in front of the statements that were read.
bool depends_on_front(const RungLogic& rung) {
  std::vector<bool> needed(rung.logic.gates.size());
  for (const std::size_t gate : rung.inputs) needed[gate] = true;
  for (std::size_t i = needed.size(); i-- > 0;) {
    const Gate& gate = rung.logic.gates[i];
    if (!needed[i] || gate.kind == Gate::Kind::True) continue;
    if (gate.kind == Gate::Kind::Contact) {
      if (!rung.logic.contacts[gate.a].statement) return true;
      continue;
    }
    needed[gate.a] = true;
    if (gate.kind != Gate::Kind::Not) needed[gate.b] = true;
  }
  return false;
}

}  // namespace

Ways::Ways(const Facts& facts, Present present) : facts_(facts), present_(std::move(present)), exclusions_(facts) {}

/// Nothing if they contradict each other.
std::optional<Conditions> Ways::merged(const Conditions& first, const Conditions& second) const {
  Conditions all;
  std::ranges::set_union(first, second, std::back_inserter(all));
  const auto same_op = [](const Condition& a, const Condition& b) { return a.op == b.op; };
  if (const auto same = std::ranges::adjacent_find(all, same_op); same != all.end()) {
    exclusion_ = exclusions_.of_looking_twice(same->op);
    return {};
  }
  for (const Condition& one : first)
    for (const Condition& other : second) {
      const auto exclusion = one.op == other.op ? std::nullopt : exclusions_.between(one, other);
      if (!exclusion) continue;
      exclusion_ = exclusion;
      return {};
    }
  return all;
}

std::optional<Exclusion> Ways::take_exclusion() const {
  const bool left_some_out = std::exchange(left_some_out_, false);
  const auto exclusion = std::exchange(exclusion_, std::nullopt);
  return left_some_out ? std::nullopt : exclusion;
}

Conditions Ways::changes(const Conditions& way) const {
  Conditions all;
  std::ranges::copy_if(way, std::back_inserter(all),
                       [&](const Condition& each) { return present_.holds(each.op) != each.on; });
  return all;
}

void Ways::prune(std::vector<Conditions>& ways) const {
  std::vector<std::tuple<std::size_t, std::size_t, Conditions>> ranked;
  for (Conditions& way : ways) {
    const std::size_t changed = changes(way).size(), all = way.size();
    ranked.emplace_back(changed, all, std::move(way));
  }
  std::ranges::sort(ranked);
  ranked.erase(std::unique(ranked.begin(), ranked.end()), ranked.end());
  if (ranked.size() > kMost) {
    ranked.resize(kMost);
    left_some_out_ = true;
  }
  ways.clear();
  for (auto& each : ranked) ways.push_back(std::move(std::get<Conditions>(each)));
}

std::vector<Conditions> Ways::both(const std::vector<Conditions>& first, const std::vector<Conditions>& second) const {
  std::vector<Conditions> all;
  for (const Conditions& one : first)
    for (const Conditions& other : second)
      if (auto way = merged(one, other)) all.push_back(std::move(*way));
  prune(all);
  return all;
}

std::vector<Conditions> Ways::either(std::vector<Conditions> first, const std::vector<Conditions>& second) const {
  first.insert(first.end(), second.begin(), second.end());
  prune(first);
  return first;
}

std::vector<Conditions> Ways::fewest_changes(const std::vector<Conditions>& ways) const {
  std::vector<Conditions> all;
  for (const Conditions& way : ways) all.push_back(changes(way));
  std::ranges::stable_sort(all, {}, &Conditions::size);
  std::vector<Conditions> fewest;
  for (const Conditions& one : all)
    if (std::ranges::none_of(fewest, [&](const Conditions& other) { return std::ranges::includes(one, other); }))
      fewest.push_back(one);
  return fewest;
}

std::uint32_t Ways::op_of(const NetworkLogic::Contact& contact) const {
  return static_cast<std::uint32_t>(contact.statement - facts_.program.statements.data());
}

RungLogic Ways::read_rung(std::uint32_t first, std::uint32_t op) const {
  const Program& program = facts_.program;
  std::vector<const stl::Statement*> statements;
  for (std::uint32_t i = first; i <= op; ++i) statements.push_back(&program.statements[i]);
  StackBetween between{.on = facts_.flow.nodes[first].powered};
  RungLogic rung{logic_of(statements, between), {}};
  const auto& actions = rung.logic.actions;
  const auto own = std::ranges::find(actions, &program.statements[op], &NetworkLogic::Action::statement);
  if (own != actions.end()) rung.inputs = own->inputs;
  return rung;
}

/// A network may go on with the power flow of the one before it.
const RungLogic& Ways::rung_of(std::uint32_t op) const {
  if (const auto known = rungs_.find(op); known != rungs_.end()) return known->second;
  const Routine& routine = facts_.flow.routine_of(op);
  std::uint32_t first = present_.begins ? present_.begins(op) : facts_.flow.nodes[op].network;
  RungLogic rung = read_rung(first, op);
  while (depends_on_front(rung) && first > routine.first) {
    first = facts_.flow.nodes[first - 1].network;
    rung = read_rung(first, op);
  }
  return rungs_.emplace(op, std::move(rung)).first->second;
}

std::vector<Conditions> Ways::of_gate(const NetworkLogic& logic, std::size_t number, bool on) const {
  const Gate& gate = logic.gates[number];
  switch (gate.kind) {
    case Gate::Kind::True:
      return on ? kAlways : std::vector<Conditions>{};
    case Gate::Kind::Contact: {
      const NetworkLogic::Contact& contact = logic.contacts[gate.a];
      if (!contact.statement) return kAlways;  // what is in front of the rung is not known
      const auto in_rung = static_cast<std::uint32_t>(gate.statement - facts_.program.statements.data());
      return {Conditions{{op_of(contact), on != contact.normally_closed, in_rung, on != gate.normally_closed}}};
    }
    case Gate::Kind::Not:
      return of_gate(logic, gate.a, !on);
    case Gate::Kind::And:
    case Gate::Kind::Or:
      break;
  }
  const bool all = on == (gate.kind == Gate::Kind::And);
  const std::vector<Conditions> first = of_gate(logic, gate.a, on), second = of_gate(logic, gate.b, on);
  return all ? both(first, second) : either(first, second);
}

std::vector<Conditions> Ways::input(std::uint32_t op, std::size_t level, bool on) const {
  const RungLogic& rung = rung_of(op);
  std::vector<Conditions> ways = level < rung.inputs.size() ? of_gate(rung.logic, rung.inputs[level], on)
                                 : on                       ? kAlways
                                                            : std::vector<Conditions>{};
  if (!facts_.program.ops[op].in_segment) return ways;
  const std::vector<Conditions> segment{Conditions{{segment_of(facts_.program, op), on}}};
  return on ? both(ways, segment) : either(std::move(ways), segment);
}

std::vector<Conditions> Ways::to(std::uint32_t op, bool power) const { return both(input(op, 0, power), reached(op)); }

std::vector<Conditions> Ways::reached(std::uint32_t op) const {
  if (present_.executed(op)) return kAlways;
  const Program& program = facts_.program;
  const Routine& routine = facts_.flow.routine_of(op);
  std::vector<Conditions> ways = routine_runs(facts_.flow.nodes[op].routine);
  for (std::uint32_t i = routine.first; i < op; ++i) {
    const Op& other = program.ops[i];
    const bool jumps =
        (structure_of(other) == Structure::Jump || structure_of(other) == Structure::SegmentExit) && other.target > op;
    const bool ends = other.instruction->effect == Effect::ConditionalEnd;
    const auto has_label = [&] {  // someone may come there another way
      return std::any_of(program.ops.begin() + i, program.ops.begin() + op,
                         [](const Op& between) { return structure_of(between) == Structure::Label; });
    };
    if ((jumps || ends) && !(facts_.flow.nodes[i].powered && has_label())) ways = both(ways, input(i, 0, false));
  }
  return ways;
}

std::vector<Conditions> Ways::routine_runs(std::uint32_t number) const {
  const Routine& routine = facts_.flow.routines[number];
  if (routine.kind == Routine::Kind::Main) return kAlways;
  if (routine.kind == Routine::Kind::Interrupt) return {Conditions{{routine.first, true}}};
  if (std::ranges::find(open_, number) != open_.end()) return {};
  open_.push_back(number);
  std::vector<Conditions> ways;
  for (const CallSite& call : facts_.flow.calls)
    if (call.routine == number) ways = either(std::move(ways), to(call.op, true));
  open_.pop_back();
  return ways;
}

}  // namespace s7200
