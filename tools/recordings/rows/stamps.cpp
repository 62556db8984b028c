#include "tools/recordings/rows/stamps.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

Time last_stamp_of(const RecordedFrame& frame) { return frame.times.empty() ? *frame.at : frame.times.back(); }

/// Most of them within three quarters of the time that one takes.
bool has_closer_characters(const RecordedFrame& frame, Time character) {
  const std::vector<Time>& times = frame.times;
  std::size_t close = 0;
  for (std::size_t i = 1; i < times.size(); ++i)
    close += times[i] > times[i - 1] && 4 * (times[i] - times[i - 1]) < 3 * character;
  return 2 * close >= std::max<std::size_t>(times.size(), 2);
}

}  // namespace

Time begin_of(const RecordedFrame& frame, const Stamps& stamps) {
  const auto characters = static_cast<Time>(frame.times.empty() ? frame.bytes.size() : 1);
  return *frame.at - (stamps.at_end ? characters * stamps.character : 0);
}

Time end_of(const RecordedFrame& frame, const Stamps& stamps) {
  if (!frame.times.empty()) return frame.times.back() + (stamps.at_end ? 0 : stamps.character);
  return *frame.at + (stamps.at_end ? 0 : static_cast<Time>(frame.bytes.size()) * stamps.character);
}

std::optional<Time> silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  if (!before.at || !after.at || *after.at < *before.at) return {};
  return std::max<Time>(0, begin_of(after, stamps) - end_of(before, stamps));
}

std::optional<Time> known_silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  const auto known = silence(before, after, stamps);
  const bool of_characters = !before.times.empty() || !after.times.empty();
  return known && !of_characters && begin_of(after, stamps) < end_of(before, stamps) ? std::nullopt : known;
}

bool overlap(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  return before.at && after.at && *after.at >= *before.at && *after.at != last_stamp_of(before) &&
         begin_of(after, stamps) + stamps.character < end_of(before, stamps);
}

bool is_faster_than_said(const LineRecording& recording, const Stamps& stamps) {
  std::size_t seen = 0, faster = 0;
  const RecordedFrame* before = nullptr;
  for (const RecordedFrame& frame : recording.frames) {
    if (!frame.at || stamps.character == 0) continue;
    const bool timed = before && *frame.at != last_stamp_of(*before);
    const bool overlaps = before && overlap(*before, frame, stamps);
    const bool too_close = has_closer_characters(frame, stamps.character);
    seen += timed || too_close;
    faster += overlaps || too_close;
    before = &frame;
  }
  return 2 * faster > seen;
}

}  // namespace s7200::tools
