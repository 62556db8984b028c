// Frames of a recording as requests and answers of a protocol.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// A frame, read.
struct ReadFrame {
  const RecordedFrame* frame = nullptr;
  Direction direction = Direction::Unknown;  ///< Unknown: neither a request nor an answer to one
  bool right = false;
  std::string text{};                     ///< what it says, or what is wrong with it
  std::optional<std::uint8_t> station{};  ///< of a request: who is asked
  std::optional<std::size_t> other{};     ///< of an answer its request, of a request its answer: number in the conversation
};

/// A protocol that recordings are read in.
struct RecordedProtocol {
  std::string_view name;  ///< as for `master --protocol`

  /// `open`: the request that still waits for an answer; null if none does.
  ReadFrame (*read)(const RecordedFrame& frame, const RecordedFrame* open);
};
std::span<const RecordedProtocol> recorded_protocols();
const RecordedProtocol* find_recorded_protocol(std::string_view name);

/// Each frame in turn; an answer goes to the last request of its connection that has none.
std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol);

/// What a recording leaves open about its times.
struct Stamps {
  Time character = 0;   ///< how long one takes on the line; 0 on TCP
  bool at_end = false;  ///< a frame's time is that of its end; otherwise of its begin
};

/// How long nothing was on the line, from the end of one frame to the begin of another, 0 at least; between a request and
/// its answer the latency. Nothing if the recording has no times.
std::optional<Time> silence(const ReadFrame& before, const ReadFrame& after, const Stamps& stamps);

}  // namespace s7200::tools
