// A session of the debugger as the verb begins it.
#pragma once

#include <atomic>
#include <memory>

#include "tools/command/debuggee_run.hpp"
#include "tools/command/options/debug_options.hpp"
#include "tools/debugger/debugger.hpp"

namespace s7200::tools {

/// All that is given must live as long as the session. `pause` is what stops `live`, too.
DebuggerOptions session_options(const DebugOptions& options, const Rig& rig, DebuggeeRun& live, std::atomic<bool>& pause);

}  // namespace s7200::tools
