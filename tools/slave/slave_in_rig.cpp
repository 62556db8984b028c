#include "tools/slave/slave_in_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tools/rig/files/recorded_rig.hpp"
#include "tools/rig/first_scans.hpp"
#include "tools/slave/line_of_other_plcs.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {
namespace {

/// Whether a PLC besides that at the spot answers on its line, also while that one is in STOP.
bool another_answers(const SystemPlan& plan, const Spot& spot) {
  return std::ranges::any_of(plan.lines[spot.line].stations, [&](const StationPlan& station) {
    if (station.kind == StationPlan::Kind::Plc) return station.number != spot.plc;
    return station.kind == StationPlan::Kind::Peer && plan.peers[station.number].automaton != nullptr;
  });
}

std::unique_ptr<Rig> powered_up(const SystemPlan& plan, const RigSurroundings& surroundings) {
  std::vector<std::string> problems;
  auto rig = RecordedRig::assemble(plan, surroundings, problems);
  if (!rig) throw SlaveUnreachable(problems.empty() ? "interrupted" : problems.front());
  rig->power_up();
  return rig;
}

/// `plant.yaml: line bus`; of a line without a name, which is alone, `path`.
std::string line_text(const std::string& path, const LinePlan& line) {
  return line.name.empty() ? path : fmt::format("{}: line {}", path, line.name);
}

}  // namespace

std::string place_text(const std::string& path, const SystemPlan& plan, const Spot& spot) {
  const std::string port = spot.port == 0 ? "" : fmt::format(", port {}", spot.port);
  return fmt::format("{}: line {}, beside {}{}", path, plan.lines[spot.line].name, plan.plcs[spot.plc].name, port);
}

std::unique_ptr<SlaveInRig> join_spot(const SystemPlan& plan, const Spot& spot, const serial::MasterSettings& master,
                                      Time after, const std::string& path, StopToken stop) {
  auto rig = powered_up(plan, {.path = path, .seen = {.spots = {spot}}, .stop = stop});
  auto slave = std::make_unique<SimulatedSlave>(rig->simulation(), on_line(master, plan.lines[spot.line]),
                                                place_text(path, plan, spot), another_answers(plan, spot));
  if (after == kNever) run_first_scans(*rig, kReadyWithin);
  const auto ready = slave->wait_until_ready(after);
  if (!ready && !slave->stop_requested())
    throw SlaveUnreachable(fmt::format("{}: {}", slave->name(), ready.why().empty() ? "the CPU went to STOP" : ready.why()));
  SlaveInRig::Masters masters;
  masters[spot.line] = std::move(slave);
  return std::make_unique<SlaveInRig>(std::move(rig), std::move(masters), spot.line);
}

std::unique_ptr<SlaveInRig> join_lines(const SystemPlan& plan, std::size_t first, const serial::MasterSettings& master,
                                       Time after, const std::string& path, StopToken stop) {
  RigSurroundings surroundings{.path = path, .stop = stop};
  for (std::size_t line = 0; line < plan.lines.size(); ++line)
    if (why_no_other_plc(plan, line).empty()) surroundings.seen.lines.push_back(line);
  auto rig = powered_up(plan, surroundings);
  SlaveInRig::Masters masters;
  for (const std::size_t line : surroundings.seen.lines)
    masters[line] = std::make_unique<LineOfOtherPlcs>(*rig, line, master, line_text(path, plan.lines[line]));
  auto slave = std::make_unique<SlaveInRig>(std::move(rig), std::move(masters), first);
  slave->wait(after == kNever ? slave->pause() : after);
  return slave;
}

}  // namespace s7200::tools
