// Random requests, for a comparison of two slaves and for a slave that must survive them.
#pragma once

#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

/// Made as they are sent: however many there are, they need no memory.
struct RandomTraffic final : StepAction {
  std::size_t exchanges = 0;
  std::uint32_t seed = 1;
  std::uint8_t station = 1;

  std::size_t steps() const override { return exchanges; }
  void act(Run& run) const override;
  bool write(TranscriptWriter& writer) const override;
};

/// Requests of all eight functions, mostly fine, often at a limit, sometimes wrong, disturbed or for others; the same ones
/// for the same seed. `exchanges` from 1 to 100 000.
Scenario random_traffic(std::size_t exchanges, std::uint32_t seed, std::uint8_t station);

}  // namespace s7200::tools
