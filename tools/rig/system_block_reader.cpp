#include "tools/rig/system_block_reader.hpp"

namespace s7200::tools {
namespace {

template <class Ports>
void read_ports(const YamlNode& map, std::string_view key, const CpuModel& model, Ports& ports, YamlValues& values,
                std::optional<Ports> (*parse)(std::string_view, const CpuModel&, std::string&)) {
  const auto written = values.optional_text(map, key);
  if (!written) return;
  std::string why;
  if (const auto read = parse(*written, model, why))
    ports = *read;
  else
    values.wrong(*map.find(key), why);
}

}  // namespace

void read_system_block(const YamlNode& map, const CpuModel& model, SystemBlock& block, YamlValues& values) {
  read_ports(map, "ppi_baud", model, block.ppi_rates, values, parse_ppi_rates);
  read_ports(map, "ppi_station", model, block.ppi_stations, values, parse_ppi_stations);
}

}  // namespace s7200::tools
