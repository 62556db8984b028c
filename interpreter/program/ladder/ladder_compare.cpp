#include "interpreter/program/ladder/ladder_compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "interpreter/model/instruction.hpp"
#include "interpreter/program/ladder/ladder.hpp"
#include "interpreter/program/ladder/network_logic.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

using Statements = std::vector<const stl::Statement*>;

struct Network {
  std::uint32_t number = 0;  // of a drawing
  stl::Position position{};
  Statements statements;  // none: cannot be read
  NetworkLogic logic{};
};

struct DrawnRoutine {
  std::string name;  // SBR 50; empty for the main program
  std::vector<Network> networks;
};

std::string one_line(const stl::Statement& statement) {
  std::string text = stl::to_text(statement);
  const std::size_t gap = text.find("  ");
  if (gap != std::string::npos) text.erase(gap, text.find_first_not_of(' ', gap) - gap - 1);
  return text;
}

bool is_head(const stl::Statement& statement) {
  const Instruction* instruction = find_instruction(statement.mnemonic);
  return instruction && begins_routine(instruction->structure);
}

std::vector<Network> drawn_networks(const stl::Source& source) {
  std::vector<Network> networks;
  for (const stl::Line& line : source.lines) {
    if (const auto* head = std::get_if<stl::NetworkHead>(&line)) networks.push_back({head->number, head->position, {}});
    if (const auto* statement = std::get_if<stl::Statement>(&line)) networks.back().statements.push_back(statement);
  }
  return networks;
}

std::vector<Network> listed_networks(const stl::Source& source) {
  std::vector<Network> networks;
  const stl::Statement* before = nullptr;
  for (const stl::Line& line : source.lines) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement) continue;
    if (begins_network(*statement, before)) networks.push_back({0, statement->position, {}});
    networks.back().statements.push_back(statement);
    before = statement;
  }
  return networks;
}

/// The networks of each routine, each with what it does.
std::vector<DrawnRoutine> routines_of(std::vector<Network> networks) {
  std::vector<DrawnRoutine> routines(1);
  StackBetween stack;
  for (Network& network : networks) {
    if (!network.statements.empty() && is_head(*network.statements.front()))
      routines.push_back({one_line(*network.statements.front()), {}});
    if (network.statements.empty()) stack.on = false;
    network.logic = logic_of(network.statements, stack);
    routines.back().networks.push_back(std::move(network));
  }
  return routines;
}

class Comparison {
 public:
  explicit Comparison(LadderComparison& result) : result_(result) {}

  void run(const std::vector<DrawnRoutine>& drawn, const std::vector<DrawnRoutine>& listed) {
    std::vector<bool> compared(listed.size());
    for (const DrawnRoutine& routine : drawn) {
      std::size_t i = 0;
      while (i < listed.size() && (compared[i] || listed[i].name != routine.name)) ++i;
      if (i == listed.size()) {
        missing(routine, "is drawn, but not in the STL");
      } else {
        compared[i] = true;
        align(routine.networks, listed[i].networks);
      }
    }
    for (std::size_t i = 0; i < listed.size(); ++i)
      if (!compared[i]) missing(listed[i], "is in the STL, but not drawn");
  }

 private:
  using Networks = std::span<const Network>;
  static constexpr std::size_t kLookAhead = 8;  // networks that may be missing on a side, or several in the place of one

  void report(const stl::Position& at, std::string message, std::string hint = {}) {
    result_.diagnostics.push_back({stl::Severity::Error, at, std::move(message), std::move(hint)});
  }

  void missing(const DrawnRoutine& routine, std::string_view what) {
    if (routine.networks.empty()) return;
    report(routine.networks.front().position,
           fmt::format("{} {}", routine.name.empty() ? "the main program" : routine.name, what),
           "compare both with the printed document");
  }

  /// Pairs the networks of a routine: those with the same outputs, and what is between such pairs in its order.
  void align(Networks drawn, Networks listed) {
    while (!drawn.empty() && !listed.empty()) {
      const auto [skip_drawn, skip_listed] = next_pair(drawn, listed);
      unequal(drawn.first(skip_drawn), listed.first(skip_listed));
      drawn = drawn.subspan(skip_drawn);
      listed = listed.subspan(skip_listed);
      if (drawn.empty() || listed.empty()) break;
      const auto [of_drawn, of_listed] = same_outputs(drawn, listed);
      compare(drawn.first(of_drawn), listed.first(of_listed));
      drawn = drawn.subspan(of_drawn);
      listed = listed.subspan(of_listed);
    }
    unequal(drawn, listed);
  }

