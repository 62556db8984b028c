// A conversation for people and for machines.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools {

/// A line for each frame: when, the silence before it, who, its bytes, what it says; and a summary.
std::string decoded_text(const std::vector<ReadFrame>& frames, const Stamps& stamps, bool colour);

/// The keys `frames` and `summary`.
void add_decoded(nlohmann::ordered_json& results, const std::vector<ReadFrame>& frames, const Stamps& stamps);

struct PlaybackChoices {
  std::string name{};                     ///< of the scenario
  std::string program{};                  ///< that is to be tested; empty: the scenario is for `test --against`
  Time tolerance = 0;                     ///< of latencies
  std::optional<std::uint8_t> station{};  ///< only what it was asked; nothing: all
};

/// A scenario that sends the requests with their gaps and expects the answers; nothing if there is no request to send.
std::string scenario_text(const std::vector<ReadFrame>& frames, const Stamps& stamps, const PlaybackChoices& choices);

}  // namespace s7200::tools
