// The last RCV at a port, and what became of it.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastReception {
  Moment moment;                           ///< in front of the RCV
  InstructionRecord by{};                  ///< the RCV
  std::optional<TraceRecord> end{};        ///< ReceiveEnd; that of this RCV, or that it has brought about
  std::optional<TraceRecord> damaged{};    ///< CharacterReceived, the damaged one that has ended it
  std::optional<TraceRecord> abandoned{};  ///< PortControl or ModeChange, with which it ended without a status
  std::optional<std::uint16_t> refused{};  ///< with this run-time error, so that it received nothing
};

struct ReceptionSearch {
  std::optional<LastReception> reception;
  bool interrupted = false;
};

/// The last RCV that a station has executed at a port before now, also one that was refused; nothing if there was none. The
/// simulation stands where it stood.
ReceptionSearch find_last_reception(History& history, std::size_t station, std::uint8_t port, StopToken stop_request);

}  // namespace s7200::tools
