#include "tools/command/run_output.hpp"

#include <fmt/format.h>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/text.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/rig_output.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {

void print_text(const Rig& rig, const Ending& ending, const RunOptions& options) {
  const serial::Simulation& simulation = rig.simulation();
  const State& state = simulation.cpu().state();
  fmt::print("{} after {}: {}, {} instructions, CPU in {}\n", ending_text(ending.reason), format_duration(state.time, 6),
             counted(state.scans, "scan"), state.instructions, state.mode == Mode::Run ? "RUN" : "STOP");
  if (state.scans)
    fmt::print("scan time: shortest {}, longest {}\n", format_duration(state.shortest_scan),
               format_duration(state.longest_scan));
  if (options.bridge.bridge()) fmt::print("{}\n", stl::printable(options.bridge.bridge()->summary()));
  if (ending.pace)
    fmt::print("real time{}: drift {}, worst lag {}\n",
               ending.pace->speed == 1 ? "" : fmt::format(" times {:g}", ending.pace->speed),
               format_duration(ending.pace->drift), format_duration(ending.pace->worst_lag));
  fmt::print("{}{}", errors_text(rig), dump_text(rig));
}

void print_json(const Rig& rig, const Ending& ending, const RunOptions& options) {
  const State& state = rig.cpu().state();
  auto results = results_of("run");
  results["stop_reason"] = ending.reason;
  results["time_ns"] = state.time;
  results.update(scans_json(state));
  results["instructions"] = state.instructions;
  results.update(rig_json(rig));
  if (ending.pace)
    results["realtime"] = {
        {"speed", ending.pace->speed}, {"drift_ns", ending.pace->drift}, {"worst_lag_ns", ending.pace->worst_lag}};
  if (options.bridge.bridge()) results["bridge"] = options.bridge.bridge()->json();
  fmt::print("{}", lines_of(results));
}

}  // namespace s7200::tools
