// The head of a scenario: what it runs on, and what holds for all its steps.
#pragma once

#include <string>

#include "tools/scenario/reading/value_reader.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

/// Reads it from the map of a scenario, or of a whole file, over what `scenario` has already. `path` is the file, `given`
/// the parameters that were given from outside, if any. Returns false if the scenario is not applicable: then its steps may
/// need values that are not there.
bool read_head(ValueReader& values, const std::string& path, const GivenParameters* given, const YamlNode& map,
               Scenario& scenario);

}  // namespace s7200::tools
