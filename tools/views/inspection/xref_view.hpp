// The cross reference of a program (interpreter/analysis/cross_reference.hpp), as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// All of it, or what there is about the addresses and routines of the selection. An address that the program does not use
/// is named with its neighbours.
std::string xref_text(const Inspection& inspection);
nlohmann::ordered_json xref_json(const Inspection& inspection);

}  // namespace s7200::tools
