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

/// `Conveyor (Q0.1)`, `Q0.1` without a symbol.
std::string named(const Program& program, const MemoryRange& range);

}  // namespace s7200::tools
