// What a program uses of each memory area (interpreter/analysis/memory_map.hpp), as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// All areas, or those that the selection names.
std::string map_text(const Inspection& inspection);
nlohmann::ordered_json map_json(const Inspection& inspection);

}  // namespace s7200::tools
