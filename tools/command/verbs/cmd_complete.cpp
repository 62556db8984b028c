#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "tools/command/exit_code.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/usage.hpp"
#include "tools/command/verbs/derived_verbs.hpp"

namespace s7200::tools {
namespace {

struct Candidate {
  std::string word, meaning;
};
using Candidates = std::vector<Candidate>;

Candidates verbs_of(CLI::App& app) {
  Candidates found;
  for (const CLI::App* verb : listed_verbs(app)) found.push_back({verb->get_name(), verb->get_description()});
  return found;
}

Candidates options_of(CLI::App& verb) {
  Candidates found;
  const auto is_shown = [](const CLI::Option* option) { return option->get_group() != help_group::kNone; };
  for (const CLI::Option* option : std::as_const(verb).get_options(is_shown))
    for (const std::string& name : option->get_lnames()) found.push_back({"--" + name, option->get_description()});
  return found;
}

/// `before` the value stands `--name=`.
Candidates values_of(CLI::Option& option, const std::string& typed, const std::vector<std::string>& words,
                     const std::string& before = "") {
  Candidates found;
  for (const std::string& value : offered_by(option, typed, words)) found.push_back({before + value, ""});
  return found;
}

bool takes_value(const CLI::Option* option) { return option != nullptr && option->get_items_expected_max() > 0; }

/// What the last word is.
struct WordAtCursor {
  CLI::Option* value_of = nullptr;  ///< the value of this option
  std::size_t positional = 0;       ///< or what stands after so many that are neither options nor their values
};

WordAtCursor place_of_last(CLI::App& verb, const std::vector<std::string>& words) {
  WordAtCursor place;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    CLI::Option* option = words[i].starts_with('-') ? verb.get_option_no_throw(words[i]) : nullptr;
    if (place.value_of == nullptr && !words[i].starts_with('-')) ++place.positional;
    place.value_of = place.value_of == nullptr && takes_value(option) ? option : nullptr;
  }
  return place;
}

/// The last of them if there are less.
CLI::Option* positional_at(CLI::App& verb, std::size_t number) {
  CLI::Option* found = nullptr;
  for (CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    found = option;
    if (number-- == 0) break;
  }
  return found;
}

/// `words` are those after the verb, of which the last is being typed.
Candidates candidates_of(CLI::App& verb, const std::vector<std::string>& words) {
  const std::string& last = words.back();
  const WordAtCursor place = place_of_last(verb, words);
  if (place.value_of != nullptr) return values_of(*place.value_of, last, words);
  const std::size_t equals = last.find('=');
  if (last.starts_with("--") && equals != std::string::npos) {
    CLI::Option* option = verb.get_option_no_throw(last.substr(0, equals));
    return takes_value(option) ? values_of(*option, last.substr(equals + 1), words, last.substr(0, equals + 1))
                               : Candidates{};
  }
  CLI::Option* positional = positional_at(verb, place.positional);
  if (last.starts_with('-') || positional == nullptr) return options_of(verb);
  return values_of(*positional, last, words);
}

Candidates candidates(CLI::App& app, std::vector<std::string> words) {
  if (words.empty()) words.emplace_back();
  const std::string first = words.front();
  if (words.size() == 1) return first.starts_with('-') ? options_of(app) : verbs_of(app);
  const auto named = app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == first; });
  words.erase(words.begin());
  return named.empty() ? Candidates{} : candidates_of(*named.front(), words);
}

}  // namespace

void derive_complete(CLI::App& app, int& exit_code) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* verb = app.add_subcommand("complete", "print what the last of the words on a command line may be")->group("");
  verb->add_option("WORD", *words, "the words after s7200 up to the one that is being typed; -- comes before them");
  verb->footer(
      "Prints nothing where a file may stand, or any value.\n"
      "Example: s7200 complete -- run --cpu 2");
  verb->callback([&app, words, &exit_code] {
    const std::string typed = words->empty() ? "" : words->back();
    for (const auto& [word, meaning] : candidates(app, *words))
      if (word.starts_with(typed)) fmt::print("{}{}{}\n", word, meaning.empty() ? "" : "\t", meaning);
    exit_code = kFine;
  });
}

}  // namespace s7200::tools
