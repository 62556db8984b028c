// What pymodbus logs at the level DEBUG, under whatever head the program's logger gives each line:
//
//   send: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa
//   recv: 0x1 0x3 0x2 old_data:  addr=None             what has come; after old_data:, later extra data:, what waits
//   already recv: 0x12 0x34 0xb5 0x33 old_data: 0x1 0x3 0x2 addr=None Processing: 0x1 0x3 0x2 0x12 0x34 0xb5 0x33        the
//   same bytes once more
//   Handling data: 0x1 0x3 0x0 …                       of a server: what has come, from version 3 on once more after recv
//   send: [ReadRegisterResponse (2)]- b'010304…'       of a server of version 2: its answer in hex
//   Getting Frame - 0x3 0x2 0x12 0x34                  of version 2: those between the station and the CRC once more
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

struct PymodbusRow {
  bool sent = false;
  Bytes bytes{}, waiting{};  ///< and what was there of the frame before
  bool handled = false;      ///< by a server, which may have said it before
};

/// The bytes that a text begins with, `0x1 0x3 …`; they are taken off it.
Bytes take_bytes(std::string_view& text) {
  constexpr std::string_view kBlanks = " \t";
  std::size_t end = 0, next = 0;
  while (text.substr(next, 2) == "0x" || text.substr(next, 2) == "0X") {
    end = std::min(text.find_first_of(kBlanks, next), text.size());
    next = std::min(text.find_first_not_of(kBlanks, end), text.size());
  }
  const auto bytes = bytes_of_text(text.substr(0, end));
  text.remove_prefix(next);
  return bytes.value_or(Bytes{});
}

/// The text after a word in the line, unless the word is the end of another.
std::optional<std::string_view> what_follows(std::string_view line, std::string_view word) {
  const std::size_t at = line.find(word);
  if (at == std::string_view::npos || (at > 0 && std::isalnum(static_cast<unsigned char>(line[at - 1])) != 0)) return {};
  return line.substr(at + word.size());
}

/// The bytes of `[ReadRegisterResponse (2)]- b'010304…'`
Bytes bytes_of_answer(std::string_view text) {
  constexpr std::string_view kBefore = "]- ";
  const std::size_t end = text.find(kBefore);
  if (!text.starts_with('[') || end == std::string_view::npos) return {};
  std::string_view hex = stl::trim(text.substr(end + kBefore.size()));
  if (hex.starts_with("b'") && hex.ends_with('\'')) hex = hex.substr(2, hex.size() - 3);
  return bytes_of_text(hex).value_or(Bytes{});
}

constexpr std::string_view kHandled = "Handling data: ";

std::optional<PymodbusRow> pymodbus_row(std::string_view line) {
  if (auto rest = what_follows(line, kHandled)) {
    PymodbusRow moved{.bytes = take_bytes(*rest), .handled = true};
    return moved.bytes.empty() ? std::nullopt : std::optional(std::move(moved));
  }
  for (const std::string_view word : {"send: ", "SEND: ", "recv: ", "RECV: "}) {
    auto rest = what_follows(line, word);
    if (!rest) continue;
    PymodbusRow moved{.sent = word.front() == 's' || word.front() == 'S', .bytes = take_bytes(*rest)};
    if (moved.bytes.empty() && moved.sent) moved.bytes = bytes_of_answer(*rest);
    if (moved.bytes.empty()) continue;
    for (const std::string_view waiting : {"old_data:", "extra data:"})
      if (rest->starts_with(waiting)) {
        std::string_view there = stl::trim(rest->substr(waiting.size()));
        moved.waiting = take_bytes(there);
      }
    return moved;
  }
  return {};
}

/// Bytes that are not understood: `recv: 0x1 0x`.
std::optional<std::string_view> damaged_in(std::string_view line) {
  for (const std::string_view word : {"send: 0", "SEND: 0", "recv: 0", "RECV: 0"})
    if (const auto rest = what_follows(line, word))
      return line.substr(static_cast<std::size_t>(rest->data() - line.data()) - 1);
  return {};
}

/// Whether the line has bytes that another line of the log has too.
bool says_it_again(std::string_view line) {
  const std::size_t received = std::min(line.find("recv: 0x"), line.size());
  const auto follows = [&](std::string_view waiting) { return line.find(waiting, received) != std::string_view::npos; };
  const auto has = [&](std::string_view words) { return line.find(words) != std::string_view::npos; };
  return has("Handling data: 0x") || has("Processing: 0x") || has("Getting Frame - 0x") || follows(" old_data:") ||
         follows(" extra data:");
}

/// The frame that has come so far goes on with these bytes.
bool goes_on(const LineRecording& recording, const PymodbusRow& moved, Direction direction) {
  return !moved.sent && !moved.waiting.empty() && !recording.frames.empty() &&
         recording.frames.back().direction == direction && recording.frames.back().bytes == moved.waiting;
}

}  // namespace

bool looks_like_pymodbus(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  const auto any = [&](auto says) {
    return std::ranges::any_of(Lines(bytes), [&](std::string_view line) { return !line.empty() && says(line); });
  };
  return any(says_it_again) && any([](std::string_view line) { return pymodbus_row(line).has_value(); });
}

/// A log that begins with what was sent is a client's. One that begins with what has come may be a server's, or begin in the
/// middle: then the frames have to say it themselves.
Result<LineRecording> read_pymodbus(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  DayCounter days;
  std::optional<bool> is_client;
  const bool says_received = std::ranges::any_of(Lines(bytes, choices.stop), [](std::string_view line) {
    const auto moved = pymodbus_row(line);
    return moved && !moved->sent && !moved->handled;
  });
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    auto moved = pymodbus_row(line);
    if (moved && moved->handled && says_received) continue;
    if (!moved) {
      if (const auto damaged = damaged_in(line))
        recording.frames.push_back(row_not_read(number, not_understood(*damaged), {}, Direction::Unknown));
      continue;
    }
    if (!is_client) is_client = moved->sent;
    const Direction who = moved->sent ? Direction::Request : Direction::Answer;
    const Direction direction = *is_client ? who : Direction::Unknown;
    if (goes_on(recording, *moved, direction)) {
      Bytes& frame = recording.frames.back().bytes;
      frame.insert(frame.end(), moved->bytes.begin(), moved->bytes.end());
      continue;
    }
    const auto time = leading_time(line);
    recording.frames.push_back({.at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt,
                                .direction = direction,
                                .bytes = std::move(moved->bytes),
                                .place = fmt::format("line {}", number)});
  }
  count_from_first(recording);
  return recording;
}

}  // namespace s7200::tools
