// The bridges of a system file: where programs and devices of this computer join its lines.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/bridge/live_run.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// By the plan's numbers.
using SystemBridges = std::vector<std::unique_ptr<Bridge>>;

/// Nothing after a message.
std::optional<SystemBridges> make_bridges(const SystemPlan& plan);

/// The same, not owned.
using Bridges = std::span<Bridge* const>;
std::vector<Bridge*> those_of(const SystemBridges& bridges);

/// A rig that follows the clock, with `bridges`, those of its plan, and the one that has `joined` the line of its first
/// spot; null: none has. Nothing is owned.
std::unique_ptr<LiveRun> live_run_of(Rig& rig, Bridges bridges, Bridge* joined, const LiveRunOptions& options);

}  // namespace s7200::tools
