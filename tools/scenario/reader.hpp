// Scenarios out of YAML. The keys, and what may be written behind them, are one table: scenario_keys().
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/scenario.hpp"
#include "tools/scenario/text.hpp"

namespace s7200::tools {

/// Values for the `${…}` of scenarios that were given from outside: a YAML map, of maps, lists and scalars.
struct GivenParameters {
  struct Name {
    std::string name;
    stl::Position position{};
  };
  std::shared_ptr<const stl::SourceLines> source{};
  Parameters parameters{};
  std::vector<Name> names{};
};

/// `program` and `times` in it are paths, relative to the folder of `path`, and come out as paths that can be opened.
/// Nothing, and `diagnostics` for the text of `path`, if it has errors.
std::optional<GivenParameters> read_parameters(const std::string& text, const std::string& path,
                                               stl::Diagnostics& diagnostics);

struct ScenarioFile {
  std::shared_ptr<const stl::SourceLines> source{};
  std::vector<Scenario> scenarios{};
  stl::Diagnostics diagnostics{};        ///< all mistakes of the file; nothing is to be run if there is any
  stl::Diagnostics given_diagnostics{};  ///< of the parameters given
};

/// Reads a file's text. `path` is for messages, and paths in it are relative to its folder. Loops are run out, `${…}` are
/// put in: what comes out is plain. At most kMostSteps steps, in loops kDeepestLoop deep.
ScenarioFile read_scenarios(const std::string& text, const std::string& path, const GivenParameters* given = nullptr);

inline constexpr std::size_t kMostSteps = 20'000;
inline constexpr int kDeepestLoop = 5;

/// One row of the format.
struct ScenarioKey {
  enum class Where : std::uint8_t {
    File,      ///< at the top of a file only
    Scenario,  ///< of a scenario; at the top of a file for all its scenarios
    Line,      ///< inside `line:`
    Action,    ///< makes a step
    Modifier,  ///< stands beside an action
  };
  Where where{};
  std::string_view key;
  std::string_view of;  ///< of a Modifier: the actions it goes with, with blanks between; empty: all of them
  std::string_view form;
  std::string_view meaning;
};
const std::vector<ScenarioKey>& scenario_keys();

/// The table as Markdown, for the description of the format.
std::string scenario_keys_markdown();

}  // namespace s7200::tools
