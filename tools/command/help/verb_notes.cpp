#include "tools/command/help/verb_notes.hpp"

#include <CLI/StringTools.hpp>
#include <string_view>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

VerbNotes::VerbNotes(const std::string& footer) {
  constexpr std::string_view kExample = "Example: ", kTopics = "Topics: ", kExitCode = "Exit code";
  for (const std::string& line : stl::split_lines(footer)) {
    if (line.starts_with(kExample))
      examples.push_back(line.substr(kExample.size()));
    else if (line.starts_with(kTopics))
      for (std::string& topic : CLI::detail::split(line.substr(kTopics.size()), ','))
        topics.push_back(CLI::detail::trim(topic));
    else
      (line.starts_with(kExitCode) ? exit_codes : notes).push_back(line);
  }
}

}  // namespace s7200::tools
