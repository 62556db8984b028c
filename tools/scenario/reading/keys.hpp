// The words of the format: what may be written where, and what it means. The description of the format is made of them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

/// One row of the format.
struct ScenarioKey {
  enum class Where : std::uint8_t {
    File,      ///< at the top of a file only
    Scenario,  ///< of a scenario; at the top of a file for all its scenarios
    Line,      ///< inside `line:`
    OfStep,    ///< makes a step; the rows are in steps/steps.cpp
    Modifier,  ///< stands beside an action
  };
  static constexpr std::string_view kOfOneProgram = "program";
  Where where{};
  std::string_view key;
  /// Of a Modifier: the actions it goes with, with blanks between; empty: all of them. Of a Scenario's: kOfOneProgram if a
  /// system file says that of each PLC.
  std::string_view of;
  std::string_view form;
  std::string_view meaning;

  /// Whether it has a place in one of these, beside `action`.
  bool belongs(std::initializer_list<Where> places, std::string_view action) const;
};
const std::vector<ScenarioKey>& scenario_keys();

/// The table as Markdown, for the description of the format.
std::string scenario_keys_markdown();

}  // namespace s7200::tools
