#include "tools/recordings/logs/printed_packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/recordings/capture_file.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

/// A kind of link, with the length of its head and the place of the protocol's number in it.
struct Link {
  int type;
  std::size_t head, protocol;
};
/// Raw IP has no head. The others: IEEE 802.3, and LINKTYPE_LINUX_SLL of the list of link types of tcpdump.org.
constexpr std::array kLinks{Link{link_types::kRawIp, 0, 0}, Link{link_types::kEthernet, 14, 12},
                            Link{link_types::kLinuxCooked, 16, 14}};

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
std::string pcap_of(std::span<const PrintedPacket> packets, int link_type) {
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

/// The length in bytes of a packet with the head of its link, by its IP head; 0 if it is no IP packet behind such a head.
std::size_t length_with(const Link& link, const Bytes& packet) {
  constexpr std::uint16_t kIp4 = 0x0800, kIp6 = 0x86DD;
  if (packet.size() <= link.head) return 0;
  const std::uint16_t protocol = link.head == 0 ? kIp4 : load16(&packet[link.protocol]);
  const std::size_t length = length_of_ip(Bytes(packet.begin() + static_cast<std::ptrdiff_t>(link.head), packet.end()));
  return length == 0 || (protocol != kIp4 && protocol != kIp6) ? 0 : link.head + length;
}

/// The link that all packets, but those of other protocols, have a head of: most of them have to.
const Link& link_of(std::span<const PrintedPacket> packets) {
  return *std::ranges::max_element(kLinks, {}, [&](const Link& link) {
    return std::ranges::count_if(packets, [&](const PrintedPacket& each) { return length_with(link, each.bytes) != 0; });
  });
}

}  // namespace

bool has_ip_head(const Bytes& packet) {
  return std::ranges::any_of(kLinks, [&](const Link& link) { return length_with(link, packet) != 0; });
}

Result<LineRecording> read_printed_packets(std::span<const PrintedPacket> packets, std::string_view instead,
                                           const ReadingChoices& choices) {
  const Link& link = link_of(packets);
  for (const PrintedPacket& packet : packets) {
    const std::size_t length = length_with(link, packet.bytes);
    if (packet.bytes.size() >= length) continue;
    return trouble("line {}: {} bytes of the packet's {} are below it; {}", packet.number, packet.bytes.size(), length,
                   instead);
  }
  return read_pcap(pcap_of(packets, link.type), choices);
}

}  // namespace s7200::tools
