// The first look at a program: how large it is, what it is made of, what it is connected to, what stands out.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

std::string overview_text(const Inspection& inspection);
nlohmann::ordered_json overview_json(const Inspection& inspection);

}  // namespace s7200::tools
