// The worst instant for an interrupt: a run in which a race (interpreter/analysis/races.hpp) loses a word.
//
// The program runs its first scans; then one scan is run again and again from the same memory, with the interrupt before the
// first of the two accesses, after the second, and after each instruction between them. What ends neither as the first nor
// as the second of these runs has lost something. If the program does not come to the accesses, or nothing is lost, it is
// tried again with other values of the shared memory, then of the inputs, then of all bits and values that contacts look at.
#pragma once

#include <optional>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// Nothing if no run loses the word, or if the program has errors.
std::optional<LostWord> worst_instant(const Inspection& inspection, const Race& race);

}  // namespace s7200::tools
