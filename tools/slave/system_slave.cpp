#include "tools/slave/system_slave.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/rig/first_scans.hpp"

namespace s7200::tools {

std::string place_text(const std::string& path, const SystemPlan& plan, const Spot& spot) {
  const std::string port = spot.port == 0 ? "" : fmt::format(", port {}", spot.port);
  return fmt::format("{}: line {}, beside {}{}", path, plan.lines[spot.line].name, plan.plcs[spot.plc].name, port);
}

/// Whether a PLC besides that at the spot answers on its line, also while that one is in STOP.
static bool another_answers(const SystemPlan& plan, const Spot& spot) {
  return std::ranges::any_of(plan.lines[spot.line].stations, [&](const StationPlan& station) {
    if (station.kind == StationPlan::Kind::Plc) return station.number != spot.plc;
    return station.kind == StationPlan::Kind::Peer && plan.peers[station.number].automaton != nullptr;
  });
}

SystemSlave::SystemSlave(const SystemPlan& plan, const Spot& spot, const serial::MasterSettings& master, Time after,
                         const std::string& path, StopToken stop) {
  std::vector<std::string> problems;
  rig_ = Rig::assemble(plan, {.path = path, .spots = {spot}, .stop = stop}, problems);
  if (!rig_) throw SlaveUnreachable(problems.empty() ? "interrupted" : problems.front());
  rig_->power_up();
  slave_.emplace(rig_->simulation(), on_line(master, plan.lines[spot.line]), place_text(path, plan, spot),
                 another_answers(plan, spot));
  std::string why;
  if (after == kNever) run_first_scans(*rig_, kReadyWithin);
  if (slave_->wait_until_ready(after, why) || stop_requested()) return;
  throw SlaveUnreachable(fmt::format("{}: {}", slave_->name(), why.empty() ? "the CPU went to STOP" : why));
}

}  // namespace s7200::tools
