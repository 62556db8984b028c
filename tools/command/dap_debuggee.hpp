// The PLC that `s7200 dap` debugs: assembled as `s7200 debug` assembles its own, from options or from what a launch says.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "tools/command/options/debug_options.hpp"
#include "tools/dap/session.hpp"

namespace s7200::tools {

/// Null after messages, and `exit_code` says how to end. The options have to live as long; `stop_request` ends its runs.
std::shared_ptr<dap::Debuggee> make_debuggee(const CLI::App& app, std::shared_ptr<DebuggeeOptions> options,
                                             const std::atomic<bool>& stop_request, int& exit_code);

/// Each attribute is an option of `s7200 debug` without its dashes, as `modbusTcp` or `modbus-tcp`; a list gives it several
/// times. Throws dap::Refused with all that is wrong.
std::shared_ptr<dap::Debuggee> launch_debuggee(const dap::Json& arguments, const std::atomic<bool>& stop_request);

}  // namespace s7200::tools
