// What the faults of a line have done.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serial_sim/faults/faults.hpp"

namespace s7200::tools {

/// `a pause before a character: character=2, of=request`: what it does, and where, as far as its text leaves that out.
std::string described(const serial::Fault& fault);

/// What has happened so far, a line for each fault.
std::vector<std::string> fault_notes(const serial::Faults& faults);

/// The same of what has happened since then: `fault missing:of=answer: 2×`. A line that was cut then, and still is, counts
/// too.
std::vector<std::string> fault_notes(const serial::Faults& faults, const serial::Faults::State& since, Time now);

/// [{"fault": "flip:bit=3", "count": 2, "impossible": 0}]
nlohmann::ordered_json faults_json(const serial::Faults& faults);

/// The same of those that have happened since then, with the difference; the faults are the same as then.
nlohmann::ordered_json faults_json(const serial::Faults& faults, const serial::Faults::State& since);

}  // namespace s7200::tools
