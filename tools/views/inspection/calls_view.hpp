// Who calls whom, interrupt routines by event, routines that nothing starts (interpreter/analysis/flow/calls.hpp).
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// All of it, or the routines of the selection with who starts them.
std::string calls_text(const Inspection& inspection);
nlohmann::ordered_json calls_json(const Inspection& inspection);

}  // namespace s7200::tools
