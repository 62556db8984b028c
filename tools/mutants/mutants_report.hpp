// Which changes nobody has noticed, in words and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/mutants/hunt.hpp"

namespace s7200::tools {

std::string mutants_text(const MutantsOfProgram& mutants);
nlohmann::ordered_json mutants_json(const MutantsOfProgram& mutants);

}  // namespace s7200::tools
