#include "tools/command/testing/opened_scenario.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/benches.hpp"
#include "tools/scenario/reading/collection.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools {
namespace {

/// The PLCs of its system; none of one program.
std::vector<DebuggedStation> debugged_stations(const Scenario& scenario) {
  std::vector<DebuggedStation> stations;
  if (!scenario.plan) return stations;
  const std::vector<Spot> spots = spots_of_plcs(*scenario.plan);
  for (std::size_t plc = 0; plc < spots.size(); ++plc)
    stations.push_back(
        {.name = scenario.plan->plcs[plc].name, .master = on_line(scenario.line, scenario.plan->lines[spots[plc].line])});
  return stations;
}

/// The first finding that has a moment; null if none has.
const Finding* finding_with_place(const ScenarioResult& result) {
  const auto first = std::ranges::find_if(result.findings, [](const Finding& finding) { return finding.place.has_value(); });
  return first == result.findings.end() ? nullptr : &*first;
}

}  // namespace

bool is_scenario_file(const std::string& path) {
  const auto text = is_yaml_file(path) ? read_text(path) : std::nullopt;
  if (!text) return false;
  stl::Diagnostics ignored;
  const auto root = read_yaml(*text, *source_of(*text, path), ignored);
  return root && root->is_map() && (root->find("steps") || root->find("scenarios"));
}

std::string option_of_a_program(const CLI::App& verb, const std::vector<std::string_view>& of_scenarios) {
  for (const CLI::Option* option : verb.get_options()) {
    const bool known = option->get_positional() || std::ranges::find(of_scenarios, option->get_name()) != of_scenarios.end();
    if (option->count() > 0 && !known) return option->get_name();
  }
  return {};
}

std::unique_ptr<OpenedScenario> OpenedScenario::open(const WantedScenario& wanted, int& exit_code) {
  exit_code = kUnusable;
  const SuiteSettings settings{.files = {wanted.path}, .only = wanted.only, .target = wanted.target, .stop = interruption()};
  Messages messages;
  Programs programs;
  auto scenarios = collect_scenarios(settings, messages);
  auto benches = scenarios ? make_benches(*scenarios, settings.target, settings, programs, messages) : std::nullopt;
  print_messages(messages);
  if (!benches) return nullptr;
  if (!benches->of_programs) return print_error("--target must be a program: nothing else can be looked into"), nullptr;
  std::unique_ptr<OpenedScenario> opened(new OpenedScenario);
  opened->scenarios_ = std::move(*scenarios);
  for (std::size_t i = 0; i < opened->scenarios_.size() && !interrupted(); ++i) {
    const Scenario& scenario = opened->scenarios_[i];
    benches->of[i].recordings_wanted = true;
    benches->of[i].band = nullptr;
    ScenarioResult result = run_scenario(scenario, benches->of[i]);
    const bool failed = !result.findings.empty();
    if (result.recordings.empty() || !(failed || !opened->scenario_)) continue;
    opened->scenario_ = &scenario;
    opened->program_ = benches->of[i].program;
    opened->result_ = std::move(result);
    if (failed) break;
  }
  if (opened->scenario_) return opened;
  print_interruption();
  if (!interrupted())
    print_error(
        fmt::format("no scenario of {} can be opened: those of programs and systems in simulation can", wanted.path));
  return nullptr;
}

std::unique_ptr<Plant> OpenedScenario::plant() const {
  return std::make_unique<Plant>(*scenario_, program_, interruption());
}

SessionSetup OpenedScenario::setup() const {
  const Finding* const finding = finding_with_place(result_);
  return {.master = scenario_->line, .stations = debugged_stations(*scenario_), .station = finding ? finding->station : 0};
}

PlaceInRun OpenedScenario::place() const {
  if (const Finding* const finding = finding_with_place(result_)) return *finding->place;
  return {result_.recordings.size() - 1, result_.recordings.back().end};
}

std::vector<MemoryRange> OpenedScenario::failed_memory() const {
  const Finding* const finding = finding_with_place(result_);
  if (!finding || !finding->memory) return {};
  return {*finding->memory};
}

std::string OpenedScenario::heading() const {
  const std::string name = stl::printable(scenario_->name);
  if (result_.findings.empty()) return fmt::format("'{}' passes; this is its end\n", name);
  const Finding& finding = result_.findings.front();
  const stl::Position position = position_of(*scenario_, finding);
  return fmt::format("'{}' fails in {}:{}:\n  {}\n", name, stl::printable(scenario_->source->name), position.line,
                     stl::printable(finding_line(*scenario_, finding)));
}

}  // namespace s7200::tools
