#include "tools/command/help/manual_page.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/command/help/help_text.hpp"
#include "tools/command/help/help_topics.hpp"
#include "tools/command/help/verb_notes.hpp"
#include "tools/command/usage.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// For roff, every character as it is: a hyphen stays one, and outside ASCII characters have their numbers.
std::string literal(std::string_view text) {
  std::string page;
  for (const stl::Character character : stl::characters(text)) {
    switch (character.code) {
      case '\\':
        page += "\\(rs";
        break;
      case '-':
        page += "\\-";
        break;
      case '\'':
        page += "\\(aq";
        break;
      case '`':
        page += "\\(ga";
        break;
      case '^':
        page += "\\(ha";
        break;
      case '~':
        page += "\\(ti";
        break;
      default:
        page += character.code < 0x80 ? std::string(1, static_cast<char>(character.code))
                                      : fmt::format("\\[u{:04X}]", static_cast<std::uint32_t>(character.code));
    }
  }
  return page;
}

/// A line of text. A dot or a quote at its beginning would be a request of roff.
std::string text_line(std::string_view text) { return fmt::format("\\&{}\n", literal(text)); }

/// Lines that keep their columns.
std::string as_typed(const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string page = ".EX\n";
  for (const std::string& line : lines) page += text_line(line);
  return page + ".EE\n";
}

std::string section(std::string_view name, std::string_view text) {
  return text.empty() ? std::string() : fmt::format(".SH {}\n{}", name, text);
}

std::string entry(std::string_view head, std::string_view meaning) {
  return fmt::format(".TP\n{}\n{}", head, text_line(meaning));
}

std::string bold(std::string_view text) { return fmt::format("\\fB{}\\fR", literal(text)); }
std::string italic(std::string_view text) { return fmt::format("\\fI{}\\fR", literal(text)); }

std::string paragraphs(const std::vector<std::string>& lines) {
  std::string page;
  for (const std::string& line : lines) page += (page.empty() ? "" : ".PP\n") + text_line(line);
  return page;
}

/// `--cpu TYPE`, `-o,--output FILE`
std::string italic_head_of(const CLI::Option& option) {
  if (option.get_positional()) return italic(option.get_name());
  const std::string value = value_name(option);
  return bold(option.get_name(false, true)) + (value.empty() ? "" : " " + italic(value));
}

std::string entries(const std::vector<const CLI::Option*>& options) {
  std::string page;
  for (const CLI::Option* option : options) page += entry(italic_head_of(*option), meaning_of(*option));
  return page;
}

std::string options_of(const CLI::App& app) {
  std::string page;
  for (const OptionGroup& group : option_groups(app)) {
    const std::string heading = group.heading == "Options" ? "" : fmt::format(".SS \"{}\"\n", literal(group.heading));
    page += heading + entries(group.options);
  }
  return page;
}

/// The lists that the verb refers to, each with its name as a heading.
std::string topics_of(const VerbNotes& notes) {
  constexpr std::size_t kColumns = 76;  // in lines of 80, with the indentation of a page
  std::string page;
  for (const std::string& name : notes.topics)
    page += fmt::format(".SS \"{}\"\n", literal(name)) +
            as_typed(stl::split_lines(stl::wrapped(find_help_topic(name)->text(), kColumns)));
  return page;
}

std::string title(std::string_view name, std::string_view meaning) {
  std::string upper(name);
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  // .nr HY 0: no word is divided, so that the names of pages and options can be searched for.
  return fmt::format(".TH {} 1 \"\" \"s7200 {}\" \"User Commands\"\n.nr HY 0\n", literal(upper), version()) +
         section("NAME", fmt::format("{} \\- {}\n", literal(name), literal(meaning)));
}

}  // namespace

std::string page_of_command(const CLI::App& app) {
  const VerbNotes notes(app.get_footer());
  std::string verbs, topics, pages;
  for (const CLI::App* verb : listed_verbs(app)) {
    verbs += entry(bold(verb->get_name()), verb->get_description());
    pages += fmt::format("{}.BR {} (1)", pages.empty() ? "" : ",\n", literal("s7200-" + verb->get_name()));
  }
  for (const HelpTopic& topic : help_topics()) topics += entry(bold(fmt::format("help {}", topic.name)), topic.meaning);
  return title("s7200", "run SIMATIC S7-200 STL programs in simulated time") +
         section("SYNOPSIS", bold("s7200") + " " + italic("VERB") + " " + literal(synopsis_of(app)) + "\n") +
         section("DESCRIPTION", text_line(app.get_description()) + paragraphs(notes.notes)) + section("VERBS", verbs) +
         section("TOPICS", topics) + section("OPTIONS", options_of(app)) +
         section("EXIT STATUS", paragraphs(notes.exit_codes)) + section("EXAMPLES", as_typed(notes.examples)) +
         section("SEE ALSO", pages + "\n");
}

std::string page_of_verb(const CLI::App& app, const CLI::App& verb) {
  const VerbNotes notes(verb.get_footer()), common(app.get_footer());
  const auto& exit_codes = notes.exit_codes.empty() ? common.exit_codes : notes.exit_codes;
  return title("s7200-" + verb.get_name(), verb.get_description()) +
         section("SYNOPSIS", bold("s7200 " + verb.get_name()) + " " + literal(synopsis_of(verb)) + "\n") +
         section("ARGUMENTS", entries(words_of(verb))) + section("OPTIONS", options_of(verb)) +
         section("NOTES", paragraphs(notes.notes) + topics_of(notes)) + section("EXIT STATUS", paragraphs(exit_codes)) +
         section("EXAMPLES", as_typed(notes.examples)) + section("SEE ALSO", ".BR s7200 (1)\n");
}

}  // namespace s7200::tools
