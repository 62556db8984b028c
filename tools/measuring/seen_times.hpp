// The largest times that a program takes in a run with random inputs and characters, to set beside its bounds.
#pragma once

#include <optional>

#include "interpreter/model/times/times.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// Two seconds of simulated time, with other inputs and a character on each port every few milliseconds; the same for the
/// same program. Nothing if the program has errors.
std::optional<SeenTimes> seen_times(const Inspection& inspection);

/// A table with the longest times that its uncertainties allow.
TimeTable slowest(const TimeTable& times);

}  // namespace s7200::tools
