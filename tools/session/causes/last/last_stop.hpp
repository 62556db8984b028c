// When a CPU went to STOP.
#pragma once

#include <atomic>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// The last time before now; nothing if it never did, or after a stop request. The simulation stands where it stood.
std::optional<Time> find_last_stop(History& history, std::size_t station, StopToken stop_request);

}  // namespace s7200::tools
