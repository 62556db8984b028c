// How the system block of a PLC sets its ports and its retentive memory, as YAML: keys of system files and of scenarios.
#pragma once

#include "interpreter/program/system_block.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// The meaning of the keys, for the tables of keys.
std::string_view ppi_baud_meaning();
std::string_view ppi_station_meaning();
std::string_view ppi_second_meaning();
std::string_view retain_meaning();

/// Reads `ppi_baud`, `ppi_station`, `ppi_second` and `retain` into `block`. Complains about keys for what the CPU does not
/// have.
void read_system_block(const YamlNode& map, const CpuModel& model, SystemBlock& block, YamlValues& values);

}  // namespace s7200::tools
