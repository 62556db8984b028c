// A run written down as a scenario: a transcript, which replayed must give the same again.
#pragma once

#include <string>
#include <vector>

#include "tools/scenario_report.hpp"

namespace s7200::tools {

struct Transcript {
  std::string path{};           ///< of the file to be: paths in it are relative to its folder
  std::string recorded_from{};  ///< what answered, for the heading
  Time tolerance = 0;           ///< 0 for programs: their times are exact
};

/// Every request as it was sent, when, what came and after how long, and what was done to the plant in between.
/// Replayed on the same program the transcript gives the same bit by bit and to the nanosecond.
std::string transcript_text(const std::vector<Report>& reports, const Transcript& transcript);

}  // namespace s7200::tools
