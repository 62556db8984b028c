// Scenarios out of YAML. What may be written where is in keys.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/scenario/reading/keys.hpp"
#include "tools/scenario/reading/parameters.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

struct ScenarioFile {
  std::shared_ptr<const stl::SourceLines> source{};
  std::vector<Scenario> scenarios{};
  stl::Diagnostics diagnostics{};        ///< all mistakes of the file; nothing is to be run if there is any
  stl::Diagnostics given_diagnostics{};  ///< of the parameters given
};

/// Reads a file's text. `path` is for messages, and paths in it are relative to its folder. Loops are run out, `${…}` are
/// put in: what comes out is plain. limits.hpp says how much it may have; loops are kDeepestLoop deep.
ScenarioFile read_scenarios(const std::string& text, const std::string& path, const GivenParameters* given = nullptr);

}  // namespace s7200::tools
