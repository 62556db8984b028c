// How long the routines of timed interrupts take, by their longest way (bounds.hpp has that of all that a program does).
#pragma once

#include <vector>

#include "interpreter/analysis/bounds.hpp"

namespace s7200 {

/// Of attached timed interrupts, event 10 and 11: how long their routines take, and the longest period that the program
/// sets. Those of which that is not known are left out; there is no latency. Empty if `waiter` asks to end.
std::vector<Bounds::OfEvent> timed_interrupts(const Facts& facts, const Calls& calls, const Waiter& waiter = {});

}  // namespace s7200
