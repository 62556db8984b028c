// Which changes of a program its scenarios notice.
//
// A scenario that never comes to what was changed cannot notice it, so it is not run: its coverage says so. The others are
// run until one of them fails. A changed program that loops for ever ends in the watchdog, or at the limits that every step
// has in simulated time; that is noticed too.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/mutants/mutations.hpp"
#include "tools/scenario/benches.hpp"

namespace s7200::tools {

/// A change that no scenario has noticed.
struct Survivor {
  Mutation mutation;
  bool tried = false;  ///< false: no scenario comes to it
};

/// What became of the changes of one program.
struct MutantsOfProgram {
  std::shared_ptr<const Program> program;
  std::size_t scenarios = 0;  ///< that pass with the program as it is
  std::size_t mutants = 0;    ///< that were tried, or that no scenario comes to
  std::size_t noticed = 0;
  std::size_t same = 0;               ///< changes that are decoded to the same operations
  std::size_t refused = 0;            ///< changes that are no program
  std::size_t not_tried = 0;          ///< changes that an interruption left out
  std::vector<Survivor> survivors{};  ///< in the order of the program
};

struct MutantsResult {
  std::vector<MutantsOfProgram> programs{};
  std::size_t left_out = 0;   ///< scenarios that are skipped, or about a system or a slave outside
  std::size_t failing = 0;    ///< scenarios that fail without a change, and are left out too
  std::size_t not_tried = 0;  ///< changes that an interruption left out, of all programs
  bool interrupted = false;   ///< before the last change was tried
};

struct HuntSettings {
  unsigned jobs = 1;  ///< changes tried at a time
  StopToken stop{};
  /// How many of all changes are done, every 200 ms; may be left out.
  std::function<void(std::size_t done, std::size_t all)> progress{};
};

/// `benches`: of these scenarios. Those on the same program hunt together.
MutantsResult hunt_mutants(const std::vector<Scenario>& scenarios, const Benches& benches, const HuntSettings& settings);

}  // namespace s7200::tools
