// Logs of serial sniffers and of mbpoll: a frame in each line.
#include <fmt/format.h>

#include "interpreter/base/text.hpp"
#include "tools/recordings/fields.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

/// libmodbus prints what it sends as [01][03], and what it receives as <01><03>.
Direction direction_of_brackets(std::string_view bytes) {
  if (bytes.starts_with('[')) return Direction::Request;
  if (bytes.starts_with('<')) return Direction::Answer;
  return Direction::Unknown;
}

}  // namespace

std::optional<LineRecording> read_text_log(const std::string& bytes, const ReadingChoices& choices, std::string&) {
  LineRecording recording;
  DayCounter days;
  std::size_t number = 0, left_out = 0;
  bool characters = true;
  for (const std::string& text : stl::split_lines(bytes)) {
    std::string_view line = text;
    ++number;
    if (const std::string_view rest = stl::trim(line); rest.empty() || rest.front() == '#') continue;
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
    recording.frames.push_back({.at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt,
                                .direction = direction,
                                .bytes = found->bytes,
                                .place = fmt::format("line {}", number)});
  }
  if (left_out > 0)
    recording.notes.push_back(left_out == 1 ? "a line without bytes was left out"
                                            : fmt::format("{} lines without bytes were left out", left_out));
  count_from_first(recording);
  if (characters) join_characters(recording, choices);
  return recording;
}

}  // namespace s7200::tools
