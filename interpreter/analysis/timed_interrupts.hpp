// How long the routines of timed interrupts take, by their longest way (bounds.hpp has that of all that a program does).
#pragma once

#include <vector>

#include "interpreter/analysis/bounds.hpp"

namespace s7200 {

/// Returns, for events 10 and 11 if attached, how long their routines take and the longest period that the program sets.
/// Leaves out events whose period is unknown. `latency` is not set. Empty if `waiter` asks to end.
std::vector<Bounds::OfEvent> timed_interrupts(const Facts& facts, const Calls& calls, const Waiter& waiter = {});

}  // namespace s7200
