// Times, directions and bytes, as tools that record lines write them.
#pragma once

#include <optional>
#include <string_view>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// A time at the beginning of a text, and what comes after it: `12:34:56.789`, `2026-11-22 12:34:56,789`, `[0.123456]`,
/// `12.3 ms`. A plain number is one only with a fraction or a unit.
struct LeadingTime {
  Time time = 0;
  std::size_t length = 0;  ///< of its text
};
std::optional<LeadingTime> leading_time(std::string_view text);

/// What a word says: TX, sent, request, > … ask; RX, received, response, < … answer.
Direction direction_of(std::string_view text);

/// `01 03 00`, `0x01,0x03`, `[01][03]`, `010300`; nothing if there is anything else.
std::optional<Bytes> bytes_of_text(std::string_view text);

/// The bytes at the end of a line, and where they begin.
struct TrailingBytes {
  Bytes bytes;
  std::size_t begin = 0;
};
std::optional<TrailingBytes> trailing_bytes(std::string_view line);

/// Rows with one character each become frames: those that follow within `gap`, in the same direction.
void join_characters(LineRecording& recording, Time gap);

/// Times count from the first frame. Those of day that go back have passed midnight.
void count_from_first(LineRecording& recording);

}  // namespace s7200::tools
