// Whether two programs do the same: both run with the same inputs at the same instants, until their outputs differ.
//
// The same are outputs that go on and off in the same order, each edge within three scans of that of the other program; an
// edge may follow from those before it, so the n-th may be n times as late. Analog outputs, and memory that is asked for,
// have the same value when nothing has come for a while. What is sent has the same characters in the same order, whenever
// they come. A difference counts if it is still there when all inputs come up to a scan later, and when they last a
// few scans longer: otherwise it is one of timing. No input is shorter than three scans, and a frame that a program answers
// before its end decides nothing.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/trials/contacts_seen.hpp"
#include "tools/trials/trial.hpp"
#include "tools/trials/trial_scenario.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

struct BehaviourSettings {
  std::uint64_t seed = 1, runs = 5000;
  double seconds = 10;                 ///< of the host
  std::vector<MemoryRange> watched{};  ///< that is to be the same as well
  StopToken stop{};
  std::function<void(std::uint64_t runs)> progress{};
};

struct BehaviourDifference {
  Time at = 0;                                          ///< since power-up
  std::string what{}, older{}, newer{};                 ///< `Q0.0`, `1`, `0`
  std::optional<std::uint32_t> older_op{}, newer_op{};  ///< that wrote it last; nothing: none did
  Trial trial{};                                        ///< the shortest that leads there
  std::vector<Time> begun{};                            ///< when each stimulus comes, since power-up
  std::vector<std::string> expectations{};  ///< steps of a scenario that holds for the old program, in YAML; the best first
  std::vector<std::string> beside{};        ///< of the frames of the trial: what they expect there
};

struct BehaviourResult {
  enum class End : std::uint8_t { Differs, AllContacts, Runs, Seconds, Interrupted };
  End end{};
  std::optional<BehaviourDifference> difference{};
  std::uint64_t runs = 0, timing_alone = 0;
  Time simulated = 0;
  std::uint8_t port = 0;
  std::vector<std::uint32_t> beyond{};        ///< presets of counters that get fewer edges than they count
  std::size_t contacts[2]{}, both_ways[2]{};  ///< of the old and the new program
  std::vector<ContactsSeen::Never> never[2]{};
};

/// Neither program has errors. The same for the same seed and number of runs.
BehaviourResult compare_behaviour(const Inspection& older, const Inspection& newer, const BehaviourSettings& settings);

std::string behaviour_text(const Inspection& older, const Inspection& newer, const BehaviourResult& result);
nlohmann::ordered_json behaviour_json(const Inspection& older, const Inspection& newer, const BehaviourResult& result);

/// A scenario that passes with the old program and fails with the new one. Trouble if there is none. `program`:
/// the old one's path, as it is to stand in the file at `path`.
Result<std::string> difference_scenario(const Inspection& older, const Inspection& newer, const BehaviourResult& result,
                                        const std::string& path, const ScenarioOrigin& origin);

}  // namespace s7200::tools
