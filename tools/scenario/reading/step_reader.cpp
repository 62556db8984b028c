#include "tools/scenario/reading/step_reader.hpp"

#include <algorithm>
#include <array>

#include "tools/scenario/steps/expected/reception.hpp"
#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {
namespace {

/// What other tools for tests call a step, or part of one.
struct OtherSteps {
  std::array<std::string_view, 5> words;
  std::string_view hint;
};
constexpr std::array kOtherSteps{
    OtherSteps{{"input", "inputs"}, "'set' switches inputs: set: {I0.0: 1}"},
    OtherSteps{{"expect"}, "of memory it is - memory: {Q0.0: 1}; of an answer it stands beside the request"},
    OtherSteps{{"assert", "check", "output", "outputs"}, "'memory' expects values: memory: {Q0.0: 1}"},
    OtherSteps{{"run", "sleep", "delay", "advance"}, "'wait' lets time pass: wait: 100ms"},
    OtherSteps{{"answer", "response"}, "'expect' beside a request expects its answer"},
};

constexpr int kLargestLoop = 4096;

// clang-format off
constexpr LoopKind kLoops[] = {
    {"repeat", &StepReader::read_repeat, "NUMBER", "the `steps` beside it, so many times"},
    {"for", &StepReader::read_for, "MAP", "the `steps` beside it for each value: `{function: [1, 2], count: 1..8, f: functions}`"},
};
// clang-format on

}  // namespace

std::span<const LoopKind> loop_kinds() { return kLoops; }

void StepReader::read_all(const YamlNode& list, Scenario& scenario) {
  const std::size_t mistakes = values_.complaints.count();
  left_out_ = false;
  read_steps(list, scenario, scenario.steps);
  if (!scenario.steps.empty() || values_.complaints.count() > mistakes) return;
  if (!left_out_)
    values_.wrong(list, "no steps: nothing would be tested", "write for example - {read: holding 0, expect: accepted}");
  else if (scenario.skipped.empty())
    scenario.skipped = "not applicable: none of its steps has what it needs";
}

void StepReader::read_steps(const YamlNode& list, const Scenario& scenario, std::vector<Step>& steps) {
  if (!list.is_list()) return values_.wrong(list, "'steps' is a list, not " + to_text(list), "begin each step with '- '");
  for (const YamlNode& node : list.items) {
    if (too_much(node)) return;
    read_step(node, scenario, steps);
  }
}

/// Steps read and turns taken are limited together, so that loops of nothing end too.
bool StepReader::too_much(const YamlNode& node) {
  if (++work_ <= most_steps_) return false;
  values_.loop.clear();
  values_.wrong(node, fmt::format("more than {} steps", most_steps_), "fewer turns of the loops will do");
  return true;
}

/// The key that makes it a step; null after a complaint. One that stands there twice is complained about already. What makes
/// a step by itself may stand beside another action: power_off beside power_cycle.
const YamlNode* StepReader::find_action(const YamlNode& node) {
  const auto makes_a_step = [](const ScenarioKey& key) { return key.where == ScenarioKey::Where::OfStep; };
  const std::vector<ScenarioKey>& keys = scenario_keys();
  const YamlNode* action = nullptr;
  for (const YamlNode& key : node.keys) {
    const bool known =
        std::any_of(keys.begin(), keys.end(), [&](const auto& k) { return makes_a_step(k) && k.key == key.text; });
    const auto stands_beside = [&](std::string_view word, std::string_view other) {
      return std::any_of(keys.begin(), keys.end(), [&](const ScenarioKey& k) {
        return k.key == word && k.belongs({ScenarioKey::Where::Modifier}, other);
      });
    };
    if (!known || (action && (action->text == key.text || stands_beside(key.text, action->text)))) continue;
    if (action && !stands_beside(action->text, key.text)) {
      values_.wrong(key, fmt::format("'{}' and '{}' in one step", action->text, key.text), "begin another step with '- '");
      return nullptr;
    }
    action = &key;
  }
  if (action) return action;
  std::vector<std::string_view> known;
  for (const ScenarioKey& key : keys)
    if (makes_a_step(key)) known.push_back(key.key);
  const auto unknown = std::ranges::find_if(node.keys, [&](const YamlNode& key) {
    return std::ranges::none_of(keys, [&](const ScenarioKey& row) {
      return row.key == key.text && (makes_a_step(row) || row.where == ScenarioKey::Where::Modifier);
    });
  });
  const YamlNode* const written = unknown != node.keys.end() ? &*unknown : node.keys.empty() ? nullptr : &node.keys.front();
  const auto other = std::ranges::find_if(kOtherSteps, [&](const OtherSteps& each) {
    return written != nullptr && !written->text.empty() && std::ranges::find(each.words, written->text) != each.words.end();
  });
  const std::string hint =
      other == kOtherSteps.end() ? fmt::format("it has one of: {}", fmt::join(known, ", ")) : std::string(other->hint);
  if (unknown != node.keys.end())
    values_.wrong(*unknown, fmt::format("there is no step '{}'", stl::shortened(unknown->text)), hint);
  else
    values_.wrong(node.keys.empty() ? node : node.keys[0], "a step that does nothing", hint);
  return nullptr;
}

