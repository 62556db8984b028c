// Captures of serial lines (link type 147) and of Modbus TCP, read by libpcap.
#include <fmt/format.h>
#include <pcap/pcap.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <tuple>

#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/fields.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr int kSerial = 147;  // LINKTYPE_USER0, which s7200 writes

struct Segment {
  Bytes from{}, to{};  ///< addresses with ports: who talks to whom
  std::uint16_t source_port = 0, destination_port = 0;
  std::uint32_t sequence = 0;
  bool begins = false;  ///< SYN
  Data data{};
};

/// The TCP segment in an IP packet; nothing if it has none, or is a fragment.
std::optional<Segment> tcp_of(Data packet) {
  constexpr std::uint8_t kTcp = 6;
  if (packet.empty()) return {};
  Data from, to, tcp;
  if (packet[0] >> 4 == 4 && packet.size() >= 20) {
    const std::size_t head = std::size_t{packet[0] & 15U} * 4, length = load16(&packet[2]);
    const bool fragment = (load16(&packet[6]) & 0x3FFF) != 0;
    if (packet[9] != kTcp || fragment || head < 20 || length < head || length > packet.size()) return {};
    from = packet.subspan(12, 4), to = packet.subspan(16, 4), tcp = packet.subspan(head, length - head);
  } else if (packet[0] >> 4 == 6 && packet.size() >= 40) {
    const std::size_t length = load16(&packet[4]);
    if (packet[6] != kTcp || 40 + length > packet.size()) return {};
    from = packet.subspan(8, 16), to = packet.subspan(24, 16), tcp = packet.subspan(40, length);
  }
  if (tcp.size() < 20) return {};
  const std::size_t head = std::size_t{tcp[12]} / 16 * 4;
  if (head < 20 || head > tcp.size()) return {};
  Segment segment{.from = Bytes(from.begin(), from.end()),
                  .to = Bytes(to.begin(), to.end()),
                  .source_port = load16(&tcp[0]),
                  .destination_port = load16(&tcp[2]),
                  .sequence = load32(&tcp[4]),
                  .begins = (tcp[13] & 2) != 0,
                  .data = tcp.subspan(head)};
  segment.from.insert(segment.from.end(), tcp.begin(), tcp.begin() + 2);
  segment.to.insert(segment.to.end(), tcp.begin() + 2, tcp.begin() + 4);
  return segment;
}

/// What a link layer's packet carries, if that is IP.
Data ip_of(Data packet, int link_type) {
  const auto after = [&](std::size_t head, std::size_t type) {
    if (packet.size() < head) return Data{};
    std::uint16_t ether_type = load16(&packet[type]);
    for (; ether_type == 0x8100 && packet.size() >= head + 4; head += 4) ether_type = load16(&packet[head + 2]);
    return ether_type == 0x0800 || ether_type == 0x86DD ? packet.subspan(head) : Data{};
  };
  switch (link_type) {
    case DLT_EN10MB:
      return after(14, 12);
    case DLT_LINUX_SLL:
      return after(16, 14);
    case DLT_LINUX_SLL2:
      return after(20, 0);
    default:
      return packet;
  }
}

/// One direction of a connection.
struct Stream {
  std::optional<std::uint32_t> next{};  ///< sequence number
  modbus::MbapReader reader{};
  std::uint32_t connection = 0;
  bool lost = false;
};

class Reader {
 public:
  Reader(const ReadingChoices& choices, int link_type) : choices_(choices), link_type_(link_type) {}

  void take(std::size_t number, Time at, Data packet) {
    const std::string place = fmt::format("packet {}", number);
    if (link_type_ == kSerial) {
      if (!packet.empty())
        recording_.frames.push_back({.at = at, .bytes = Bytes(packet.begin(), packet.end()), .place = place});
      return;
    }
    const auto segment = tcp_of(ip_of(packet, link_type_));
    const bool ours =
        segment && (segment->source_port == choices_.tcp_port || segment->destination_port == choices_.tcp_port);
    if (ours)
      take(*segment, at, place);
    else
      ++left_out_;
  }

