#include "tools/command/usage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/host/files/file_system.hpp"

namespace s7200::tools {
namespace {

std::vector<std::string> names_of(const std::vector<const CLI::App*>& verbs) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  return names;
}

/// `there are` and the verbs, in lines that keep to the usual width.
std::string there_are(const std::vector<std::string_view>& verbs) {
  const std::string list = fmt::format("  {}", fmt::join(verbs, ", "));
  std::string text = "there are\n" + stl::wrapped(list, stl::kUsualWidth);
  text.pop_back();  // the end of its last line
  return text;
}

/// `'chek' is not a verb; is check meant?`
std::string not_a_verb(const std::string& word, const std::vector<std::string>& verbs) {
  if (file_system::is_file(word))
    return fmt::format("'{0}' is a file, and the verb before it is missing; write for example s7200 run {0}", word);
  std::vector<std::string_view> known(verbs.begin(), verbs.end());
  known.insert(known.end(), {"help", "version"});
  const std::string_view meant = nearest(CLI::detail::to_lower(word), known);
  const std::string shown = stl::shortened(word);
  return meant.empty() ? fmt::format("'{}' is not a verb; {}", shown, there_are(known))
                       : fmt::format("'{}' is not a verb; did you mean {}?", shown, meant);
}

/// `; did you mean --version?`; empty if no option is close. One dash may be meant for two.
std::string meant_option(std::string option, const CLI::App& app) {
  if (!option.starts_with("--")) option.insert(0, "-");
  std::vector<std::string> names;
  for (const CLI::Option* known : app.get_options())
    for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string_view meant = nearest(option.substr(0, option.find('=')), known);
  return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
}

/// `a verb is missing, and there is no option --verison before one; did you mean --version?`
std::string not_an_option(const std::string& option, const CLI::App& app, bool any_verb) {
  return fmt::format("{}there is no option {} before {}{}", any_verb ? "" : "a verb is missing, and ",
                     stl::shortened(option), any_verb ? "the verb" : "one", meant_option(option, app));
}

/// Verbs that take frames or actions behind PROGRAM have `--with` for the other files of a project; for the others they stand
/// there as words.
std::string files_are_words(std::string_view option, const CLI::App& verb) {
  const CLI::Option* program = verb.get_option_no_throw("PROGRAM");
  const bool takes_files = program != nullptr && program->get_items_expected_max() > 1;
  return option == "--with" && takes_files ? " here; other files of the project are named behind PROGRAM, without an option" : "";
}

/// Of words that a verb does not take: `there is no option --cup; did you mean --cpu?`, or that one is too many.
std::string not_expected(const CLI::App& verb) {
  const std::vector<std::string> words = verb.remaining();
  const auto option = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with("-"); });
  if (option == words.end())
    return fmt::format("'{}' is one word too many here", stl::shortened(words.empty() ? "" : words.back()));
  const std::string name = option->substr(0, option->find('='));
  const std::string files = files_are_words(name, verb);
  return fmt::format("there is no option {}{}", stl::shortened(name), files.empty() ? meant_option(*option, verb) : files);
}

/// Of CLI11 what stands around a name or a value in a message, and what we say instead: `{0}` is in front of `between`,
/// `{1}` behind it.
struct ParserWords {
  std::string_view before, between, after, ours;
};

constexpr ParserWords kParserWords[] = {
    {"", " is required", "", "{0} is missing"},
    {"", ": 1 required ", " missing", "{0} needs a value: {1}"},
    {"", ": At Most 1 required but received ", "", "{0} stands here {1} times, and takes one value"},
    {"", ": At least 1 required but received 0", "", "{0} needs a value"},
    {"", " was given a disallowed flag override", "", "{0} takes no value"},
    {"", ": Should be true/false or a number", "", "{0} takes no value"},
    {"", ": too many inputs for a flag", "", "{0} takes no value"},
    {"Could not convert: ", " = ", "", "{0} does not take '{1}'"},
    {"The value ", " is not an allowed value for ", "", "{1} does not take '{0}'"},
    {"", " not in {", "}", "{0} is not one of {1}"},
};

/// Nothing if the message is not of these words.
std::optional<std::string> translated(std::string_view text, const ParserWords& words) {
  if (!text.starts_with(words.before) || !text.ends_with(words.after)) return {};
  text.remove_prefix(words.before.size());
  text.remove_suffix(words.after.size());
  const std::size_t place = words.between.empty() ? text.size() : text.find(words.between);
  if (place == std::string_view::npos) return {};
  const std::string_view rest = text.substr(place + words.between.size());
  if (words.after.empty() && words.ours.find("{1}") == std::string_view::npos && !rest.empty()) return {};
  return fmt::format(fmt::runtime(words.ours), text.substr(0, place), rest);
}

}  // namespace

std::vector<const CLI::App*> listed_verbs(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

std::vector<std::string> as_options(const CLI::App& app, std::vector<std::string> arguments) {
  const std::vector<std::string> verbs = names_of(listed_verbs(app)), all = names_of(app.get_subcommands({}));
  const auto is_verb = [&](const std::string& word) { return std::find(all.begin(), all.end(), word) != all.end(); };
  if (arguments.empty())
    throw CLI::ParseError("the verb is missing; " + there_are({verbs.begin(), verbs.end()}), CLI::ExitCodes::RequiredError);
  if (arguments[0] == "version") arguments[0] = "--version";
  if (arguments[0].starts_with('-') && app.get_option_no_throw(arguments[0]) == nullptr) {
    const bool any_verb = std::any_of(arguments.begin(), arguments.end(), is_verb);
    throw CLI::ParseError(not_an_option(arguments[0], app, any_verb), CLI::ExitCodes::ExtrasError);
  }
  if (!arguments[0].starts_with('-') && !is_verb(arguments[0]))
    throw CLI::ParseError(not_a_verb(arguments[0], verbs), CLI::ExitCodes::ExtrasError);
  return arguments;
}

void refuse_empty_values(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands({}))
    for (CLI::Option* option : verb->get_options())
      if (option->get_items_expected_max() > 0 && !option->get_positional())
        option->check([](const std::string& given) { return given.empty() ? "a value is missing" : ""; });
}

std::string usage_error(const CLI::App* app, const CLI::Error& error) {
  const auto verbs = app->get_subcommands();
  const std::string command = verbs.empty() ? app->get_name() : fmt::format("{} {}", app->get_name(), verbs[0]->get_name());
  return fmt::format("s7200: error: {}\n'{} --help' shows how it is used\n",
                     in_our_words(error, verbs.empty() ? *app : *verbs[0]), command);
}

std::string in_our_words(const CLI::Error& error, const CLI::App& verb) {
  if (std::string_view(error.what()).starts_with("The following argument")) return not_expected(verb);
  for (const ParserWords& words : kParserWords)
    if (auto ours = translated(error.what(), words)) return *std::move(ours);
  return error.what();
}

}  // namespace s7200::tools
