// A master at work, from its first exchange to what is said at the end; each returns the exit code.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/command/options/verb/master_options.hpp"
#include "tools/command/polling/master_output.hpp"

namespace s7200::tools {

/// Whichever way it ends. `over`: whether it is to end now. `plant` then says what the JSON has of the plant around the CPU,
/// and `seen` is told each result.
int run_session(
    const MasterOptions& options, MasterSession& session, const std::vector<MasterAction>& actions, MasterOutput& output,
    const std::function<bool()>& over, const std::function<nlohmann::ordered_json()>& plant,
    const std::function<void(const MasterResult&)>& seen = [](const MasterResult&) {});

/// On a PROGRAM, or on a line of a system file.
int run_on_program(const CLI::App& verb, MasterOptions& options, const std::vector<MasterAction>& actions);

/// The same with every table of a band of execution times.
int run_on_program_band(MasterOptions& options, const std::vector<MasterAction>& actions);

/// On a simulated PLC of another make, alone on a line.
int run_on_peer(MasterOptions& options, const std::string& model, const std::vector<MasterAction>& actions);

}  // namespace s7200::tools
