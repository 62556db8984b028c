// The peers of a system file: masters and PLCs of other makes.
#pragma once

#include "tools/plan/reading/system_reading.hpp"

namespace s7200::tools {

/// Adds those below `peers` to the plan, whose PLCs are there.
void read_peers(const YamlNode& root, SystemReading& reading);

}  // namespace s7200::tools
