#include "interpreter/program/ladder/network_logic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "interpreter/base/split_mix.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/operands/operand_memory.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

using Gate = NetworkLogic::Gate;

std::uint64_t mask_of(Width width) { return width == Width::Double ? 0xFFFF'FFFF : width == Width::Word ? 0xFFFF : 0xFF; }

/// An operand in one notation: -1, 65535 and 16#FFFF are the same word.
std::string operand_text(const stl::Operand& operand, const OperandRule* rule) {
  const auto* constant = std::get_if<stl::Integer>(&operand.value);
  if (!constant) return stl::to_text(operand);
  const bool value = rule && rule->kind == OperandKind::Memory && !rule->count;
  return fmt::format("{}",
                     value ? static_cast<std::int64_t>(static_cast<std::uint64_t>(constant->value) & mask_of(rule->width))
                           : constant->value);
}

const OperandRule* rule_of(const Instruction* instruction, std::size_t i) {
  return instruction && i < instruction->rules().size() ? &instruction->rules()[i] : nullptr;
}

std::string operand_text(const stl::Statement& statement, const Instruction* instruction, std::size_t i) {
  return i < statement.operands.size() ? operand_text(statement.operands[i], rule_of(instruction, i)) : std::string{};
}

bool is_load(const Instruction& instruction) {
  return !instruction.rung.writes_output && instruction.rung.stack.needs == 0 && instruction.rung.stack.change > 0;
}

/// LBL, SBR, RET …: runs whatever the logic stack holds, and does not change it.
bool is_mark(const Instruction& instruction) {
  return instruction.rung.writes_output && instruction.rung.stack == StackUse{} && !instruction.rung.needs_power_flow;
}

/// Whether an instruction may change what a contact reads.
bool affects(const stl::Statement& action, const stl::Operand& read) {
  const Instruction* instruction = find_instruction(action.mnemonic);
  if (!instruction || instruction->structure == Structure::Call) return true;
  const auto source = memory_of(read);
  if (instruction->flags != 0 && source && source->overlaps({"SM", 8, 16})) return true;
  for (std::size_t i = 0; i < action.operands.size(); ++i) {
    const OperandRule* rule = rule_of(instruction, i);
    if (!rule || rule->role == Role::In) continue;
    const auto target = memory_of(action.operands[i]);
    if (may_change(action.operands[i], read)) return true;
    if (rule->counted && target && source && target->area == source->area && target->from <= source->from) return true;
  }
  return false;
}

/// Follows the logic stack through a network.
class LogicReader {
 public:
  explicit LogicReader(StackBetween& between) : between_(between) {
    stack_.push_back(between.on ? gate(Gate::Kind::True) : contact("the power flow before it", false));
  }

  NetworkLogic read(std::span<const stl::Statement* const> statements) {
    for (const stl::Statement* statement : statements) step(*statement);
    between_.on = is_true(stack_.back());
    return std::move(logic_);
  }

 private:
  std::size_t gate(Gate::Kind kind, std::size_t a = 0, std::size_t b = 0) {
    logic_.gates.push_back({.kind = kind, .a = a, .b = b});
    return logic_.gates.size() - 1;
  }
  bool is_true(std::size_t index) const { return logic_.gates[index].kind == Gate::Kind::True; }
  std::size_t both(std::size_t a, std::size_t b) {
    if (is_true(a)) return b;
    return is_true(b) ? a : gate(Gate::Kind::And, a, b);
  }
  std::size_t either(std::size_t a, std::size_t b) {
    if (is_true(a)) return a;
    return is_true(b) ? b : gate(Gate::Kind::Or, a, b);
  }
  std::size_t contact(std::string name, bool normally_closed, const stl::Statement* statement = nullptr) {
    const auto [known, added] = known_.try_emplace(std::move(name), logic_.contacts.size());
    if (added) logic_.contacts.push_back({known->first, normally_closed, statement});
    logic_.gates.push_back({Gate::Kind::Contact, known->second, 0, normally_closed, statement});
    return logic_.gates.size() - 1;
  }

  std::size_t pop() {
    const std::size_t top = stack_.back();
    stack_.pop_back();
    if (stack_.empty()) stack_.push_back(contact("the logic stack before it", false));
    return top;
  }

  void step(const stl::Statement& statement) {
    const Instruction* instruction = find_instruction(statement.mnemonic);
    if (!instruction || instruction->rung.writes_output) return act(statement, instruction);
    const std::string& name = statement.mnemonic;
    if (name == "NOT") return stack_.push_back(gate(Gate::Kind::Not, pop()));
    if (name == "EU" || name == "ED") return edge(statement);
    if (name == "LPS") return stack_.push_back(stack_.back());
    if (name == "LPP") return void(pop());
    if (name == "LRD") {
      pop();
      return stack_.push_back(stack_.back());
    }
    if (name == "ALD" || name == "OLD") {
      const std::size_t top = pop(), second = pop();
      return stack_.push_back(name == "ALD" ? both(second, top) : either(second, top));
    }
    if (name == "LDS") return copy_level(statement);
    const std::size_t value = read_contact(statement, *instruction);
    if (is_load(*instruction)) return stack_.push_back(value);
    const std::size_t top = pop();
    stack_.push_back(name.front() == 'A' ? both(top, value) : either(top, value));
  }

  void copy_level(const stl::Statement& statement) {
    const auto* level = statement.operands.empty() ? nullptr : std::get_if<stl::Integer>(&statement.operands.front().value);
    const auto depth = level ? static_cast<std::uint64_t>(level->value) : 0;
    stack_.push_back(depth < stack_.size() ? stack_[stack_.size() - 1 - depth]
                                           : contact("the logic stack before it", false));
  }

  /// An edge is as good as an output that remembers its input, and a contact that nothing else reads.
  void edge(const stl::Statement& statement) {
    logic_.actions.push_back({&statement, statement.mnemonic, {pop()}});
    stack_.push_back(contact(fmt::format("edge {}", ++edges_), false, &statement));
  }

  std::size_t read_contact(const stl::Statement& statement, const Instruction& instruction) {
    std::string_view rest = statement.mnemonic;
    rest.remove_prefix(is_load(instruction) ? 2 : 1);
    const std::size_t relation = rest.find_first_of("<>=");
    if (relation != std::string_view::npos)
      return comparison(statement, instruction, rest.substr(0, relation), rest.substr(relation));
    const bool closed = rest.starts_with('N');
    const bool immediate = rest.ends_with('I');
    const std::string bit = operand_text(statement, &instruction, 0);
    if (bit == "SM0.0") return closed ? gate(Gate::Kind::Not, gate(Gate::Kind::True)) : gate(Gate::Kind::True);
    const std::size_t value =
        contact(fmt::format("{}{}{}", bit, immediate ? " read immediately" : "", moment(statement)), closed, &statement);
    return closed ? gate(Gate::Kind::Not, value) : value;
  }

  /// The comparison that an instruction makes: `<=` is `>=` the other way round, and `<`, `>` and `<>` are their opposites,
  /// except for reals, which may be NaN.
  std::size_t comparison(const stl::Statement& statement, const Instruction& instruction, std::string_view type,
                         std::string_view relation) {
    std::string left = operand_text(statement, &instruction, 0), right = operand_text(statement, &instruction, 1);
    const bool whole = type != "R";
    const bool opposite = whole && (relation == "<" || relation == ">" || relation == "<>");
    std::string kind(opposite ? (relation == "<>" ? "=" : relation == "<" ? ">=" : "<=") : relation);
    if (kind == "<=" || (kind == "=" && right < left)) {
      std::swap(left, right);
      if (kind == "<=") kind = ">=";
    }
    const std::size_t value = contact(
        fmt::format("{} {}{} {}{}", left, kind == "=" ? "==" : kind, type, right, moment(statement)), opposite, &statement);
    return opposite ? gate(Gate::Kind::Not, value) : value;
  }

  /// The moment at which a contact is read: after how many outputs of the network that may change what it reads; empty if
  /// there is none.
  std::string moment(const stl::Statement& statement) const {
    constexpr std::size_t kOutputsLookedAt = 256;  // more than any network has
    std::size_t changes = 0, looked_at = 0;
    for (auto action = logic_.actions.rbegin(); action != logic_.actions.rend() && looked_at < kOutputsLookedAt;
         ++action, ++looked_at)
      changes += std::ranges::any_of(statement.operands,
                                     [&](const stl::Operand& read) { return affects(*action->statement, read); });
    return changes == 0 ? "" : fmt::format(" after output {}", changes);
  }

  void act(const stl::Statement& statement, const Instruction* instruction) {
    NetworkLogic::Action action{&statement, statement.mnemonic};
    for (std::size_t i = 0; i < statement.operands.size(); ++i)
      action.text += (i == 0 ? " " : ", ") + operand_text(statement, instruction, i);
    const StackUse use = instruction ? instruction->rung.stack : StackUse{1, 0};
    for (int level = 0; level < use.needs; ++level) {
      const std::size_t depth = static_cast<std::size_t>(level);
      action.inputs.push_back(depth < stack_.size() ? stack_[stack_.size() - 1 - depth] : stack_.front());
    }
    if (instruction && instruction->rung.needs_power_flow && action.inputs.empty()) action.inputs.push_back(stack_.back());
    logic_.actions.push_back(std::move(action));
    for (int change = use.change; change < 0; ++change) pop();
    for (int change = use.change; change > 0; --change) stack_.push_back(contact("the segment", false));
    if (instruction) follow(instruction->structure);
  }

  /// A routine begins with 1 on top; NEXT goes on with what FOR had, or with what the loop leaves.
  void follow(Structure structure) {
    if (begins_routine(structure)) {
      stack_.assign(1, gate(Gate::Kind::True));
      between_.loops.clear();
    } else if (structure == Structure::For) {
      between_.loops.push_back(is_true(stack_.back()));
    } else if (structure == Structure::Next) {
      const bool on = is_true(stack_.back()) && !between_.loops.empty() && between_.loops.back();
      if (!between_.loops.empty()) between_.loops.pop_back();
      stack_.assign(1, on ? gate(Gate::Kind::True) : contact("the power flow before it", false));
    }
  }

  StackBetween& between_;
  NetworkLogic logic_;
  std::vector<std::size_t> stack_;
  std::map<std::string, std::size_t> known_;
  std::size_t edges_ = 0;
};

// ---- Comparison ----------------------------------------------------------------------------------------------------------

constexpr std::size_t kAllValues = 12;  // so many contacts have 4096 combinations

/// The values of all contacts in 64 trials at once: a word for each contact.
class Trials {
 public:
  explicit Trials(std::vector<NetworkLogic::Contact> contacts) : contacts_(std::move(contacts)) {}

  std::size_t rounds() const {
    const std::size_t n = contacts_.size();
    if (n <= 6) return 1;
    return n <= kAllValues ? std::size_t{1} << (n - 6) : kRandomRounds + turns();
  }

  std::vector<std::uint64_t> round(std::size_t number) {
    std::vector<std::uint64_t> values(contacts_.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = contacts_.size() <= kAllValues ? counted(i, number)
                  : number < kRandomRounds       ? random(number)
                                                 : turned(i, number);
    return values;
  }

  const NetworkLogic::Contact& contact(std::size_t i) const { return contacts_[i]; }

 private:
  static constexpr std::size_t kRandomRounds = 64;
  static constexpr std::size_t kMostTurns = 16;

  std::size_t turns() const { return std::min((contacts_.size() + 63) / 64, kMostTurns); }

  static std::uint64_t counted(std::size_t i, std::size_t round) {
    constexpr std::uint64_t kPatterns[] = {0xAAAA'AAAA'AAAA'AAAA, 0xCCCC'CCCC'CCCC'CCCC, 0xF0F0'F0F0'F0F0'F0F0,
                                           0xFF00'FF00'FF00'FF00, 0xFFFF'0000'FFFF'0000, 0xFFFF'FFFF'0000'0000};
    if (i < std::size(kPatterns)) return kPatterns[i];
    return (round >> (i - std::size(kPatterns))) & 1 ? ~std::uint64_t{0} : 0;
  }
  /// Long series are on only if nearly all contacts are, so ones and zeros are not always as many.
  std::uint64_t random(std::size_t round) {
    const std::uint64_t even = draw_split_mix(seed_);
    return round % 3 == 0 ? even : round % 3 == 1 ? even | draw_split_mix(seed_) : even & draw_split_mix(seed_);
  }
  /// Every contact conducts, but one in each trial.
  std::uint64_t turned(std::size_t i, std::size_t round) const {
    const std::uint64_t conducting = contacts_[i].normally_closed ? 0 : ~std::uint64_t{0};
    return i / 64 == round - kRandomRounds ? conducting ^ (std::uint64_t{1} << (i % 64)) : conducting;
  }

  std::vector<NetworkLogic::Contact> contacts_;
  std::uint64_t seed_ = 7200;
};

std::vector<std::uint64_t> evaluated(const NetworkLogic& logic, const std::vector<std::uint64_t>& contacts) {
  std::vector<std::uint64_t> values;
  values.reserve(logic.gates.size());
  for (const Gate& gate : logic.gates) {
    switch (gate.kind) {
      case Gate::Kind::True:
        values.push_back(~std::uint64_t{0});
        break;
      case Gate::Kind::Contact:
        values.push_back(contacts[gate.a]);
        break;
      case Gate::Kind::Not:
        values.push_back(~values[gate.a]);
        break;
      case Gate::Kind::And:
        values.push_back(values[gate.a] & values[gate.b]);
        break;
      case Gate::Kind::Or:
        values.push_back(values[gate.a] | values[gate.b]);
        break;
    }
  }
  return values;
}

/// The contacts of both, each once, and where those of the second are among them.
std::pair<std::vector<NetworkLogic::Contact>, std::vector<std::size_t>> united(const NetworkLogic& first,
                                                                               const NetworkLogic& second) {
  std::vector<NetworkLogic::Contact> contacts = first.contacts;
  std::map<std::string_view, std::size_t> known;
  for (std::size_t i = 0; i < first.contacts.size(); ++i) known.emplace(first.contacts[i].name, i);
  std::vector<std::size_t> places;
  for (const NetworkLogic::Contact& contact : second.contacts) {
    const auto [place, added] = known.try_emplace(contact.name, contacts.size());
    if (added) contacts.push_back(contact);
    places.push_back(place->second);
  }
  return {std::move(contacts), std::move(places)};
}

/// The contacts, by index, that a gate depends on.
std::vector<bool> contacts_of(const NetworkLogic& logic, std::size_t gate) {
  std::vector<bool> contacts(logic.contacts.size()), needed(logic.gates.size());
  needed[gate] = true;
  for (std::size_t i = gate + 1; i-- > 0;) {
    const Gate& each = logic.gates[i];
    if (!needed[i] || each.kind == Gate::Kind::True) continue;
    if (each.kind == Gate::Kind::Contact) {
      contacts[each.a] = true;
      continue;
    }
    needed[each.a] = true;
    if (each.kind != Gate::Kind::Not) needed[each.b] = true;
  }
  return contacts;
}

std::size_t common_actions(const NetworkLogic& first, const NetworkLogic& second) {
  const auto [end, _] =
      std::mismatch(first.actions.begin(), first.actions.end(), second.actions.begin(), second.actions.end(),
                    [](const auto& a, const auto& b) { return a.text == b.text && a.inputs.size() == b.inputs.size(); });
  return static_cast<std::size_t>(end - first.actions.begin());
}

}  // namespace

NetworkLogic logic_of(std::span<const stl::Statement* const> statements, StackBetween& stack) {
  return LogicReader(stack).read(statements);
}

bool begins_network(const stl::Statement& statement, const stl::Statement* before) {
  const Instruction* instruction = find_instruction(statement.mnemonic);
  const Instruction* last = before ? find_instruction(before->mnemonic) : nullptr;
  if (!before || (last && is_mark(*last))) return true;
  return instruction && (is_mark(*instruction) || (is_load(*instruction) && last && last->rung.writes_output));
}

bool same_actions(const NetworkLogic& first, const NetworkLogic& second) {
  return first.actions.size() == second.actions.size() && common_actions(first, second) == first.actions.size();
}

std::optional<LogicDifference> difference(const NetworkLogic& first, const NetworkLogic& second) {
  const std::size_t common = common_actions(first, second);
  auto [contacts, places] = united(first, second);
  Trials trials(std::move(contacts));
  std::optional<LogicDifference> found;
  for (std::size_t round = 0; round < trials.rounds(); ++round) {
    const auto values = trials.round(round);
    std::vector<std::uint64_t> second_values;
    for (const std::size_t place : places) second_values.push_back(values[place]);
    const auto a = evaluated(first, values), b = evaluated(second, second_values);
    const std::size_t end = found ? found->action : common;  // an earlier output may differ in a later round
    for (std::size_t i = 0; i < end && (!found || i < found->action); ++i)
      for (std::size_t input = 0; input < first.actions[i].inputs.size(); ++input) {
        const std::size_t left = first.actions[i].inputs[input], right = second.actions[i].inputs[input];
        const std::uint64_t differing = a[left] ^ b[right];
        if (differing == 0) continue;
        const std::uint64_t trial = differing & (~differing + 1);
        found = LogicDifference{i, true, (a[left] & trial) != 0};
        std::vector<bool> shown = contacts_of(first, left);
        shown.resize(values.size());
        const std::vector<bool> of_second = contacts_of(second, right);
        for (std::size_t c = 0; c < of_second.size(); ++c) shown[places[c]] = shown[places[c]] || of_second[c];
        for (std::size_t c = 0; c < values.size(); ++c)
          if (shown[c]) found->example.emplace_back(trials.contact(c).name, (values[c] & trial) != 0);
        break;
      }
  }
  if (!found && (common < first.actions.size() || common < second.actions.size())) found = LogicDifference{common};
  return found;
}

}  // namespace s7200
