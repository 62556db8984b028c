// How the system block of a PLC sets its ports, as YAML: keys of system files and of scenarios.
#pragma once

#include "interpreter/program/system_block.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// `ppi_baud` and `ppi_station`: what is there goes into `block`. Complains about what the CPU does not have.
void read_system_block(const YamlNode& map, const CpuModel& model, SystemBlock& block, YamlValues& values);

}  // namespace s7200::tools