  LineRecording finish() {
    if (left_out_ > 0)
      recording_.notes.push_back(fmt::format("{} not of TCP port {} {} left out",
                                             left_out_ == 1 ? "a packet" : fmt::format("{} packets", left_out_),
                                             choices_.tcp_port, left_out_ == 1 ? "was" : "were"));
    count_from_first(recording_);
    return std::move(recording_);
  }

 private:
  void take(const Segment& segment, Time at, const std::string& place) {
    const bool asks = segment.destination_port == choices_.tcp_port;
    Stream& stream = streams_[{segment.from, segment.to}];
    if (stream.connection == 0) {
      const auto other = streams_.find({segment.to, segment.from});
      stream.connection =
          other == streams_.end() || other->second.connection == 0 ? ++connections_ : other->second.connection;
    }
    if (segment.begins) {
      stream.next = segment.sequence + 1;
      stream.reader = {};
      stream.lost = false;
      return;
    }
    if (segment.data.empty() || stream.lost) return;
    const std::uint32_t ahead = stream.next ? segment.sequence - *stream.next : 0;
    if (ahead > 0x8000'0000) return;  // sent again
    if (ahead != 0) return lose(stream, place, "segments before it are missing");
    stream.next = segment.sequence + static_cast<std::uint32_t>(segment.data.size());
    stream.reader.take(segment.data);
    while (const auto message = stream.reader.next())
      recording_.frames.push_back({.at = at,
                                   .direction = asks ? Direction::Request : Direction::Answer,
                                   .bytes = modbus::rtu_frame(message->unit, message->pdu),
                                   .place = place,
                                   .stream = stream.connection});
    if (!stream.reader.error().empty()) lose(stream, place, stream.reader.error());
  }

  void lose(Stream& stream, const std::string& place, std::string_view why) {
    stream.lost = true;
    recording_.notes.push_back(fmt::format("{}: the rest of this connection was left out: {}", place, why));
  }

  const ReadingChoices& choices_;
  int link_type_;
  LineRecording recording_{.form = "pcap"};
  std::map<std::pair<Bytes, Bytes>, Stream> streams_;
  std::uint32_t connections_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace

std::optional<LineRecording> read_pcap(const std::string& bytes, const ReadingChoices& choices, std::string& why) {
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  std::FILE* file = ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb");
  if (file == nullptr) return why = "out of memory", std::nullopt;
  const std::unique_ptr<pcap_t, void (*)(pcap_t*)> capture(
      pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, error.data()), [](pcap_t* p) {
        if (p != nullptr) pcap_close(p);
      });
  if (!capture) {
    std::fclose(file);
    why = error.data();
    return {};
  }
  const int link_type = pcap_datalink(capture.get());
  if (link_type != kSerial && link_type != DLT_EN10MB && link_type != DLT_LINUX_SLL && link_type != DLT_LINUX_SLL2 &&
      link_type != DLT_RAW && link_type != DLT_IPV4 && link_type != DLT_IPV6) {
    why = fmt::format("link type {} is not one of 147 (serial), Ethernet, Linux cooked or raw IP", link_type);
    return {};
  }
  Reader reader(choices, link_type);
  pcap_pkthdr* head = nullptr;
  const u_char* data = nullptr;
  int result = 0;
  std::size_t number = 0;
  while ((result = pcap_next_ex(capture.get(), &head, &data)) == 1)
    reader.take(++number, head->ts.tv_sec * kSecond + head->ts.tv_usec, {data, head->caplen});
  LineRecording recording = reader.finish();
  if (result == PCAP_ERROR)
    recording.notes.push_back(
        fmt::format("after packet {} the file cannot be read: {}", number, pcap_geterr(capture.get())));
  return recording;
}

}  // namespace s7200::tools
