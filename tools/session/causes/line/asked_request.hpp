// The last request on the lines of a PLC, whoever has asked: a master in the simulation, a program, or a master on a bridge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct AskedRequest {
  std::uint8_t port = 0;  ///< of the PLC, on whose line it was
  std::string by{};       ///< `the master`, `scada`, `this PLC`, `gateway`
  Asker asker{};
  int driver = 0;              ///< of the line
  Bytes frame{};               ///< as it was to be sent
  bool meant_damaged = false;  ///< with characters whose parity it wants wrong
  Time start = 0;
  Time end = 0;                               ///< of its last character; 0 while it is being sent
  std::optional<Time> given_up{};             ///< when a master in the simulation gave it up
  std::vector<ReceivedCharacter> response{};  ///< what such a master has heard of an answer: knows_response()
  SerialFormat format{};                      ///< of who has asked
  bool unanswered = false;                    ///< so far
  bool wrong = false;                         ///< its answer: whoever has asked cannot take it
  Time answer_end = 0;                        ///< of its last character
  bool in_vain = false;                       ///< unanswered, and nobody waits for it any more
  bool under_way = false;                     ///< it is being sent, or its answer is

  /// The station of the program that has asked.
  std::optional<std::size_t> plc() const {
    return asker.kind == Asker::Kind::Plc ? std::optional(asker.number) : std::nullopt;
  }
  bool knows_response() const { return asker.kind == Asker::Kind::Send || asker.kind == Asker::Kind::Poller; }

  bool operator==(const AskedRequest&) const = default;
};

/// One that waits for its answer, or has just been given up or answered; a request without a right answer is chosen before
/// one that has it, or that is still being sent, and one whose wrong answer has just ended before any other. How long a
/// program and a master on a bridge wait is not known: no longer than `host_timeout`, as in OpenRequests; what the latter
/// has sent counts as long again.
std::optional<AskedRequest> last_asked(const History& history, std::size_t station, Time host_timeout);

}  // namespace s7200::tools
