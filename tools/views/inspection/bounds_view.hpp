// Upper bounds of times (interpreter/analysis/bounds.hpp), beside the largest seen in a run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// All routines and events, or the routines of the selection.
std::string bounds_text(const Inspection& inspection);
nlohmann::ordered_json bounds_json(const Inspection& inspection);

}  // namespace s7200::tools
