// Races between the main program and interrupt routines (interpreter/analysis/races.hpp), each with an instant at which the
// word is lost, if one was found.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// All of them, or those of memory or routines of the selection.
std::string races_text(const Inspection& inspection);
nlohmann::ordered_json races_json(const Inspection& inspection);

}  // namespace s7200::tools
