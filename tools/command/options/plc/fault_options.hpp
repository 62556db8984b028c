// Faults of the simulated line, as given on the command line.
#pragma once

#include <string>
#include <vector>

#include "serial_sim/faults/fault.hpp"

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

  const std::vector<serial::Fault>& faults() const { return faults_; }

 private:
  std::vector<std::string> texts_;
  std::vector<serial::Fault> faults_;
};

/// `error`, the text and a caret below the place:
///     s7200: error: --fault, column 10: bit: '8' is not a bit: …
///       flip:bit=8
///                ^
void print_fault_error(const serial::FaultError& error, std::string_view text);

}  // namespace s7200::tools
