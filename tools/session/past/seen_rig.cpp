#include "tools/session/past/seen_rig.hpp"

#include <algorithm>

#include "tools/rig/event_words.hpp"

namespace s7200::tools {
namespace {

/// Each PLC looks at one line. A line where a master asks comes before the one that its PLC is on first.
std::vector<Spot> spots_of(const SystemPlan& plan, const std::vector<Spot>& asked) {
  std::vector<Spot> spots = spots_of_plcs(plan);
  std::vector<bool> taken(spots.size());
  const auto take = [&](const Spot& spot) {
    if (taken[spot.plc]) return false;
    spots[spot.plc] = spot;
    taken[spot.plc] = true;
    return true;
  };
  for (const Spot& spot : asked) {
    const auto is_seen = [&](const Spot& one) { return taken[one.plc] && one.line == spot.line; };
    if (std::ranges::any_of(spots, is_seen) || take(spot)) continue;
    for (const StationPlan& station : plan.lines[spot.line].stations)
      if (station.kind == StationPlan::Kind::Plc && take({spot.line, station.number, station.port})) break;
  }
  return spots;
}

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

SeenRig::SeenRig(Rig& rig, const std::vector<Spot>& asked) : spots_(spots_of(rig.plan(), asked)) {
  for (const Spot& spot : spots_)
    simulations_.push_back(std::make_unique<serial::Simulation>(rig.system(), rig.line(spot.line), rig.plc(spot.plc),
                                                                spot.port, rig.requester(spot.line), nullptr));
}

std::vector<serial::Simulation*> SeenRig::stations() const {
  std::vector<serial::Simulation*> stations;
  for (const auto& simulation : simulations_) stations.push_back(simulation.get());
  return stations;
}

std::optional<std::size_t> SeenRig::station_on(std::size_t line) const {
  const auto spot = std::ranges::find(spots_, line, &Spot::line);
  return spot == spots_.end() ? std::nullopt : std::optional(spot->plc);
}

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

std::vector<serial::HostPort*> hosts_of(Rig& rig) {
  std::vector<serial::HostPort*> hosts;
  if (rig.has_simulation() && rig.simulation().has_host_port()) hosts.push_back(&rig.simulation().host_port());
  for (std::size_t bridge = 0; bridge < rig.plan().bridges.size(); ++bridge) hosts.push_back(&rig.host_port(bridge));
  return hosts;
}

History::Settings history_settings(Rig& rig) {
  History::Settings settings;
  for (std::size_t peer = 0; peer < rig.plan().peers.size(); ++peer)
    if (const serial::Poller* const poller = rig.poller(peer))
      settings.pollers.push_back({rig.plan().peers[peer].name, poller});
  settings.line_stations = line_stations(rig);
  for (const PlcPlan& plc : rig.plan().plcs) settings.plcs.push_back({plc.name, plc.address});
  settings.planned = event_texts(rig.plan());
  settings.carry_out = [&rig](const EventPlan& event) { rig.carry_out(event); };
  return settings;
}

}  // namespace s7200::tools
