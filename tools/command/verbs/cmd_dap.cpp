#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "tools/command/debugging/dap_debuggee.hpp"
#include "tools/command/debugging/dap_server.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/faces/dap/wire/serve.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

struct DapOptions {
  std::shared_ptr<DebuggeeOptions> debuggee = std::make_shared<DebuggeeOptions>();
  std::string listen, token_file;
  std::vector<std::string> allowed;
};

bool write_standard_output(std::string_view bytes) {
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  return std::cout.good();
}

int run_dap(const CLI::App& verb, const DapOptions& options) {
  std::atomic<bool> stop_request = false;
  int exit_code = kFine;
  LaunchLimits limits{.programs = options.debuggee->program.parts, .may_open = {}};
  if (!options.debuggee->program.path.empty()) limits.programs.push_back(options.debuggee->program.path);
  if (!options.listen.empty()) {
    limits.may_open = options.allowed;
    limits.may_use_files = std::ranges::find(options.allowed, kFilesOfCommands) != options.allowed.end();
  }
  dap::SessionSettings settings{
      .launch = [&](const dap::Json& arguments) { return launch_debuggee(arguments, limits, StopToken(stop_request)); },
      .stop_request = StopToken(stop_request)};
  if (!options.debuggee->program.path.empty()) {
    settings.attachable =
        make_debuggee(verb, options.debuggee, StopToken(stop_request), exit_code, {.may_use_files = limits.may_use_files});
    if (!settings.attachable) return exit_code;
  }
  if (!options.listen.empty()) {
    exit_code = serve_clients({options.listen, options.token_file}, settings, stop_request);
  } else if (const std::string wrong =
                 dap::serve(standard_input(), write_standard_output, settings, stop_request, interruption());
             !wrong.empty()) {
    print_error(fmt::format("standard input {}", wrong));
    exit_code = kUnusable;
  }
  if (settings.attachable) print_notes(settings.attachable->finish());
  print_interruption();
  if (exit_code == kFine && interrupted() && options.listen.empty()) return kCheckFailed;
  return exit_code;
}

}  // namespace

void add_dap(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DapOptions>();
  CLI::App* verb = app.add_subcommand("dap", "serve the Debug Adapter Protocol, for VS Code and other editors");
  options->debuggee->add_program_to(*verb);
  verb->get_option("PROGRAM")->required(false);
  auto* listen =
      verb->add_option("--listen", options->listen,
                       "a TCP port of this computer, for one client after the other, instead of standard input and output")
          ->type_name("[ADDRESS:]PORT");
  verb->add_option("--token-file", options->token_file,
                   "a file whose first line is the token of --listen, instead of a new one each time")
      ->type_name("FILE")
      ->needs(listen);
  offer(verb->add_option("--allow", options->allowed,
                         "what a launch over --listen may write or open, such as trace,modbus-tcp (repeatable)"),
        writing_attributes())
      ->check(not_a_writing_attribute)
      ->delimiter(',')
      ->type_name("ATTRIBUTE,...")
      ->allow_extra_args(false)
      ->needs(listen);
  options->debuggee->add_plant_to(*verb);
  for (CLI::Option* option : verb->get_options())
    if (!option->get_positional()) option->group(help_group::kMore);  // attributes of a launch say it in an editor
  for (const char* often : {"--listen", "--token-file", "--allow"}) verb->get_option(often)->group(help_group::kRun);
  verb->footer(
      "An editor starts it and launches a program: the attributes of a launch are the options of 's7200 debug' without "
      "their "
      "dashes. With a PROGRAM here, editors attach to that one, which stays as it stands when they leave, and launch no "
      "other.\n"
      "Over --listen a launch or an attach needs the token that is printed, as its attribute 'token'.\n"
      "Without a bridge, --realtime or --speed programs run as fast as the computer can; with one as fast as the clock, and "
      "masters outside wait while it stands still.\n"
      "tools/faces/dap/README.md lists the requests of our own, tools/vscode-s7200 is the extension for VS Code.\n"
      "Topics: bridges, debugger, faults, files, programs, systems\n"
      "Example: s7200 dap");
  verb->callback([options, &exit_code, verb] { exit_code = run_dap(*verb, *options); });
}

}  // namespace s7200::tools
