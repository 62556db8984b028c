// Which instruction attached or detached an event last.
#pragma once

#include <atomic>
#include <optional>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastAttachment {
  Moment moment;       ///< in front of the instruction
  TraceRecord what{};  ///< Attach or Detach
  InstructionRecord by{};
};

struct AttachmentSearch {
  std::optional<LastAttachment> attachment;
  bool interrupted = false;
};

/// The last ATCH or DTCH of an event of a station before now; the simulation stands where it stood.
AttachmentSearch find_last_attachment(History& history, std::size_t station, std::uint8_t event, StopToken stop_request);

}  // namespace s7200::tools
