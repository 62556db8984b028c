// Text logs that show the characters themselves: `[10:00:00.000] -> ?W<CR><LF>`, `10:00:00.000 > "?W\r\n"`.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// The name of a character that cannot be printed.
struct ControlName {
  std::string_view name;
  std::uint8_t byte;
};
constexpr std::array kControlNames{
    ControlName{"NUL", 0x00}, ControlName{"SOH", 0x01}, ControlName{"STX", 0x02}, ControlName{"ETX", 0x03},
    ControlName{"EOT", 0x04}, ControlName{"ENQ", 0x05}, ControlName{"ACK", 0x06}, ControlName{"BEL", 0x07},
    ControlName{"BS", 0x08},  ControlName{"HT", 0x09},  ControlName{"TAB", 0x09}, ControlName{"LF", 0x0A},
    ControlName{"NL", 0x0A},  ControlName{"VT", 0x0B},  ControlName{"FF", 0x0C},  ControlName{"CR", 0x0D},
    ControlName{"SO", 0x0E},  ControlName{"SI", 0x0F},  ControlName{"DLE", 0x10}, ControlName{"DC1", 0x11},
    ControlName{"XON", 0x11}, ControlName{"DC2", 0x12}, ControlName{"DC3", 0x13}, ControlName{"XOFF", 0x13},
    ControlName{"DC4", 0x14}, ControlName{"NAK", 0x15}, ControlName{"SYN", 0x16}, ControlName{"ETB", 0x17},
    ControlName{"CAN", 0x18}, ControlName{"EM", 0x19},  ControlName{"SUB", 0x1A}, ControlName{"ESC", 0x1B},
    ControlName{"FS", 0x1C},  ControlName{"GS", 0x1D},  ControlName{"RS", 0x1E},  ControlName{"US", 0x1F},
    ControlName{"DEL", 0x7F},
};

/// A character that a name in brackets stands for, and how long that is: `<CR>`, `[cr]`, `<0D>`.
struct NamedCharacter {
  std::uint8_t byte = 0;
  std::size_t length = 0;  ///< 0: there is none
};
NamedCharacter named_character(std::string_view text) {
  constexpr std::size_t kLongestName = 4;
  const char closing = text.front() == '<' ? '>' : text.front() == '[' ? ']' : '\0';
  const std::size_t end = closing == '\0' ? std::string_view::npos : text.substr(0, kLongestName + 2).find(closing);
  if (end == std::string_view::npos) return {};
  const std::string_view inner = text.substr(1, end - 1);
  const auto row = std::ranges::find(kControlNames, stl::upper_case(inner), &ControlName::name);
  if (row != kControlNames.end()) return {row->byte, end + 1};
  const bool is_hex = closing == '>' && inner.size() == 2 && std::ranges::all_of(inner, is_hex_digit);
  return is_hex ? NamedCharacter{static_cast<std::uint8_t>(hex_number(inner)), end + 1} : NamedCharacter{};
}

bool has_named_character(std::string_view text) {
  for (std::size_t at = text.find_first_of("<["); at != std::string_view::npos; at = text.find_first_of("<[", at + 1))
    if (named_character(text.substr(at)).length > 0) return true;
  return false;
}

bool is_octal_digit(char c) { return c >= '0' && c <= '7'; }

/// Whether a text has an escape: `\r`, `\n`, `\x02`, `\u0002`, `\002`.
bool has_escape(std::string_view text) {
  for (std::size_t at = text.find('\\'); at != std::string_view::npos; at = text.find('\\', at + 1)) {
    const std::string_view after = text.substr(at + 1, 3);
    if (after.starts_with('r') || after.starts_with('n')) return true;
    if (after.size() == 3 && after[0] == 'x' && is_hex_digit(after[1]) && is_hex_digit(after[2])) return true;
    if (after == "u00" || (after.size() == 3 && after[0] <= '3' && std::ranges::all_of(after, is_octal_digit))) return true;
  }
  return false;
}

bool shows_characters(std::string_view text) { return has_named_character(text) || has_escape(text); }

Bytes with_named_characters(std::string_view text) {
  Bytes bytes;
  while (!text.empty()) {
    const NamedCharacter named = named_character(text);
    bytes.push_back(named.length > 0 ? named.byte : static_cast<std::uint8_t>(text.front()));
    text.remove_prefix(std::max<std::size_t>(named.length, 1));
  }
  return bytes;
}

/// The characters of a text with escapes; nothing if an escape is unknown.
std::optional<Bytes> characters_of(std::string_view text) {
  const std::string_view trimmed = stl::trim(text);
  const bool quoted = trimmed.size() > 1 && trimmed.front() == '"' && trimmed.back() == '"';
  if (quoted) return bytes_of_literal(trimmed.substr(1, trimmed.size() - 2));
  if (has_named_character(text)) return with_named_characters(text);
  return bytes_of_literal(text);
}

/// A row of the log: a time, a direction, and the characters after them.
struct Row {
  std::optional<LeadingTime> time{};
  Direction direction = Direction::Unknown;
  std::string_view characters{};
};
Row row_of(std::string_view line) {
  constexpr std::size_t kMostWords = 4;  // before the direction: a level, a port
  Row row{.time = leading_time(line.substr(length_of_index(line)))};
  if (row.time) line.remove_prefix(length_of_index(line) + row.time->length);
  row.characters = line;
  Scan scan(line);
  for (std::size_t words = 0; words < kMostWords && !scan.at_end(); ++words) {
    scan.skip(kAllBlanks);
    const std::string_view word = scan.take_while([](char c) { return !is_any_of(c, kAllBlanks) && c != '"'; });
    if (shows_characters(word) || word.empty()) break;
    if ((row.direction = direction_of(word)) == Direction::Unknown) continue;
    scan.skip(kAllBlanks, 1);
    row.characters = line.substr(scan.at());
    break;
  }
  return row;
}

}  // namespace

bool looks_like_character_log(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  constexpr std::size_t kFewestBytes = 2;
  std::size_t shown = 0, in_hex = 0;
  BytesOfLines bytes_of_lines;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    const Row row = row_of(line);
    if (!row.time && row.direction == Direction::Unknown) continue;
    const auto hex = bytes_of_lines.in(row.characters);
    shown += shows_characters(row.characters);
    in_hex += hex && hex->bytes.size() >= kFewestBytes;
  }
  return shown > in_hex;
}

Result<LineRecording> read_character_log(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  LeftOut left_out;
  DayCounter days;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    if (stl::trim(line).empty()) continue;
    const Row row = row_of(line);
    const bool is_frame = row.direction != Direction::Unknown || (row.time && shows_characters(row.characters));
    if (!is_frame || row.characters.empty()) {
      left_out.without_bytes(number);
      continue;
    }
    const auto at = row.time ? std::optional(days.since_first_midnight(*row.time)) : std::nullopt;
    auto characters = characters_of(row.characters);
    recording.frames.push_back(characters ? RecordedFrame{.at = at,
                                                          .direction = row.direction,
                                                          .bytes = std::move(*characters),
                                                          .place = fmt::format("line {}", number)}
                                          : row_not_read(number, not_understood(row.characters), at, row.direction));
  }
  count_from_first(recording);
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools
