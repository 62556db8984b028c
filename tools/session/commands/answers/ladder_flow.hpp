// The power flow of a drawn network: what its instructions did when they were executed last, put beside its elements.
#pragma once

#include "interpreter/analysis/drawn_networks.hpp"
#include "tools/session/observers/last_executions.hpp"
#include "tools/views/ladder/ladder_text.hpp"

namespace s7200::tools {

/// Of a network that is drawn. What was not executed is open and has no value. In a segment the power rail is drawn with
/// power, and its contacts are open while the segment is not active.
LadderFlow ladder_flow(const Program& program, const DrawnNetwork& network, const LastExecutions& last);

}  // namespace s7200::tools
