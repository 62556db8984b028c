// How what is debugged runs: as fast as the computer can, or with the clock if a bridge or an option wants that.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"
#include "tools/bridge/live_run.hpp"
#include "tools/command/options/verb/debug_options.hpp"
#include "tools/command/running/system_bridges.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

class DebuggeeRun {
 public:
  /// `bridges` are those of a system file, besides the one of the options. Rig and options are not owned; Runs with the
  /// clock end at an interruption and when `pause` asks for it.
  DebuggeeRun(RecordedRig& rig, const DebuggeeOptions& options, SystemBridges bridges, const LiveMessages& messages,
              StopToken pause);

  /// Lets the bridges serve. Trouble if they cannot.
  Result<> start() { return live_->start(); }

  /// Why a bridge cannot go on; empty as long as all can.
  const std::string& failure() const { return live_->failure(); }
  /// Why the last run has ended, if a bridge has failed in it; said once.
  std::string take_failure() { return live_->take_failure(); }

  /// Whether a run is no faster than the clock.
  bool follows_clock() const { return realtime_; }

  bool has_bridges() const { return has_bridges_; }

  /// What a history of the rig drives, records and hears. It must not live longer than this.
  History::Settings history();

 private:
  RecordedRig& rig_;
  SystemBridges bridges_;
  std::unique_ptr<LiveRun> live_;
  bool has_bridges_ = false, realtime_ = false;
};

/// The bridges of what was loaded, if it is a system; nothing after a message.
std::optional<SystemBridges> bridges_of(const DebuggeeOptions& options);

/// Whether the bridge of the options, if there is one, can join its line; false after a message.
bool has_room_for_bridge(const DebuggeeOptions& options, const Rig& rig);

}  // namespace s7200::tools
