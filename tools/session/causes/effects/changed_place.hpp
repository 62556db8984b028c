// The last change of memory: what made it another value than it had, and the moment just before.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct ChangedPlace {
  Moment before;                        ///< in front of the instruction, the action or the part of the scan that changed it
  Time at = 0;                          ///< when it was changed
  std::optional<InstructionRecord> by;  ///< nothing: the system, an action or the system file
  std::optional<std::size_t> action;    ///< its number in History::actions()
  std::optional<std::size_t> planned;   ///< what the system file did, its number in History::planned()
  std::vector<std::uint8_t> was, became;  ///< the bytes of the place, with its bits alone
};

struct ChangeSearch {
  std::optional<ChangedPlace> change;  ///< nothing if it has been so since the oldest moment
  bool interrupted = false;
};

/// The bytes of a place of the image; of one bit 0 or 1.
std::vector<std::uint8_t> bytes_at(const State& state, const Bits& place);

/// The last change of these bits of a station before now; the history stands where it stood.
ChangeSearch find_changed_place(History& history, std::size_t station, const Bits& place, StopToken stop_request);

}  // namespace s7200::tools
