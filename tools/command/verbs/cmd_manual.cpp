#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/help/manual_page.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/usage.hpp"
#include "tools/command/verbs/derived_verbs.hpp"

namespace s7200::tools {
namespace {

int run_manual(CLI::App& app, const std::string& name) {
  if (name.empty()) {
    fmt::print("{}", page_of_command(app));
    return kFine;
  }
  const auto verbs = listed_verbs(app);
  const auto verb = std::ranges::find(verbs, name, &CLI::App::get_name);
  if (verb == verbs.end()) {
    print_error(fmt::format("'{}' is not a verb; 's7200 --help' lists them", stl::shortened(name)));
    return kUnusable;
  }
  fmt::print("{}", page_of_verb(app, **verb));
  return kFine;
}

}  // namespace

void derive_manual(CLI::App& app, int& exit_code) {
  auto name = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("manual", "print the manual page of the command, or of a verb, in roff")->group("");
  std::vector<std::string> names;
  for (const CLI::App* each : listed_verbs(app)) names.push_back(each->get_name());
  offer(verb->add_option("VERB", *name, "the verb that the page is about; the command itself if none is given"), names);
  verb->footer("Example: s7200 manual run | man -l -");
  verb->callback([&app, name, &exit_code] { exit_code = run_manual(app, *name); });
}

}  // namespace s7200::tools
