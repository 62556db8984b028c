#include "tools/command/debugging/debug_script.hpp"

#include <fmt/format.h>

#include <iostream>
#include <sstream>

#include "tools/command/terminal/console.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/console.hpp"

namespace s7200::tools {
namespace {

/// False after a message for a wrong command.
bool run_script(Prompt& debugger, std::istream& in, std::string_view name, bool is_whole = true) {
  if (constexpr int kByteOrderMark = 0xEF; in.peek() == kByteOrderMark) in.ignore(3);
  const auto error = debugger.run_script(in, is_whole);
  if (error) print_error(fmt::format("{}:{}: {}", name, error->line, error->message));
  return !error;
}

/// The commands of the command line; false when one is wrong.
bool run_given(Prompt& debugger, const std::string& script, const DebugOptions& options) {
  std::istringstream file(script);
  if (!options.commands_file.empty() && !run_script(debugger, file, options.commands_file)) return false;
  std::string given;
  for (const std::string& command : options.commands) given += command + "\n";
  std::istringstream in(given);
  return run_script(debugger, in, "-x");
}

}  // namespace

bool run_commands(Prompt& debugger, const std::string& script, const DebugOptions& options) {
  const bool terminal = is_terminal(Standard::Input);
  if (!options.given() && terminal) std::cout << "'help' lists the commands.\n";
  debugger.show_place();
  if (options.given() && !run_given(debugger, script, options)) return false;
  if (options.given() && !options.interactive) return true;
  if (!terminal) return run_script(debugger, std::cin, "standard input", false);
  talk(debugger);
  return true;
}

}  // namespace s7200::tools
