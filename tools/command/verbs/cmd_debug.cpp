#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <iostream>

#include "tools/command/debugging/debug_scenario.hpp"
#include "tools/command/debugging/debug_script.hpp"
#include "tools/command/debugging/debug_session.hpp"
#include "tools/command/debugging/debuggee_run.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/verb/debug_options.hpp"
#include "tools/command/reports/run_recorder.hpp"
#include "tools/command/running/rig_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/opened_scenario.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/faces/console/prompt.hpp"
#include "tools/faces/files/host_files.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

int run_debug(const CLI::App& verb, DebugOptions& options) {
  if (is_standard_input(options.program.path) && (!options.given() || options.interactive)) {
    print_error(
        "the program comes from standard input, so the commands cannot: give them with -x or --commands, without -i");
    return kUnusable;
  }
  if (is_scenario_file(options.program.path)) return run_debug_scenario(verb, options);
  for (const auto& [option, given] : {std::pair("--only", &options.only), std::pair("--target", &options.target)})
    if (!given->empty())
      return print_error(fmt::format("{} is about a file of scenarios, and this is none", option)), kUnusable;
  int exit_code = kFine;
  if (!options.rig.load_all(verb, options.program, exit_code)) return exit_code;
  const auto script = options.commands_file.empty() ? std::string() : read_file(options.commands_file);
  if (!script) return print_error(fmt::format("cannot read {}: {}", options.commands_file, script.why())), kUnusable;
  options.bridge.set_line(options.master);
  if (!options.bridge.prepare()) return kUnusable;
  auto bridges = bridges_of(options);
  if (!bridges) return kUnusable;
  if (!options.report.prepare_for(options.rig.plan())) return kUnusable;
  const auto rig = options.rig.assemble(false, options.bridge.link());
  if (!rig) return options.rig.exit_code_without_rig();
  if (!has_room_for_bridge(options, *rig)) return kUnusable;
  rig->power_up();
  rig->simulation().stop_when({});  // the debugger looks itself, in front of each instruction
  bool good = false, all_written = false, in_the_past = false, expectation_failed = false;
  {
    std::atomic<bool> pause = false;
    DebuggeeRun live(*rig, options, std::move(*bridges), print_live_messages(), StopToken(pause));
    if (const auto done = live.start(); !done) return print_error(done.why()), kUnusable;
    if (live.has_bridges()) print_note(kMastersWait);
    print_note_if_any(options.rig.note_on_first_station());
    const HostFiles files(rig->files());
    PromptSettings settings = prompt_settings(session_setup(options, *rig, live, &files), &pause);
    settings.history = live.history();
    Prompt debugger(options.rig.stations(*rig), std::cout, settings);
    good = run_commands(debugger, *script, options);
    expectation_failed = !good && debugger.expectation_failed();
    good &= live.failure().empty();
    in_the_past = debugger.in_the_past();
    all_written = write_run(options.report, "debug", *rig, options.rig.system_path(), options.rig.spot(),
                            debugger.recording(), options.program.repairs);
  }
  fmt::print("{}", dump_text(*rig));
  const std::vector<std::string> notes = fault_notes(*rig);
  print_notes(notes);
  if (in_the_past && !notes.empty()) print_note("faults are counted up to where the session stands, in the past");
  all_written &= finish(*rig);
  if (!all_written) return kUnusable;
  if (std::ferror(stdin) != 0 && !interrupted()) return print_error("cannot read standard input"), kUnusable;
  print_interruption();
  if (interrupted() || expectation_failed) return kCheckFailed;
  if (!good) return kUnusable;
  if (options.rig.failed_strictly(rig->cpu()) && !rig->cpu().state().fatal_code) return kCheckFailed;
  return exit_code_of(*rig);
}

}  // namespace

void add_debug(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DebugOptions>();
  CLI::App* verb = app.add_subcommand("debug", "step through a program: breakpoints, frames on its port, back again");
  options->add_to(*verb);
  verb->footer(
      "Without --commands and -x the commands come from standard input; 'help' lists them. A program from standard input, "
      "-, "
      "needs --commands or -x.\n"
      "With a bridge, --realtime or --speed it follows the clock, and masters outside wait while it stands still; their "
      "time-outs are their own affair. Traces and captures get everything once: what is played again is not written again. "
      "A new branch goes on in traces after what ran before, and ends captures.\n"
      "A file of scenarios (.yaml) instead of a PROGRAM: the first of them that fails, or that of --only, is opened where "
      "it "
      "failed.\n"
      "A system file (.yaml) instead of a PROGRAM: all its PLCs run, and go back, in one time; 'station NAME' goes over "
      "from "
      "one to another.\n"
      "Exit code 2 after a wrong command in a script, 1 after an 'expect' that does not hold; Ctrl-C ends a script too, "
      "with "
      "1, or at the prompt with -i.\n"
      "Topics: debugger, bridges, faults, files, models, programs, systems\n"
      "Example: s7200 debug stl_programs/modbus_slave.stl -x \"continue 2s; status NETWORK 2\"");
  verb->callback([options, &exit_code, verb] { exit_code = run_debug(*verb, *options); });
}

}  // namespace s7200::tools
