// A recording of a line: frames with their times, whatever tool wrote them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/base/time.hpp"
#include "serial_sim/line/line_settings.hpp"

namespace s7200::tools {

enum class Direction : std::uint8_t { Unknown, Request, Answer };

/// A possible reading of a row's bytes.
struct Reading {
  Bytes bytes{};
  bool without_word = true;  ///< the word that is in doubt is none of them
};

/// A row of which some words may be bytes or not. Only the protocol can tell: a reading of the row is accepted if it is a
/// right frame.
struct Doubt {
  std::string why{};                ///< `'7?' beside its bytes is not understood`
  std::string word{};               ///< `7?`, safe to print, as `why` is
  std::vector<Reading> readings{};  ///< the likelier first; none: some of the bytes are lost
  bool is_text = false;             ///< words stand there, not a damaged frame: a request above it still waits
};

struct RecordedFrame {
  std::optional<Time> at{};  ///< when it began, since the first frame; nothing if the recording does not say
  Direction direction = Direction::Unknown;
  Bytes bytes{};               ///< as on a serial line: a message of Modbus TCP has its unit for the station, and a CRC
  std::string place{};         ///< `packet 3`, `line 12`
  std::size_t line = 0;        ///< of a text log, from 1; 0: it is of no line of one
  std::uint32_t stream = 0;    ///< of Modbus TCP: which connection; a request and its answer are of the same
  std::uint32_t exchange = 0;  ///< of Modbus TCP: transaction and unit; a request and its answer have the same
  std::vector<Time> times{};   ///< of each character, if the recording says; the first is `at`
  /// The places of the bytes that had a parity or framing error, from 0; all of them if the recording says it of the whole
  /// frame.
  std::vector<std::size_t> damaged{};
  std::shared_ptr<const Doubt> doubt{};  ///< null: none. `bytes` hold if no reading is right; empty: the row is not read
  bool more_was_lost = false;            ///< what came after it on its line or connection is missing
};

struct LineRecording {
  std::vector<RecordedFrame> frames{};
  std::string form{};                  ///< name of its RecordingForm
  std::optional<SerialFormat> line{};  ///< if the recording shows it
  bool is_log = false;               ///< programs have noted its times when they were told; a capture has those of the line
  bool over_tcp = false;             ///< its frames were messages of Modbus TCP
  std::optional<Time> timeout{};     ///< of the master, if the recording says it
  std::vector<std::string> notes{};  ///< what was left out, and why
};

/// Characters of a recording with one in each row belong to a frame up to this silence, unless told otherwise.
inline constexpr Time kCharacterGap = 5 * kMillisecond;

struct ReadingChoices {
  Time gap = 0;  ///< between the characters of a frame, at most; 0: kCharacterGap
  std::uint16_t tcp_port = 502;
  serial::LineSettings line{};   ///< as far as the user knows them
  SerialFormat usual{};          ///< of the protocol, for what the user does not know
  std::uint64_t samplerate = 0;  ///< samples a second of a recording that counts them; 0: as it says itself, or not known
  /// mbpoll had its option -0: references count from 0. A run of mbpoll that starts at 0 counts so without this, too.
  bool mbpoll_from_zero = false;
  StopToken stop{};  ///< asked from line to line: what comes after it is not read
};

/// A form in which tools write recordings.
struct RecordingForm {
  std::string_view name;     ///< `pcap`
  std::string_view meaning;  ///< for the help
  bool is_log;               ///< CSV counts as one: analysers write it, but so do programs
  bool (*looks_like)(std::string_view bytes);
  Result<LineRecording> (*read)(std::string_view bytes, const ReadingChoices& choices);
  bool counts_samples = false;  ///< so that a samplerate makes times of them
};
std::span<const RecordingForm> recording_forms();

/// Reads a file of any of the forms. Trouble if `bytes` have none of them, or no frame.
Result<LineRecording> read_recording(std::string_view bytes, const ReadingChoices& choices);

}  // namespace s7200::tools
