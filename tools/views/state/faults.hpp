// The effects of a line's faults, as text and as JSON.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "serial_sim/faults/faults.hpp"

namespace s7200::tools {

/// A fault in words, with its place as far as the words leave that out: `a pause before a character: character=2,
/// of=request`
std::string described(const serial::Fault& fault);

/// The name of the station with a driver, where faults are of one; empty if it has none.
using StationName = std::function<std::string(int driver)>;
inline std::string without_names(int) { return {}; }

/// The kinds of faults, an example and its meaning for each, one a line.
std::string fault_kinds_text();

/// The effects so far, a line for each fault.
std::vector<std::string> fault_notes(const serial::Faults& faults, const StationName& station = without_names);

/// The effects from `since` on: `fault missing:of=answer: 2×`. A line that was cut then, and still is `now`, counts too.
std::vector<std::string> fault_notes(const serial::Faults::State& faults, const serial::Faults::State& since, Time now,
                                     const StationName& station = without_names);

/// [{"fault": "flip:bit=3", "count": 2, "impossible": 0}], and "station" if it is of one.
nlohmann::ordered_json faults_json(const serial::Faults& faults, const StationName& station = without_names);

/// The faults that have acted since then, with the difference of their counts.
nlohmann::ordered_json faults_json(const serial::Faults& faults, const serial::Faults::State& since,
                                   const StationName& station = without_names);

}  // namespace s7200::tools
