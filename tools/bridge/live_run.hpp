// Runs a simulation in real time, with or without a bridge.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "tools/bridge/bridge.hpp"
#include "tools/host/pace.hpp"

namespace s7200::tools {

struct LiveRunOptions {
  Time end = kNever;        ///< simulated
  std::uint64_t scans = 0;  ///< 0: any number
  bool strict = false;      ///< the first run-time error ends it
  double speed = 1;
  serial::LineSettings line;  ///< the other end of the line
  LiveMessages messages;
  const std::atomic<bool>* stop = nullptr;  ///< ends it as an interruption does; not owned
};

struct LiveRunResult {
  /// `time`, `scans`, `stop`, `fatal`, `run-time error`, `interrupted`, `bridge` if that failed; empty if it could not be
  /// started.
  std::string_view reason;
  std::string failure;  ///< of the bridge: why
  Pace::Report pace;
};

/// Runs a simulation that is powered up, until its end comes, the CPU stops, or Ctrl-C (catch_interruption()). `bridge` may
/// be null.
LiveRunResult run_live(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge);

}  // namespace s7200::tools
