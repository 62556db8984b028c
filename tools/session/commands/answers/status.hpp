// The program with what each instruction did last beside it, as Micro/WIN's STL status shows it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"
#include "tools/session/observers/last_executions.hpp"

namespace s7200::tools {

LastExecutions last_executions_of(Session& session, std::uint32_t first, std::uint32_t end);

/// A line for each instruction of [first, end), as it was executed last.
std::vector<std::string> status_lines(const Session& session, std::uint32_t first, std::uint32_t end,
                                      const LastExecutions& last);

/// {"lines": [{"op": 40, "line": 52, "at_ns": …, "powerFlow": true, "top": true, "values": [1], "text": "S0=1 …"}],
/// "since_ns": …}: of those that were executed since then.
Json status_json(const Session& session, const LastExecutions& last);

/// `*>`: it has a breakpoint, and it is the next one.
std::string mark_of(const Session& session, std::uint32_t op);

}  // namespace s7200::tools
