// When a PLC lost its power, and who switched it off.
#pragma once

#include <atomic>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastPowerLoss {
  Time at = 0;
  std::optional<std::size_t> action{};   ///< from outside
  std::optional<std::size_t> planned{};  ///< in the system file
};

struct PowerLossSearch {
  std::optional<LastPowerLoss> loss;
  bool interrupted = false;
};

/// Before now; the simulation stands where it stood.
PowerLossSearch find_last_power_loss(History& history, std::size_t station, StopToken stop_request);

}  // namespace s7200::tools
