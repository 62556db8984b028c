// The commands of a session of `debug`: those of the command line, and standard input.
#pragma once

#include <string>

#include "tools/command/options/verb/debug_options.hpp"
#include "tools/faces/console/prompt.hpp"

namespace s7200::tools {

/// Executes the text of --commands, the commands of -x, and standard input, as far as they are wanted. Returns false after a
/// message for a wrong command.
bool run_commands(Prompt& debugger, const std::string& script, const DebugOptions& options);

}  // namespace s7200::tools
