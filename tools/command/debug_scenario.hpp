// A scenario in the debugger: it is run, and opened where it failed.
#pragma once

#include <string>

#include "tools/command/options/debug_options.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// Whether a file has scenarios in it: it is YAML, with `steps:` or `scenarios:`.
bool is_scenario_file(const std::string& path);

/// Returns the exit code, after messages.
int run_debug_scenario(const CLI::App& verb, const DebugOptions& options);

}  // namespace s7200::tools
