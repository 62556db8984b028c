// The two programs of `s7200 compare`, with the files that belong to one of them or to both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/command/options/plc/program_options.hpp"

namespace s7200::tools {

struct ComparedFiles {
  std::vector<std::string> words;                 ///< both programs, and parts of both projects
  std::vector<std::string> old_parts, new_parts;  ///< parts of one of them

  std::vector<std::string> all() const;
};

struct OldAndNew {
  ProgramFiles older, newer;
  std::vector<std::string> old_parts;  ///< paths of the other files of the old project
};

/// Reads them; nothing after a message.
std::optional<OldAndNew> read_compared(const ComparedFiles& files);

}  // namespace s7200::tools
