// How a scenario went.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "serial_sim/peers/requester.hpp"
#include "tools/coverage/coverage_report.hpp"
#include "tools/coverage/profile_report.hpp"
#include "tools/measuring/band.hpp"
#include "tools/scenario/reading/text.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// A moment of a run, after the power-up of that number.
struct PlaceInRun {
  std::size_t power_up = 0;
  Moment moment{};
};

/// What a step expected and did not find.
struct Finding {
  std::optional<std::size_t> step{};  ///< in the scenario; nothing if it did not come to its steps
  std::string what{};                 ///< `answer`, `transmission`, `latency`, `VW20`
  std::string expected{}, found{};    ///< in words; may be empty if there are bytes
  std::vector<BytePattern> expected_bytes{};
  std::vector<BytePattern> found_bytes{};  ///< of memory, or of an answer
  std::optional<serial::Exchange> exchange{};
  bool of_run = false;                  ///< the scenario could not be run as it is written, whatever the answers
  std::optional<Time> waited{};         ///< for what did not come, where a step waits for something
  std::optional<stl::Position> at{};    ///< in the file, of what is about no step
  std::string timeline{};               ///< what the CPU did in that exchange; empty if it cannot be seen, or is not shown
  std::optional<MemoryRange> memory{};  ///< of a program, whose value is not as expected
  std::optional<PlaceInRun> place{};    ///< in simulation: when it was found
  std::size_t station = 0;              ///< there: the PLC that it is about, or from which its line is seen
  std::vector<std::string> why{};       ///< what led to it, if that is known: a line each
};

/// From the end of the request to the start of the answer; of what no one asked for, from when it was waited for, 0 if it
/// came earlier.
std::optional<Time> latency_of(const serial::Exchange& exchange);

/// How many findings of a scenario are shown in text. The others have no timeline.
inline constexpr std::size_t kFindingsShown = 5;

/// An exchange as it went, or what was received.
struct Seen {
  std::size_t step = 0;  ///< in the scenario
  std::size_t turn = 0;  ///< of a step with many: which of them
  serial::Exchange exchange{};
};

/// How a scenario went with all tables of a band of execution times.
struct BandResult {
  std::size_t asked = 0;               ///< tables it has
  std::size_t tables = 0, passed = 0;  ///< fewer if it was interrupted
  std::string failed_with{};           ///< the first of the tables with which it failed; empty: none
  std::vector<Finding> findings{};     ///< with that one, if it is not the first of all
  LatencyRange latency{};              ///< of all its answers
};

struct ScenarioResult {
  enum class Outcome : std::uint8_t {
    Passed,
    Failed,  ///< or passed, though a failure was expected
    Skipped,
    ExpectedFailure,  ///< failed, as was expected
  };
  Outcome outcome = Outcome::Passed;
  std::string reason{};             ///< of Skipped and of ExpectedFailure
  std::vector<Finding> findings{};  ///< in the order of the steps
  std::vector<Seen> seen{};
  std::size_t checks = 0;                    ///< steps that expected something and were judged
  std::size_t skipped_steps = 0;             ///< that look inside, or cannot go this way, on a slave that is not a program
  Time time = 0;                             ///< on the slave's clock
  std::vector<Spot> spots{};                 ///< of a system: where its masters have joined
  std::vector<Recording> recordings{};       ///< of one that failed on a program in simulation: to run it again, by power-up
  std::shared_ptr<const Program> program{};  ///< of those, that ran it; null of a system
  double host_seconds = 0;
  CoverageOfPrograms coverage{};     ///< if it was observed; of an interrupted scenario up to then
  ProfileOfPrograms profile{};       ///< the same
  std::optional<BandResult> band{};  ///< all else is of the first table, but the recordings of the first that failed
};

}  // namespace s7200::tools
