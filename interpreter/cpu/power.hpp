// Power-up, and what outlasts power off (facts 1.6).
//
// RAM intact: the retentive ranges of the model keep their values, V that is not retentive is loaded from the EEPROM, all
// else is 0, and the clock has gone on. RAM lost: V is loaded from the EEPROM, all else is 0, SM0.2 is 1 during the first
// scan, and the clock starts anew.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::power {

/// Power comes on: all is new but what `memory` has kept. Without `memory` the CPU is as new. It goes to RUN if `run`, or
/// stays in STOP.
void up(Core& core, bool run, const RetentiveMemory* memory);

/// What would be kept if power went off now.
RetentiveMemory retentive_memory(const Core& core);

// For the table of units.
void recall_ranges(Core& core, const RetentiveMemory* memory);

}  // namespace s7200::power
