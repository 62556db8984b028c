// The console or log of Tasmota with its serial bridge in raw hex: `CMD: SerialSend5 0103…`, at its level debug also `CMD:
// Grp 0, Cmd 'SERIALSEND', Idx 5, …, Data '0103…'`, and `MQT: tele/x/RESULT = {"SerialReceived":"0103…"}`.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"

namespace s7200::tools {
namespace {

struct TasmotaRow {
  Direction direction = Direction::Unknown;
  std::string_view written{};
  bool once_more = false;  ///< the command may stand in the row above, too
};

/// A command as it is logged at the level debug.
std::optional<TasmotaRow> command_of_debug(std::string_view line) {
  constexpr std::string_view kCommand = "Cmd 'SERIALSEND", kInHex = "Idx 5,", kData = "Data '";
  const std::size_t command = line.find(kCommand), in_hex = line.find(kInHex, command), data = line.find(kData, in_hex);
  if (command == std::string_view::npos || in_hex == std::string_view::npos || data == std::string_view::npos) return {};
  const std::string_view written = line.substr(data + kData.size());
  return TasmotaRow{Direction::Request, written.substr(0, written.find('\'')), true};
}

/// Whether a row is of Tasmota's driver for Modbus, which logs values and no frames.
bool is_of_modbus_driver(std::string_view line) {
  return line.find("ModbusReceived\":") != std::string_view::npos || line.find("CMD: ModbusSend") != std::string_view::npos;
}

std::optional<TasmotaRow> tasmota_row(std::string_view line) {
  if (const auto command = command_of_debug(line)) return command;
  constexpr std::string_view kReceived = "SerialReceived\":", kSent = "SerialSend";
  if (const std::size_t at = line.find(kReceived); at != std::string_view::npos) {
    const std::string_view value = line.substr(at + kReceived.size());
    return TasmotaRow{Direction::Answer, value.substr(0, value.find('}'))};
  }
  const std::size_t at = line.find(kSent);
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + kSent.size());
  if (rest.starts_with('"')) return {};  // {"SerialSend":"Done"}
  constexpr char kHex = '5';             // SerialSend5 takes hex, the others texts
  const bool in_hex = rest.starts_with(kHex);
  return TasmotaRow{Direction::Request, in_hex ? rest.substr(1) : line.substr(at)};
}

}  // namespace

bool looks_like_tasmota(std::string_view bytes) {
  return is_text(bytes) && std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) {
           const auto moved = tasmota_row(line);
           return (moved && bytes_of_text(moved->written)) || is_of_modbus_driver(line);
         });
}

Result<LineRecording> read_tasmota(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  LeftOut left_out;
  DayCounter days;
  std::size_t number = 0;
  bool has_values = false;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    const auto moved = tasmota_row(line);
    has_values = has_values || is_of_modbus_driver(line);
    if (!moved) {
      if (!stl::trim(line).empty()) left_out.without_bytes(number);
      continue;
    }
    auto frame = bytes_of_text(moved->written);
    const auto time = leading_time(line);
    const auto at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt;
    if (!frame) {
      recording.frames.push_back(row_not_read(number, not_understood(stl::trim(moved->written)), at, moved->direction));
      continue;
    }
    const bool is_same = moved->once_more && !recording.frames.empty() &&
                         recording.frames.back().direction == moved->direction && recording.frames.back().bytes == *frame;
    if (is_same) continue;
    recording.frames.push_back(
        {.at = at, .direction = moved->direction, .bytes = std::move(*frame), .place = fmt::format("line {}", number)});
  }
  if (recording.frames.empty() && has_values)
    return Trouble{
        "it has what Tasmota's driver for Modbus sent and read, as values and not as frames; its serial bridge logs frames: "
        "SerialSend5 and SerialReceived"};
  count_from_first(recording);
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools
