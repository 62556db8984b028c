#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "interpreter/base/text.hpp"
#include "interpreter/program/load.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/dap_debuggee.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/terminal.hpp"
#include "tools/dap/serve.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/server_rules.hpp"
#include "tools/host/tcp_listener.hpp"

namespace s7200::tools {
namespace {

struct DapOptions {
  std::shared_ptr<DebuggeeOptions> debuggee = std::make_shared<DebuggeeOptions>();
  std::string listen, token_file;
  std::vector<std::string> allowed;
};

constexpr std::size_t kShortestToken = 16;

bool write_standard_output(std::string_view bytes) {
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  return std::cout.good();
}

/// The token that clients give; empty and an error if the file with it is of no use.
std::string token_of(const DapOptions& options) {
  if (options.token_file.empty()) return new_token();
  std::string why;
  const auto text = read_text(options.token_file, why);
  const std::string token(stl::trim(std::string_view(text.value_or("")).substr(0, text.value_or("").find('\n'))));
  if (token.size() >= kShortestToken) return token;
  print_error(
      fmt::format("--token-file {}: {}", options.token_file,
                  text ? fmt::format("its first line is not a token of {} characters or more", kShortestToken) : why));
  return {};
}

/// One client after the other, until an interruption.
int serve_clients(const DapOptions& options, const dap::SessionSettings& settings, std::atomic<bool>& stop_request) {
  std::string why;
  const std::string token = token_of(options);
  if (token.empty()) return kUnusable;
  const auto address = parse_listen_address(options.listen, why);
  const auto listener = address ? TcpListener::open(*address, why) : nullptr;
  if (!listener) return print_error(fmt::format("--listen {}: {}", options.listen, why)), kUnusable;
  catch_interruption();
  fmt::print(stderr, "listening on {}, for clients with {}\n", to_text(listener->address()),
             options.token_file.empty() ? fmt::format("\"token\": \"{}\"", token) : "the token of --token-file");
  while (!interrupted()) {
    const int client = listener->accept(why);
    if (client < 0 && !interrupted()) return print_error(fmt::format("--listen {}: {}", options.listen, why)), kUnusable;
    if (client < 0) break;
    const auto write = [client](std::string_view bytes) { return send_all(client, bytes) == 0; };
    const std::string wrong = dap::serve(client, write, settings, stop_request, token);
    if (!wrong.empty()) print_note(fmt::format("a client {}", wrong));
    close(client);
  }
  return kFine;
}

int run_dap(const CLI::App& verb, const DapOptions& options) {
  std::atomic<bool> stop_request = false;
  int exit_code = kFine;
  LaunchLimits limits{.programs = options.debuggee->program.parts, .may_open = {}};
  if (!options.debuggee->program.path.empty()) limits.programs.push_back(options.debuggee->program.path);
  if (!options.listen.empty()) limits.may_open = options.allowed;
  dap::SessionSettings settings{
      .launch = [&](const dap::Json& arguments) { return launch_debuggee(arguments, limits, stop_request); },
      .stop_request = &stop_request};
  if (!options.debuggee->program.path.empty()) {
    settings.attachable = make_debuggee(verb, options.debuggee, stop_request, exit_code);
    if (!settings.attachable) return exit_code;
  }
  if (!options.listen.empty()) {
    exit_code = serve_clients(options, settings, stop_request);
  } else if (const std::string wrong = dap::serve(STDIN_FILENO, write_standard_output, settings, stop_request);
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
  verb->footer(
      R"(An editor starts it and launches a program: the attributes of a launch are the options of 's7200 debug' without their
dashes. With a PROGRAM here, editors attach to that one, which stays as it stands when they leave, and launch no other.
Over --listen a launch or an attach needs the token that is printed, as its attribute 'token'. Without a bridge,
--realtime or --speed programs run as fast as the computer can; with one as fast as the clock, and masters outside wait
while it stands still. tools/dap/README.md lists the requests of our own, tools/vscode-s7200 is the extension for VS Code.
Example: s7200 dap)");
  verb->callback([options, &exit_code, verb] { exit_code = run_dap(*verb, *options); });
}

}  // namespace s7200::tools
