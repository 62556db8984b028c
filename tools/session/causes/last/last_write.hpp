// Who wrote an address last.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct LastWrite {
  Moment moment;                        ///< in front of the instruction or the action, or of the instruction before what
                                        ///< the system file did; otherwise of what came next
  std::optional<InstructionRecord> by;  ///< nothing: between two instructions, by the system, an action or the system file
  std::optional<std::uint32_t> call;    ///< `by` returned to it: it is a parameter that this CALL gets back
  std::optional<std::size_t> action;    ///< its number in History::actions()
  std::optional<std::size_t> planned;   ///< what the system file did, its number in History::planned()
  Time at = 0;                          ///< end of the instruction, or when it was found changed
  bool in_interrupt = false;
  std::uint8_t event = 0, routine = 0;      ///< of the interrupt
  std::vector<std::uint8_t> before, after;  ///< like bytes_of()
};

struct WriteSearch {
  std::optional<LastWrite> write;
  bool interrupted = false;
};

/// The last write to memory of a station before now, also of the value that was there already; the simulation stands where
/// it stood. Instructions that fill tables, strings and messages are found only if they change the value.
WriteSearch find_last_write(History& history, std::size_t station, const MemoryRange& range, StopToken stop_request);

}  // namespace s7200::tools
