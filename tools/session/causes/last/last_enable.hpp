// What enabled or disabled the interrupts of a station last, as changes_interrupts() counts it.
#pragma once

#include <atomic>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastEnable {
  Moment moment;                          ///< in front of the instruction
  Time at = 0;                            ///< when it was done
  std::optional<InstructionRecord> by{};  ///< ENI or DISI; nothing: the CPU went to RUN, which leaves them disabled
};

struct EnableSearch {
  std::optional<LastEnable> enable;
  bool interrupted = false;
};

/// Before now; the simulation stands where it stood.
EnableSearch find_last_enable(History& history, std::size_t station, StopToken stop_request);

}  // namespace s7200::tools
