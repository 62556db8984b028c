// `s7200 inspect PROGRAM steps`: the steps of the sequence, what activates each, where it leads and what it does.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

std::string steps_text(const Inspection& inspection);
nlohmann::ordered_json steps_json(const Inspection& inspection);

}  // namespace s7200::tools
