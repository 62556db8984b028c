#include "tools/plan/system_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "interpreter/analysis/warnings/lint.hpp"
#include "interpreter/base/text/joined.hpp"

namespace s7200::tools {
namespace {

/// The PPI station of a port: that of its program's SPA, or of its system block, if the latter was set or the program leaves
/// the port as it is.
std::optional<std::uint8_t> ppi_station_of(const Program& program, std::uint8_t port) {
  if (const auto set = ppi_station_set(program, port)) return set;
  const std::uint8_t station = program.system_block.ppi_stations[port];
  if (station != SystemBlock{}.ppi_stations[port] || keeps_ppi_station(program, port)) return station;
  return {};
}

/// Ports of PLCs, as the file writes them: `a, b.1`.
using PlcPorts = std::vector<StationPlan>;

std::string names_of(const SystemReading& reading, const PlcPorts& ports) {
  return stl::joined(ports, [&](const StationPlan& each) {
    const std::string& name = reading.file.plan.plcs[each.number].name;
    return each.port == 0 ? name : fmt::format("{}.{}", name, each.port);
  });
}

void warn_of_station(SystemReading& reading, std::string_view kind, std::string_view key, int station, const LinePlan& line,
                     const PlcPorts& ports) {
  if (ports.size() < 2) return;
  reading.file.file.diagnostics.push_back(
      {.severity = stl::Severity::Warning,
       .position = reading.names.plc_keys[ports[1].number]->position,
       .message = fmt::format("{} station {} on line '{}' is {}: they answer at the same time, and the answers collide",
                              kind, station, line.name, names_of(reading, ports)),
       .hint = fmt::format("give each a '{}' of its own", key)});
}

void warn_of_ppi_stations_that_are_the_same(SystemReading& reading) {
  for (const LinePlan& line : reading.file.plan.lines) {
    std::map<std::uint8_t, PlcPorts> by_station;
    for (const StationPlan& each : line.stations) {
      if (each.kind != StationPlan::Kind::Plc) continue;
      const Program& program = *reading.file.plan.plcs[each.number].program;
      if (const auto station = ppi_station_of(program, each.port)) by_station[*station].push_back(each);
    }
    for (const auto& [station, ports] : by_station) warn_of_station(reading, "PPI", "ppi_station", station, line, ports);
  }
}

/// Warns of several masters on a line: PPI masters do not pass a token on, so each goes on as if it were alone.
void warn_of_several_ppi_masters(SystemReading& reading) {
  for (const LinePlan& line : reading.file.plan.lines) {
    PlcPorts masters;
    for (const StationPlan& each : line.stations)
      if (each.kind == StationPlan::Kind::Plc && is_ppi_master(*reading.file.plan.plcs[each.number].program, each.port))
        masters.push_back(each);
    if (masters.size() < 2) continue;
    reading.file.file.diagnostics.push_back(
        {.severity = stl::Severity::Warning,
         .position = reading.names.plc_keys[masters[1].number]->position,
         .message =
             fmt::format("line '{}' has several PPI masters, with NETR or NETW: {}; how they pass the token on is not "
                         "modelled, so they collide",
                         line.name, names_of(reading, masters)),
         .hint = "let one of them ask, and the others answer"});
  }
}

/// Programs whose Modbus station is known: the constant that our slaves and Application Tip 41 move into VB4095. They
/// answer at one of their ports.
void warn_of_modbus_stations_that_are_the_same(SystemReading& reading) {
  for (const LinePlan& line : reading.file.plan.lines) {
    std::map<std::uint8_t, PlcPorts> by_station;
    for (const StationPlan& each : line.stations) {
      if (each.kind != StationPlan::Kind::Plc) continue;
      const auto station = reading.names.modbus_stations[each.number];
      if (!station) continue;
      PlcPorts& ports = by_station[*station];
      if (std::ranges::find(ports, each.number, &StationPlan::number) == ports.end())
        ports.push_back({StationPlan::Kind::Plc, each.number});
    }
    for (const auto& [station, ports] : by_station) warn_of_station(reading, "Modbus", "station", station, line, ports);
  }
}

/// Power that is switched on twice, or off, does nothing the second time.
void warn_of_power_that_stays_as_it_is(SystemReading& reading, const std::vector<TimedEvent>& events) {
  std::map<std::pair<StationPlan::Kind, std::size_t>, bool> powered;
  for (const auto& [event, node] : events) {
    using What = EventPlan::What;
    if (event.what != What::PowerOff && event.what != What::PowerOn) continue;
    const bool on = event.what == What::PowerOn;
    const bool is_plc = event.station.kind == StationPlan::Kind::Plc;
    const bool from_start = !is_plc || reading.file.plan.plcs[event.station.number].settings.starts == 0;
    bool& now = powered.try_emplace({event.station.kind, event.station.number}, from_start).first->second;
    if (now == on)
      reading.file.file.diagnostics.push_back(
          {.severity = stl::Severity::Warning,
           .position = node->position,
           .message = fmt::format("'{}' has {} already: this does nothing", name_of(reading.file.plan, event.station),
                                  on ? "power" : "no power"),
           .hint = on ? "power_off it before that" : "power_on it before that"});
    now = on;
  }
}

/// Warns of cables and faults that stay as they are.
void warn_of_lines_that_stay_as_they_are(SystemReading& reading, const std::vector<TimedEvent>& events) {
  struct Now {
    std::optional<std::size_t> near{};  // of the cut
    bool faults = false;
  };
  std::vector<Now> lines;
  for (const LinePlan& line : reading.file.plan.lines) lines.push_back({.faults = !line.faults.empty()});
  for (const auto& [event, node] : events) {
    using What = EventPlan::What;
    constexpr std::array kOfLines{What::Cut, What::Mend, What::Fault, What::ClearFaults};
    if (std::ranges::find(kOfLines, event.what) == kOfLines.end()) continue;
    const std::string name = reading.file.plan.lines[event.line].name;
    const auto warn = [&, at = node](std::string_view why) {
      reading.file.file.diagnostics.push_back({.severity = stl::Severity::Warning,
                                               .position = at->position,
                                               .message = fmt::format("line '{}' {}: this does nothing", name, why)});
    };
    Now& now = lines[event.line];
    if (event.what == What::Cut && now.near == event.near) warn("is cut there already");
    if (event.what == What::Mend && !now.near) warn("is not cut");
    if (event.what == What::ClearFaults && !now.faults) warn("has no fault");
    if (event.what == What::Cut) now.near = event.near;
    if (event.what == What::Mend) now.near.reset();
    if (event.what == What::Fault || event.what == What::ClearFaults) now.faults = event.what == What::Fault;
  }
}

}  // namespace

/// Complains about stations that are on no line; for a PLC one port on a line is enough.
void check_system(SystemReading& reading) {
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

void warn_of_system(SystemReading& reading, const std::vector<TimedEvent>& events) {
  warn_of_ppi_stations_that_are_the_same(reading);
  warn_of_several_ppi_masters(reading);
  warn_of_modbus_stations_that_are_the_same(reading);
  warn_of_power_that_stays_as_it_is(reading, events);
  warn_of_lines_that_stay_as_they_are(reading, events);
}

}  // namespace s7200::tools
