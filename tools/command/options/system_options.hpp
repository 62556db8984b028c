// A system file where a PROGRAM could be.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "tools/rig/system_plan.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// Reads it; nothing after messages, and `exit_code` says which way to end.
std::optional<SystemPlan> load_system(const std::string& path, int& exit_code);

/// False after a message if an option was given that is about one PLC or its line: all but `allowed`, such as `--for`.
bool refuse_options_of_one_plc(const CLI::App& verb, const std::set<std::string_view>& allowed);

}  // namespace s7200::tools
