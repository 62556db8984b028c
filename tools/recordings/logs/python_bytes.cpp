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

/// Bytes in a line, as Python shows them: `b'\x01\x03'`, or of Python 2 and of texts `'\x01\x03'`.
struct Literal {
  std::size_t begin = std::string_view::npos, end = std::string_view::npos;  ///< of what is between the quotation marks
  std::size_t place = std::string_view::npos;                                ///< of its first sign

  bool any() const { return place != std::string_view::npos; }
  bool is_closed(std::string_view line) const { return end < line.size(); }
};

/// The next of them that does not end a word. One without its `b` has an escape in hex; in double quotes, as Python writes
/// what has a single one.
Literal find_literal(std::string_view line, std::size_t from) {
  constexpr std::string_view kMarks = "'\"";
  char unclosed = '\0';  // a mark to which the line has no other
  for (std::size_t at = line.find_first_of(kMarks, from); at != std::string_view::npos;
       at = line.find_first_of(kMarks, at + 1)) {
    const bool is_bytes = at > from && line[at - 1] == 'b';
    const std::size_t place = at - (is_bytes ? 1 : 0);
    const bool in_word = place > 0 && (stl::is_letter(line[place - 1]) || stl::is_digit(line[place - 1]));
    if (in_word || line[at] == unclosed) continue;
    std::size_t end = at + 1;
    while (end < line.size() && line[end] != line[at]) end += line[end] == '\\' ? 2U : 1U;
    const std::string_view inner = line.substr(at + 1, end - at - 1);
    if (end >= line.size()) unclosed = line[at];
    const bool is_text = line[at] == '"' && inner.find('\'') == std::string_view::npos;
    if (is_bytes || (!is_text && inner.find("\\x") != std::string_view::npos)) return {at + 1, end, place};
  }
  return {};
}

/// The characters of a text up to U+00FF are its bytes.
std::optional<Bytes> bytes_shown(std::string_view line, const Literal& literal) {
  const std::string_view inner = line.substr(literal.begin, literal.end - literal.begin);
  if (line[literal.place] == 'b' || stl::is_ascii(inner)) return bytes_of_literal(inner);
  const auto characters = in_latin_1(inner);
  if (!characters) return {};
  return bytes_of_literal({reinterpret_cast<const char*>(characters->data()), characters->size()});
}

/// The same bytes in hex, as minimalmodbus writes them after the text: ` (05 06 00 10 12 34 84 FC)`. Nothing for a number of
/// bytes in brackets.
std::optional<Bytes> hex_in_brackets(std::string_view after) {
  constexpr std::string_view kOpens = " (";
  if (!after.starts_with(kOpens)) return {};
  const std::string_view inner = after.substr(kOpens.size(), after.find(')') - kOpens.size());
  const auto bytes = inner.find(' ') == std::string_view::npos ? std::nullopt : bytes_of_text(inner);
  return bytes;
}

/// The bytes shown in a line; nothing if there are none. The bytes of several texts in a line are not understood.
std::optional<ShownBytes> shown_bytes(std::string_view line) {
  const Literal literal = find_literal(line, 0);
  if (!literal.any()) return {};
  ShownBytes shown{.before = line.substr(0, literal.place)};
  if (!literal.is_closed(line) || find_literal(line, literal.end + 1).any()) return shown;
  shown.bytes = hex_in_brackets(line.substr(literal.end + 1));
  if (!shown.bytes) shown.bytes = bytes_shown(line, literal);
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
