// The PLC that `s7200 dap` debugs: assembled as `s7200 debug` assembles its own, from options or from what a launch says.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/command/options/verb/debug_options.hpp"
#include "tools/faces/dap/session.hpp"

namespace s7200::tools {

/// What a launch may do, by the command line of the server.
struct LaunchLimits {
  std::vector<std::string> programs{};                 ///< the only files that it may run; empty: any
  std::optional<std::vector<std::string>> may_open{};  ///< of writing_attributes() those that it may have; nothing: all
  bool may_use_files = true;                           ///< commands of the console read and write files
};

/// Null after messages, and `exit_code` says how to end. The options have to live as long; `stop_request` ends its runs.
/// Throws dap::Refused for a system file that writes or opens what `limits` do not have.
std::shared_ptr<dap::Debuggee> make_debuggee(const CLI::App& app, std::shared_ptr<DebuggeeOptions> options,
                                             StopToken stop_request, int& exit_code, const LaunchLimits& limits = {});

/// What lets commands of the console read and write files: `save`, `load`, `record`.
inline constexpr std::string_view kFilesOfCommands = "files";

/// The attributes by which a launch writes files, or opens ports, ptys and devices: as options without their dashes; and
/// kFilesOfCommands.
std::vector<std::string> writing_attributes();

/// What is wrong with a word that is to be one of them, or empty.
std::string not_a_writing_attribute(const std::string& word);

/// Each attribute is an option of `s7200 debug` without its dashes, as `modbusTcp` or `modbus-tcp`; a list gives it several
/// times. Throws dap::Refused or WrongValue with what is wrong.
std::shared_ptr<dap::Debuggee> launch_debuggee(const dap::Json& arguments, const LaunchLimits& limits,
                                               StopToken stop_request);

}  // namespace s7200::tools
