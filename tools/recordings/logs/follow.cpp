// What Wireshark saves of a TCP stream that it follows: as a hex dump, which tshark -z follow,tcp,hex prints as well, as
// arrays of C, or as YAML. Peer 0 opened the connection, and asks.
//
//   00000000  00 01 00 00 00 06 01 03  00 0a 00 02               ........ ....
//       00000000  00 01 00 00 00 07 01 03  04 12 34 56 78        ........ ..4Vx
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/json/base64.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kArray = "char peer", kComment = "/*", kBinary = "data: !!binary";

Direction direction_of_peer(bool second) { return second ? Direction::Answer : Direction::Request; }

RecordedFrame frame_of_peer(bool second, std::size_t line) {
  return {.direction = direction_of_peer(second), .place = fmt::format("line {}", line)};
}

// --- as a hex dump: offsets count in the stream of each peer ---

struct FollowedRow {
  bool second = false;  ///< of peer 1, whose rows are indented
  std::size_t offset = 0;
  Bytes bytes{};
};

std::optional<FollowedRow> followed_row(std::string_view line) {
  constexpr std::size_t kIndent = 4, kOffset = 8;
  Scan scan(line);
  const std::size_t indent = scan.take("\t") != '\0' ? kIndent : scan.skip(" ");  // a tab is tshark's
  const std::string_view offset = scan.take_hex(kOffset);
  if ((indent != 0 && indent != kIndent) || offset.size() != kOffset || scan.skip(" ") != 2) return {};
  FollowedRow row{.second = indent != 0, .offset = hex_number(offset), .bytes = take_row(scan)};
  return row.bytes.empty() ? std::nullopt : std::optional(std::move(row));
}

/// Whether a line is of the frame that tshark draws around a stream: `=====`, `Follow: tcp,hex`, `Node 0: 10.0.0.1:40000`
bool is_around_stream(std::string_view line) {
  return std::ranges::any_of(std::array<std::string_view, 4>{"====", "Follow: ", "Filter: ", "Node "},
                             [line](std::string_view begin) { return line.starts_with(begin); });
}

/// Whether the first lines are rows of two peers, each at the end of what its peer has sent so far.
bool is_followed_dump(std::string_view text) {
  constexpr std::size_t kEnough = 100;
  std::size_t rows = 0;
  std::array<std::size_t, 2> sent{};
  for (const std::string_view line : Lines(text)) {
    if (stl::trim(line).empty() || is_around_stream(line)) continue;
    const auto row = followed_row(line);
    if (!row || row->offset != sent[row->second]) return false;
    sent[row->second] += row->bytes.size();
    if (++rows == kEnough) break;
  }
  return sent[0] > 0 && sent[1] > 0;
}

void read_dump(std::string_view text, StopToken stop, LineRecording& recording) {
  constexpr std::size_t kFullRow = 16;
  bool goes_on = false;
  std::size_t number = 0;
  for (const std::string_view line : Lines(text, stop)) {
    ++number;
    const auto row = followed_row(line);
    if (!row) continue;
    const bool same = goes_on && recording.frames.back().direction == direction_of_peer(row->second);
    if (!same) recording.frames.push_back(frame_of_peer(row->second, number));
    Bytes& bytes = recording.frames.back().bytes;
    bytes.insert(bytes.end(), row->bytes.begin(), row->bytes.end());
    goes_on = row->bytes.size() == kFullRow;
  }
}

// --- as arrays of C: `char peer0_0[] = { /* Packet 4 */`, and their bytes in the lines below ---

void read_arrays(std::string_view text, StopToken stop, LineRecording& recording) {
  std::size_t number = 0;
  for (std::string_view line : Lines(text, stop)) {
    ++number;
    if (const std::size_t array = line.find(kArray); array != std::string_view::npos) {
      recording.frames.push_back(frame_of_peer(line.substr(array + kArray.size()).starts_with('1'), number));
      line.remove_prefix(std::min(line.find('{'), line.size()));
    }
    if (recording.frames.empty()) continue;
    for (std::size_t at = line.find("0x"); at != std::string_view::npos; at = line.find("0x", at + 1)) {
      Scan scan(line.substr(at + 2));
      const std::string_view digits = scan.take_hex(2);
      if (!digits.empty()) recording.frames.back().bytes.push_back(static_cast<std::uint8_t>(hex_number(digits)));
    }
  }
}

// --- as YAML: a list of packets with their bytes in base64 ---

/// The value of a key: `  timestamp: 1616595070.25`. Empty if the line has another key.
std::string_view value_of_key(std::string_view line, std::string_view key) {
  line = stl::trim(line);
  if (line.starts_with("- ")) line.remove_prefix(2);
  const bool has_key = line.size() > key.size() && line.starts_with(key) && line[key.size()] == ':';
  return has_key ? stl::trim(line.substr(key.size() + 1)) : "";
}

/// Trouble if bytes are not base64.
Result<> read_packets(std::string_view text, StopToken stop, LineRecording& recording) {
  std::string base64;
  std::size_t number = 0;
  bool in_bytes = false;
  const auto end_packet = [&]() -> Result<> {
    if (recording.frames.empty() || !recording.frames.back().bytes.empty()) return {};
    auto bytes = from_base64(base64);
    if (!bytes) return trouble("{}: its bytes are not base64", recording.frames.back().place);
    recording.frames.back().bytes = *std::move(bytes);
    return {};
  };
  for (const std::string_view line : Lines(text, stop)) {
    ++number;
    if (!value_of_key(line, "packet").empty()) {
      if (const auto done = end_packet(); !done) return done;
      recording.frames.push_back(frame_of_peer(false, number));
      base64.clear();
      in_bytes = false;
    } else if (recording.frames.empty()) {
      continue;
    } else if (in_bytes) {
      base64 += stl::trim(line);
    } else if (const auto peer = value_of_key(line, "peer"); !peer.empty()) {
      recording.frames.back().direction = direction_of_peer(peer == "1");
    } else if (const auto at = value_of_key(line, "timestamp"); !at.empty()) {
      if (const auto time = leading_time(at)) recording.frames.back().at = time->time;
    } else if (stl::trim(line).starts_with(kBinary)) {
      in_bytes = true;
    }
  }
  return end_packet();
}

/// Whether the first line that is no comment begins an array: `static const unsigned char peer0_0[] = {`
bool has_followed_arrays(std::string_view text) {
  for (const std::string_view line : Lines(beginning_of(text)))
    if (!stl::trim(line).empty() && !line.starts_with(kComment)) return line.find(kArray) != std::string_view::npos;
  return false;
}

bool has_followed_packets(std::string_view text) {
  return text.find("peers:") != std::string_view::npos && text.find("packets:") != std::string_view::npos &&
         text.find(kBinary) != std::string_view::npos;
}

}  // namespace

bool looks_like_followed_stream(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  const std::string_view beginning = beginning_of(bytes);
  return has_followed_arrays(beginning) || has_followed_packets(beginning) || is_followed_dump(beginning);
}

Result<LineRecording> read_followed_stream(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  if (has_followed_arrays(bytes))
    read_arrays(bytes, choices.stop, recording);
  else if (!has_followed_packets(beginning_of(bytes)))
    read_dump(bytes, choices.stop, recording);
  else if (const auto done = read_packets(bytes, choices.stop, recording); !done)
    return done.trouble();
  for (RecordedFrame& frame : recording.frames)
    if (frame.bytes.empty()) frame.doubt = std::make_shared<Doubt>(Doubt{.why = "no bytes in it"});
  count_from_first(recording);
  return recording;
}

}  // namespace s7200::tools
