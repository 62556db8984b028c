// s7200: one binary, a verb for each thing it does.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <sstream>
#include <string_view>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/help/help_text.hpp"
#include "tools/command/terminal/standard_streams.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/usage.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/command/verbs/derived_verbs.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/process.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct Verb {
  std::string_view name;
  void (*add)(CLI::App& app, int& exit_code);
};
constexpr std::array kVerbs{
    Verb{"check", add_check},
    Verb{"inspect", add_inspect},
    Verb{"why", add_why},
    Verb{"compare", add_compare},
    Verb{"fuzz", add_fuzz},
    Verb{"import", add_import},
    Verb{"convert", add_convert},
    Verb{"run", add_run},
    Verb{"send", add_send},
    Verb{"test", add_test},
    Verb{"master", add_master},
    Verb{"decode", add_decode},
    Verb{"import-capture", add_import_capture},
    Verb{"debug", add_debug},
    Verb{"view", add_view},
    Verb{"dap", add_dap},
    Verb{"instructions", add_instructions},
    Verb{"times", add_times},
    Verb{"calibrate", add_calibrate},
    Verb{"bench", add_bench},
};

/// In the order of the help. All their options take milliseconds: if it is clear which verb is asked for, only its own, and
/// none for the version.
void add_verbs(CLI::App& app, std::string_view asked, int& exit_code) {
  const bool clear = asked == "-V" || asked == "--version" || std::ranges::find(kVerbs, asked, &Verb::name) != kVerbs.end();
  for (const Verb& verb : kVerbs)
    if (!clear || verb.name == asked) verb.add(app, exit_code);
}

/// A signal before the verb has begun what is to be completed.
[[noreturn]] void end_interrupted(int) {
  constexpr std::string_view kNote = "s7200: note: interrupted\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kNote.data(), kNote.size());
  _exit(kCheckFailed);
}

/// Quotation marks that the console of Windows hands on: single ones, as pages for Linux have them, hold nothing together
/// there, and a \ makes the closing one behind it a part of the word, as in "C:\plant\".
struct StrayQuote {
  bool (*stands_in)(const std::string& word);
  std::string_view hint;  // behind the word
};

constexpr StrayQuote kStrayQuotes[] = {
    {[](const std::string& word) { return word.starts_with('\''); },
     "begins with a single quote: the console of Windows holds words together with double quotes only"},
    {[](const std::string& word) { return std::ranges::count(word, '"') % 2 != 0; },
     "has a double quote in it: the console of Windows takes one for a part of the word where a \\ stands in front of it; "
     "leave that \\ out"},
};

void hint_at_stray_quotes(const std::vector<std::string>& words) {
  for (const StrayQuote& quote : kStrayQuotes)
    if (const auto word = std::ranges::find_if(words, quote.stands_in); word != words.end())
      print_note(fmt::format("{} {}", stl::shortened(*word), quote.hint));
}

int run_command(const std::vector<std::string>& words) {
  CLI::App app{"s7200 runs SIMATIC S7-200 STL programs in simulated time, with their ports on simulated lines."};
  app.name("s7200");
  app.require_subcommand(1);
  app.allow_windows_style_options(false);  // /name is a path, on every system
  app.set_version_flag("-V,--version", fmt::format("s7200 {}", version()));
  app.failure_message(usage_error);
  app.footer(
      "Exit codes: 0 fine; 1 what was checked failed; 2 wrong usage, input or output; 3 a CPU in STOP\n"
      "Example: s7200 send stl_programs/modbus_slave.stl --crc 01030000000a --timeline");
  app.formatter(help_layout());
  app.set_help_flag("-h,--help", "show what most users need");
  app.set_help_all_flag("--help-all", "show all options");

  int exit_code = kFine;
  add_verbs(app, words.size() > 1 ? words[1] : "", exit_code);
  derive_help(app, exit_code);
  derive_manual(app, exit_code);
  derive_complete(app, exit_code);
  refuse_empty_values(app);

  try {
    std::vector<std::string> arguments =
        as_options(app, {words.begin() + std::min<std::ptrdiff_t>(1, std::ssize(words)), words.end()});
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    std::ostringstream said;
    const bool fine = app.exit(error, std::cout, said) == 0;
    fmt::print(stderr, "{}", stl::printable_lines(said.str()));
    return fine ? kFine : kUnusable;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kUnusable;
  }
  return exit_code;
}

}  // namespace
}  // namespace s7200::tools

int main(int argc, char** argv) {
  using namespace s7200::tools;
  open_standard_streams();
  end_at_interruption(end_interrupted);
  const std::vector<std::string> words = words_of_command_line(argc, argv);
  const int exit_code = run_command(words);
  if (exit_code == kUnusable) hint_at_stray_quotes(words);
  return close_standard_streams(exit_code);
}
