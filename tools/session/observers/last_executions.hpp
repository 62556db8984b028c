// What each instruction did when it was last executed, as Micro/WIN's STL status shows it.
#pragma once

#include <atomic>
#include <map>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"
#include "tools/views/program/execution_text.hpp"

namespace s7200::tools {

struct LastExecutions {
  std::map<std::uint32_t, Execution> of;  ///< by instruction; those that were not executed are not there
  Time since = 0;                         ///< how far back it was looked for them
  bool interrupted = false;               ///< by a stop request: what is not there may have been executed
};

/// How far back it is worth looking.
inline constexpr Time kLookedAt = 2 * kSecond;

/// Of the instructions [first, end) of a station, up to now: of the last `within` at least. The simulation stands where it
/// stood.
LastExecutions last_executions(History& history, std::size_t station, std::uint32_t first, std::uint32_t end, Time within,
                               StopToken stop_request);

}  // namespace s7200::tools
