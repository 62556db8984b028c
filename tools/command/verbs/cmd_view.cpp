#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "interpreter/base/text/text.hpp"
#include "tools/command/debugging/dap_debuggee.hpp"
#include "tools/command/debugging/server_token.hpp"
#include "tools/command/debugging/view_scenario.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/faces/page/server/serve.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

struct ViewOptions {
  std::shared_ptr<DebuggeeOptions> debuggee = std::make_shared<DebuggeeOptions>();
  std::string listen = "0", token_file;
  std::string only, target;  ///< of a file of scenarios
  bool files = false;
};

bool is_address_word(const std::string& token) {
  return std::ranges::all_of(token, [](char c) { return stl::is_letter(c) || stl::is_digit(c) || c == '-' || c == '_'; });
}

void print_address(const std::string& address) {
  print_note("the page is at this address, for browsers of this computer; Ctrl-C ends it");
  fmt::print("{}\n", address);
  std::fflush(stdout);
}

int run_view(const CLI::App& verb, const ViewOptions& options) {
  const std::string token = server_token(options.token_file);
  if (token.empty()) return kUnusable;
  if (!is_address_word(token))
    return print_error("--token-file: this token is a part of an address: letters, digits, - and _ only"), kUnusable;
  auto listener = parse_listen_address(options.listen).and_then(TcpListener::open);
  if (!listener) return print_error(fmt::format("--listen {}: {}", options.listen, listener.why())), kUnusable;
  page::PageServer server{.listener = *std::move(listener), .token = token, .ready = print_address, .note = print_note};
  page::PageFlags flags;
  int exit_code = kFine;
  if (is_scenario_file(options.debuggee->program.path))
    return view_scenario(verb, {options.debuggee->program.path, options.only, options.target}, options.files,
                         std::move(server), flags);
  for (const auto& [option, given] : {std::pair("--only", &options.only), std::pair("--target", &options.target)})
    if (!given->empty())
      return print_error(fmt::format("{} is about a file of scenarios, and this is none", option)), kUnusable;
  const auto debuggee =
      make_debuggee(verb, options.debuggee, StopToken(flags.pause), exit_code, {.may_use_files = options.files});
  if (!debuggee) return exit_code;
  catch_interruption();
  SessionSetup setup = debuggee->setup();
  setup.why_no_files = kWhyNoFiles;
  page::PageSettings settings{.session = std::move(setup), .program = debuggee->source(), .live = debuggee->follows_clock()};
  page::serve(std::move(server), debuggee->history(), std::move(settings), flags,
              [&](auto say) { debuggee->when_saying(std::move(say)); });
  print_notes(debuggee->finish());
  return kFine;
}

}  // namespace

void add_view(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* verb = app.add_subcommand("view", "see a program at work on a page in the browser: status, timeline, past");
  options->debuggee->add_program_to(*verb);
  verb->add_option("--listen", options->listen,
                   "the address and port of the page, on this computer [a free port of 127.0.0.1]")
      ->type_name("[ADDRESS:]PORT")
      ->group(help_group::kRun);
  verb->add_option("--token-file", options->token_file,
                   "a file whose first line is the token in the address, instead of a new one each time")
      ->type_name("FILE")
      ->group(help_group::kRun);
  verb->add_flag("--files", options->files, "commands of the page may read and write files: save, load, record")
      ->group(help_group::kRun);
  verb->add_option("--only", options->only,
                   "of a file of scenarios: the first that fails with PATTERN in its name; * is anything")
      ->type_name("PATTERN");
  verb->add_option("--target", options->target, "of a file of scenarios: the program to run it on")->type_name("PROGRAM");
  options->debuggee->add_plant_to(*verb);
  verb->footer(
      "The address has a token: whoever has it can do what the prompt of 's7200 debug' can, with files only if --files "
      "is given. Several windows show the same session.\n"
      "Without a bridge, --realtime or --speed runs are as fast as the computer can; with one they follow the clock, and "
      "commands are carried out meanwhile.\n"
      "A system file (.yaml) instead of a PROGRAM: all its PLCs, one of them at a time. A file of scenarios: the first of "
      "them that fails, or that of --only, where it failed.\n"
      "Topics: bridges, debugger, faults, files, models, programs, systems\n"
      "Example: s7200 view stl_programs/modbus_slave.stl");
  verb->callback([options, &exit_code, verb] { exit_code = run_view(*verb, *options); });
}

}  // namespace s7200::tools
