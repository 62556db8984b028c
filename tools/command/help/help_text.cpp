#include "tools/command/help/help_text.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/command/help/help_topics.hpp"
#include "tools/command/help/verb_notes.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/usage.hpp"

namespace s7200::tools {
namespace {

/// Where the meanings begin.
constexpr std::size_t kMeaning = 30;

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::ranges::sort(names);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// `even, none, odd`; empty if the option takes other values too.
std::string choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find(":{"), end = type.rfind('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return fmt::format("{}", fmt::join(CLI::detail::split(type.substr(begin + 2, end - begin - 2), ','), ", "));
}

/// What the description of an option says, in parts.
struct Meaning {
  explicit Meaning(const CLI::Option& option) : text(option.get_description()) {
    if (const std::string values = choices_of(option); !values.empty()) choices = ": " + values;
    const std::size_t bracket = text.ends_with(']') ? text.rfind(" [") : std::string::npos;
    if (bracket != std::string::npos) {
      standard = text.substr(bracket);
      text.erase(bracket);
    }
    if (!option.get_default_str().empty()) standard = fmt::format(" [{}]", option.get_default_str());
  }

  std::string text, choices;
  std::string standard;  ///< what holds without the option, in brackets
};

/// For `--help`: up to a semicolon, and with the standard as far as that fits into a line of `room` characters.
std::string short_meaning_of(const CLI::Option& option, std::size_t room) {
  const Meaning meaning(option);
  const std::string text = meaning.text.substr(0, meaning.text.find("; ")) + meaning.choices;
  return stl::count_characters(text + meaning.standard) <= room ? text + meaning.standard : text;
}

std::string line_of(const std::string& head, const std::string& meaning, std::size_t width) {
  const std::size_t used = 2 + stl::count_characters(head);
  const std::string gap = used < kMeaning ? std::string(kMeaning - used, ' ') : "\n" + std::string(kMeaning, ' ');
  return stl::wrapped(fmt::format("  {}{}{}\n", head, gap, meaning), width, kMeaning);
}

std::string head_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name() + (option.get_items_expected_max() > 1 ? "..." : "");
  const std::string value = value_name(option);
  return option.get_name(false, true) + (value.empty() ? "" : " " + value);
}

std::string lines_of(const std::vector<const CLI::Option*>& options, bool all, std::size_t width) {
  const std::size_t room = width > kMeaning ? width - kMeaning : 0;
  std::string text;
  for (const CLI::Option* option : options)
    text += line_of(head_of(*option), all ? meaning_of(*option) : short_meaning_of(*option, room), width);
  return text;
}

std::string examples_of(const VerbNotes& notes) {
  std::string text;
  for (const std::string& example : notes.examples) text += fmt::format("Example: {}\n", example);
  return text;
}

std::string paragraphs(const std::vector<std::string>& lines, std::size_t width) {
  std::string text;
  for (const std::string& line : lines) text += stl::wrapped(line + '\n', width);
  return text;
}

/// `More: s7200 run --help-all shows all 54 options; s7200 help faults, bridges or systems`
std::string where_more_is(const CLI::App& verb, const VerbNotes& notes, bool all, std::size_t width) {
  std::string text;
  if (!all) {
    const auto options = verb.get_options(
        [](const CLI::Option* option) { return !option->get_positional() && option->get_group() != help_group::kNone; });
    text = fmt::format("s7200 {} --help-all shows all {} options", verb.get_name(), options.size());
  }
  if (!notes.topics.empty())
    text += fmt::format("{}s7200 help TOPIC has the lists: {}", text.empty() ? "" : "; ", fmt::join(notes.topics, ", "));
  return text.empty() ? text : stl::wrapped(text + '\n', width);
}

std::string help_of_verb(const CLI::App& verb, bool all, std::size_t width) {
  const VerbNotes notes(verb.get_footer());
  std::string text = stl::wrapped(verb.get_description() + '\n', width);
  text += fmt::format("Usage: s7200 {} {}\n{}", verb.get_name(), synopsis_of(verb), examples_of(notes));
  if (const auto words = words_of(verb); !words.empty()) text += "\n" + lines_of(words, all, width);
  for (const OptionGroup& group : option_groups(verb))
    if (all || group.often)
      text += fmt::format("{}{}{}", all ? "\n" : "", stl::wrapped(group.heading + ":\n", width),
                          lines_of(group.options, all, width));
  text += "\n";
  if (all) text += paragraphs(notes.notes, width) + paragraphs(notes.exit_codes, width);
  return text + where_more_is(verb, notes, all, width);
}

std::string help_of_command(const CLI::App& app, std::size_t width) {
  const VerbNotes notes(app.get_footer());
  std::string text = stl::wrapped(app.get_description() + '\n', width);
  text += fmt::format("Usage: s7200 VERB …, and for each verb s7200 VERB --help\n{}Verbs:\n", examples_of(notes));
  for (const CLI::App* verb : listed_verbs(app)) text += line_of(verb->get_name(), verb->get_description(), width);
  text += "Topics, shown by s7200 help TOPIC:\n";
  for (const HelpTopic& topic : help_topics()) text += line_of(std::string(topic.name), std::string(topic.meaning), width);
  return text + paragraphs(notes.exit_codes, width);
}

class HelpLayout final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode mode) const override {
    const std::size_t width = std::min(output_width(), stl::kUsualWidth);
    return app->get_parent() == nullptr ? help_of_command(*app, width)
                                        : help_of_verb(*app, mode == CLI::AppFormatMode::All, width);
  }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_layout() { return std::make_shared<HelpLayout>(); }

std::vector<OptionGroup> option_groups(const CLI::App& app) {
  const auto in_group = [&](const std::string& group) {
    return app.get_options(
        [&](const CLI::Option* option) { return option->get_group() == group && !option->get_positional(); });
  };
  std::vector<OptionGroup> groups;
  const auto add = [&](const std::string& group, const std::string& heading, bool often) {
    if (auto options = in_group(group); !options.empty()) groups.push_back({heading, often, std::move(options)});
  };
  const std::string without_heading = help_group::kMore;
  for (const char* group : help_group::kAll) add(group, group, true);
  for (const std::string& group : app.get_groups())
    if (group != without_heading && group != help_group::kNone &&
        std::ranges::find(help_group::kAll, group) == help_group::kAll.end())
      add(group, group, false);
  add(without_heading, groups.empty() ? "Options" : "More options", groups.empty());
  return groups;
}

std::vector<const CLI::Option*> words_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::string synopsis_of(const CLI::App& app) {
  std::string line = "[OPTIONS]";
  for (const CLI::Option* option : words_of(app))
    line += option->get_required() ? fmt::format(" {}", head_of(*option)) : fmt::format(" [{}]", head_of(*option));
  return line;
}

std::string value_name(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(":{"));
}

std::string meaning_of(const CLI::Option& option) {
  const Meaning meaning(option);
  std::string text = meaning.text + meaning.choices + meaning.standard;
  if (!option.get_needs().empty()) text += "; needs " + names_of(option.get_needs());
  if (!option.get_excludes().empty()) text += "; not with " + names_of(option.get_excludes());
  return text;
}

}  // namespace s7200::tools
