// A system file where a PROGRAM could be.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tools/plan/system_plan.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

struct ProgramOptions;

/// Reads what stands in place of the PROGRAM; nothing after messages, and `exit_code` says which way to end.
std::optional<SystemPlan> load_system(const ProgramOptions& options, int& exit_code);

/// Whether an option of this name is about one PLC, its program or its line: one of the program or its rig.
bool is_about_one_plc(const std::string& option);

/// False after a message if something was given that is about one PLC or its line: an option of the program or its rig, one
/// of `more`, or another file of the project.
bool refuse_options_of_one_plc(const CLI::App& verb, const ProgramOptions& program,
                               std::span<const std::string_view> more = {});

}  // namespace s7200::tools