  /// The number of networks on each side that come before the next two with the same outputs.
  static std::pair<std::size_t, std::size_t> next_pair(Networks drawn, Networks listed) {
    for (std::size_t distance = 0; distance <= 2 * kLookAhead; ++distance)
      for (std::size_t i = 0; i <= distance; ++i) {
        const std::size_t j = distance - i;
        if (i >= drawn.size() || j >= listed.size() || i > kLookAhead || j > kLookAhead) continue;
        if (same_outputs(drawn.subspan(i), listed.subspan(j)).first != 0) return {i, j};
      }
    return {std::min(drawn.size(), kLookAhead), std::min(listed.size(), kLookAhead)};
  }

  /// The number of networks on each side that have the same outputs together: usually one, but the STL may begin a network
  /// again with LD where the drawing has a branch. It is 0 if the first ones have different outputs.
  static std::pair<std::size_t, std::size_t> same_outputs(Networks drawn, Networks listed) {
    constexpr std::size_t kMostJoined = 4;
    if (drawn.front().statements.empty()) return {0, 0};
    if (same_actions(drawn.front().logic, listed.front().logic)) return {1, 1};
    for (std::size_t count = 2; count <= kMostJoined; ++count) {
      if (count <= listed.size() && have_actions(listed.first(count), drawn.front().logic)) return {1, count};
      if (count <= drawn.size() && have_actions(drawn.first(count), listed.front().logic)) return {count, 1};
    }
    return {0, 0};
  }

  static bool have_actions(Networks networks, const NetworkLogic& logic) {
    auto action = logic.actions.begin();
    for (const Network& network : networks)
      for (const NetworkLogic::Action& each : network.logic.actions) {
        if (action == logic.actions.end() || action->text != each.text) return false;
        ++action;
      }
    return action == logic.actions.end();
  }

  static Statements joined(Networks networks) {
    Statements statements;
    for (const Network& network : networks)
      statements.insert(statements.end(), network.statements.begin(), network.statements.end());
    return statements;
  }

  void compare(Networks drawn, Networks listed) {
    if (drawn.size() == 1 && listed.size() == 1) return compare(drawn.front(), listed.front());
    Network left{drawn.front().number, drawn.front().position, joined(drawn)},
        right{0, listed.front().position, joined(listed)};
    StackBetween before_left, before_right;
    left.logic = logic_of(left.statements, before_left);
    right.logic = logic_of(right.statements, before_right);
    const std::size_t same = result_.same;
    compare(left, right);
    if (result_.same > same) result_.same = same + drawn.size();
  }

  void compare(const Network& drawn, const Network& listed) {
    const auto found = difference(drawn.logic, listed.logic);
    if (!found) {
      ++result_.same;
      return;
    }
    const auto& ours = drawn.logic.actions;
    const auto& theirs = listed.logic.actions;
    const std::size_t i = found->action;
    if (found->condition) return conditions_differ(drawn, listed, *found);
    if (i < ours.size() && i < theirs.size())
      return report(ours[i].statement->position,
                    fmt::format("network {}: the drawing has {}, the STL has {}", drawn.number, one_line(*ours[i].statement),
                                one_line(*theirs[i].statement)),
                    fmt::format("the STL is in line {}", theirs[i].statement->position.line));
    if (i < ours.size())
      return report(ours[i].statement->position,
                    fmt::format("network {}: {} is drawn, but not in the STL", drawn.number, one_line(*ours[i].statement)),
                    fmt::format("the STL of this network ends in line {}", listed.statements.back()->position.line));
    report(theirs[i].statement->position,
           fmt::format("network {}: {} is in the STL, but not drawn", drawn.number, one_line(*theirs[i].statement)),
           fmt::format("the drawing begins in line {}", drawn.position.line));
  }

