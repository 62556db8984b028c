// The scenarios that a suite is made of.
#pragma once

#include <optional>
#include <vector>

#include "tools/scenario/reporting/messages.hpp"
#include "tools/scenario/scenario.hpp"
#include "tools/scenario/suite_settings.hpp"

namespace s7200::tools {

/// Reads files, folders, the rules of Modbus or random traffic, and chooses from them. Nothing, with messages, if a file
/// cannot be read or has mistakes, or if nothing is left to be run.
std::optional<std::vector<Scenario>> collect_scenarios(const SuiteSettings& settings, Messages& messages);

}  // namespace s7200::tools
