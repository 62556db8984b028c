// How long an interrupt waits for others: first come, first served in each queue, the queues in the order in which the CPU
// serves them, and a routine that has begun runs to its end (S7-200 manual C230-02, 10-120).
//
// An event that comes while others wait is served after them, so what waits may grow from one period to the next. So all
// events of one busy period are looked at: it begins with one of each kind at once, while something keeps interrupts away,
// and ends when nothing waits any more (response times of tasks without pre-emption and with fixed priorities, Tindell and
// Burns 1994).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "interpreter/base/time.hpp"
#include "interpreter/model/cpu_model.hpp"

namespace s7200 {

/// The events of one number.
struct InterruptSource {
  Queue queue{};
  Time period = 0;   ///< from one of them to the next, at least; above 0
  Time routine = 0;  ///< the longest, with the entry
};

struct InterruptWait {
  Time longest = 0;                  ///< from the event until the CPU begins to serve it
  std::size_t waiting_in_queue = 0;  ///< at most, with the event itself, if the queue were long enough
};

/// The share of all time that the routines need, 1 or more if there is not enough.
double load_of(const std::vector<InterruptSource>& sources);

/// The wait of an event of a queue, among `sources`, whose routine is `routine`. `kept_away`: for how long something else
/// keeps interrupts away when the first one comes. Nothing if the routines of this queue and of those served before need
/// more time than there is.
std::optional<InterruptWait> interrupt_wait(const std::vector<InterruptSource>& sources, Queue queue, Time routine,
                                            Time kept_away);

}  // namespace s7200
