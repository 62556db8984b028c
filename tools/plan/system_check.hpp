// The errors and doubts about a system as a whole, which no single part of its file shows.
#pragma once

#include <vector>

#include "tools/plan/reading/system_reading.hpp"

namespace s7200::tools {

struct TimedEvent {
  EventPlan plan;
  const YamlNode* node;  ///< that says it
};

/// Complains about PLCs, peers and bridges that are on no line.
void check_system(SystemReading& reading);

/// Warns of mistakes that a real network permits, so that the system runs: equal stations, several PPI masters, power that
/// is on already. `events` are in the order of time.
void warn_of_system(SystemReading& reading, const std::vector<TimedEvent>& events);

}  // namespace s7200::tools
