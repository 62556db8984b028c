#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <thread>

#include "tools/commands.hpp"
#include "tools/duration_option.hpp"
#include "tools/exit_code.hpp"
#include "tools/interruption.hpp"
#include "tools/plant_options.hpp"
#include "tools/program_options.hpp"
#include "tools/report.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

using HostClock = std::chrono::steady_clock;

/// A scan that goes on for so long in simulated time is taken for one that never ends; only WDR lets it come so far.
constexpr Time kEndlessScan = 10 * kSecond;

struct RunOptions {
  ProgramOptions program;
  Time duration = kSecond;
  bool duration_given = false;
  std::uint64_t scans = 0;
  bool realtime = false, json = false;
  PlantOptions plant;
};

/// Runs in slices, so that Ctrl-C, pacing and progress come in between; what is computed does not depend on them.
class Runner {
 public:
  Runner(serial::Simulation& simulation, const RunOptions& options) : simulation_(simulation), options_(options) {}

  /// Why it ended: `time`, `scans`, `endless scan`, `stop`, `fatal` or `interrupted`.
  std::string_view run() {
    catch_interruption();
    simulation_.cpu().pause_at_scan_end(options_.scans != 0);
    while (simulation_.time() < end()) {
      if (interrupted()) return "interrupted";
      const serial::Halt halt = simulation_.run_until(std::min(end(), next_slice()));
      if (halt == serial::Halt::Stopped) return simulation_.cpu().state().fatal_code ? "fatal" : "stop";
      if (options_.scans != 0 && simulation_.cpu().state().scans >= options_.scans) return "scans";
      if (halt == serial::Halt::Time) between_slices();
    }
    return until_scans() ? "endless scan" : "time";
  }

 private:
  /// Only the number of scans ends it.
  bool until_scans() const { return options_.scans != 0 && !options_.duration_given; }
  Time end() const { return until_scans() ? simulation_.cpu().state().scan_begin + kEndlessScan : options_.duration; }
  Time next_slice() const { return simulation_.time() + (options_.realtime ? 10 * kMillisecond : 10 * kSecond); }

  void between_slices() {
    const Time host = std::chrono::duration_cast<std::chrono::nanoseconds>(HostClock::now() - begin_).count();
    if (options_.realtime && simulation_.time() > host)
      std::this_thread::sleep_for(std::chrono::nanoseconds(simulation_.time() - host));
    if (host > next_progress_ && isatty(STDERR_FILENO)) {
      next_progress_ = host + kSecond;
      const std::string goal = until_scans() ? fmt::format("{} scans", options_.scans) : format_duration(end());
      fmt::print(stderr, "\r{} of {} simulated", format_duration(simulation_.time()), goal);
      if (simulation_.time() >= end()) fmt::print(stderr, "\n");
    }
  }

  serial::Simulation& simulation_;
  const RunOptions& options_;
  const HostClock::time_point begin_ = HostClock::now();
  Time next_progress_ = 2 * kSecond;
};

void print_text(const serial::Simulation& simulation, std::string_view reason, const PlantOptions& plant) {
  const State& state = simulation.cpu().state();
  fmt::print("ended by {} after {}: {} scans, {} instructions, CPU in {}\n", reason, format_duration(state.time, 6),
             state.scans, state.instructions, state.mode == Mode::Run ? "RUN" : "STOP");
  if (state.scans)
    fmt::print("scan time: shortest {}, longest {}\n", format_duration(state.shortest_scan),
               format_duration(state.longest_scan));
  fmt::print("{}{}", errors_text(simulation.cpu()), plant.dump_text(state));
}

void print_json(const serial::Simulation& simulation, std::string_view reason, const PlantOptions& plant) {
  const State& state = simulation.cpu().state();
  const nlohmann::ordered_json json{{"stop_reason", reason},
                                    {"time_ns", state.time},
                                    {"scans", state.scans},
                                    {"instructions", state.instructions},
                                    {"mode", state.mode == Mode::Run ? "RUN" : "STOP"},
                                    {"errors", errors_json(simulation.cpu())},
                                    {"dump", plant.dump_json(state)}};
  fmt::print("{}\n", json.dump(2));
}

int run_run(RunOptions& options) {
  int exit_code = kFine;
  const auto program = options.program.load(exit_code);
  if (!program) return exit_code;
  if (!options.plant.prepare(program)) return kUnusable;

  serial::Simulation simulation(program, options.plant.field());
  options.plant.power_up(simulation);
  const std::string_view reason = Runner(simulation, options).run();
  if (!options.plant.finish(simulation)) return kUnusable;

  if (options.json)
    print_json(simulation, reason, options.plant);
  else
    print_text(simulation, reason, options.plant);
  if (reason == "endless scan") {
    print_error(
        fmt::format("scan {} has lasted {} and is not over: the program loops in it, and WDR keeps it going. "
                    "To run it all the same say how long: --for",
                    simulation.cpu().state().scans + 1, format_duration(kEndlessScan)));
    return kCheckFailed;
  }
  return exit_code_of(simulation.cpu());
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb = app.add_subcommand("run", "run a program in simulated time, as fast as the computer can");
  options->program.add_to(*verb);
  auto* duration = add_duration(*verb, "--for", options->duration, "how long, in simulated time (default 1s)");
  verb->add_option("--scans", options->scans, "how many scans; with --for: what comes first")->check(CLI::PositiveNumber);
  verb->add_flag("--realtime", options->realtime, "no faster than real time");
  options->plant.add_to(*verb);
  verb->add_flag("--json", options->json, "print the result as JSON");
  verb->footer("Example: s7200 run stl_programs/modbus_slave.stl --for 2s --set VW100=5 --dump VW100:4");
  verb->callback([options, duration, &exit_code] {
    options->duration_given = duration->count() != 0;
    exit_code = run_run(*options);
  });
}

}  // namespace s7200::tools
