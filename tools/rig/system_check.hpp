// What is wrong or doubtful about a system as a whole, which none of the parts of its file shows.
#pragma once

#include <vector>

#include "tools/rig/system_reading.hpp"

namespace s7200::tools {

struct TimedEvent {
  EventPlan plan;
  const YamlNode* node;  ///< that says it
};

/// Complains about PLCs, peers and bridges that are on no line.
void check_system(SystemReading& reading);

/// What a real network lets one do by mistake, so the system runs: stations that are the same, several PPI masters, power
/// that is on already. `events` are in the order of time.
void warn_of_system(SystemReading& reading, const std::vector<TimedEvent>& events);

}  // namespace s7200::tools
