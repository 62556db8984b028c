// Why memory is as it is: who wrote it last and when, what decided that, and so on back to an input, special memory, or
// somebody outside; or that nobody has written it, and which instructions could.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// Of memory of a station, as it is where the history stands, which stands there afterwards. The first line says who wrote
/// it; each of the others goes one step further back, and names the bit that it is about. Nothing after a stop request.
std::optional<std::vector<std::string>> memory_cause(History& history, std::size_t station, const MemoryRange& range,
                                                     StopToken stop_request);

/// Of the bits that decided the rung in which the history stands, in front of what the rung decides: `M0.0 was 1: last
/// written at 31.066500 ms by S M0.0, 1 in line 38 (LDW<> VW107, 16#AAAA: VW107=16#FFFF)`, and so on back from there. The
/// history stands where it stood; nothing after a stop request.
std::optional<std::vector<std::string>> rung_cause(History& history, std::size_t station, StopToken stop_request);

/// `Conveyor (Q0.1)`, `Q0.1` without a symbol.
std::string named(const Program& program, const MemoryRange& range);

}  // namespace s7200::tools
