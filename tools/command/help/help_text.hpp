// What `--help` and `--help-all` print: the one place where help is laid out.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class FormatterBase;
class Option;
}  // namespace CLI

namespace s7200::tools {

/// Lays out the help of the command and of its verbs, no wider than the terminal and than stl::kUsualWidth: `--help` with
/// the options in the groups of help_groups.hpp, `--help-all` with all of them.
std::shared_ptr<CLI::FormatterBase> help_layout();

/// A heading of the help with its options, none of which is a word without a name.
struct OptionGroup {
  std::string heading;
  bool often;  ///< whether `--help` shows it
  std::vector<const CLI::Option*> options;
};

/// The groups of a verb: those of help_groups.hpp first, then those with a heading of their own, then what is left.
std::vector<OptionGroup> option_groups(const CLI::App& app);

/// The words of a verb that are not options, in their order.
std::vector<const CLI::Option*> words_of(const CLI::App& app);

/// `[OPTIONS] PROGRAM [HEX...]`
std::string synopsis_of(const CLI::App& app);

/// `FILE`, without the choices; empty for an option that takes no value.
std::string value_name(const CLI::Option& option);

/// What an option does, with the values that it takes and the option that it needs.
std::string meaning_of(const CLI::Option& option);

}  // namespace s7200::tools
