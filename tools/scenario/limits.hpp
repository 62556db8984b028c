// How much a file of scenarios may have: nothing that comes from outside makes a run grow without bounds.
#pragma once

#include <cstddef>
#include <string_view>

#include "tools/yaml/yaml.hpp"

namespace s7200::tools {

struct Limits {
  std::size_t bytes = YamlDocument{}.bytes;
  std::size_t nodes = YamlDocument{}.nodes;  ///< of its YAML
  std::size_t steps = 20'000;                ///< with its loops run out
};

/// How the first line of a transcript begins, and that of a recording made a scenario.
inline constexpr std::string_view kTranscriptBeginning = "# Recorded from", kImportBeginning = "# Imported from";

inline constexpr std::size_t kLongestTranscript = 32 << 20;  ///< bytes

/// Both may be as long as what was recorded. It says everything once, so the text itself bounds the rest: as many
/// steps as it has, and no node in fewer than four bytes.
Limits limits_of(std::string_view text);

}  // namespace s7200::tools