  void conditions_differ(const Network& drawn, const Network& listed, const LogicDifference& found) {
    const stl::Statement& ours = *drawn.logic.actions[found.action].statement;
    const stl::Statement& theirs = *listed.logic.actions[found.action].statement;
    report(first_difference(drawn, listed, ours, theirs).position,
           fmt::format("network {}: {} runs under different conditions in the drawing and in the STL", drawn.number,
                       one_line(ours)),
           fmt::format("the drawing has {}; the STL in line {} has {}; {}", logic_text(drawn, ours), theirs.position.line,
                       logic_text(listed, theirs), example_text(found)));
  }

  /// The first statement of the drawing that is not in the STL, up to the output that differs.
  static const stl::Statement& first_difference(const Network& drawn, const Network& listed, const stl::Statement& ours,
                                                const stl::Statement& theirs) {
    for (std::size_t i = 0; i < drawn.statements.size() && drawn.statements[i] != &ours; ++i)
      if (i >= listed.statements.size() || listed.statements[i] == &theirs ||
          one_line(*drawn.statements[i]) != one_line(*listed.statements[i]))
        return *drawn.statements[i];
    return ours;
  }

  /// `LD I0.0; O I0.1`: the logic up to an output.
  static std::string logic_text(const Network& network, const stl::Statement& output) {
    constexpr std::size_t kShown = 12;
    std::string text;
    std::size_t count = 0;
    for (const stl::Statement* statement : network.statements) {
      if (statement == &output) break;
      const Instruction* instruction = find_instruction(statement->mnemonic);
      if (!instruction || instruction->rung.writes_output || ++count > kShown) continue;
      text += (text.empty() ? "" : "; ") + one_line(*statement);
    }
    if (count > kShown) text += "; …";
    return text.empty() ? "no contacts" : text;
  }

  static std::string example_text(const LogicDifference& found) {
    constexpr std::size_t kShown = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(kShown, found.example.size()); ++i)
      text += fmt::format("{}{} {}", i == 0 ? "" : ", ", found.example[i].first, found.example[i].second ? "on" : "off");
    return fmt::format("with {}{} only the {} runs it", text, found.example.size() > kShown ? ", …" : "",
                       found.on_in_first ? "drawing" : "STL");
  }

  /// Networks without the same outputs anywhere near, paired in their order.
  void unequal(Networks drawn, Networks listed) {
    for (std::size_t i = 0; i < std::max(drawn.size(), listed.size()); ++i) {
      if (i < drawn.size() && drawn[i].statements.empty()) continue;  // has its own message
      if (i < drawn.size() && i < listed.size())
        compare(drawn[i], listed[i]);
      else if (i < drawn.size())
        report(drawn[i].position, fmt::format("network {} is drawn, but not in the STL", drawn[i].number),
               fmt::format("it is {}", listing(drawn[i])));
      else
        report(listed[i].position, "these statements are not drawn", fmt::format("they are {}", listing(listed[i])));
    }
  }

  static std::string listing(const Network& network) {
    constexpr std::size_t kShown = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(kShown, network.statements.size()); ++i)
      text += (i == 0 ? "" : "; ") + one_line(*network.statements[i]);
    return text + (network.statements.size() > kShown ? "; …" : "");
  }

  LadderComparison& result_;
};

}  // namespace

Result<LadderComparison> compare_drawings(std::string_view bytes, const std::string& name) {
  const auto drawn = read_drawings(bytes, name);
  if (!drawn) return drawn.trouble();
  const auto listed = read_source(bytes, name, true);
  if (!listed) return listed.trouble();
  LadderComparison result;
  result.source = drawn->parsed.source;
  result.encoding = drawn->encoding;
  result.diagnostics = drawn->parsed.diagnostics;
  const auto& more = listed->parsed.diagnostics;
  result.diagnostics.insert(result.diagnostics.end(), more.begin(), more.end());
  auto networks = drawn_networks(drawn->parsed.source);
  result.networks = networks.size();
  auto statements = listed_networks(listed->parsed.source);
  if (!networks.empty() && !statements.empty())
    Comparison(result).run(routines_of(std::move(networks)), routines_of(std::move(statements)));
  stl::sort(result.diagnostics);
  return result;
}

}  // namespace s7200
