#include "tools/scenario/reading/reader.hpp"

#include <algorithm>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/joined.hpp"
#include "tools/scenario/limits.hpp"
#include "tools/scenario/reading/head_reader.hpp"
#include "tools/scenario/reading/step_reader.hpp"

namespace s7200::tools {
namespace {

using Where = ScenarioKey::Where;

class Reader {
 public:
  Reader(ScenarioFile& file, const std::string& path, const GivenParameters* given, const Limits& limits)
      : file_(file), path_(path), given_(given), values_(file.diagnostics), steps_(values_, limits.steps) {}

  void read(const YamlNode& root) {
    if (!root.is_map())
      return values_.wrong(root, "a file of scenarios is a map, not " + to_text(root),
                           "begin with 'name:', 'program:' and 'steps:'");
    values_.check_keys(root, {Where::File, Where::Scenario});
    read_parameters(root);
    Scenario common;
    common.source = file_.source;
    common.position = root.position;
    common.name = file_path(file_.source->name).stem().string();
    const bool applicable = read_head(values_, path_, given_, root, common);
    const YamlNode* list = root.find("scenarios");
    const YamlNode* steps = root.find("steps");
    if (!list && !steps) return values_.wrong(root, "neither 'steps' nor 'scenarios'", "a scenario has 'steps:', a list");
    if (steps) {
      if (list) return values_.wrong(*steps, "both 'steps' and 'scenarios'", "steps stand inside each scenario of the list");
      if (applicable) steps_.read_all(*steps, common);
      file_.scenarios.push_back(std::move(common));
      return;
    }
    if (!list->is_list())
      return values_.wrong(*list, "'scenarios' is a list, not " + to_text(*list), "begin each with '- name:'");
    if (list->items.empty())
      return values_.wrong(*list, "no scenarios: nothing would be tested", "begin each with '- name:'");
    for (const YamlNode& each : list->items) read_scenario(each, common);
  }

  /// Those of the parameters given.
  void mark_expected_failures() {
    for (const GivenParameters::ExpectedFailure& expected : given_->expected_failures) {
      bool found = false;
      std::string known;
      for (Scenario& scenario : file_.scenarios) {
        if (scenario.rule.id.empty()) continue;
        known.append(known.empty() ? "" : ", ").append(scenario.rule.id);
        if (scenario.rule.id != expected.rule.name) continue;
        scenario.expected_failure = expected.reason;
        found = true;
      }
      if (!found)
        file_.given_diagnostics.push_back(
            {stl::Severity::Error, expected.rule.position,
             fmt::format("{} has no rule '{}'", file_.source->name, stl::shortened(expected.rule.name)),
             known.empty() ? "it has none" : "known: " + known});
    }
  }

 private:
  void read_scenario(const YamlNode& node, const Scenario& common) {
    if (!node.is_map()) return values_.wrong(node, "a scenario is a map, not " + to_text(node), "begin each with '- name:'");
    values_.check_keys(node, {Where::Scenario});
    Scenario scenario = common;
    scenario.position = node.position;
    scenario.name = fmt::format("{}:{}", common.name, node.position.line);
    if (read_head(values_, path_, given_, node, scenario)) {
      if (const YamlNode* steps = node.find("steps"))
        steps_.read_all(*steps, scenario);
      else
        values_.wrong(node, "a scenario without 'steps'");
    }
    file_.scenarios.push_back(std::move(scenario));
  }

  void read_parameters(const YamlNode& root) {
    std::vector<ParameterName> declared;
    if (const YamlNode* node = root.find("parameters"))
      read_parameter_tree(*node, values_.parameters, declared, values_.complaints);
    if (!given_) return;
    refuse_unknown(declared);
    Parameters& own = values_.parameters;
    for (const auto& [name, list] : given_->parameters.lists) {
      for (const std::string& old : own.lists[name]) own.values.erase(name + "." + old);
      own.lists[name] = list;
    }
    for (const auto& [name, is] : given_->parameters.values) {
      own.values[name] = is;
      own.empty.erase(name);
    }
  }

  void refuse_unknown(const std::vector<ParameterName>& declared) {
    for (const ParameterName& given : given_->names) {
      if (std::any_of(declared.begin(), declared.end(), [&](const auto& d) { return d.name == given.name; })) continue;
      const std::string known = stl::joined(declared, &ParameterName::name);
      file_.given_diagnostics.push_back(
          {stl::Severity::Error, given.position,
           fmt::format("{} has no parameter '{}'", file_.source->name, stl::shortened(given.name)),
           known.empty() ? "it has none" : "known: " + known});
    }
  }

  ScenarioFile& file_;
  const std::string& path_;
  const GivenParameters* given_;
  ValueReader values_;
  StepReader steps_;
};

}  // namespace

ScenarioFile read_scenarios(const std::string& text, const std::string& path, const GivenParameters* given) {
  ScenarioFile file;
  file.source = source_of(text, path);
  const Limits limits = limits_of(text);
  const auto root = read_yaml(text, *file.source, file.diagnostics, {.bytes = limits.bytes, .nodes = limits.nodes});
  if (!root) return file;
  Reader reader(file, path, given, limits);
  reader.read(*root);
  if (given && file.diagnostics.empty()) reader.mark_expected_failures();
  stl::sort(file.diagnostics);
  stl::sort(file.given_diagnostics);
  return file;
}

}  // namespace s7200::tools
