// The timeline of what has run, put together by playing it again.
#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools {

/// Of what happened at a station from `from` on up to now; nothing after a stop request. The simulation stands where it
/// stood.
std::optional<TimelineReport> timeline_of_past(History& history, std::size_t station,
                                               const std::shared_ptr<const Program>& program, Time from,
                                               StopToken stop_request);

}  // namespace s7200::tools
