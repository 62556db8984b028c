// Since when memory has been as it is.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastChange {
  Time at = 0;           ///< the beginning of the first scan that found it so, or the oldest moment
  bool earlier = false;  ///< it was so even before `at`, which is how far back it was looked
};

/// Of each of these places of a station, as it is where the history stands, at most a minute back; the history stands there
/// afterwards. Nothing after a stop request.
std::optional<std::vector<LastChange>> find_last_changes(History& history, std::size_t station,
                                                         const std::vector<Bits>& places, StopToken stop_request);

}  // namespace s7200::tools
