// What `s7200 run` runs: a PROGRAM, a system file, or a simulated PLC of another make for whoever asks it over a bridge.
#pragma once

#include <optional>
#include <vector>

#include "tools/command/options/verb/run_options.hpp"
#include "tools/command/running/system_bridges.hpp"

namespace s7200::tools {

/// The bridges of a run.
struct RunBridges {
  SystemBridges of_file{};
  std::vector<Bridge*> of_plan{};  ///< by the plan's numbers
  Bridge* joined = nullptr;        ///< that the options have joined to the line of a PROGRAM; null: none
};

/// Loads what is to be run into the options of the rig. Nothing after messages: `exit_code` says which way to end. Options
/// that it has no use for are refused.
std::optional<RunBridges> load_run(const CLI::App& verb, RunOptions& options, int& exit_code);

}  // namespace s7200::tools
