// The long lists of the help, each in one place: `s7200 help TOPIC`.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace s7200::tools {

struct HelpTopic {
  std::string_view name;
  std::string_view meaning;  ///< for the list of topics
  std::string (*text)();     ///< in lines of any length; a longer one goes on below its last column
};
std::span<const HelpTopic> help_topics();

/// Null for a name that no topic has.
const HelpTopic* find_help_topic(std::string_view name);

}  // namespace s7200::tools
