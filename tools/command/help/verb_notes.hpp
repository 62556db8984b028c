// What a verb says of itself beside its options, for its help and its manual page.
#pragma once

#include <string>
#include <vector>

namespace s7200::tools {

/// The footer of a verb, by the words that its lines begin with: `Example: …`, `Exit code…`, `Topics: faults, bridges`. All
/// other lines are notes, a paragraph each.
struct VerbNotes {
  explicit VerbNotes(const std::string& footer);

  std::vector<std::string> notes, exit_codes;
  std::vector<std::string> examples;  ///< command lines
  std::vector<std::string> topics;    ///< names of help topics
};

}  // namespace s7200::tools
