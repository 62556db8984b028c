// What ESPHome's component `modbus` logs at the level VERY_VERBOSE: what it writes as a frame, what it receives byte by
// byte.
//
//   [10:00:00.000][V][modbus:199]: Modbus write: 01.03.00.0A.00.02.E4.09 (8)
//   [10:00:00.025][VV][modbus:042]: Modbus received Byte  18 (0X12)
//
// Later ones log what they receive as a frame: `Modbus received frame: 01.03.04.…(9)`
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kModbusTag = "[modbus:", kWrite = "rite: ", kFrameReceived = "eceived frame: ",
                           kByteReceived = "eceived Byte ";

/// Silence that ends what it receives: it waits so long for the next byte.
constexpr Time kReceivingEnds = 50 * kMillisecond;

/// The text after a word that comes after the tag.
std::optional<std::string_view> said_after(std::string_view line, std::string_view word) {
  const std::size_t tag = line.find(kModbusTag);
  const std::size_t at = tag == std::string_view::npos ? tag : line.find(word, tag);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = line.substr(at + word.size());
  return stl::trim(rest.substr(0, rest.find('\x1b')));
}

/// Written bytes with signs between them, and their number: `01.03.00.0A (4)`
std::optional<Bytes> written_bytes(std::string_view text) {
  std::string plain(text.substr(0, text.find('(')));
  std::ranges::replace_if(
      plain, [](char c) { return c == '.' || c == ':'; }, ' ');
  return bytes_of_text(plain);
}

/// A received byte: `18 (0X12)`
std::optional<Bytes> received_byte(std::string_view text) {
  const std::size_t bracket = text.find('(');
  if (bracket == std::string_view::npos) return {};
  const auto bytes = bytes_of_text(text.substr(bracket));
  return bytes && bytes->size() == 1 ? bytes : std::nullopt;
}

}  // namespace

bool looks_like_esphome_modbus(std::string_view bytes) {
  return is_text(bytes) && std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) {
           const auto written = said_after(line, kWrite), received = said_after(line, kFrameReceived);
           return (written && written_bytes(*written)) || (received && written_bytes(*received));
         });
}

Result<LineRecording> read_esphome_modbus(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  LeftOut left_out;
  DayCounter days;
  std::size_t number = 0;
  std::optional<Time> last;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    const auto written = said_after(line, kWrite);
    const auto whole = said_after(line, kFrameReceived);
    const auto received = written || whole ? std::nullopt : said_after(line, kByteReceived);
    if (!written && !whole && !received) {
      if (!stl::trim(line).empty()) left_out.without_bytes(number);
      continue;
    }
    const std::string_view said = written ? *written : whole ? *whole : *received;
    auto frame = received ? received_byte(said) : written_bytes(said);
    const std::size_t head = line.find('[');
    const auto time = head == std::string_view::npos ? std::nullopt : leading_time(line.substr(head));
    const auto at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt;
    const Direction direction = written ? Direction::Request : Direction::Answer;
    const bool goes_on = received && !recording.frames.empty() && recording.frames.back().direction == direction &&
                         (!at || !last || *at - *last <= kReceivingEnds);
    last = at;
    const auto lost = [&] { return row_not_read(number, not_understood(said), at, direction); };
    if (goes_on && !frame)
      recording.frames.back() = lost();
    else if (goes_on && !recording.frames.back().doubt)
      recording.frames.back().bytes.push_back(frame->front());
    else if (!frame)
      recording.frames.push_back(lost());
    else if (!goes_on)
      recording.frames.push_back(
          {.at = at, .direction = direction, .bytes = std::move(*frame), .place = fmt::format("line {}", number)});
  }
  count_from_first(recording);
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools
