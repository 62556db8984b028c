// Runs a simulation in real time, with or without a bridge.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/bridge/bridge.hpp"
#include "tools/host/pace.hpp"

namespace s7200::tools {

struct LiveRunOptions {
  double speed = 1;             ///< times the clock
  serial::LineSettings line{};  ///< the other end of the line
  LiveMessages messages{};
  StopToken stop{};                     ///< ends a run
  StopToken pause{};                    ///< a stop after which the run will go on
  bool in_stop_too = false;             ///< a run that begins in STOP lets time pass
  std::function<void()> before_wait{};  ///< is told when the simulation has caught up with the clock; may be null
};

/// A machine that runs in real time: a simulation, or a system.
class LiveMachine {
 public:
  virtual ~LiveMachine() = default;
  virtual Time time() const = 0;
  virtual serial::Halt run_until(Time end) = 0;

  /// The time until which its programs are known to send nothing; a past time if it is not known.
  virtual Time silent_until() const { return 0; }

  /// Tells whether anyone has sent something of late.
  virtual void is_in_use(bool /*in_use*/) {}
};

/// The end of a line where a bridge stands, and the program that sets how it is written.
struct LiveEnd {
  Bridge* bridge = nullptr;  ///< none of these is owned
  serial::HostPort* port = nullptr;
  const serial::SharedLine* line = nullptr;
  const serial::Plc* plc = nullptr;  ///< null: the line has no program
  std::uint8_t plc_port = 0;
  SerialFormat without_program{};   ///< format of a line without a program
  serial::LineSettings settings{};  ///< the other end of the line
  /// Why no station on that line answers Modbus at the moment; empty if one may. If the function is left out, one may.
  std::function<std::string()> why_no_modbus{};
};

/// A simulation that is powered up, and the host it follows. Between two runs it stands still, and whoever is on the bridge
/// waits.
class LiveRun {
 public:
  /// Neither the simulation nor the bridge is owned; `bridge` may be null.
  LiveRun(serial::Simulation& simulation, const LiveRunOptions& options, Bridge* bridge);
  /// Runs a machine with any number of bridges on its lines.
  LiveRun(std::unique_ptr<LiveMachine> machine, const std::vector<LiveEnd>& ends, const LiveRunOptions& options);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Lets the bridge serve. Trouble if it cannot.
  Result<> start();

  /// Runs in real time from now on, until the simulation has come to `end`, the CPU stops, or pauses and `goes_on` returns
  /// false, a stop is asked for (Halt::Request), or a bridge fails (Halt::Request, and failure()). The next run goes on
  /// without that bridge. `meanwhile` is called many times a second, whatever the simulation does.
  serial::Halt run_until(
      Time end, std::function<bool()> goes_on = [] { return false; }, const std::function<void()>& meanwhile = [] {});

  /// Why the first bridge that failed cannot go on; empty as long as all can.
  const std::string& failure() const;

  /// Why the last run has ended, if a bridge has failed in it; said once.
  std::string take_failure();

  Pace::Report pace() const;

  /// How often a master on a bridge sent while the PLC at the other end of that line was sending; 0 for a line without a
  /// bridge.
  std::uint64_t collisions(const serial::SharedLine* line) const;

 private:
  class Engine;
  std::unique_ptr<LiveMachine> machine_;
  std::unique_ptr<Engine> engine_;
};

struct LiveLimits {
  Time end = kNever;        ///< simulated
  std::uint64_t scans = 0;  ///< 0: any number
  bool strict = false;      ///< the first run-time error ends it
  /// Is called when the CPU goes to STOP without a fatal error and the run goes on, for a master may start the CPU again;
  /// the options have in_stop_too. Null: STOP ends the run.
  std::function<void()> stopped{};
};

/// Runs until a limit is reached, the CPU stops, an interruption comes or the bridge fails. Returns why it ended: `time`,
/// `scans`, `stop`, `fatal`, `run-time error`, `interrupted`, `bridge`.
std::string_view run_live(LiveRun& live, serial::Simulation& simulation, const LiveLimits& limits);

}  // namespace s7200::tools
