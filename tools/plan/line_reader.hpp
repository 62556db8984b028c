// The bridges and the lines of a system file, and who is on which line.
#pragma once

#include "tools/plan/system_reading.hpp"

namespace s7200::tools {

/// Adds those below `bridges` and `lines` to the plan, whose PLCs and peers are there.
void read_bridges(const YamlNode& root, SystemReading& reading);
void read_lines(const YamlNode& root, SystemReading& reading);

}  // namespace s7200::tools
