// What somebody recorded on a line: frames with their times, whatever tool wrote them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/time.hpp"

namespace s7200::tools {

enum class Direction : std::uint8_t { Unknown, Request, Answer };

struct RecordedFrame {
  std::optional<Time> at{};  ///< when it began, since the first frame; nothing if the recording does not say
  Direction direction = Direction::Unknown;
  Bytes bytes{};              ///< as on a serial line: a message of Modbus TCP has its unit for the station, and a CRC
  std::string place{};        ///< `packet 3`, `line 12`
  std::uint32_t stream = 0;   ///< of Modbus TCP: which connection; a request and its answer are of the same
  std::vector<Time> times{};  ///< of each character, if the recording says; the first is `at`
  std::vector<std::size_t> damaged{};  ///< which of them had a parity or framing error, from 0
};

struct LineRecording {
  std::vector<RecordedFrame> frames{};
  std::string form{};                ///< `pcap`, `text`, `CSV`
  std::vector<std::string> notes{};  ///< what was left out, and why
};

struct ReadingChoices {
  Time gap = 0;  ///< characters of a recording with one in each row belong to a frame up to this silence; 0: 5 ms
  std::uint16_t tcp_port = 502;
};

/// Reads a pcap or pcapng file (link types 147, Ethernet, Linux cooked, raw IP), a CSV file or a text log. Nothing and `why`
/// if `bytes` are none of these, or have no frame.
std::optional<LineRecording> read_recording(const std::string& bytes, const ReadingChoices& choices, std::string& why);

// The readers behind it. Frames may be none.
std::optional<LineRecording> read_pcap(const std::string& bytes, const ReadingChoices& choices, std::string& why);
std::optional<LineRecording> read_csv(std::string_view text, const ReadingChoices& choices, std::string& why);
LineRecording read_text_log(std::string_view text, const ReadingChoices& choices);

/// Whether a text begins with a row that names its columns.
bool looks_like_csv(std::string_view text);

}  // namespace s7200::tools
