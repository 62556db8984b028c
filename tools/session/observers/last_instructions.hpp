// The last instructions that were executed, in order.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"
#include "tools/views/program/execution_text.hpp"

namespace s7200::tools {

/// How many are asked for at most, and if nothing is said.
inline constexpr std::uint32_t kMostInstructions = 10'000, kUsualInstructions = 10;

/// Those of a station before now, oldest first, at most `count`; nothing after a stop request. The simulation stands where
/// it stood.
std::optional<std::vector<Execution>> last_instructions(History& history, std::size_t station, std::size_t count,
                                                        StopToken stop_request);

}  // namespace s7200::tools
