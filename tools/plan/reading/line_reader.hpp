// The bridges and the lines of a system file, and who is on which line.
#pragma once

#include "tools/plan/reading/system_reading.hpp"

namespace s7200::tools {

/// Adds those below `bridges` and `lines` to the plan, whose PLCs and peers are there.
void read_bridges(const YamlNode& root, SystemReading& reading);
void read_lines(const YamlNode& root, SystemReading& reading);

/// Reads `baud`, `parity`, `data_bits` and `stop_bits`: of a line of a system file, and of the line of a scenario.
void read_line_settings(const YamlNode& map, serial::LineSettings& line, YamlValues& values);

}  // namespace s7200::tools
