#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "interpreter/base/text.hpp"
#include "tools/bridge/live_run.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/bridge_options.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/options/rig_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/faults.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// A scan that goes on for so long in simulated time is taken for one that never ends; only WDR lets it come so far.
constexpr Time kEndlessScan = 10 * kSecond;

struct RunOptions {
  ProgramOptions program;
  Time duration = kNever;  // kNever: a second, or as many scans as asked for, or with a bridge without end
  std::uint64_t scans = 0;
  bool json = false;
  BridgeOptions bridge;
  RigOptions rig;

  Time end() const {
    if (duration != kNever || scans != 0 || bridge.bridge()) return duration;
    return kSecond;
  }
};

/// Runs in slices, so that Ctrl-C and progress come in between; what is computed does not depend on them.
class Runner {
 public:
  Runner(serial::Simulation& simulation, const RunOptions& options) : simulation_(simulation), options_(options) {}

  /// Why it ended: `time`, `scans`, `endless scan`, `stop`, `fatal`, `run-time error` or `interrupted`.
  std::string_view run() {
    simulation_.cpu().pause_at_scan_end(options_.scans != 0);
    const State& state = simulation_.cpu().state();
    while (simulation_.time() < end()) {
      if (interrupted()) return "interrupted";
      const serial::Halt halt = simulation_.run_until(std::min(end(), simulation_.time() + 10 * kSecond));
      if (state.mode == Mode::Stop) return state.fatal_code ? "fatal" : "stop";
      if (options_.rig.failed_strictly(simulation_.cpu())) return "run-time error";
      if (options_.scans != 0 && state.scans >= options_.scans) return "scans";
      if (halt == serial::Halt::Time) show_progress();
    }
    return until_scans() ? "endless scan" : "time";
  }

 private:
  using HostClock = std::chrono::steady_clock;

  /// Only the number of scans ends it.
  bool until_scans() const { return options_.scans != 0 && options_.duration == kNever; }
  Time end() const { return until_scans() ? simulation_.cpu().state().scan_begin + kEndlessScan : options_.end(); }

  void show_progress() {
    const Time host = std::chrono::duration_cast<std::chrono::nanoseconds>(HostClock::now() - begin_).count();
    if (host <= next_progress_ || !isatty(STDERR_FILENO)) return;
    next_progress_ = host + kSecond;
    const std::string goal = until_scans() ? fmt::format("{} scans", options_.scans) : format_duration(end());
    fmt::print(stderr, "\r{} of {} simulated", format_duration(simulation_.time()), goal);
    if (simulation_.time() >= end()) fmt::print(stderr, "\n");
  }

  serial::Simulation& simulation_;
  const RunOptions& options_;
  const HostClock::time_point begin_ = HostClock::now();
  Time next_progress_ = 2 * kSecond;
};

struct Ending {
  std::string_view reason;
  std::optional<Pace::Report> pace;  // of a run in real time
};

Ending run_to_end(serial::Simulation& simulation, const RunOptions& options) {
  if (!options.bridge.realtime()) return {Runner(simulation, options).run(), {}};
  const LiveRunOptions live{options.end(),
                            options.scans,
                            options.rig.strict(),
                            options.bridge.speed(),
                            options.bridge.line(),
                            {[](const std::string& text) { fmt::print(stderr, "{}\n", stl::printable(text)); }, print_note}};
  const LiveRunResult result = run_live(simulation, live, options.bridge.bridge());
  if (!result.failure.empty()) print_error(result.failure);
  return {result.reason, result.pace};
}

void print_text(const serial::Simulation& simulation, const Ending& ending, const RunOptions& options) {
  const State& state = simulation.cpu().state();
  fmt::print("ended by {} after {}: {} scans, {} instructions, CPU in {}\n", ending.reason, format_duration(state.time, 6),
             state.scans, state.instructions, state.mode == Mode::Run ? "RUN" : "STOP");
  if (state.scans)
    fmt::print("scan time: shortest {}, longest {}\n", format_duration(state.shortest_scan),
               format_duration(state.longest_scan));
  if (options.bridge.bridge()) fmt::print("{}\n", stl::printable(options.bridge.bridge()->summary()));
  if (ending.pace)
    fmt::print("real time{}: drift {}, worst lag {}\n",
               ending.pace->speed == 1 ? "" : fmt::format(" times {:g}", ending.pace->speed),
               format_duration(ending.pace->drift), format_duration(ending.pace->worst_lag));
  fmt::print("{}{}", errors_text(simulation.cpu()), options.rig.dump_text(simulation.cpu()));
}

void print_json(const serial::Simulation& simulation, const Ending& ending, const RunOptions& options) {
  const State& state = simulation.cpu().state();
  auto results = results_of("run");
  results["stop_reason"] = ending.reason;
  results["time_ns"] = state.time;
  results["scans"] = state.scans;
  results["instructions"] = state.instructions;
  results.update(options.rig.json(simulation));
  if (ending.pace)
    results["realtime"] = {
        {"speed", ending.pace->speed}, {"drift_ns", ending.pace->drift}, {"worst_lag_ns", ending.pace->worst_lag}};
  if (options.bridge.bridge()) results["bridge"] = options.bridge.bridge()->json();
  fmt::print("{}", lines_of(results));
}

int run_run(RunOptions& options) {
  int exit_code = kFine;
  const auto program = options.program.load(exit_code);
  if (!program) return exit_code;
  if (!options.bridge.prepare()) return kUnusable;
  const auto rig = options.rig.assemble(program, options.json, options.bridge.link());
  if (!rig) return kUnusable;
  serial::Simulation& simulation = rig->simulation();
  rig->power_up();
  simulation.cpu().pause_at_error(options.rig.strict());
  const Ending ending = run_to_end(simulation, options);
  if (ending.reason.empty()) return kUnusable;
  const bool all_written = finish(*rig);

  if (options.json)
    print_json(simulation, ending, options);
  else
    print_text(simulation, ending, options);
  print_notes(fault_notes(simulation.faults()));
  if (!all_written) return kUnusable;
  if (ending.reason == "endless scan") {
    print_error(
        fmt::format("scan {} has lasted {} and is not over: the program loops in it, and WDR keeps it going. "
                    "To run it all the same say how long: --for",
                    simulation.cpu().state().scans + 1, format_duration(kEndlessScan)));
    return kCheckFailed;
  }
  if (ending.reason == "run-time error") {
    print_error("--strict: the run ended at the first run-time error");
    return kCheckFailed;
  }
  return ending.reason == "bridge" ? kUnusable : exit_code_of(simulation.cpu());
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb =
      app.add_subcommand("run", "run a program, as fast as the computer can, or in real time for masters of this computer");
  options->program.add_to(*verb);
  add_duration(*verb, "--for", options->duration, "how long, in simulated time [1s; with a bridge until Ctrl-C]");
  add_whole_number(*verb, "--scans", options->scans, {1, UINT64_MAX},
                   "how many scans; with --for whichever comes first ends the run");
  options->bridge.add_to(*verb);
  options->rig.add_to(*verb);
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer(std::string(BridgeOptions::kAboutPty) + fault_help() +
               "Example: s7200 run stl_programs/modbus_slave.stl --for 2s --set VW100=5 --dump VW100:4");
  verb->callback([options, &exit_code] { exit_code = run_run(*options); });
}

}  // namespace s7200::tools
