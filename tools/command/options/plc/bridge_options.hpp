// `run` in real time and its bridges, on the command line.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "interpreter/base/result.hpp"
#include "tools/bridge/bridge.hpp"
#include "tools/command/options/plc/line_options.hpp"
#include "tools/plan/bridge_kinds.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// Where it serves, and its notes, on standard error.
LiveMessages print_live_messages();

/// Trouble if it cannot be there. `timeout`: how long those of Modbus wait for an answer to start.
Result<std::unique_ptr<Bridge>> make_bridge(BridgeKind kind, const std::string& where, const serial::LineSettings& line,
                                            Time timeout);

/// Before masters lose patience: libmodbus waits 500 ms.
inline constexpr Time kBridgeTimeout = 400 * kMillisecond;

/// What is said when a program that can be stopped is joined to masters outside.
inline constexpr const char* kMastersWait =
    "while the program stands still, masters outside get no answers: their time-outs are their own affair; bytes "
    "that come in then reach the line without pauses when it goes on";

class BridgeOptions {
 public:
  void add_to(CLI::App& app);

  /// Whether and how fast the clock is followed.
  void add_pace(CLI::App& app);

  /// The bridges alone; set_line() says how the line is set.
  void add_bridges(CLI::App& app);
  void set_line(const serial::LineSettings& line) { line_ = line; }

  /// Makes the bridge asked for. False after a message: more than one, or an address that is not one.
  bool prepare();

  bool realtime() const { return realtime_ || speed_given_ || bridge_; }
  double speed() const { return speed_; }
  const serial::LineSettings& line() const { return line_; }

  /// The name of the pty, if that is the bridge.
  const std::string& link() const { return where(BridgeKind::Pty); }

  /// Null if none was asked for.
  Bridge* bridge() const { return bridge_.get(); }

 private:
  const std::string& where(BridgeKind kind) const { return where_[static_cast<std::size_t>(kind)]; }

  std::array<std::string, kBridges.size()> where_;  ///< each kind; empty: not asked for
  serial::LineSettings line_;
  Time timeout_ = kBridgeTimeout;
  bool realtime_ = false, speed_given_ = false;
  double speed_ = 1;
  std::unique_ptr<Bridge> bridge_;
};

}  // namespace s7200::tools
