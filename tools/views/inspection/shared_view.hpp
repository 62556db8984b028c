// Memory that the main program and interrupt routines share: what `s7200 inspect PROGRAM shared` shows.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// All of it, or that of memory or routines of the selection.
std::string shared_text(const Inspection& inspection);
nlohmann::ordered_json shared_json(const Inspection& inspection);

}  // namespace s7200::tools
