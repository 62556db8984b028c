// Hears a serial line of this computer, and says nothing there.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tools/recordings/conversation.hpp"
#include "tools/slave/host_link.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {

/// Of characters only their arrival is known: each has begun a character time before, those that come together one after the
/// other. A message that is complete by what it says of itself ends a frame; else a silence does.
class LineListener {
 public:
  /// Opens a device, or characters over TCP. `gap`: the silence; 0: 20 ms, or 3.5 characters if that is more. Throws
  /// SlaveUnreachable.
  LineListener(const SlaveTarget& target, const SerialFormat& format, Time gap);

  /// Tells each frame, with times since the first character, until an interruption, or until `duration` is over. Throws
  /// SlaveLost.
  void listen(Time duration, Conversation& conversation, const std::function<void(ReadFrame)>& tell);

  std::string name() const { return link_->name(); }

  /// How long a character takes there; over TCP that is not known.
  Stamps stamps() const { return {.character = character_}; }

 private:
  void take(RecordedFrame& frame);

  std::unique_ptr<HostLink> link_;
  Time character_, gap_;
  std::optional<Time> first_{};  // of the host's clock
  Time last_ = 0;                // the last character that came
};

}  // namespace s7200::tools
