// What people type before they have read the help, and what they are told then.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace s7200::tools {

/// The verbs that the help lists.
std::vector<const CLI::App*> listed_verbs(const CLI::App& app);

/// The arguments as CLI11 knows them: `version` is `--version`. Throws a CLI::ParseError, with
/// the verb that was probably meant, if the first is neither an option nor a verb.
std::vector<std::string> as_options(const CLI::App& app, std::vector<std::string> arguments);

/// No option of any verb takes an empty value: most often that is a shell variable that is not set.
void refuse_empty_values(CLI::App& app);

/// A usage error, and where the right usage is told.
std::string usage_error(const CLI::App* app, const CLI::Error& error);

/// What is wrong with the words that a verb has parsed, in our words: what CLI11 says is for programmers. What an option's
/// own check says stays as it is.
std::string in_our_words(const CLI::Error& error, const CLI::App& verb);

}  // namespace s7200::tools
