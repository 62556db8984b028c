// The PLCs of a system file.
#pragma once

#include "tools/plan/reading/system_reading.hpp"

namespace s7200::tools {

/// Adds the PLCs below `plcs` to the plan.
void read_plcs(const YamlNode& root, SystemReading& reading);

}  // namespace s7200::tools
