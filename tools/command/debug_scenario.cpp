#include "tools/command/debug_scenario.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "interpreter/base/text.hpp"
#include "tools/command/debug_script.hpp"
#include "tools/command/debug_session.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal.hpp"
#include "tools/command/test_output.hpp"
#include "tools/faces/console/prompt.hpp"
#include "tools/faces/files/host_files.hpp"
#include "tools/host/files.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/benches.hpp"
#include "tools/scenario/collection.hpp"
#include "tools/scenario/plant.hpp"
#include "tools/scenario/report.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools {
namespace {

/// What else belongs to a program; a scenario says it itself.
std::string option_of_a_program(const CLI::App& verb) {
  constexpr std::array<std::string_view, 5> kOfScenarios{"--only", "--target", "--commands", "--execute", "--interactive"};
  for (const CLI::Option* option : verb.get_options()) {
    const bool known = option->get_positional() || std::ranges::find(kOfScenarios, option->get_name()) != kOfScenarios.end();
    if (option->count() > 0 && !known) return option->get_name();
  }
  return {};
}

/// A scenario as it went.
struct Opened {
  const Scenario* scenario = nullptr;
  std::shared_ptr<const Program> program{};
  ScenarioResult result{};
};

/// The first that fails; the first one if none does. Nothing if none can be run again.
std::optional<Opened> opened(const std::vector<Scenario>& scenarios, Benches& benches) {
  std::optional<Opened> first;
  for (std::size_t i = 0; i < scenarios.size() && !interrupted(); ++i) {
    benches.of[i].recordings_wanted = true;
    benches.of[i].band = nullptr;
    Opened one{&scenarios[i], benches.of[i].program, run_scenario(scenarios[i], benches.of[i])};
    if (one.result.recordings.empty()) continue;
    const bool failed = !one.result.findings.empty();
    if (failed || !first) first = std::move(one);
    if (failed) break;
  }
  return first;
}

/// Where it is opened: at what it found, or else at its end.
PlaceInRun place_of(const ScenarioResult& result) {
  for (const Finding& finding : result.findings)
    if (finding.place) return *finding.place;
  return {result.recordings.size() - 1, result.recordings.back().end};
}

/// Memory that was not as expected, if that is what it found first.
std::vector<MemoryRange> failed_memory(const ScenarioResult& result) {
  const auto first = std::ranges::find_if(result.findings, [](const Finding& finding) { return finding.place.has_value(); });
  if (first == result.findings.end() || !first->memory) return {};
  return {*first->memory};
}

/// The PLC that it looks at then.
std::size_t station_of(const ScenarioResult& result) {
  for (const Finding& finding : result.findings)
    if (finding.place) return finding.station;
  return 0;
}

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

std::string heading(const Opened& one) {
  const std::string name = stl::printable(one.scenario->name);
  if (one.result.findings.empty()) return fmt::format("'{}' passes; this is its end\n", name);
  const Finding& finding = one.result.findings.front();
  const stl::Position position = position_of(*one.scenario, finding);
  return fmt::format("'{}' fails in {}:{}:\n  {}\n", name, stl::printable(one.scenario->source->name), position.line,
                     stl::printable(finding_line(*one.scenario, finding)));
}

int debug(const Opened& one, const std::string& script, const DebugOptions& options) {
  const PlaceInRun place = place_of(one.result);
  const auto plant = std::make_unique<Plant>(*one.scenario, one.program, interruption());
  const HostFiles files;
  PromptSettings settings = prompt_settings({.master = one.scenario->line,
                                             .stations = debugged_stations(*one.scenario),
                                             .station = station_of(one.result),
                                             .files = &files},
                                            nullptr);
  settings.history = plant->history_settings();
  Prompt debugger(plant->stations(), std::cout, settings);
  if (!debugger.open(one.result.recordings[place.power_up], place.moment, failed_memory(one.result)))
    return print_error("the scenario does not run the same way in the debugger; 'test' shows what it found"), kUnusable;
  fmt::print("{}", heading(one));
  std::cout << std::flush;
  const bool good = run_commands(debugger, script, options);
  print_interruption();
  if (interrupted() || (!good && debugger.expectation_failed())) return kCheckFailed;
  return good ? kFine : kUnusable;
}

}  // namespace

bool is_scenario_file(const std::string& path) {
  std::string why;
  const auto text = is_yaml_file(path) ? read_text(path, why) : std::nullopt;
  if (!text) return false;
  stl::Diagnostics ignored;
  const auto root = read_yaml(*text, *source_of(*text, path), ignored);
  return root && root->is_map() && (root->find("steps") || root->find("scenarios"));
}

int run_debug_scenario(const CLI::App& verb, const DebugOptions& options) {
  if (const std::string option = option_of_a_program(verb); !option.empty()) {
    print_error(fmt::format("{} is about a program; a scenario says that itself, in its head", option));
    return kUnusable;
  }
  std::string why;
  const auto script = options.commands_file.empty() ? std::string() : read_file(options.commands_file, why);
  if (!script) return print_error(fmt::format("cannot read {}: {}", options.commands_file, why)), kUnusable;
  const SuiteSettings settings{
      .files = {options.program.path}, .only = options.only, .target = options.target, .stop = interruption()};
  Messages messages;
  Programs programs;
  auto scenarios = collect_scenarios(settings, messages);
  auto benches = scenarios ? make_benches(*scenarios, settings.target, settings, programs, messages) : std::nullopt;
  print_messages(messages);
  if (!benches) return kUnusable;
  if (!benches->of_programs) return print_error("--target must be a program: nothing else can be looked into"), kUnusable;
  const auto one = opened(*scenarios, *benches);
  if (one) return debug(*one, *script, options);
  print_interruption();
  if (!interrupted())
    print_error(
        fmt::format("no scenario of {} can be opened: the debugger opens those of programs and systems in simulation",
                    options.program.path));
  return kUnusable;
}

}  // namespace s7200::tools
