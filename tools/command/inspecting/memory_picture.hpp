// The memory that `s7200 why` looks at: of a file, or as a first scan leaves it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "serial_sim/system/simulation.hpp"

namespace s7200::tools {

/// A PLC that stands with the memory of a file, all that a real one has kept, or after its first scan without one. `set`:
/// assignments besides, `I0.0=1`. Of a file nothing runs: the bits of timers and counters follow from their values and
/// presets, and what it does not have stays 0: inputs, outputs, S and special memory. Null after a message.
std::unique_ptr<serial::Simulation> pictured(std::shared_ptr<const Program> program, const std::string& memory_file,
                                             const std::vector<std::string>& set);

}  // namespace s7200::tools
