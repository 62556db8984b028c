#include "tools/rig/system_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "interpreter/program/lint.hpp"
#include "interpreter/program/load.hpp"
#include "tools/rig/event_reader.hpp"
#include "tools/rig/line_reader.hpp"
#include "tools/rig/peer_reader.hpp"
#include "tools/rig/plc_reader.hpp"
#include "tools/rig/system_reading.hpp"

namespace s7200::tools {
namespace {

/// Of a PLC one port is enough.
void check_all_are_on_lines(SystemReading& reading) {
  const SystemPlan& plan = reading.file.plan;
  const SystemNames& names = reading.names;
  const auto check = [&](const YamlNode& key, const std::string& name, bool on_a_line) {
    if (!on_a_line) reading.values.wrong(key, fmt::format("'{}' is on no line", name), "name it in the 'stations' of one");
  };
  for (std::size_t plc = 0; plc < plan.plcs.size(); ++plc)
    check(*names.plc_keys[plc], plan.plcs[plc].name,
          on_a_line({StationPlan::Kind::Plc, plc, 0}, plan) || on_a_line({StationPlan::Kind::Plc, plc, 1}, plan));
  for (const auto& [name, station] : names.others) check(*station.key, name, on_a_line(station.plan, plan));
}

/// Whether a port may be asked at the PPI station of its system block: someone has set that, or the program leaves the port
/// as it is.
bool may_answer_ppi(const Program& program, std::uint8_t port) {
  const auto station = [port](const SystemBlock& block) { return block.ppi_stations[port]; };
  return station(program.system_block) != station({}) || keeps_ppi_station(program, port);
}

/// It is a mistake that a real network lets one make, so the system runs.
void warn_of_stations_that_are_the_same(SystemReading& reading) {
  for (const LinePlan& line : reading.file.plan.lines) {
    std::map<std::uint8_t, std::vector<const StationPlan*>> by_station;
    for (const StationPlan& each : line.stations) {
      if (each.kind != StationPlan::Kind::Plc) continue;
      const Program& program = *reading.file.plan.plcs[each.number].program;
      if (may_answer_ppi(program, each.port)) by_station[program.system_block.ppi_stations[each.port]].push_back(&each);
    }
    for (const auto& [station, plcs] : by_station) {
      if (plcs.size() < 2) continue;
      std::string names;
      for (const StationPlan* plc : plcs) names.append(names.empty() ? "" : ", ").append(name_of(reading.file.plan, *plc));
      reading.file.file.diagnostics.push_back(
          {.severity = stl::Severity::Warning,
           .position = reading.names.plc_keys[plcs[1]->number]->position,
           .message = fmt::format("PPI station {} on line '{}' is {}: they answer at the same time, and the answers collide",
                                  station, line.name, names),
           .hint = "give each a 'ppi_station' of its own"});
    }
  }
}

void read_file(const YamlNode& root, SystemReading& reading) {
  YamlValues& values = reading.values;
  SystemPlan& plan = reading.file.plan;
  if (!root.is_map())
    return values.wrong(root, "a system file is a map, not " + to_text(root), "begin with 'plcs:' and 'lines:'");
  for (const char* const key : {"scenarios", "steps"})
    if (const YamlNode* const of_scenario = root.find(key); of_scenario && !root.find("lines"))
      return values.wrong(*of_scenario, fmt::format("'{}' is of a scenario, and this is to be a system file", key),
                          "'s7200 test' runs it; a scenario names its system with 'system:'");
  check_keys(root, {SystemKey::Where::File}, values);
  read_plcs(root, reading);
  read_peers(root, reading);
  read_bridges(root, reading);
  read_lines(root, reading);
  if (plan.lines.empty() && values.complaints.count() == 0)
    values.wrong(root, "no line: no one would hear another", "write for example lines: {bus: {stations: [master, slave]}}");
  if (values.complaints.count() == 0)
    for (const YamlNode* node : items_of(root, "events", "{at: 1s, power_off: slave}", values))
      if (auto event = read_timed_event(*node, plan, values)) plan.events.push_back(std::move(*event));
  std::ranges::stable_sort(plan.events, {}, &EventPlan::at);
  if (values.complaints.count() == 0) check_all_are_on_lines(reading);
  if (values.complaints.count() == 0) warn_of_stations_that_are_the_same(reading);
}

}  // namespace

bool is_system_file(std::string_view path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

SystemFile read_system(const std::string& text, const std::string& path) {
  SystemFile file;
  file.file.source = source_of(text, path);
  stl::Diagnostics& diagnostics = file.file.diagnostics;
  const auto root = read_yaml(text, *file.file.source, diagnostics, {"a system file", "'plcs:' and 'lines:'"});
  YamlValues values(diagnostics);
  SystemReading reading{file, path, values};
  if (root) read_file(*root, reading);
  stl::sort(diagnostics);
  return file;
}

}  // namespace s7200::tools
