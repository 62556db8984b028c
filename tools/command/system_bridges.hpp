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

/// Why nobody on that line answers Modbus, as the programs stand now; empty if somebody may.
std::string why_no_modbus(const Rig& rig, std::size_t line);

/// Where they stand. Nothing is owned.
std::vector<LiveEnd> ends_of(Rig& rig, Bridges bridges);

/// A system as what follows the clock. It is not owned.
std::unique_ptr<LiveMachine> machine_of(serial::System& system);

}  // namespace s7200::tools