void StepReader::read_step(const YamlNode& node, const Scenario& scenario, std::vector<Step>& steps) {
  if (!node.is_map()) return values_.wrong(node, "a step is a map, not " + to_text(node), "write for example - wait: 20ms");
  const YamlNode* action = find_action(node);
  if (!action) return;
  values_.check_keys(node, {ScenarioKey::Where::Modifier}, action->text);
  std::string missing;
  if (!values_.has_what_it_needs(node, missing)) {
    left_out_ = true;
    return;
  }
  const YamlNode& is = *node.find(action->text);
  for (const LoopKind& loop : loop_kinds())
    if (loop.key == action->text) return (this->*loop.read)(node, is, scenario, steps);
  const auto kinds = step_kinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const StepKind& k) { return k.key == action->text; });
  Step step{.key = kind->key, .position = action->position, .loop = values_.loop};
  step.position.length = static_cast<std::uint32_t>(action->text.size());
  if (const auto note = values_.optional_text(node, "note")) step.note = *note;
  if (scenario.plan && kind->of != StepKind::Of::System)
    read_place(node, scenario, kind->of == StepKind::Of::Plc, step);
  else if (const YamlNode* on = scenario.plan ? nullptr : node.find("on"))
    values_.wrong(*on, "'on' names a PLC or a line of a system", "name the file of one with 'system:', not 'program:'");
  if (scenario.plan && kind->of == StepKind::Of::Plc && !step.spot && !step.line) return;
  step.action = kind->read({values_, node, is, scenario, step});
  const bool scans = kind->of == StepKind::Of::Either && step.action->needs() == Needs::ToChange;  // and not a time
  if (scenario.plan && scans && step.on.empty() && !scenario.on.empty()) read_place(node, scenario, true, step);
  check_place(node, scenario, step);
  steps.push_back(std::move(step));
}

/// What it is about: nothing after a complaint, or if it is not needed.
void StepReader::read_place(const YamlNode& node, const Scenario& scenario, bool needed, Step& step) {
  step.on = values_.optional_text(node, "on").value_or("");
  if (step.on.empty() && !needed) return;
  const std::string& place = step.on.empty() ? scenario.on : step.on;
  std::string why;
  if (scenario.is_of_peers()) {
    const auto line = find_line(*scenario.plan, place);
    step.line = line.if_any();
    why = line.why();
  } else {
    const auto spot = find_spot(*scenario.plan, place);
    step.spot = spot.if_any();
    why = spot.why();
  }
  const YamlNode* const on = node.find("on");
  if (!why.empty()) values_.wrong(on ? *on : node, why, on ? "" : "put on: NAME beside it");
}

