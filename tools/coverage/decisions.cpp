#include "tools/coverage/decisions.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "interpreter/program/ladder/networks.hpp"

namespace s7200::tools {
namespace {

using Gate = Decision::Gate;
using Kind = ContactForm::Kind;

/// Follows the logic stack through a program and keeps what each level of it is made of.
class ConditionReader {
 public:
  ConditionReader(const Program& program, const std::vector<ContactForm>& forms)
      : program_(program), forms_(forms), networks_(program) {
    found_.constant_input.resize(program.ops.size());
  }

  Decisions read() {
    for (op_ = 0; op_ < program_.ops.size(); ++op_) step(program_.ops[op_]);
    return std::move(found_);
  }

 private:
  /// A gate of the program, with the op of a contact in the place of its number in a condition.
  struct Node {
    Gate gate;
    bool known = true;                  // false: it depends on what was on the stack before
    std::optional<bool> constant = {};  // it never changes
  };
  using Index = std::uint32_t;

  Index add(Gate::Kind kind, Index a, Index b, bool known, std::optional<bool> constant) {
    nodes_.push_back({{kind, a, b}, known, constant});
    return static_cast<Index>(nodes_.size() - 1);
  }
  Index always_on() { return add(Gate::Kind::True, 0, 0, true, true); }
  Index unknown() { return add(Gate::Kind::True, 0, 0, false, {}); }
  Index inverse(Index a) {
    const auto& constant = nodes_[a].constant;
    return add(Gate::Kind::Not, a, 0, nodes_[a].known, constant ? std::optional(!*constant) : std::nullopt);
  }
  Index joined(Join join, Index a, Index b) {
    const bool is_and = join == Join::And;
    const bool known = nodes_[a].known && nodes_[b].known;
    std::optional<bool> constant;
    for (const Index each : {a, b})  // an open contact in series, a closed one in parallel
      if (nodes_[each].constant == !is_and) constant = !is_and;
    if (nodes_[a].constant == is_and && nodes_[b].constant == is_and) constant = is_and;
    return add(is_and ? Gate::Kind::And : Gate::Kind::Or, a, b, known, constant);
  }

  void begin_with(Index level) { stack_.assign(1, level); }
  Index level(std::size_t depth) {
    while (depth >= stack_.size()) stack_.insert(stack_.begin(), unknown());
    return stack_[stack_.size() - 1 - depth];
  }
  Index pop() {
    const Index top = level(0);
    stack_.pop_back();
    return top;
  }

  void step(const Op& op) {
    if (networks_.begins(op_)) begin_with(unknown());
    if (forms_[op_].is_contact()) return contact(op, forms_[op_]);
    if (is_box_or_coil(op)) return output(op);
    move(op.instruction->mnemonic, op);
  }

  /// ALD, OLD, LPS, LRD, LPP and LDS.
  void move(std::string_view name, const Op& op) {
    if (name == "ALD" || name == "OLD") {
      const Index top = pop(), second = pop();
      stack_.push_back(joined(name == "ALD" ? Join::And : Join::Or, second, top));
    } else if (name == "LPS") {
      stack_.push_back(level(0));
    } else if (name == "LPP") {
      pop();
    } else if (name == "LRD") {
      pop();
      stack_.push_back(level(0));
    } else if (name == "LDS") {
      stack_.push_back(level(op[0].at));
    }
  }

  void contact(const Op& op, const ContactForm& form) {
    if (form.kind == Kind::Not) {
      found_.constant_input[op_] = nodes_[level(0)].constant.has_value();
      return stack_.push_back(inverse(pop()));
    }
    if (form.is_edge()) return edge(form);
    const auto constant =
        why_constant(op, form).empty() ? std::nullopt : std::optional(is_always_closed(program_, op, form));
    const Index own = add(Gate::Kind::Contact, op_, 0, true, constant);
    if (form.join == Join::Load) return stack_.push_back(own);
    stack_.push_back(joined(form.join, pop(), own));
  }

  void edge(const ContactForm& form) {
    const Index input = pop();
    const bool constant = nodes_[input].constant.has_value();
    found_.constant_input[op_] = constant;
    stack_.push_back(add(form.kind == Kind::Rising ? Gate::Kind::Rising : Gate::Kind::Falling, input, op_,
                         nodes_[input].known, constant ? std::optional(false) : std::nullopt));
  }

  void output(const Op& op) {
    const StackUse& use = op.instruction->rung.stack;
    if (depends_on_power_flow(op))
      for (std::size_t i = 0; i < static_cast<std::size_t>(use.needs); ++i) decide(level(i));
    for (int change = use.change; change < 0; ++change) pop();
    for (int change = use.change; change > 0; --change) stack_.push_back(unknown());
    follow(op.instruction->structure);
  }

  /// Routines begin with 1 on top, and so does a pass of a loop. What jumps lead to is reached with anything.
  void follow(Structure structure) {
    if (begins_routine(structure) || structure == Structure::For)
      begin_with(always_on());
    else if (structure == Structure::Label || structure == Structure::Next || structure == Structure::SegmentBegin ||
             structure == Structure::SegmentEnd)
      begin_with(unknown());
  }

