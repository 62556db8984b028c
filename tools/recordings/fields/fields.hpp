// Times, directions and bytes, as tools that record lines write them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// 126 years: seconds since 1970 are within it, and the difference of two still fits a Time.
inline constexpr Time kFurthestTime = 4'000'000'000 * kSecond;

/// Days since 1970 of a date, with the day first and with the month first. They differ only in dates with slashes, of which
/// tools write both; nothing for one that does not exist.
using ReadDate = std::array<std::optional<std::int32_t>, 2>;

/// A time at the beginning of a text: `12:34:56.789`, `2026-11-22 12:34:56,789`, `3/1/2026 1:02:03.5 PM`, `24 Mar 2021
/// 1:02:03`, `02:03.456`, `[0.123456]`, `-12.3 ms`. A plain number is a time only with a fraction or a unit, or if it has
/// the 13 digits of milliseconds since 1970 or the 19 of nanoseconds. The time is no further than kFurthestTime from 0.
struct LeadingTime {
  Time time = 0;           ///< of day: since midnight
  std::size_t length = 0;  ///< of the time's text
  bool of_day = false;
  bool has_sign = false;  ///< `+0.037`: it may count from the row above
  ReadDate date{};        ///< of a time of day
};
std::optional<LeadingTime> leading_time(std::string_view text);

/// The time that all of a cell of a table is, with a zone or without: `2026-11-27T10:00:00.123Z`, `…+02:00`. All times of a
/// table have the same zone.
std::optional<LeadingTime> time_in_cell(std::string_view cell);

/// The length of a row's number before its time, with the signs between them: `17 12:34:56.789`, `17;12:34:56.789`. 0: the
/// text does not begin so.
std::size_t length_of_index(std::string_view text);

/// The length of a unit, by the first word of a column's name that is one: `Time [ms]`, `time_us`.
std::optional<Time> unit_of(std::string_view name);

/// Whether a word is what tools call the check sum of a frame, in any case: CRC, CRC16, LRC, CHECKSUM or CHK.
bool is_name_of_check_sum(std::string_view word);

/// Whether the name of a column says that it has times, in one of several languages: `Time [s]`, `Zeit`.
bool is_name_of_time(std::string_view name);

/// The direction that a word names: TX, sent, request, > … ask; RX, received, response, < … answer.
Direction direction_of(std::string_view text);

/// What a cell says of the direction. IN and OUT are those of USB, as its host has them; sentences have such words, too.
Direction direction_in_cell(std::string_view cell);

/// The direction of IN or OUT as the last word before bytes; sentences have these words elsewhere.
Direction direction_beside_bytes(std::string_view before);

/// The direction of bytes in brackets: [01][03] was sent, <01><03> was received.
Direction direction_of_brackets(std::string_view bytes);

/// The bytes of a text such as `01 03 00`, `0x01,0x3`, `[01][03]`, `010300`; nothing if there is anything else in it.
std::optional<Bytes> bytes_of_text(std::string_view text);

/// A word between blanks, or the part of it that has bytes.
struct Word {
  std::string_view text;
  std::size_t begin = 0;
  std::size_t first_byte = 0, bytes = 0;  ///< of those of its line; 0: the word is something else
  enum class Number : std::uint8_t { No, Yes, Perhaps } number = Number::No;  ///< the word is a number that is not a byte
};

/// Whether there is a time of day in a text: `10:00`.
bool has_clock(std::string_view text);

/// The first word that somebody may have meant for a time: `8:15`, `1100 ms` without its blank. Empty: there is none.
std::string_view time_like_word(std::string_view text);

/// The name before a time: `T=`, `time: `, `T+`; `Δt=` and `dt=` name the difference to the row above.
struct NameOfTime {
  std::size_t length = 0;  ///< 0: there is none
  bool is_difference = false;
};
NameOfTime name_of_time(std::string_view text);

/// The bytes of a line: one run of words in hex after what names them, with nothing after it but a comment.
struct BytesInLine {
  Bytes bytes{};
  std::size_t begin = 0;              ///< of the run
  std::size_t next_cell = 0;          ///< after a bar that ends the bytes; 0: there is none
  bool has_characters = false;        ///< the bytes stand once more as characters after it
  std::string_view not_understood{};  ///< what makes it doubtful which bytes there were; empty: nothing does
  std::vector<Reading> readings{};    ///< what the bytes of a doubtful line may be, the likelier first
};

/// Finds the bytes of lines, one after the other.
class BytesOfLines {
 public:
  /// The bytes of a line; nothing if there are none. The characters that some tools put beside the hex, after two blanks or
  /// more, or after one in a full row, are not bytes.
  std::optional<BytesInLine> in(std::string_view line);

 private:
  std::optional<BytesInLine> among_words(std::string_view line);
  void take_apart(std::string_view line);
  std::size_t end_of_hex(std::string_view line) const;
  std::optional<BytesInLine> bytes_in_comment(std::string_view line);
  std::optional<BytesInLine> bytes_with_name_of_crc() const;
  Bytes bytes_of(std::span<const Word> run) const;
  void take_readings(BytesInLine& found) const;

  std::vector<Word> words_;
  Bytes bytes_;  // of all words, one after the other
};

/// Whether a text shows the bytes as characters, as tools do beside the hex: those that cannot be printed as a sign.
/// Blanks at its end may be missing.
bool is_column_of_characters(std::string_view text, std::span<const std::uint8_t> bytes);

/// Rows with one character each become frames: those that follow within the gap, in the same direction.
class CharacterJoiner {
 public:
  explicit CharacterJoiner(const ReadingChoices& choices) : gap_(choices.gap == 0 ? kCharacterGap : choices.gap) {}
  /// The next row, into the last of the frames or as one more.
  void add(const RecordedFrame& row, std::vector<RecordedFrame>& frames);

 private:
  Time gap_;
  std::optional<Time> last_{};
};
void join_characters(LineRecording& recording, const ReadingChoices& choices);

/// Puts times of day, row after row, on one axis. Between dates that can be read in two ways lie the fewer days. Without a
/// date, midnight has passed where the time goes back by more than half a day.
class DayCounter {
 public:
  /// The time since the midnight before the first time of day; a time that is not a time of day is returned as read.
  Time since_first_midnight(const LeadingTime& read);

 private:
  Time days_ = 0;
  std::optional<Time> last_;
  ReadDate date_{};
};

/// Times count from the first frame; a row before it in time has one below 0.
void count_from_first(LineRecording& recording);

}  // namespace s7200::tools
