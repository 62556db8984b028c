// Talking with the debugger on a terminal.
#pragma once

#include "tools/faces/console/prompt.hpp"

namespace s7200::tools {

/// Reads commands from standard input until it ends, `quit`, or something else than Ctrl-C ends the command. An empty line
/// repeats the last one where that makes sense.
void talk(Prompt& debugger);

}  // namespace s7200::tools
