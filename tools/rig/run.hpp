// Runs a simulation or a whole rig as fast as the computer can, until it has done what was asked.
#pragma once

#include <functional>
#include <string_view>

#include "serial_sim/system/simulation.hpp"

namespace s7200::tools {

class Rig;

/// A scan that goes on for so long in simulated time is taken for one that never ends; only WDR lets it come so far.
inline constexpr Time kEndlessScan = 10 * kSecond;

struct RunLimits {
  Time end = kNever;        ///< of the simulation; kNever: only the number of scans ends it
  std::uint64_t scans = 0;  ///< 0: any number
  bool strict = false;      ///< the first run-time error ends it
  Time slice = 10 * kSecond;
};

/// Is told between the slices of a run; false ends it. What is computed does not depend on it.
using RunProgress = std::function<bool()>;

/// Runs in slices. Returns why it ended: `time`, `scans`, `endless scan`, `stop`, `fatal`, `run-time error`, `interrupted`,
/// or `record limit` if `progress` has ended it.
std::string_view run(serial::Simulation& simulation, const RunLimits& limits, const RunProgress& progress);

/// The same of a rig: a PROGRAM runs within its limits, a system to their `end`, whatever its PLCs do.
std::string_view run(Rig& rig, const RunLimits& limits, const RunProgress& progress);

}  // namespace s7200::tools
