#include "tools/session/past/line_stations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/rig/rig.hpp"

namespace s7200::tools {
namespace {

int driver_of(const Rig& rig, std::size_t line, const StationPlan& station, const std::string& name) {
  if (station.kind == StationPlan::Kind::Plc) return rig.plc(station.number).driver(station.port);
  int driver = 0;
  while (driver < serial::Line::kDrivers && rig.station_at(line, driver) != name) ++driver;
  return driver;
}

LineStation::Kind kind_of(const Rig& rig, const StationPlan& station) {
  if (station.kind == StationPlan::Kind::Plc) return LineStation::Kind::Plc;
  if (station.kind == StationPlan::Kind::Bridge) return LineStation::Kind::Bridge;
  return rig.poller(station.number) ? LineStation::Kind::Poller : LineStation::Kind::Responder;
}

}  // namespace

std::vector<LineStation> line_stations(Rig& rig) {
  std::vector<LineStation> all;
  const std::vector<LinePlan>& lines = rig.plan().lines;
  for (std::size_t line = 0; line < lines.size(); ++line)
    for (const StationPlan& station : lines[line].stations) {
      const std::string& name = name_of(rig.plan(), station);
      all.push_back({.kind = kind_of(rig, station),
                     .name = name,
                     .number = station.number,
                     .port = station.port,
                     .line = &rig.line(line),
                     .line_name = lines[line].name,
                     .driver = driver_of(rig, line, station, name)});
    }
  return all;
}

std::string_view kind_text(LineStation::Kind kind) {
  switch (kind) {
    case LineStation::Kind::Plc:
      return "a PLC";
    case LineStation::Kind::Poller:
      return "a master that polls";
    case LineStation::Kind::Responder:
      return "a peer that answers";
    case LineStation::Kind::Bridge:
      return "a bridge";
  }
  return {};
}

const LineStation* find_station(const std::vector<LineStation>& stations, const serial::SharedLine& line,
                                std::string_view name) {
  const auto is_it = [&](const LineStation& one) {
    return one.line == &line && (one.name == name || fmt::format("{}.{}", one.name, one.port) == name);
  };
  const auto found = std::ranges::find_if(stations, is_it);
  return found == stations.end() ? nullptr : &*found;
}

std::string names_on(const std::vector<LineStation>& stations, const serial::SharedLine& line) {
  std::string names;
  for (const LineStation& one : stations)
    if (one.line == &line && !one.name.empty()) names.append(names.empty() ? "" : ", ").append(one.name);
  return names;
}

}  // namespace s7200::tools
