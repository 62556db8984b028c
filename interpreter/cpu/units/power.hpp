// Power-up, and what survives power off (facts 1.6).
//
// RAM intact: the retentive ranges, those of the system block or else of the CPU, keep their values, V memory that is not
// retentive is loaded from the EEPROM, all else is 0, and the clock has run on. RAM lost: V memory is loaded from the EEPROM,
// and so are MB0 to MB13 if they are retentive; all else is 0, SM0.2 is 1 during the first scan, and the clock starts again
// from its beginning.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::power {

/// Power comes on: everything is cleared except what `memory` has kept. Without `memory` the CPU is brand-new. It goes to
/// RUN if `run`, otherwise it stays in STOP. It is `at`.
void up(Core& core, bool run, const RetentiveMemory* memory, Time at = 0);

/// The memory that would be kept if power went off now.
RetentiveMemory retentive_memory(const Core& core);

// For the table of units.
void recall_ranges(Core& core, const RetentiveMemory* memory);

}  // namespace s7200::power
