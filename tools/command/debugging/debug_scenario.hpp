// A scenario in the debugger: it is run, and opened where it failed.
#pragma once

#include "tools/command/options/verb/debug_options.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// Returns the exit code, after messages.
int run_debug_scenario(const CLI::App& verb, const DebugOptions& options);

}  // namespace s7200::tools
