// Runs a simulation in real time, with or without a bridge.
#pragma once

#include <string_view>

#include "tools/bridge/bridge.hpp"
#include "tools/command/options/master_options.hpp"
#include "tools/host/pace.hpp"

namespace s7200::tools {

struct LiveRunOptions {
  Time end = kNever;        ///< simulated
  std::uint64_t scans = 0;  ///< 0: any number
  bool strict = false;      ///< the first run-time error ends it
  double speed = 1;
  LineOptions line;  ///< the other end of the line
};

struct LiveRunResult {
  /// `time`, `scans`, `stop`, `fatal`, `run-time error`, `interrupted`, `bridge` when that failed, after a message; empty
  /// when it could not be started, after a message.
  std::string_view reason;
  Pace::Report pace;
};

/// Runs a simulation that is powered up, until its end comes, the CPU stops, or Ctrl-C (catch_interruption()). `bridge` may
/// be null.
LiveRunResult run_live(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge);

}  // namespace s7200::tools
