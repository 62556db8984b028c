// A recorded conversation as a scenario.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recordings/conversation.hpp"

namespace s7200::tools {

struct PlaybackChoices {
  std::string name{};                         ///< of the scenario
  std::string program{};                      ///< that is to be tested; empty: the scenario is for `test --target`
  std::string cpu{};                          ///< to run it on; empty: the one that scenarios have if they name none
  std::optional<std::uint8_t> ppi_station{};  ///< of a program that is tested; nothing: the one that it has itself
  std::uint8_t port = 0;                      ///< of the CPU, that it was recorded at
  Time tolerance = 0;                         ///< of latencies
  std::optional<std::uint8_t> station{};      ///< only what it was asked; nothing: all
};

struct Playback {
  std::string scenario{};            ///< empty if there is no request to send
  std::vector<std::string> notes{};  ///< which requests were left out, and why
};

/// The PPI station that a program has to be to be asked: `only`, or the only one that is asked. Nothing if several are.
std::optional<std::uint8_t> ppi_station_asked(const std::vector<ReadFrame>& frames, std::optional<std::uint8_t> only);

/// Why a playback has no scenario: no request, or none to that station.
std::string why_nothing_is_asked(const std::vector<ReadFrame>& frames, const PlaybackChoices& choices);

/// The command that plays the scenario: `Run by s7200 test --target TARGET.`
std::string how_to_run(const RecordedProtocol& protocol, const PlaybackChoices& choices);

/// A scenario that sends the requests with their gaps and expects the answers. Left out are requests that are damaged, or
/// that other characters follow without a silence, and those whose answer is wrong: no slave can give it.
Playback playback(const std::vector<ReadFrame>& frames, const Stamps& stamps, const PlaybackChoices& choices);

}  // namespace s7200::tools
