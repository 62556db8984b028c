// A fault as people write it at the prompt, with the station that it is about.
#pragma once

#include <optional>
#include <string>

#include "interpreter/base/result.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// `parity:character=2`, or `none`; of a system also `parity:character=2 station=slave2`, for what that station on the line
/// of PLC `station` sends. Trouble if it is not a fault, or cannot be that station's.
Result<InjectFault> fault_of(const std::string& text, const History& history, std::size_t station);

/// `on the line from now on, of what slave2 sends: parity:character=2`, and a line that describes it.
std::string fault_text(const InjectFault& inject);

/// The faults in force on the line of PLC `station`, and how often each has happened, a line for each.
std::string faults_text(const History& history, std::size_t station);

}  // namespace s7200::tools
