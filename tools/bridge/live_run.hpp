// Runs a simulation in real time, with or without a bridge.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tools/bridge/bridge.hpp"
#include "tools/host/pace.hpp"

namespace s7200::tools {

struct LiveRunOptions {
  double speed = 1;             ///< times the clock
  serial::LineSettings line{};  ///< the other end of the line
  LiveMessages messages{};
  const std::atomic<bool>* stop = nullptr;  ///< ends a run as an interruption does; not owned
};

/// A simulation that is powered up, and the host it follows. Between two runs it stands still, and whoever is on the bridge
/// waits.
class LiveRun {
 public:
  /// Neither is owned; `bridge` may be null.
  LiveRun(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Lets the bridge serve. Returns false and sets `why` if it cannot.
  bool start(std::string& why);

  /// From now on in real time, until the simulation has come to `end`, the CPU stops, or pauses and `goes_on` says no, a
  /// stop is asked for (Halt::Request), or the bridge fails (Halt::Request, and failure()).
  serial::Halt run_until(
      Time end, std::function<bool()> goes_on = [] { return false; });

  /// Why the bridge cannot go on; empty as long as it can.
  const std::string& failure() const;

  Pace::Report pace() const;

 private:
  class Line;
  std::unique_ptr<Line> line_;
};

struct LiveLimits {
  Time end = kNever;        ///< simulated
  std::uint64_t scans = 0;  ///< 0: any number
  bool strict = false;      ///< the first run-time error ends it
};

/// Runs until a limit is reached, the CPU stops, an interruption comes or the bridge fails. Returns why it ended: `time`,
/// `scans`, `stop`, `fatal`, `run-time error`, `interrupted`, `bridge`.
std::string_view run_live(LiveRun& live, serial::Simulation& simulation, const LiveLimits& limits);

}  // namespace s7200::tools