/// Complains about what cannot be done there.
void StepReader::check_place(const YamlNode& node, const Scenario& scenario, const Step& step) {
  if (!scenario.plan) return;
  const Needs needs = step.action->needs();
  if (scenario.is_of_peers() && (needs == Needs::ToLook || needs == Needs::ToChange))
    return values_.wrong(node, fmt::format("'{}' is about an S7-200, and there is none in {}", step.key, scenario.system),
                         "what other PLCs keep is asked for on the line: send, request, read, write");
  if (!reception_of(step)) return;
  const std::size_t line = step.spot ? step.spot->line : *step.line;
  const std::string why = step.line ? why_no_other_plc(*scenario.plan, line) : why_no_room(*scenario.plan, line);
  if (!why.empty()) values_.wrong(node, why);
}

// --- loops ---

void StepReader::read_repeat(const YamlNode& node, const YamlNode& times, const Scenario& scenario,
                             std::vector<Step>& steps) {
  const auto count = values_.number(&times, 1, kLargestLoop);
  const YamlNode* body = loop_body(node);
  if (!count || !body) return;
  ++depth_;
  for (std::int64_t turn = 1; turn <= *count && !too_much(*body); ++turn)
    in_loop(fmt::format("turn {} of {}", turn, *count), [&] { read_steps(*body, scenario, steps); });
  --depth_;
}

void StepReader::read_for(const YamlNode& node, const YamlNode& variables, const Scenario& scenario,
                          std::vector<Step>& steps) {
  if (!variables.is_map() || variables.keys.empty())
    return values_.wrong(
        variables, "'for' has a map of names and values, not " + (variables.is_map() ? "an empty one" : to_text(variables)),
        "write for example for: {count: [0, 126]}");
  const YamlNode* body = loop_body(node);
  if (!body) return;
  ++depth_;
  loop_over(variables, 0, *body, scenario, steps);
  --depth_;
}

/// The steps to repeat; null after a complaint.
const YamlNode* StepReader::loop_body(const YamlNode& node) {
  const YamlNode* body = node.find("steps");
  if (!body) {
    values_.wrong(node.keys[0], "a loop without 'steps'", "put 'steps:' and a list of steps beside it");
    return nullptr;
  }
  if (depth_ == kDeepestLoop) {
    values_.wrong(node.keys[0], fmt::format("more than {} loops inside each other", kDeepestLoop));
    return nullptr;
  }
  return body;
}

template <class Body>
void StepReader::in_loop(const std::string& turn, Body body) {
  const std::string outer = values_.loop;
  values_.loop += (values_.loop.empty() ? "" : ", ") + turn;
  body();
  values_.loop = outer;
}

void StepReader::loop_over(const YamlNode& variables, std::size_t which, const YamlNode& body, const Scenario& scenario,
                           std::vector<Step>& steps) {
  if (which == variables.keys.size() || which == variables.items.size()) return read_steps(body, scenario, steps);
  const std::string& name = variables.keys[which].text;
  const auto kept = values_.parameters.values;
  for (const std::string& each : loop_values(variables.items[which])) {
    if (too_much(body)) break;
    values_.parameters.values[name] = each;
    in_loop(fmt::format("{} = {}", name, stl::shortened(each)),
            [&] { loop_over(variables, which + 1, body, scenario, steps); });
  }
  values_.parameters.values = kept;
}

/// A list as it stands, `1..8`, or the name of a list.
std::vector<std::string> StepReader::loop_values(const YamlNode& node) {
  std::vector<std::string> values;
  if (node.is_list()) {
    for (const YamlNode& item : node.items)
      if (const auto one = values_.text(item)) values.push_back(*one);
    return values;
  }
  const auto written = values_.text(node);
  if (!written) return values;
  if (const auto list = values_.parameters.lists.find(*written); list != values_.parameters.lists.end()) return list->second;
  const auto range = written->find("..") == std::string::npos ? std::nullopt : parse_count(*written);
  if (!range || range->to - range->from >= kLargestLoop) {
    values_.wrong(
        node, fmt::format("'{}' are not values for a loop", stl::shortened(*written)),
        fmt::format("write a list, a range such as 1..8 of {} values at most, or the name of a list among the parameters",
                    kLargestLoop));
    return values;
  }
  for (std::uint64_t i = range->from; i <= range->to; ++i) values.push_back(std::to_string(i));
  return values;
}

}  // namespace s7200::tools