  void decide(Index condition) {
    if (!nodes_[condition].known || nodes_[condition].constant || condition == last_) return;
    last_ = condition;
    Decision decision{.op = op_};
    std::map<Index, Index> places;
    copy(condition, decision, places);
    found_.all.push_back(std::move(decision));
  }

  static bool has_second(Gate::Kind kind) { return kind == Gate::Kind::And || kind == Gate::Kind::Or; }

  /// Copies what a gate is made of, and then the gate: nodes come in this order. A condition has as many levels as the
  /// network has contacts, so no calls are nested.
  void copy(Index condition, Decision& decision, std::map<Index, Index>& places) {
    std::vector<Index> open{condition}, needed;
    while (!open.empty()) {
      const Index at = open.back();
      open.pop_back();
      if (!places.emplace(at, 0).second) continue;
      needed.push_back(at);
      const Gate& gate = nodes_[at].gate;
      if (gate.kind == Gate::Kind::True || gate.kind == Gate::Kind::Contact) continue;
      open.push_back(gate.a);
      if (has_second(gate.kind)) open.push_back(gate.b);
    }
    std::ranges::sort(needed);
    for (const Index at : needed) {
      places[at] = static_cast<Index>(decision.gates.size());
      decision.gates.push_back(placed(nodes_[at].gate, decision, places));
    }
  }

  static Gate placed(const Gate& gate, Decision& decision, const std::map<Index, Index>& places) {
    const auto contact = [&](std::uint32_t op) {
      decision.contacts.push_back(op);
      return static_cast<Index>(decision.contacts.size() - 1);
    };
    switch (gate.kind) {
      case Gate::Kind::True:
        return gate;
      case Gate::Kind::Contact:
        return {gate.kind, contact(gate.a), 0};
      case Gate::Kind::Rising:
      case Gate::Kind::Falling:
        return {gate.kind, places.at(gate.a), contact(gate.b)};
      case Gate::Kind::Not:
        return {gate.kind, places.at(gate.a), 0};
      case Gate::Kind::And:
      case Gate::Kind::Or:
        return {gate.kind, places.at(gate.a), places.at(gate.b)};
    }
    return gate;
  }

  static constexpr Index kNone = ~Index{0};

  const Program& program_;
  const std::vector<ContactForm>& forms_;
  const Networks networks_;
  std::uint32_t op_ = 0;
  std::vector<Node> nodes_;
  std::vector<Index> stack_;
  Index last_ = kNone;  // the condition of the output before
  Decisions found_;
};

/// The condition in many worlds at once: bit 63 of a word is the world as it was, bit i that in which contact `first` + i
/// alone was otherwise.
constexpr std::uint32_t kWorlds = 63;
constexpr std::uint64_t kAsItWas = std::uint64_t{1} << kWorlds;

std::uint64_t everywhere(bool value) { return value ? ~std::uint64_t{0} : 0; }

std::uint64_t otherwise_in(std::uint32_t contact, std::uint32_t first) {
  return contact >= first && contact - first < kWorlds ? std::uint64_t{1} << (contact - first) : 0;
}

std::uint64_t condition_in_worlds(const Decision& decision, const SeenContacts& seen, std::uint32_t first,
                                  std::vector<std::uint64_t>& words) {
  words.clear();
  for (const Gate& gate : decision.gates) {
    switch (gate.kind) {
      case Gate::Kind::True:
        words.push_back(everywhere(true));
        break;
      case Gate::Kind::Contact:
        words.push_back(everywhere(seen.closed[gate.a]) ^ otherwise_in(gate.a, first));
        break;
      case Gate::Kind::Not:
        words.push_back(~words[gate.a]);
        break;
      case Gate::Kind::And:
        words.push_back(words[gate.a] & words[gate.b]);
        break;
      case Gate::Kind::Or:
        words.push_back(words[gate.a] | words[gate.b]);
        break;
      case Gate::Kind::Rising:
        words.push_back((seen.before[gate.b] ? 0 : words[gate.a]) ^ otherwise_in(gate.b, first));
        break;
      case Gate::Kind::Falling:
        words.push_back((seen.before[gate.b] ? ~words[gate.a] : 0) ^ otherwise_in(gate.b, first));
        break;
    }
  }
  return words.back();
}

}  // namespace

Decisions decisions_of(const Program& program, const std::vector<ContactForm>& forms) {
  return ConditionReader(program, forms).read();
}

void find_deciding(const Decision& decision, const SeenContacts& seen, std::vector<std::uint8_t>& alone) {
  std::vector<std::uint64_t> words;
  for (std::uint32_t first = 0; first < decision.contacts.size(); first += kWorlds) {
    const std::uint64_t condition = condition_in_worlds(decision, seen, first, words);
    const bool on = condition & kAsItWas;
    const std::uint64_t differs = condition ^ everywhere(on);
    for (std::uint32_t i = first; i < std::min<std::size_t>(first + kWorlds, decision.contacts.size()); ++i)
      if (differs & otherwise_in(i, first))
        alone[i] |= static_cast<std::uint8_t>(seen.closed[i] ? (on ? kClosedOn : kClosedOff) : (on ? kOpenOn : kOpenOff));
  }
}

}  // namespace s7200::tools
