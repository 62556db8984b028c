#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

#include "interpreter/base/text.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/line_options.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

struct DebugOptions {
  ProgramOptions program;
  serial::MasterSettings master;
  std::string commands_file;
  std::vector<std::string> commands;
  bool interactive = false;
};

/// A line from the terminal; an empty one stands for `last`. Ctrl-C ends a run, and at the prompt the line being typed:
/// reading is not taken up again, and an empty prompt comes with nothing to repeat. False at the end of the input, and when
/// something else than Ctrl-C ends the command.
bool read_line(std::string& line, std::string& last) {
  while (true) {
    forget_ctrl_c();
    if (interrupted()) return false;
    std::cout << Debugger::kPrompt << std::flush;
    if (std::getline(std::cin, line)) {
      if (line.empty()) line = last;
      return true;
    }
    std::cout << '\n';
    if (!interrupted()) return false;
    last.clear();
    std::clearerr(stdin);
    std::cin.clear();
  }
}

void talk(Debugger& debugger) {
  std::string last;
  for (std::string line; !debugger.quit_asked() && read_line(line, last);) {
    if (const auto error = debugger.execute(line)) std::cout << stl::printable(*error) << '\n';
    last = debugger.repeatable();
  }
}

/// False after a message for a wrong command.
bool run_script(Debugger& debugger, std::istream& in, std::string_view name) {
  const auto error = debugger.run_script(in);
  if (error) print_error(fmt::format("{}:{}: {}", name, error->line, error->message));
  return !error;
}

/// The commands of the command line; false when one is wrong.
bool run_given(Debugger& debugger, const std::string& script, const DebugOptions& options) {
  std::istringstream file(script);
  if (!options.commands_file.empty() && !run_script(debugger, file, options.commands_file)) return false;
  std::string given;
  for (const std::string& command : options.commands) given += command + "\n";
  std::istringstream in(given);
  return run_script(debugger, in, "-x");
}

int run_debug(const DebugOptions& options) {
  const bool given = !options.commands_file.empty() || !options.commands.empty();
  if (is_standard_input(options.program.path) && (!given || options.interactive)) {
    print_error(
        "the program comes from standard input, so the commands cannot: give them with -x or --commands, without -i");
    return kUnusable;
  }
  int exit_code = kFine;
  const auto program = options.program.load(exit_code);
  if (!program) return exit_code;
  std::string why, script;
  if (!options.commands_file.empty()) {
    auto text = read_file(options.commands_file, why);
    if (!text) {
      print_error(fmt::format("cannot read {}: {}", options.commands_file, why));
      return kUnusable;
    }
    script = std::move(*text);
  }

  serial::Simulation simulation(program);
  simulation.power_up();
  Debugger debugger(simulation, std::cout, {.master = options.master, .stop_request = &interruption()});
  catch_interruption();
  const bool terminal = isatty(STDIN_FILENO) != 0;
  if (!given && terminal) std::cout << "'help' lists the commands.\n";
  debugger.show_place();
  bool good = !given || run_given(debugger, script, options);
  if (good && (!given || options.interactive)) {
    if (terminal)
      talk(debugger);
    else
      good = run_script(debugger, std::cin, "standard input");
  }
  if (std::ferror(stdin) != 0 && !interrupted()) {
    print_error("cannot read standard input");
    return kUnusable;
  }
  print_interruption();
  if (interrupted()) return kCheckFailed;
  return good ? exit_code_of(simulation.cpu()) : kUnusable;
}

}  // namespace

void add_debug(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DebugOptions>();
  CLI::App* verb =
      app.add_subcommand("debug", "step through a program: breakpoints, watches, frames on its port, and back again");
  options->program.add_to(*verb);
  verb->add_option("--commands", options->commands_file, "commands to execute, one a line; # begins a comment")
      ->type_name("FILE");
  verb->add_option("-x,--execute", options->commands, "commands to execute, separated by ; (repeatable; after --commands)")
      ->type_name("COMMANDS")
      ->allow_extra_args(false);
  verb->add_flag("-i,--interactive", options->interactive, "go on with standard input after --commands and -x");
  add_master_options(*verb, options->master);
  verb->footer(
      "Without --commands and -x the commands come from standard input; 'help' lists them. A wrong command ends a script\n"
      "with exit code 2. A program from standard input, -, needs --commands or -x.\n"
      "Example: s7200 debug stl_programs/modbus_slave.stl -x \"continue 2s; send 01 03 00 00 00 02 crc; continue; regs\"");
  verb->callback([options, &exit_code] { exit_code = run_debug(*options); });
}

}  // namespace s7200::tools
