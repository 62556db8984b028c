#include "tools/command/manual_page.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "interpreter/base/text.hpp"
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

/// What the help says at its end, by what it is about.
struct Footer {
  std::vector<std::string> notes, exit_codes, examples;

  explicit Footer(const std::string& footer) {
    std::vector<std::string>* part = &notes;
    for (std::string line : stl::split_lines(footer)) {
      if (line.starts_with("Exit code")) part = &exit_codes;
      if (line.starts_with(kExample)) {
        part = &examples;
        line.erase(0, kExample.size());
      }
      part->push_back(line);
    }
  }

 private:
  static constexpr std::string_view kExample = "Example: ";
};

std::string filled(const std::vector<std::string>& lines) {
  std::string page;
  for (const std::string& line : lines) page += text_line(line);
  return page;
}

/// `--cpu TYPE=214`, `-o,--output FILE`
std::string head_of(const CLI::Option& option) {
  if (option.get_positional()) return italic(option.get_name());
  std::string head = bold(option.get_name(false, true));
  if (option.get_items_expected_max() == 0) return head;
  head += " " + italic(option.get_type_name());
  if (!option.get_default_str().empty()) head += literal("=" + option.get_default_str());
  return head;
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::ranges::sort(names);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string meaning_of(const CLI::Option& option) {
  std::string meaning = option.get_description();
  if (!option.get_needs().empty()) meaning += "; needs " + names_of(option.get_needs());
  if (!option.get_excludes().empty()) meaning += "; excludes " + names_of(option.get_excludes());
  return meaning;
}

std::string entries(const std::vector<const CLI::Option*>& options) {
  std::string page;
  for (const CLI::Option* option : options) page += entry(head_of(*option), meaning_of(*option));
  return page;
}

std::string arguments_of(const CLI::App& app) {
  return entries(app.get_options([](const CLI::Option* option) { return option->get_positional(); }));
}

/// The groups of the help, those with a heading of their own below it.
std::string options_of(const CLI::App& app) {
  std::string page;
  for (const std::string& group : app.get_groups()) {
    const std::string of_group = entries(app.get_options(
        [&](const CLI::Option* option) { return option->get_group() == group && !option->get_positional(); }));
    if (group.empty() || of_group.empty()) continue;
    if (group != "Options") page += fmt::format(".SS \"{}\"\n", literal(group));
    page += of_group;
  }
  return page;
}

std::string synopsis(const CLI::App& app) {
  std::string line = " [" + italic("OPTIONS") + "]";
  for (const CLI::Option* option : app.get_options([](const CLI::Option* each) { return each->get_positional(); })) {
    const std::string name = italic(option->get_name()) + (option->get_items_expected_max() > 1 ? "..." : "");
    line += option->get_required() ? " " + name : " [" + name + "]";
  }
  return line;
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
  const Footer footer(app.get_footer());
  std::string verbs, pages;
  for (const CLI::App* verb : listed_verbs(app)) {
    verbs += entry(bold(verb->get_name()), verb->get_description());
    pages += fmt::format("{}.BR s7200\\-{} (1)", pages.empty() ? "" : ",\n", verb->get_name());
  }
  return title("s7200", "run SIMATIC S7-200 STL programs in simulated time") +
         section("SYNOPSIS", bold("s7200") + " " + italic("VERB") + synopsis(app) + "\n") +
         section("DESCRIPTION", text_line(app.get_description()) + filled(footer.notes)) + section("VERBS", verbs) +
         section("OPTIONS", options_of(app)) + section("EXIT STATUS", filled(footer.exit_codes)) +
         section("EXAMPLES", as_typed(footer.examples)) + section("SEE ALSO", pages + "\n");
}

std::string page_of_verb(const CLI::App& app, const CLI::App& verb) {
  const Footer footer(verb.get_footer()), common(app.get_footer());
  const auto& exit_codes = footer.exit_codes.empty() ? common.exit_codes : footer.exit_codes;
  return title("s7200-" + verb.get_name(), verb.get_description()) +
         section("SYNOPSIS", bold("s7200 " + verb.get_name()) + synopsis(verb) + "\n") +
         section("ARGUMENTS", arguments_of(verb)) + section("OPTIONS", options_of(verb)) +
         section("NOTES", as_typed(footer.notes)) + section("EXIT STATUS", filled(exit_codes)) +
         section("EXAMPLES", as_typed(footer.examples)) + section("SEE ALSO", ".BR s7200 (1)\n");
}

}  // namespace s7200::tools
