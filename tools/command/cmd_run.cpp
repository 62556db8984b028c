#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/bridge/live_run.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/run_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/rig_output.hpp"
#include "tools/command/run_output.hpp"
#include "tools/command/system_run.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/rig/run.hpp"

namespace s7200::tools {
namespace {

Ending run_to_end(Rig& rig, const RunOptions& options) {
  serial::Simulation& simulation = rig.simulation();
  Bridge* const bridge = options.bridge.bridge();
  const Time end = options.end(bridge != nullptr);
  if (!options.bridge.realtime()) {
    const RunLimits limits{end, options.scans, options.rig.strict()};
    return {run(simulation, limits, Progress([&] { return simulation.time(); }, limits))};
  }
  const bool to_ppi = bridge && bridge->carries_ppi();
  LiveRun live(simulation,
               {.speed = options.bridge.speed(),
                .line = options.bridge.line(),
                .messages = print_live_messages(),
                .stop = interruption(),
                .in_stop_too = to_ppi,
                .before_wait = [&rig] { rig.flush_records(); }},
               bridge);
  std::string why;
  if (!live.start(why)) return print_error(why), Ending{};
  LiveLimits limits{end, options.scans, options.rig.strict()};
  if (to_ppi)
    limits.stopped = [] { print_note("the CPU went to STOP: its ports speak PPI, and a PPI master may start it again"); };
  const std::string_view reason = run_live(live, simulation, limits);
  if (!live.failure().empty()) print_error(live.failure());
  if (bridge && (reason == "stop" || reason == "fatal"))
    print_note("the CPU went to STOP, which ends the run: it no longer answers");
  return {reason, live.pace(), live.collisions(&simulation.line())};
}

int run_run(const CLI::App& verb, RunOptions& options) {
  if (const auto code = run_without_program(verb, options)) return *code;
  int exit_code = kFine;
  const auto program = options.program.load(exit_code);
  if (!program) return exit_code;
  if (!options.bridge.prepare()) return kUnusable;
  if (!options.rig.take(program)) return kUnusable;
  const auto rig = options.rig.assemble(options.json, options.bridge.link());
  if (!rig) return options.rig.exit_code_without_rig();
  serial::Simulation& simulation = rig->simulation();
  rig->power_up();
  simulation.cpu().pause_at_error(options.rig.strict());
  const Ending ending = run_to_end(*rig, options);
  if (ending.reason.empty()) return kUnusable;
  const bool all_written = finish(*rig);

  if (options.json)
    print_json(*rig, ending, options);
  else
    print_text(*rig, ending, options);
  print_notes(line_notes(*rig, [&](const serial::SharedLine*) { return ending.collisions; }));
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
  if (ending.reason == "bridge") return kUnusable;
  if (ending.reason == "interrupted" && options.has_end(options.bridge.bridge() != nullptr)) return kCheckFailed;
  return exit_code_of(simulation.cpu());
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb = app.add_subcommand("run", "run a program, as fast as possible or in real time behind a bridge");
  options->add_to(*verb);
  verb->footer(
      "Exit code 1 if it was interrupted before its end, be it --for, --scans or a second; a run with a bridge and neither "
      "of the two serves until Ctrl-C or SIGTERM, and that is 0.\n"
      "Topics: bridges, faults, files, models, programs, systems, westinghouse\n"
      "Example: s7200 run stl_programs/modbus_slave.stl --for 2s --set VW100=5 --dump VW100:4");
  verb->callback([options, verb, &exit_code] { exit_code = run_run(*verb, *options); });
}

}  // namespace s7200::tools
