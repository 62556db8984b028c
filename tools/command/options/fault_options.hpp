// Faults of the simulated line, as given on the command line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serial_sim/system/simulation.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class FaultOptions {
 public:
  void add_to(CLI::App& app);

  bool empty() const { return texts_.empty(); }

  /// Reads what was given. False after messages.
  bool prepare();

  void inject(serial::Simulation& simulation) const;

 private:
  std::vector<std::string> texts_;
  std::vector<serial::Fault> faults_;
};

/// `error`, the text and a caret below the place:
///     s7200: error: --fault, column 10: bit: '8' is no bit: …
///       flip:bit=8
///                ^
void print_fault_error(const serial::FaultError& error, std::string_view text);

/// The kinds of faults with their parameters, one a line, for --help.
std::string fault_help();

/// What has happened so far, a line for each fault; nothing without faults.
std::string faults_text(const serial::Faults& faults);

/// [{"fault": "flip:bit=3", "count": 2, "impossible": 0}]
nlohmann::ordered_json faults_json(const serial::Faults& faults);

/// The same of those that have happened since then, with the difference; the faults are the same as then.
nlohmann::ordered_json faults_json(const serial::Faults& faults, const serial::Faults::State& since);

}  // namespace s7200::tools
