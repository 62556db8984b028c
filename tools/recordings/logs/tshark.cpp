// What tshark and Wireshark print: a line about each packet, and with -x rows with its bytes below it; with -x alone only
// the rows; with -V the fields of each packet.
//
//     1   0.000000 192.168.1.10 → 192.168.1.20 Modbus/TCP 66    Query: Trans:     1; Unit:   1, Func:   3
//   0000  00 1d 9c c7 b0 70 00 24 21 5e 8f 01 08 00 45 00   .....p.$!^....E.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/logs/printed_packets.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kInstead = "record with tshark -w FILE.pcap";

struct TsharkRow {
  std::size_t offset = 0;
  Bytes bytes{};
};

std::optional<TsharkRow> tshark_row(std::string_view line) {
  constexpr std::size_t kFullRow = 16;
  Scan scan(line);
  const std::string_view offset = scan.take_hex(8);
  const std::size_t blanks = offset.size() < 4 ? 0 : scan.skip(" ");
  if (blanks != 2 && blanks != 3) return {};  // 3: Wireshark's export
  TsharkRow row{.offset = hex_number(offset)};
  if (row.offset % kFullRow != 0) return {};
  row.bytes = take_row(scan);
  return row.bytes.empty() ? std::nullopt : std::optional(std::move(row));
}

/// The time of a line about a packet: its number, seconds, and two addresses, with an arrow between them or in columns; or
/// that of its fields.
std::optional<LeadingTime> time_of_packet(std::string_view line, bool in_columns) {
  constexpr std::string_view kSinceFirst = "    [Time since reference or first frame: ";
  if (line.starts_with(kSinceFirst)) return leading_time(line.substr(kSinceFirst.size()));
  Scan scan(line);
  scan.skip(" ");
  if (scan.take_digits(9).empty() || scan.skip(" ") == 0) return {};
  const std::string_view rest = line.substr(scan.at());
  const bool has_arrow = rest.find(" \u2192 ") != rest.npos || rest.find(" -> ") != rest.npos;
  return has_arrow || in_columns ? leading_time(rest) : std::nullopt;
}

/// The list of packets that Wireshark exports as text or CSV, by the names of its columns.
bool is_list_of_packets(std::string_view bytes) {
  const std::string names = stl::lower_case(first_line(bytes));
  return std::ranges::all_of(std::array{"time", "source", "destination", "protocol", "info"},
                             [&](std::string_view name) { return names.find(name) != std::string::npos; });
}

/// Whether a line begins the fields of a packet: `Frame 1: 66 bytes on wire (528 bits), 66 bytes captured (528 bits)`
bool begins_fields(std::string_view line) {
  constexpr std::size_t kMostDigits = 9;
  Scan scan(line);
  return scan.take_word("Frame ") && !scan.take_digits(kMostDigits).empty() && scan.take_word(": ") &&
         !scan.take_digits(kMostDigits).empty() && scan.take_word(" byte") &&
         line.find(" on wire") != std::string_view::npos;
}

struct Packets {
  std::vector<PrintedPacket> all{};
  std::size_t listed = 0;  ///< those that have a line about them
};

/// Takes the rows of packets. Trouble if a row is missing.
Result<Packets> packets_of(std::string_view text, StopToken stop) {
  Packets packets;
  DayCounter days;
  std::optional<Time> next;
  std::size_t number = 0;
  const bool in_columns = is_list_of_packets(text);
  for (const std::string_view line : Lines(text, stop)) {
    ++number;
    if (const auto time = time_of_packet(line, in_columns)) {
      next = days.since_first_midnight(*time);
      ++packets.listed;
      continue;
    }
    const auto row = tshark_row(line);
    if (!row) continue;
    if (row->offset == 0) packets.all.push_back({.at = std::exchange(next, std::nullopt).value_or(0), .number = number});
    if (packets.all.empty() || packets.all.back().bytes.size() != row->offset)
      return trouble("line {}: rows before it are missing; {}", number, kInstead);
    Bytes& bytes = packets.all.back().bytes;
    bytes.insert(bytes.end(), row->bytes.begin(), row->bytes.end());
  }
  return packets;
}

}  // namespace

bool looks_like_tshark(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  if (is_list_of_packets(bytes)) return true;
  const std::string_view beginning = beginning_of(bytes);
  Bytes first;
  std::size_t listed = 0;
  for (const std::string_view line : Lines(beginning)) {
    if (begins_fields(line)) return true;
    if (time_of_packet(line, false)) ++listed;
    const auto row = tshark_row(line);
    if (row && row->offset != first.size()) break;
    if (row) first.insert(first.end(), row->bytes.begin(), row->bytes.end());
  }
  return first.empty() ? listed > 1 : has_ip_head(first);
}

Result<LineRecording> read_tshark(std::string_view bytes, const ReadingChoices& choices) {
  const auto packets = packets_of(bytes, choices.stop);
  if (!packets) return packets.trouble();
  if (packets->all.empty() && is_list_of_packets(bytes))
    return Trouble{"it is Wireshark's list of packets without their bytes; save the capture itself, with File, Save As"};
  if (packets->all.empty())
    return trouble("it is the list of packets without their bytes; print them with tshark -x, or {}", kInstead);
  auto recording = read_printed_packets(packets->all, kInstead, choices);
  if (!recording || packets->listed > 0) return recording;
  for (RecordedFrame& frame : recording->frames) frame.at.reset(), frame.times.clear();
  recording->notes.emplace_back("tshark -x alone prints no times; tshark -P -x does");
  return recording;
}

}  // namespace s7200::tools
