// A run written down as a scenario: a transcript, which replayed must give the same again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/limits.hpp"
#include "tools/scenario/reporting/report.hpp"

namespace s7200::tools {

struct Transcript {
  std::string path{};           ///< of the file to be: paths in it are relative to its folder
  std::string recorded_from{};  ///< what answered, for the heading
  Time tolerance = 0;           ///< 0 for programs: their times are exact
  bool live = false;            ///< from a slave outside simulation
  bool memory = false;          ///< what steps expect of memory is written too
  std::string by = "s7200 test --record";
};

/// Every request as it was sent, when, what came and after how long, and what was done to the plant in between.
/// From a slave that is not a program, the pauses between exchanges stand for the instants, and nothing is written of the
/// inside of a PLC that was not reached: so that it can be replayed there and in simulation. Replayed on the same program
/// the transcript gives the same bit by bit and to the nanosecond.
std::string transcript_text(const std::vector<Report>& reports, const Transcript& transcript);

/// What stands before the scenarios.
std::string transcript_heading(const Transcript& transcript);

/// Why a transcript of so many bytes could not be replayed; empty if it can.
std::string why_not_replayed(std::size_t bytes);

/// The same of these scenarios: one without any could not be replayed either, and is not written over another.
std::string why_not_recorded(const std::vector<Report>& reports, std::size_t bytes);

}  // namespace s7200::tools
