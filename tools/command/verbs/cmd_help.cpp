#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/help/help_topics.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/usage.hpp"
#include "tools/command/verbs/derived_verbs.hpp"

namespace s7200::tools {
namespace {

/// What `s7200 help` explains, by name: verbs and topics.
std::vector<std::string> names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : listed_verbs(app)) names.push_back(verb->get_name());
  for (const HelpTopic& topic : help_topics())
    if (std::ranges::find(names, topic.name) == names.end()) names.emplace_back(topic.name);
  return names;
}

/// `times` is a verb and a topic: both are shown.
int run_help(const CLI::App& app, const std::string& word) {
  if (word.empty() || word == "help" || word == "version") {
    fmt::print("{}", app.get_formatter()->make_help(&app, "", CLI::AppFormatMode::Normal));
    return kFine;
  }
  const auto verbs = listed_verbs(app);
  const auto verb = std::ranges::find(verbs, word, &CLI::App::get_name);
  const HelpTopic* topic = find_help_topic(word);
  if (verb != verbs.end()) fmt::print("{}{}", (*verb)->help(), topic ? "\n" : "");
  if (topic) fmt::print("{}", stl::wrapped(topic->text(), std::min(output_width(), stl::kUsualWidth)));
  if (verb != verbs.end() || topic) return kFine;
  const std::vector<std::string> known = names(app);
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string_view meant = nearest(CLI::detail::to_lower(word), views);
  print_error(fmt::format("'{}' is not a verb or a topic; {}", stl::shortened(word),
                          meant.empty() ? "'s7200 help' lists them" : fmt::format("did you mean {}?", meant)));
  return kUnusable;
}

}  // namespace

void derive_help(CLI::App& app, int& exit_code) {
  auto word = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("help", "show the help of a verb, or a list that is too long for it")->group("");
  offer(verb->add_option("WORD", *word, "a verb or a topic; without it both are listed"), names(app));
  verb->footer("Example: s7200 help faults");
  verb->callback([&app, word, &exit_code] { exit_code = run_help(app, *word); });
}

}  // namespace s7200::tools
