#include "interpreter/analysis/warnings/find_warnings.hpp"

#include "interpreter/analysis/warnings/lint.hpp"

namespace s7200 {

void find_warnings(const Program& program, stl::Diagnostics& diagnostics, const Waiter& waiter) {
  constexpr void (*kFinders[])(const Facts&, stl::Diagnostics&) = {
      find_constant_contacts,     find_constant_comparisons, find_double_coils,     find_double_counters,
      find_double_loops,          find_double_timers,        find_missing_eni,      find_missing_freeport,
      find_missing_receive_event, find_never_true,           find_overwritten,      find_busy_port,
      find_receive_once,          find_repeated_edges,       find_restarted_timers, find_skipped_timers,
      find_unreachable,           find_unreached_presets,    find_unused_freeport,  find_unused_steps,
  };
  const Facts facts = facts_of(program, waiter);
  for (const auto find : kFinders)
    if (!waiter.asks_to_end()) find(facts, diagnostics);
  if (!waiter.asks_to_end()) find_long_interrupts(facts, diagnostics, waiter);
}

}  // namespace s7200
