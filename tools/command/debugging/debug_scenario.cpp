#include "tools/command/debugging/debug_scenario.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <utility>

#include "tools/command/debugging/debug_script.hpp"
#include "tools/command/debugging/debug_session.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/opened_scenario.hpp"
#include "tools/faces/console/prompt.hpp"
#include "tools/faces/files/host_files.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

int debug(const OpenedScenario& one, const std::string& script, const DebugOptions& options) {
  const auto plant = one.plant();
  const HostFiles files;
  SessionSetup setup = one.setup();
  setup.files = &files;
  PromptSettings settings = prompt_settings(std::move(setup), nullptr);
  settings.history = plant->history_settings();
  Prompt debugger(plant->stations(), std::cout, settings);
  if (!debugger.open(one.recording(), one.place().moment, one.failed_memory()))
    return print_error("the scenario does not run the same way in the debugger; 'test' shows what it found"), kUnusable;
  fmt::print("{}", one.heading());
  std::cout << std::flush;
  const bool good = run_commands(debugger, script, options);
  print_interruption();
  if (interrupted() || (!good && debugger.expectation_failed())) return kCheckFailed;
  return good ? kFine : kUnusable;
}

}  // namespace

int run_debug_scenario(const CLI::App& verb, const DebugOptions& options) {
  const std::string option = option_of_a_program(verb, {"--only", "--target", "--commands", "--execute", "--interactive"});
  if (!option.empty()) {
    print_error(fmt::format("{} is about a program; a scenario says that itself, in its head", option));
    return kUnusable;
  }
  const auto script = options.commands_file.empty() ? std::string() : read_file(options.commands_file);
  if (!script) return print_error(fmt::format("cannot read {}: {}", options.commands_file, script.why())), kUnusable;
  int exit_code = kFine;
  const auto one =
      OpenedScenario::open({.path = options.program.path, .only = options.only, .target = options.target}, exit_code);
  return one ? debug(*one, *script, options) : exit_code;
}

}  // namespace s7200::tools
