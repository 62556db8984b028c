#include "tools/rig/run.hpp"

#include <algorithm>

#include "tools/rig/rig.hpp"

namespace s7200::tools {

namespace {

constexpr std::string_view kEndedByProgress = "record limit";

}  // namespace

std::string_view run(serial::Simulation& simulation, const RunLimits& limits, const RunProgress& progress) {
  const State& state = simulation.cpu().state();
  const bool until_scans = limits.scans != 0 && limits.end == kNever;
  const auto end = [&] { return until_scans ? state.scan_begin + kEndlessScan : limits.end; };
  simulation.cpu().pause_at_scan_end(limits.scans != 0);
  while (simulation.time() < end()) {
    if (simulation.stop_requested()) return "interrupted";
    const serial::Halt halt = simulation.run_until(std::min(end(), simulation.time() + limits.slice));
    if (state.mode == Mode::Stop) return state.fatal_code ? "fatal" : "stop";
    if (limits.strict && state.error_count != 0) return "run-time error";
    if (limits.scans != 0 && state.scans >= limits.scans) return "scans";
    if (halt == serial::Halt::Time && !progress()) return kEndedByProgress;
  }
  return until_scans ? "endless scan" : "time";
}

std::string_view run(Rig& rig, const RunLimits& limits, const RunProgress& progress) {
  if (is_of_one_program(rig.plan())) return run(rig.simulation(), limits, progress);
  constexpr Time kSlice = kSecond;
  while (rig.system().time() < limits.end) {
    if (rig.system().stop_requested()) return "interrupted";
    rig.system().run_until(std::min(limits.end, rig.system().time() + kSlice));
    if (!progress()) return kEndedByProgress;
  }
  return "time";
}

}  // namespace s7200::tools
