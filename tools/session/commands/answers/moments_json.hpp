// Where a session stands, for machines.
#pragma once

#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

/// {"now_ns": …, "oldest_ns": …, "newest_ns": …, "in_the_past": …, "station": …, "scan": …, "mode": "RUN", "op": …, "line":
/// …, "routine": …, "fatal": 0}
Json moments_json(const Session& session);

}  // namespace s7200::tools
