#include "tools/command/debugging/debuggee_run.hpp"

#include <utility>

#include "tools/command/terminal/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/past/seen_rig.hpp"

namespace s7200::tools {

DebuggeeRun::DebuggeeRun(RecordedRig& rig, const DebuggeeOptions& options, SystemBridges bridges,
                         const LiveMessages& messages, StopToken pause)
    : rig_(rig), bridges_(std::move(bridges)) {
  Bridge* const bridge = options.bridge.bridge();
  has_bridges_ = bridge != nullptr || !bridges_.empty();
  realtime_ = has_bridges_ || options.bridge.realtime();
  live_ = live_run_of(rig, those_of(bridges_), bridge,
                      {.speed = options.bridge.speed(),
                       .line = options.rig.on_line(options.master),
                       .messages = messages,
                       .stop = interruption(),
                       .pause = pause,
                       .in_stop_too = true,
                       .before_wait = [&rig] { rig.flush_records(); }});
}

History::Settings DebuggeeRun::history() {
  History::Settings settings = history_settings(rig_);
  for (std::size_t plc = 0; plc < rig_.plan().plcs.size(); ++plc) settings.records.push_back(&rig_.sinks(plc));
  settings.hosts = hosts_of(rig_);
  if (realtime_)
    settings.drive = [this](Time end, const std::function<void()>& meanwhile) {
      return live_->run_until(
          end, [] { return false; }, meanwhile);
    };
  return settings;
}

std::optional<SystemBridges> bridges_of(const DebuggeeOptions& options) { return make_bridges(options.rig.plan()); }

bool has_room_for_bridge(const DebuggeeOptions& options, const Rig& rig) {
  if (options.bridge.bridge() == nullptr || rig.simulation().has_host_port()) return true;
  print_error("this line has as many stations already as it takes: there is no place for a bridge");
  return false;
}

}  // namespace s7200::tools
