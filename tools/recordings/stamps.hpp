// What the times of a recording say: when frames began and ended, and how long nothing was on the line between them.
#pragma once

#include <optional>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// How long a master waits for an answer, at least, where nobody says so. Few slaves are slower.
inline constexpr Time kMasterTimeout = 100 * kMillisecond;

/// What a recording leaves open about its times.
struct Stamps {
  Time character = 0;   ///< how long one takes on the line; 0 on TCP
  bool at_end = false;  ///< a frame's time is that of its end; otherwise of its begin
  /// The same frame as the request, of unknown direction and after a longer silence, is the request repeated; else its echo.
  Time timeout = kMasterTimeout;
  /// So that a frame that begins before the end of the one before is one that a second station sent into it. A log's
  /// times are not: programs note when they were told.
  bool exact = false;
};

/// The frame has a time.
Time begin_of(const RecordedFrame& frame, const Stamps& stamps);
Time end_of(const RecordedFrame& frame, const Stamps& stamps);

/// How long nothing was on the line, from the end of one frame to the begin of another, 0 at least; between a request and
/// its answer the latency. Nothing if the recording has no times, or they run backwards.
std::optional<Time> silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

/// The same, and nothing if frames with one time each overlap: what there was of silence is not known then. The times of
/// characters are those of their arrival, which differ by chance.
std::optional<Time> known_silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

/// Whether `after` begins a character or more before the end of `before`. Equal times, as adapters give what comes in one
/// packet, say nothing.
bool overlap(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

/// Whether most frames begin before the one before can be over, or their characters follow each other faster than they can:
/// the line had a higher rate than that.
bool is_faster_than_said(const LineRecording& recording, const Stamps& stamps);

}  // namespace s7200::tools
