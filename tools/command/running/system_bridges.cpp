#include "tools/command/running/system_bridges.hpp"

#include <fmt/format.h>

#include "serial_sim/westinghouse/modbus_plc.hpp"
#include "tools/command/options/plc/bridge_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/views/state/port_mode.hpp"

namespace s7200::tools {
namespace {

class SystemMachine final : public LiveMachine {
 public:
  explicit SystemMachine(serial::System& system) : system_(system) {}
  Time time() const override { return system_.time(); }
  serial::Halt run_until(Time end) override { return system_.run_until(end); }

 private:
  serial::System& system_;
};

/// Why nobody on that line answers Modbus, as the programs stand now; empty if somebody may.
std::string why_no_modbus(const Rig& rig, std::size_t line) {
  const SystemPlan& plan = rig.plan();
  std::string why = "no PLC on this line speaks it";
  std::size_t bridges = 0;
  for (const StationPlan& station : plan.lines[line].stations) {
    switch (station.kind) {
      case StationPlan::Kind::Plc: {
        const std::string of_station = why_no_freeport(rig.plc(station.number).cpu(), station.port);
        if (of_station.empty()) return {};
        why = fmt::format("on {} {}", plan.plcs[station.number].name, of_station);
        break;
      }
      case StationPlan::Kind::Peer:
        if (dynamic_cast<const westinghouse::ModbusPlc*>(plan.peers[station.number].automaton.get())) return {};
        break;
      case StationPlan::Kind::Bridge:
        if (++bridges > 1) return {};  // there may be slaves behind the other one
    }
  }
  return why;
}

/// Where the bridges of the plan stand.
std::vector<LiveEnd> ends_of(Rig& rig, Bridges bridges) {
  std::vector<LiveEnd> ends;
  for (std::size_t line = 0; line < rig.plan().lines.size(); ++line) {
    const LinePlan& plan = rig.plan().lines[line];
    const StationPlan* const first = first_plc(plan);
    for (const StationPlan& station : plan.stations)
      if (station.kind == StationPlan::Kind::Bridge)
        ends.push_back({.bridge = bridges[station.number],
                        .port = &rig.host_port(station.number),
                        .line = &rig.line(line),
                        .plc = first ? &rig.plc(first->number) : nullptr,
                        .plc_port = first ? first->port : std::uint8_t{0},
                        .without_program = format_without_s7200(rig.plan(), plan),
                        .settings = plan.settings,
                        .why_no_modbus = [&rig, line] { return why_no_modbus(rig, line); }});
  }
  return ends;
}

/// Where a bridge has joined.
LiveEnd end_of(Rig& rig, Bridge* joined, const serial::LineSettings& settings) {
  serial::Simulation& simulation = rig.simulation();
  std::size_t line = 0;
  while (&rig.line(line) != &simulation.line()) ++line;
  return {.bridge = joined,
          .port = &simulation.host_port(),
          .line = &simulation.line(),
          .plc = &simulation.plc(),
          .plc_port = simulation.port(),
          .settings = settings,
          .why_no_modbus = [&rig, line] { return why_no_modbus(rig, line); }};
}

}  // namespace

std::vector<Bridge*> those_of(const SystemBridges& bridges) {
  std::vector<Bridge*> those;
  for (const auto& bridge : bridges) those.push_back(bridge.get());
  return those;
}

std::optional<SystemBridges> make_bridges(const SystemPlan& plan) {
  SystemBridges bridges(plan.bridges.size());
  for (const LinePlan& line : plan.lines)
    for (const StationPlan& station : line.stations) {
      if (station.kind != StationPlan::Kind::Bridge) continue;
      const BridgePlan& bridge = plan.bridges[station.number];
      auto made = make_bridge(bridge.kind, bridge.where, line.settings, kBridgeTimeout);
      if (!made) return print_error(fmt::format("bridge {} at {}: {}", bridge.name, bridge.where, made.why())), std::nullopt;
      bridges[station.number] = *std::move(made);
    }
  return bridges;
}

std::unique_ptr<LiveRun> live_run_of(Rig& rig, Bridges bridges, Bridge* joined, const LiveRunOptions& options) {
  if (is_of_one_program(rig.plan())) return std::make_unique<LiveRun>(rig.simulation(), options, joined);
  std::vector<LiveEnd> ends = ends_of(rig, bridges);
  if (joined) ends.push_back(end_of(rig, joined, options.line));
  return std::make_unique<LiveRun>(std::make_unique<SystemMachine>(rig.system()), ends, options);
}

}  // namespace s7200::tools
