// Who did it last, in words: who wrote an address, or attached an event.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/cpu/state.hpp"
#include "tools/session/past/history.hpp"
#include "tools/views/program/listing.hpp"

namespace s7200::tools {

struct Writer {
  Moment moment;                        ///< to go back to: in front of it
  std::optional<InstructionRecord> by;  ///< nothing: the system, or someone outside
  bool by_system = false;
  std::string text;  ///< what it did and when, and who it was in a line of its own
};

struct WriterSearch {
  std::optional<Writer> writer;
  std::string none{};  ///< what is to be said if there is none
  bool interrupted = false;
};

/// Who has changed memory between two instructions: `'set VW20', from outside`, `'slave2: power on', in the system file`.
std::string changer_text(const History& history, std::optional<std::size_t> action, std::optional<std::size_t> planned);

/// `asked by pump`: a master that polls, one on a bridge, or the PLC that is called `plc`; without a name it is the only
/// one. Empty if there is nothing to tell it from others: that of `send`, one on the only bridge.
std::string asked_by_text(const History& history, const Asker& asker, const std::string& plc);

struct ForcedPlace {
  bool all = false;    ///< no instruction changes any of it
  std::string text{};  ///< `it is forced; 'unforce VW10' releases it`; empty if none of it is
};
ForcedPlace forced_place(const Forcing& forcing, const Bits& bits);

/// Of memory of a station, which is called `name`; or of an event. The simulation stands where it stood.
WriterSearch find_writer(History& history, std::size_t station, const Listing& listing, const MemoryRange& range,
                         std::string_view name, StopToken stop_request);
WriterSearch find_writer(History& history, std::size_t station, const Listing& listing, std::uint8_t event,
                         StopToken stop_request);

}  // namespace s7200::tools
