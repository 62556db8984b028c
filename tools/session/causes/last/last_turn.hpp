// When a state of a CPU began that it is in now.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastTurn {
  Moment moment;  ///< in front of the instruction
  Time at = 0;
  std::optional<InstructionRecord> by{};  ///< nothing: between two instructions
  bool from_outside = false;              ///< by what was done to the PLC
};

struct TurnSearch {
  std::optional<LastTurn> turn;
  bool interrupted = false;
};

/// What has made `holds` true last, before now; nothing if it was true all along. Instructions that left it so are none of
/// it. The simulation stands where it stood.
TurnSearch find_last_turn(History& history, std::size_t station, const std::function<bool(const State& state)>& holds,
                          StopToken stop_request);

}  // namespace s7200::tools
