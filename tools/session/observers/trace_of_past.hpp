// What a trace has to know of what was before it begins: put together by playing that again.
#pragma once

#include <atomic>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/trace/text/trace_lines.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// Of a station, now; the simulation stands where it stood. Forgotten too after a stop request.
TraceReasons::Disabled interrupts_disabled(History& history, std::size_t station, StopToken stop_request);

/// What happened before now, to the traces of all stations, by their numbers: since a while before the oldest interrupt that
/// waits, so that they go on as they would have from power-up. After a stop request they know nothing, and it is false. The
/// simulation stands where it stood.
bool tell_what_was_before(History& history, const std::vector<TraceLines*>& traces, StopToken stop_request);

}  // namespace s7200::tools
