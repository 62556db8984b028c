// Logs of programs in Python, and of Home Assistant's integrations, with bytes as Python shows them: `TX:
// b'\x01\x03\x00\n'`.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"

namespace s7200::tools {
namespace {

struct ShownBytes {
  std::string_view before{};
  std::optional<Bytes> bytes{};  ///< nothing: the bytes are not understood
};

/// The place of the next `b'` or `b"` that does not end a word; npos if there is none.
std::size_t find_literal(std::string_view line, std::size_t from) {
  for (std::size_t at = line.find('b', from); at != std::string_view::npos; at = line.find('b', at + 1)) {
    const bool opens = at + 1 < line.size() && (line[at + 1] == '\'' || line[at + 1] == '"');
    const bool in_word = at > 0 && (stl::is_letter(line[at - 1]) || stl::is_digit(line[at - 1]));
    if (opens && !in_word) return at;
  }
  return std::string_view::npos;
}

/// The bytes shown in a line; nothing if there are none. The bytes of several texts in a line are not understood.
std::optional<ShownBytes> shown_bytes(std::string_view line) {
  const std::size_t begin = find_literal(line, 0);
  if (begin == std::string_view::npos) return {};
  const char mark = line[begin + 1];
  std::size_t end = begin + 2;
  while (end < line.size() && line[end] != mark) end += line[end] == '\\' ? 2U : 1U;
  ShownBytes shown{.before = line.substr(0, begin)};
  if (end < line.size() && find_literal(line, end + 1) == std::string_view::npos)
    shown.bytes = bytes_of_literal(line.substr(begin + 2, end - begin - 2));
  return shown;
}

}  // namespace

bool looks_like_python_bytes(std::string_view bytes) {
  return is_text(bytes) && std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) {
           const auto shown = shown_bytes(line);
           return shown && shown->bytes && !shown->bytes->empty();
         });
}

Result<LineRecording> read_python_bytes(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  LeftOut left_out;
  DayCounter days;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    auto shown = shown_bytes(line);
    if (!shown || (shown->bytes && shown->bytes->empty())) {
      if (!stl::trim(line).empty()) left_out.without_bytes(number);
      continue;
    }
    const auto time = leading_time(line);
    const auto at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt;
    const Direction direction = direction_of(shown->before.substr(time ? time->length : 0));
    if (!shown->bytes) {
      const std::string why = not_understood(line.substr(shown->before.size()));
      recording.frames.push_back(row_not_read(number, why, at, direction));
      continue;
    }
    recording.frames.push_back(
        {.at = at, .direction = direction, .bytes = std::move(*shown->bytes), .place = fmt::format("line {}", number)});
  }
  count_from_first(recording);
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools
