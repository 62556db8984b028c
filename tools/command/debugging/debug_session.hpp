// A session as the verbs `debug` and `dap` begin it.
#pragma once

#include <atomic>

#include "tools/command/debugging/debuggee_run.hpp"
#include "tools/command/options/verb/debug_options.hpp"
#include "tools/faces/console/prompt.hpp"

namespace s7200::tools {

/// All that is given must live as long as the session. `files`: that its commands read and write; null for none.
SessionSetup session_setup(const DebuggeeOptions& options, const Rig& rig, DebuggeeRun& live, const SessionFiles* files);

/// With the terminal, and what ends the command. `pause` is what stops a run with the clock, too; null if nothing does.
PromptSettings prompt_settings(SessionSetup setup, std::atomic<bool>* pause);

}  // namespace s7200::tools
