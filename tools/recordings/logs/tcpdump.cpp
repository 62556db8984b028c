// What tcpdump prints with -x, -xx, -X or -XX: a line about each packet, and rows with its bytes below it.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/logs/printed_packets.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

struct TcpdumpRow {
  std::size_t offset = 0;
  Bytes bytes{};
};

/// A row of a dump, groups of two bytes with a blank between them: `	0x0010:  7f00 0001 9c40 01f6  .....@..`
std::optional<TcpdumpRow> tcpdump_row(std::string_view line) {
  constexpr std::size_t kFullRow = 16;
  Scan scan(line);
  if (scan.skip(kAllBlanks) == 0 || !scan.take_word("0x")) return {};
  const std::string_view offset = scan.take_hex(5);
  if (offset.size() < 4 || scan.take(":") == '\0') return {};
  TcpdumpRow row{.offset = hex_number(offset)};
  for (std::size_t blanks = scan.skip(" "), most = 2; blanks >= 1 && blanks <= most && row.bytes.size() < kFullRow;
       most = 1) {
    const std::string_view group = scan.take_hex(4);
    if (group.size() != 4 && group.size() != 2) return {};
    for (std::size_t i = 0; i < group.size(); i += 2)
      row.bytes.push_back(static_cast<std::uint8_t>(hex_number(group.substr(i, 2))));
    blanks = scan.skip(" ");
    if (blanks == 0 && !scan.at_end()) return {};
  }
  return row.bytes.empty() ? std::nullopt : std::optional(std::move(row));
}

/// Takes the rows of packets. Returns false after a message if a row is missing.
Result<> take_rows(std::string_view text, StopToken stop, std::vector<PrintedPacket>& packets) {
  DayCounter days;
  std::size_t number = 0;
  for (const std::string_view line : Lines(text, stop)) {
    ++number;
    if (const auto row = tcpdump_row(line)) {
      if (packets.empty() || packets.back().bytes.size() != row->offset)
        return trouble("line {}: rows before it are missing; record with tcpdump -w FILE.pcap", number);
      packets.back().bytes.insert(packets.back().bytes.end(), row->bytes.begin(), row->bytes.end());
    } else if (const auto time = leading_time(line); time && time->time >= 0) {
      packets.push_back({.at = days.since_first_midnight(*time), .number = number});
    }
  }
  return {};
}

}  // namespace

bool looks_like_tcpdump(std::string_view bytes) {
  bool after_packet = false;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    if (after_packet && tcpdump_row(line)) return is_text(bytes);
    after_packet = leading_time(line).has_value() && line.find(" IP") != std::string_view::npos;
  }
  return false;
}

Result<LineRecording> read_tcpdump(std::string_view bytes, const ReadingChoices& choices) {
  std::vector<PrintedPacket> packets;
  if (const auto done = take_rows(bytes, choices.stop, packets); !done) return done.trouble();
  std::erase_if(packets, [](const PrintedPacket& packet) { return packet.bytes.empty() || packet.at < 0; });
  return read_printed_packets(packets, "record with tcpdump -w FILE.pcap", choices);
}

}  // namespace s7200::tools
