// Logs of serial sniffers and of mbpoll: a frame in each line.
#include "tools/recordings/fields.hpp"

namespace s7200::tools {
namespace {

/// libmodbus prints what it sends as [01][03], and what it receives as <01><03>.
Direction direction_of_brackets(std::string_view bytes) {
  if (bytes.starts_with('[')) return Direction::Request;
  if (bytes.starts_with('<')) return Direction::Answer;
  return Direction::Unknown;
}

}  // namespace

LineRecording read_text_log(std::string_view text, const ReadingChoices& choices) {
  constexpr Time kGap = 5 * kMillisecond;
  LineRecording recording{.form = "text"};
  std::size_t number = 0, left_out = 0;
  bool characters = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    const auto time = leading_time(line);
    if (time) line.remove_prefix(time->length);
    const auto found = trailing_bytes(line);
    if (!found) {
      ++left_out;
      continue;
    }
    Direction direction = direction_of(line.substr(0, found->begin));
    const std::size_t bracket = line.find_first_of("[<", found->begin == 0 ? 0 : found->begin - 1);
    if (direction == Direction::Unknown && bracket != std::string_view::npos && bracket <= found->begin)
      direction = direction_of_brackets(line.substr(bracket));
    characters = characters && found->bytes.size() == 1 && time.has_value();
    recording.frames.push_back({.at = time ? std::optional(time->time) : std::nullopt,
                                .direction = direction,
                                .bytes = found->bytes,
                                .place = "line " + std::to_string(number)});
  }
  if (left_out > 0)
    recording.notes.push_back(left_out == 1 ? "a line without bytes was left out"
                                            : std::to_string(left_out) + " lines without bytes were left out");
  count_from_first(recording);
  if (characters) join_characters(recording, choices.gap == 0 ? kGap : choices.gap);
  return recording;
}

}  // namespace s7200::tools
