// A scenario as it went, to be opened where it failed: by `s7200 debug` and `s7200 view`.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/scenario/plant.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/session/commands/session.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// Whether a file has scenarios in it: it is YAML, with `steps:` or `scenarios:`.
bool is_scenario_file(const std::string& path);

struct WantedScenario {
  std::string path{};
  std::string only{};    ///< a pattern of their names; "" for all
  std::string target{};  ///< the program to run it on, instead of its own
};

class OpenedScenario {
 public:
  /// Runs them up to the first that fails, and takes that; the first one if none does. Null after messages: `exit_code` says
  /// which way to end.
  static std::unique_ptr<OpenedScenario> open(const WantedScenario& wanted, int& exit_code);

  /// A plant of its own, powered up, in which it can be run again.
  std::unique_ptr<Plant> plant() const;
  /// How a session on it begins.
  SessionSetup setup() const;
  /// Its last recording up to where it is opened, and that place: at what it found, or else at its end.
  const Recording& recording() const { return result_.recordings[place().power_up]; }
  PlaceInRun place() const;
  /// Memory that was not as expected, if that is what it found first.
  std::vector<MemoryRange> failed_memory() const;
  bool has_failed() const { return !result_.findings.empty(); }
  /// What it found, in lines.
  std::string heading() const;
  const std::string& name() const { return scenario_->name; }

 private:
  OpenedScenario() = default;

  std::vector<Scenario> scenarios_{};
  const Scenario* scenario_ = nullptr;  ///< one of them
  std::shared_ptr<const Program> program_{};
  ScenarioResult result_{};
};

/// The first option given that belongs to a program, which a scenario says itself; empty if there is none. `of_scenarios`:
/// the names of those that go with a file of scenarios.
std::string option_of_a_program(const CLI::App& verb, const std::vector<std::string_view>& of_scenarios);

}  // namespace s7200::tools
