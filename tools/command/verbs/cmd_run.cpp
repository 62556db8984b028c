#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/bridge/live_run.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/verb/run_options.hpp"
#include "tools/command/reports/run_recorder.hpp"
#include "tools/command/running/rig_output.hpp"
#include "tools/command/running/run_observers.hpp"
#include "tools/command/running/run_output.hpp"
#include "tools/command/running/run_source.hpp"
#include "tools/command/running/unanswered.hpp"
#include "tools/command/terminal/progress.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/rig/run.hpp"

namespace s7200::tools {
namespace {

/// Runs with the clock. Of a PROGRAM its STOP ends the run, unless a bridge carries PPI, in which a master may start it
/// again.
std::string_view run_with_clock(LiveRun& live, RecordedRig& rig, const RunLimits& limits, bool to_ppi) {
  if (is_of_one_program(rig.plan())) {
    LiveLimits of_program{limits.end, limits.scans, limits.strict};
    if (to_ppi)
      of_program.stopped = [] {
        print_note("the CPU went to STOP: its ports speak PPI, and a PPI master may start it again");
      };
    return run_live(live, rig.simulation(), of_program);
  }
  const serial::Halt halt = live.run_until(limits.end);
  return !live.failure().empty() ? "bridge" : halt == serial::Halt::Time ? "time" : "interrupted";
}

Ending run_to_end(RecordedRig& rig, const RunBridges& bridges, bool serves, UnansweredOnBridge* unanswered,
                  const RunOptions& options) {
  RunLimits limits{options.end(serves), options.scans, options.rig.strict()};
  if (!rig.record_sizes().empty()) limits.slice = kSecond;  // so that a full record ends it soon
  if (!serves && !options.bridge.realtime())
    return {run(rig, limits, Progress([&] { return rig.system().time(); }, [&] { return rig.record_sizes(); }, limits))};
  const bool to_ppi = bridges.joined && bridges.joined->carries_ppi();
  const auto live = live_run_of(rig, bridges.of_plan, bridges.joined,
                                {.speed = options.bridge.speed(),
                                 .line = options.bridge.line(),
                                 .messages = print_live_messages(),
                                 .stop = interruption(),
                                 .in_stop_too = to_ppi,
                                 .before_wait = [&rig, unanswered] {
                                   rig.flush_records();
                                   if (unanswered) unanswered->look();
                                 }});
  if (const auto done = live->start(); !done) return print_error(done.why()), Ending{};
  const std::string_view reason = run_with_clock(*live, rig, limits, to_ppi);
  if (!live->failure().empty()) print_error(live->failure());
  if (bridges.joined && (reason == "stop" || reason == "fatal"))
    print_note("the CPU went to STOP, which ends the run: it no longer answers");
  Ending ending{reason, live->pace()};
  for (std::size_t i = 0; i < rig.plan().lines.size(); ++i) ending.collisions[&rig.line(i)] = live->collisions(&rig.line(i));
  return ending;
}

int run_run(const CLI::App& verb, RunOptions& options) {
  int exit_code = kFine;
  const auto bridges = load_run(verb, options, exit_code);
  if (!bridges) return exit_code;
  if (!options.report.prepare_for(options.rig.plan())) return kUnusable;
  const auto rig = options.rig.assemble(options.json, options.bridge.link());
  if (!rig) return options.rig.exit_code_without_rig();
  WrittenFiles files = rig->files();
  options.coverage.claim(files);
  options.profile.claim(files);
  const RunObservers observers(*rig, options);
  rig->power_up();
  const bool asked = bridges->joined != nullptr && rig->has_simulation() && !options.rig.without_s7200();
  const std::size_t most = options.report.wanted() ? RunRecorder::kMostActions : UnansweredOnBridge::kMostActions;
  const auto recorder = options.report.wanted() || asked
                            ? std::make_unique<RunRecorder>(*rig, options.rig.system_path(), options.rig.spot(), most)
                            : nullptr;
  const auto unanswered = asked ? std::make_unique<UnansweredOnBridge>(*rig, options.rig.spot(), *recorder) : nullptr;
  if (is_of_one_program(rig->plan())) rig->simulation().cpu().pause_at_error(options.rig.strict());
  std::vector<Bridge*> served = bridges->of_plan;
  if (bridges->joined) served.push_back(bridges->joined);
  const Ending ending = run_to_end(*rig, *bridges, !served.empty(), unanswered.get(), options);
  if (ending.reason.empty()) return kUnusable;
  const bool report_written = write_report(options.report, "run", recorder.get(), options.program.repairs);
  const bool all_written = finish(*rig) && report_written;
  const UnansweredRequests why_none = unanswered ? unanswered->explained() : UnansweredRequests{};
  if (options.json)
    print_json(*rig, ending, served, with_why(observers.json(options), why_none));
  else
    print_text(*rig, ending, served);
  if (!options.json) fmt::print("{}", why_text(why_none));
  print_notes(line_notes(*rig, [&](const serial::SharedLine* line) { return ending.collisions_on(line); }));
  if (ending.reason == "time") note_events_to_come(*rig);
  if (!all_written || ending.reason == "bridge") return kUnusable;
  if (const std::string error = error_at_end(ending.reason, *rig); !error.empty()) return print_error(error), kCheckFailed;
  if (ending.reason == "interrupted" && options.has_end(!served.empty())) return kCheckFailed;
  return observers.show(options, exit_code_of(*rig));
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
