// What a logic analyser records: levels of channels over time. The project's own receiver makes characters of them.
#pragma once

#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/recordings/recording.hpp"

namespace s7200::tools {

struct Channel {
  std::string name{};
  std::optional<bool> first{};  ///< level before the first edge; nothing as long as none is known
  Time since = 0;               ///< when that began
  std::vector<Time> edges{};    ///< in order of time; each one changes the level
  bool level = false;           ///< after the last edge

  /// Sets the level from `at` on.
  void set(Time at, bool to) {
    if (first && level != to) edges.push_back(at);
    if (!first) first = to, since = at;
    level = to;
  }
};

struct Levels {
  std::vector<Channel> channels{};
  Time end = 0;  ///< of the last levels
  std::vector<std::string> notes{};
};

/// Makes frames of the characters on the channels. The rate, the parity and the data bits that `choices` do not give are
/// those that fit the levels; a note says which. Channels that repeat others, or have no characters of that line, are left
/// out by name. Trouble if there is no frame.
Result<LineRecording> frames_of(Levels levels, const ReadingChoices& choices);

}  // namespace s7200::tools
