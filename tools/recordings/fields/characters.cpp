// Characters: those beside the hex of a line, and those that become frames.
#include <algorithm>
#include <cctype>

#include "tools/recordings/fields/fields.hpp"

namespace s7200::tools {

bool is_column_of_characters(std::string_view text, std::span<const std::uint8_t> bytes) {
  if (text.size() > bytes.size()) return false;
  const auto shows = [](char shown, std::uint8_t byte) {
    const auto c = static_cast<unsigned char>(shown);
    return byte > ' ' && byte <= '~' ? c == byte : std::isalnum(c) == 0;
  };
  const bool ends_with_blanks = std::all_of(bytes.begin() + static_cast<std::ptrdiff_t>(text.size()), bytes.end(),
                                            [&](std::uint8_t byte) { return shows(' ', byte); });
  return ends_with_blanks && std::equal(text.begin(), text.end(), bytes.begin(), shows);
}

void CharacterJoiner::add(const RecordedFrame& row, std::vector<RecordedFrame>& frames) {
  if (row.doubt) {
    last_.reset();
    return frames.push_back(row);
  }
  const bool joins =
      !frames.empty() && frames.back().direction == row.direction && last_ && row.at && *row.at - *last_ <= gap_;
  last_ = row.at;
  if (!joins)
    frames.push_back({.at = row.at, .direction = row.direction, .place = row.place, .line = row.line, .stream = row.stream});
  RecordedFrame& frame = frames.back();
  for (const std::size_t place : row.damaged) frame.damaged.push_back(frame.bytes.size() + place);
  frame.bytes.insert(frame.bytes.end(), row.bytes.begin(), row.bytes.end());
  if (row.at) frame.times.push_back(*row.at);
}

void join_characters(LineRecording& recording, const ReadingChoices& choices) {
  CharacterJoiner joiner(choices);
  std::vector<RecordedFrame> frames;
  for (const RecordedFrame& row : recording.frames) joiner.add(row, frames);
  recording.frames = std::move(frames);
}

}  // namespace s7200::tools
