// What the program did last: which instruction attached or detached an event, and the last instructions in order.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "tools/debugger/history.hpp"

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
AttachmentSearch find_last_attachment(History& history, std::size_t station, std::uint8_t event,
                                      const std::atomic<bool>* stop_request);

/// The last instructions of a station before now, oldest first, at most `count`; nothing after a stop request. The
/// simulation stands where it stood.
std::optional<std::vector<InstructionRecord>> last_instructions(History& history, std::size_t station, std::size_t count,
                                                                const std::atomic<bool>* stop_request);

}  // namespace s7200::tools
