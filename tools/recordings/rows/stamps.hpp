// The times of a recording: when frames began and ended, and how long the line was silent between them.
#pragma once

#include <optional>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// The least time that a master waits for an answer, where the user gives none. Few slaves are slower.
inline constexpr Time kMasterTimeout = 100 * kMillisecond;

/// The properties of a recording's times.
struct Stamps {
  Time character = 0;   ///< how long one takes on the line; 0 on TCP
  bool at_end = false;  ///< a frame's time is that of its end; otherwise of its begin
  /// A frame equal to the request, of unknown direction and after a longer silence than this, is the request repeated; else
  /// its echo.
  Time timeout = kMasterTimeout;
  /// The times are exact: a frame that begins before the end of the one before was sent into it by a second station. The
  /// times of a log are not exact: programs note when they were told.
  bool exact = false;
};

/// The begin and the end of a frame that has a time.
Time begin_of(const RecordedFrame& frame, const Stamps& stamps);
Time end_of(const RecordedFrame& frame, const Stamps& stamps);

/// The silence on the line from the end of one frame to the begin of another, 0 at least; between a request and its answer
/// it is the latency. Nothing if the recording has no times, or they run backwards.
std::optional<Time> silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

/// The silence as above, or nothing if frames with one time each overlap: the silence is not known then. The times of
/// characters are those of their arrival, which differ by chance.
std::optional<Time> known_silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

/// Whether `after` begins a character or more before the end of `before`. Equal times, as adapters give what comes in one
/// packet, say nothing.
bool overlap(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps);

/// Whether most frames begin before the one before can be over, or their characters follow each other faster than they can:
/// the line had a higher rate than that.
bool is_faster_than_said(const LineRecording& recording, const Stamps& stamps);

}  // namespace s7200::tools
