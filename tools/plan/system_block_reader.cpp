#include "tools/plan/system_block_reader.hpp"

#include <fmt/format.h>

#include "interpreter/base/ppi_frame.hpp"

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

std::string_view ppi_baud_meaning() {
  static const std::string kMeaning = fmt::format(
      "rate of ports in PPI mode, as the system block sets it: {}; `\"9600,187500\"` is port 0 and port 1; {} if left out",
      ppi_rates_text(), s7200::to_text(SystemBlock{}.ppi_rates));
  return kMeaning;
}

std::string_view ppi_station_meaning() {
  static const std::string kMeaning = fmt::format(
      "PPI station of ports until the program's SPA sets another, as the system block sets it, 1 to {}; `\"3,4\"` is port 0 "
      "and port 1; {} if left out",
      ppi::kLastStation, s7200::to_text(SystemBlock{}.ppi_stations));
  return kMeaning;
}

std::string_view ppi_second_meaning() {
  static const std::string kMeaning = fmt::format(
      "what becomes of a PPI master's request before it has fetched the answer to the last one: `{}`, it takes its place, "
      "or "
      "`{}`, there is no resource; `{}` if left out",
      kSecondRequestWords[0], kSecondRequestWords[1], s7200::to_text(SystemBlock{}.second_request));
  return kMeaning;
}

std::string_view retain_meaning() {
  return "memory that survives power off, as the system block sets it: up to six ranges of V, M, T0–T31, T64–T95 and C, as "
         "`VB0:100,MB0:14,T0:32,C0:5`, or `none`; if left out those that the CPU is delivered with";
}

void read_system_block(const YamlNode& map, const CpuModel& model, SystemBlock& block, YamlValues& values) {
  read_ports(map, "ppi_baud", model, block.ppi_rates, values, parse_ppi_rates);
  read_ports(map, "ppi_station", model, block.ppi_stations, values, parse_ppi_stations);
  std::string why;
  if (const auto second = values.optional_text(map, "ppi_second")) {
    if (const auto read = parse_second_request(*second, why))
      block.second_request = *read;
    else
      values.wrong(*map.find("ppi_second"), why);
  }
  const auto retain = values.optional_text(map, "retain");
  if (!retain) return;
  block.retentive = parse_retentive(*retain, model, why);
  if (!block.retentive) values.wrong(*map.find("retain"), why);
}

}  // namespace s7200::tools
