// What tcpdump prints with -x, -xx, -X or -XX: a line about each packet, and rows with its bytes below it. They are put into
// a pcap, which has a reader.
#include <fmt/format.h>
#include <pcap/dlt.h>

#include <algorithm>

#include "interpreter/base/text.hpp"
#include "tools/recordings/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// LINKTYPE_RAW: files have another number for it than DLT_RAW.
constexpr int kRawIp = 101;

struct PrintedPacket {
  Time at = 0;
  std::size_t number = 0;  ///< of its line
  Bytes bytes{};
};

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

/// The length in bytes that an IP packet states; 0 if it is not an IP packet.
std::size_t length_of_ip(const Bytes& packet) {
  constexpr std::size_t kIp4Head = 20, kIp6Head = 40;
  if (packet.size() >= kIp4Head && packet[0] >> 4 == 4 && (packet[0] & 15) >= 5) return load16(&packet[2]);
  if (packet.size() >= kIp6Head && packet[0] >> 4 == 6) return kIp6Head + load16(&packet[4]);
  return 0;
}

void append32(std::string& file, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) file += static_cast<char>(value >> shift);
}

/// A file of libpcap in nanoseconds. Source: draft-ietf-opsawg-pcap, sections 4 and 5.
std::string pcap_of(const std::vector<PrintedPacket>& packets, int link_type) {
  std::string file;
  constexpr std::uint32_t kMagic = 0xA1B23C4D, kVersion = 4U << 16 | 2U, kLongest = 0x40000;
  for (const std::uint32_t word : {kMagic, kVersion, 0U, 0U, kLongest, static_cast<std::uint32_t>(link_type)})
    append32(file, word);
  for (const PrintedPacket& packet : packets) {
    const auto length = static_cast<std::uint32_t>(packet.bytes.size());
    append32(file, static_cast<std::uint32_t>(packet.at / kSecond));
    append32(file, static_cast<std::uint32_t>(packet.at % kSecond));
    append32(file, length);
    append32(file, length);
    file.append(packet.bytes.begin(), packet.bytes.end());
  }
  return file;
}

/// Takes the rows of packets. Returns false after a message if a row is missing.
bool take_rows(std::string_view text, StopToken stop, std::vector<PrintedPacket>& packets, std::string& why) {
  DayCounter days;
  std::size_t number = 0;
  for (const std::string_view line : Lines(text, stop)) {
    ++number;
    if (const auto row = tcpdump_row(line)) {
      if (packets.empty() || packets.back().bytes.size() != row->offset) {
        why = fmt::format("line {}: rows before it are missing; record with tcpdump -w FILE.pcap", number);
        return false;
      }
      packets.back().bytes.insert(packets.back().bytes.end(), row->bytes.begin(), row->bytes.end());
    } else if (const auto time = leading_time(line); time && time->time >= 0) {
      packets.push_back({.at = days.since_first_midnight(*time), .number = number});
    }
  }
  return true;
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

std::optional<LineRecording> read_tcpdump(std::string_view bytes, const ReadingChoices& choices, std::string& why) {
  std::vector<PrintedPacket> packets;
  if (!take_rows(bytes, choices.stop, packets, why)) return {};
  std::erase_if(packets, [](const PrintedPacket& packet) { return packet.bytes.empty() || packet.at < 0; });
  // The bytes begin with the head of IP after -x and -X, and with that of the link after -xx and -XX.
  const bool of_ip =
      std::ranges::all_of(packets, [](const PrintedPacket& packet) { return length_of_ip(packet.bytes) != 0; });
  for (const PrintedPacket& packet : packets) {
    const std::size_t length = of_ip ? length_of_ip(packet.bytes) : 0;
    if (packet.bytes.size() >= length) continue;
    why = fmt::format("line {}: {} bytes of the packet's {} are below it; record with tcpdump -w FILE.pcap", packet.number,
                      packet.bytes.size(), length);
    return {};
  }
  return read_pcap(pcap_of(packets, of_ip ? kRawIp : DLT_EN10MB), choices, why);
}

}  // namespace s7200::tools
