// The frames that mbpoll and other programs with libmodbus print on demand.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"

namespace s7200::tools {
namespace {

/// The frame in a line. Only bytes in brackets are a frame: `[1]:  4369` is a register.
std::optional<RecordedFrame> frame_in(std::string_view line) {
  constexpr std::size_t kByte = 4;
  const std::string_view text = stl::trim(line);
  if (text.empty() || text.size() % kByte != 0) return {};
  const Direction direction = direction_of_brackets(text);
  if (direction == Direction::Unknown) return {};
  const bool sent = direction == Direction::Request;
  const auto digit = [&](std::size_t at) { return std::isxdigit(static_cast<unsigned char>(text[at])) != 0; };
  for (std::size_t at = 0; at < text.size(); at += kByte)
    if (text[at] != (sent ? '[' : '<') || text[at + 3] != (sent ? ']' : '>') || !digit(at + 1) || !digit(at + 2)) return {};
  return RecordedFrame{.direction = direction, .bytes = *bytes_of_text(text)};
}

/// Whether a line begins a frame that is not whole: `<01><03><0`
bool begins_frame(std::string_view line) {
  const std::string_view text = stl::trim(line);
  constexpr std::size_t kShortest = 5;
  return text.size() >= kShortest && direction_of_brackets(text) != Direction::Unknown && text[4] == text[0] &&
         bytes_of_text(text.substr(0, 4));
}

/// mbpoll prints as modpoll does, which was there before it.
bool is_of_mbpoll(std::string_view line) {
  return line.starts_with("mbpoll ") || line.starts_with("modpoll ") || line.starts_with("-- Polling slave");
}

}  // namespace

bool looks_like_libmodbus(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  return std::ranges::any_of(Lines(bytes), [](std::string_view line) {
    return !line.empty() && (is_of_mbpoll(line) || frame_in(line).has_value());
  });
}

Result<LineRecording> read_libmodbus(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    auto frame = frame_in(line);
    if (!frame) {
      if (begins_frame(line))
        recording.frames.push_back(
            row_not_read(number, not_understood(stl::trim(line)), {}, direction_of_brackets(stl::trim(line))));
      continue;
    }
    frame->place = fmt::format("line {}", number);
    recording.frames.push_back(std::move(*frame));
  }
  if (recording.frames.empty()) read_values_of_mbpoll(bytes, choices, recording);
  return recording;
}

}  // namespace s7200::tools
