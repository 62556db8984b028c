// What was printed or expected in a session: a test of it expects that again.
#pragma once

#include <vector>

#include "tools/session/causes/expression.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

void note_looked_at(Session& session, const Place& place);

/// On the way to where it stands, since power came back last, as far as it is so there still.
std::vector<SessionRecord::LookedAt> looked_at_here(Session& session);

/// The same of each power-up on that way, the first one first.
std::vector<std::vector<SessionRecord::LookedAt>> looked_at_since_the_beginning(Session& session);

/// Object `i` of a range, with its value; a whole accumulator, which has no parts in a scenario.
Assignment object_of(const State& state, const MemoryRange& range, std::uint32_t i);

}  // namespace s7200::tools
