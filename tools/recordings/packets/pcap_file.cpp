// Captures of serial lines and of Modbus TCP.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "interpreter/base/result.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/capture_file.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/packets/serial_links.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

struct Segment {
  bool whole = true;   ///< otherwise a fragment, or cut off, and the rest does not count
  Bytes from{}, to{};  ///< addresses with ports: who talks to whom
  std::uint16_t source_port = 0, destination_port = 0;
  std::uint32_t sequence = 0;
  bool begins = false;  ///< SYN
  Data data{};
};

/// The TCP segment in an IP packet; nothing if it has none. Where the network card divides what is sent, the length may be 0
/// in the recording: then it goes to the end.
std::optional<Segment> tcp_of(Data packet) {
  constexpr std::uint8_t kTcp = 6;
  constexpr std::size_t kIp4Head = 20, kIp6Head = 40, kTcpHead = 20;
  if (packet.empty()) return {};
  const auto broken = [] { return Segment{.whole = false}; };
  Data from, to, tcp;
  if (packet[0] >> 4 == 4 && packet.size() >= kIp4Head) {
    const std::size_t head = std::size_t{packet[0] & 15U} * 4, length = load16(&packet[2]);
    const std::size_t end = length == 0 ? packet.size() : length;
    const bool fragment = (load16(&packet[6]) & 0x3FFF) != 0;
    if (packet[9] != kTcp) return {};
    if (fragment || head < kIp4Head || end < head || end > packet.size()) return broken();
    from = packet.subspan(12, 4), to = packet.subspan(16, 4), tcp = packet.subspan(head, end - head);
  } else if (packet[0] >> 4 == 6 && packet.size() >= kIp6Head) {
    const std::size_t length = load16(&packet[4]);
    if (packet[6] != kTcp) return {};
    if (kIp6Head + length > packet.size()) return broken();
    from = packet.subspan(8, 16), to = packet.subspan(24, 16);
    tcp = length == 0 ? packet.subspan(kIp6Head) : packet.subspan(kIp6Head, length);
  } else {
    return {};
  }
  const std::size_t head = tcp.size() < kTcpHead ? 0 : std::size_t{tcp[12]} / 16 * 4;
  if (head < kTcpHead || head > tcp.size()) return broken();
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

/// Whether a tag of a virtual network follows: IEEE 802.1Q, 802.1ad, and what was there before that.
bool is_tag(std::uint16_t ether_type) { return ether_type == 0x8100 || ether_type == 0x88A8 || ether_type == 0x9100; }

/// The IP packet in a packet of the link layer, if there is one.
Data ip_of(Data packet, int link_type) {
  constexpr std::size_t kFamily = 4;  // bytes before a packet of the loopback
  const auto after = [&](std::size_t head, std::size_t type) {
    if (packet.size() < head) return Data{};
    std::uint16_t ether_type = load16(&packet[type]);
    for (; is_tag(ether_type) && packet.size() >= head + 4; head += 4) ether_type = load16(&packet[head + 2]);
    return ether_type == 0x0800 || ether_type == 0x86DD ? packet.subspan(head) : Data{};
  };
  switch (link_type) {
    case link_types::kEthernet:
      return after(14, 12);
    case link_types::kLinuxCooked:
      return after(16, 14);
    case link_types::kLinuxCooked2:
      return after(20, 0);
    case link_types::kLoopback:
    case link_types::kLoopbackOfOpenBsd:
      return packet.subspan(std::min(kFamily, packet.size()));
    default:
      return packet;
  }
}

/// One direction of a connection.
struct Stream {
  std::optional<std::uint32_t> next{};  ///< sequence number
  modbus::MbapReader reader{};
  std::uint32_t connection = 0;
  bool out_of_step = false;  ///< where the next message begins is not known
  Bytes held{};              ///< then: what may be the first bytes of one whose head is not all there
};

/// The place of the first message of a segment after something was lost: the messages' heads lead from one to the next, up
/// to the end of the segment. Only the first byte may begin a message that goes on in the next segment.
std::optional<std::size_t> first_message_in(Data data) {
  constexpr std::size_t kHead = 6;
  const auto after_message = [&](std::size_t begin) {
    if (begin + kHead > data.size() || load16(&data[begin + 2]) != 0) return std::size_t{0};
    const std::size_t length = load16(&data[begin + 4]);
    return length >= 2 && length <= 1 + modbus::kLongestPdu ? begin + kHead + length : std::size_t{0};
  };
  if (after_message(0) > data.size()) return 0;
  for (std::size_t begin = 0; begin + kHead < data.size(); ++begin) {
    std::size_t end = begin;
    do end = after_message(end);
    while (end != 0 && end < data.size());
    if (end == data.size()) return begin;
  }
  return {};
}

/// Whether bytes may be the first of a message, and are not its whole head.
bool may_begin_head(Data data) {
  constexpr std::size_t kHead = 6, kProtocol = 2, kLength = 4;
  bool is_modbus = true;
  for (std::size_t at = kProtocol; at < std::min(kLength, data.size()); ++at) is_modbus &= data[at] == 0;
  return data.size() < kHead && is_modbus;
}

/// Whether a segment is a frame of Modbus RTU, as servers of serial ports send it, and no message of Modbus TCP.
bool is_rtu(Data data) {
  constexpr std::size_t kHead = 6, kShortest = 4;
  const bool has_head = data.size() > kHead && load16(&data[2]) == 0 && kHead + load16(&data[4]) == data.size();
  return data.size() >= kShortest && !has_head && modbus::crc_ok(data);
}

class PacketFrames {
 public:
  explicit PacketFrames(const ReadingChoices& choices) : choices_(choices) {}

  void take(std::size_t number, Time at, int link_type, Data packet) {
    const std::string place = fmt::format("packet {}", number);
    if (SerialLinks::carry(link_type)) return serial_.take(place, at, link_type, packet);
    const auto segment = tcp_of(ip_of(packet, link_type));
    if (segment && !segment->whole)
      ++broken_;
    else if (segment && (segment->source_port == choices_.tcp_port || segment->destination_port == choices_.tcp_port))
      take(*segment, at, place);
    else
      leave_out(segment);
  }

  /// The capture lacks everything after the last frame of each connection.
  void cut_off() {
    for (const auto& [connection, frame] : last_) recording_.frames[frame].more_was_lost = true;
    serial_.cut_off();
  }

  /// The recording. Trouble if several devices are captured and none is known to be the line.
  Result<LineRecording> finish() {
    if (const auto done = serial_.finish(recording_); !done) return done.trouble();
    note_left_out(others_, fmt::format("not of TCP port {}", choices_.tcp_port));
    if (recording_.frames.empty() && !other_ports_.empty()) {
      const auto most = std::ranges::max_element(other_ports_, {}, [](const auto& each) { return each.second; });
      recording_.notes.push_back(fmt::format("most have port {}: --tcp-port {}", most->first, most->first));
    }
    if (of_rtu_)
      recording_.notes.emplace_back("its TCP carries Modbus RTU: the frames have a CRC, and no head of Modbus TCP");
    note_left_out(broken_, "of TCP in fragments or cut off");
    for (const auto& [reason, losses] : losses_) {
      const std::string more = losses.count == 1 ? "" : fmt::format(", and {} more", losses.count - 1);
      recording_.notes.push_back(
          fmt::format("{}{}: {}; reading goes on with the next message that begins a segment", losses.first, more, reason));
    }
    count_from_first(recording_);
    return std::move(recording_);
  }

 private:
  /// Counts packets with data by the port of the server, which is the lower one.
  void leave_out(const std::optional<Segment>& segment) {
    ++others_;
    if (segment && !segment->data.empty()) ++other_ports_[std::min(segment->source_port, segment->destination_port)];
  }

  void add(RecordedFrame frame) {
    last_[frame.stream] = recording_.frames.size();
    recording_.frames.push_back(std::move(frame));
  }

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
      stream.out_of_step = false;
      stream.held.clear();
      return;
    }
    if (segment.data.empty()) return;
    const auto ahead = static_cast<std::int32_t>(segment.sequence - stream.next.value_or(segment.sequence));
    const Bytes& server = asks ? segment.to : segment.from;
    if (ahead > 0) lose(stream, place, "segments before it are missing");
    const auto sent_again = static_cast<std::size_t>(std::max<std::int64_t>(0, -std::int64_t{ahead}));
    if (sent_again >= segment.data.size()) return;
    stream.next = segment.sequence + static_cast<std::uint32_t>(segment.data.size());
    Data data = segment.data.subspan(sent_again);
    const bool may_begin = !tcp_servers_.contains(server) && (stream.out_of_step || stream.reader.pending() == 0);
    if (rtu_servers_.contains(server) || (may_begin && is_rtu(data))) {
      rtu_servers_.insert(server);
      recording_.is_log = of_rtu_ = true;  // its times are those of TCP, which divides and joins frames as it likes
      return recording_.frames.push_back({.at = at,
                                          .direction = asks ? Direction::Request : Direction::Answer,
                                          .bytes = Bytes(data.begin(), data.end()),
                                          .place = place});
    }
    Bytes whole;
    if (stream.out_of_step) {
      whole = std::exchange(stream.held, {});
      whole.insert(whole.end(), data.begin(), data.end());
      const auto begin = first_message_in(whole);
      if (!begin) {
        for (const Data first : {Data(whole), data})
          if (stream.held.empty() && may_begin_head(first)) stream.held.assign(first.begin(), first.end());
        return;
      }
      data = Data(whole).subspan(*begin);
      stream.reader = {};
      stream.out_of_step = false;
    }
    stream.reader.take(data);
    while (const auto message = stream.reader.next()) {
      tcp_servers_.insert(server);
      add({.at = at,
           .direction = asks ? Direction::Request : Direction::Answer,
           .bytes = modbus::rtu_frame(message->unit, message->pdu),
           .place = place,
           .stream = stream.connection,
           .exchange = modbus::exchange_of(*message)});
    }
    if (!stream.reader.error().empty()) lose(stream, place, stream.reader.error());
  }

  void note_left_out(std::size_t packets, std::string_view kind) {
    if (packets == 0) return;
    recording_.notes.push_back(packets == 1 ? fmt::format("a packet {} was left out", kind)
                                            : fmt::format("{} packets {} were left out", packets, kind));
  }

  /// Skips to the next segment in which a message begins. The last frame of the connection may have lost its answer.
  void lose(Stream& stream, const std::string& place, const std::string& why) {
    stream.out_of_step = true;
    const auto last = last_.find(stream.connection);
    if (last != last_.end()) recording_.frames[last->second].more_was_lost = true;
    Losses& losses = losses_[why];
    if (losses.count++ == 0) losses.first = place;
  }

  struct Losses {
    std::string first{};
    std::size_t count = 0;
  };

  const ReadingChoices& choices_;
  LineRecording recording_;
  SerialLinks serial_;
  std::map<std::pair<Bytes, Bytes>, Stream> streams_;
  std::map<std::uint32_t, std::size_t> last_;         // frame of each connection
  std::map<std::string, Losses> losses_;              // by their reason
  std::map<std::uint16_t, std::size_t> other_ports_;  // packets of each that is not the one chosen
  std::set<Bytes> rtu_servers_,
      tcp_servers_;  // addresses with ports whose streams carry Modbus RTU, or messages with a head
  bool of_rtu_ = false;
  std::uint32_t connections_ = 0;
  std::size_t others_ = 0, broken_ = 0;
};

bool is_known(int link_type) {
  using namespace link_types;
  constexpr std::array kOfIp{kEthernet,       kLinuxCooked, kLinuxCooked2, kRawIp,    kRawIpOnce,
                             kRawIpOfOpenBsd, kIp4,         kIp6,          kLoopback, kLoopbackOfOpenBsd};
  return SerialLinks::carry(link_type) || std::ranges::find(kOfIp, link_type) != kOfIp.end();
}

}  // namespace

Result<LineRecording> read_pcap(std::string_view bytes, const ReadingChoices& choices) {
  auto capture = CaptureFile::open(bytes);
  if (!capture) return capture.trouble();
  PacketFrames reader(choices);
  std::set<int> with_packets;
  while (const auto packet = capture->next()) {
    with_packets.insert(packet->link_type);
    if (!is_known(packet->link_type)) continue;
    if (std::abs(packet->seconds) >= kFurthestTime / kSecond)
      return trouble("packet {}: {} s since 1970 is not a time of a recording", packet->number, packet->seconds);
    reader.take(packet->number, packet->seconds * kSecond + packet->nanoseconds, packet->link_type, packet->data);
  }
  std::set<int> unknown = with_packets.empty() ? capture->link_types() : with_packets;
  const bool only_unknown = !unknown.empty() && std::ranges::none_of(unknown, is_known);
  std::erase_if(unknown, is_known);
  if (only_unknown)
    return trouble(
        "link type {} is not one of 147 to 162 (serial), 250 (RTAC serial), 189, 220 and 249 (USB), Ethernet, "
        "Linux cooked, loopback or raw IP",
        *unknown.begin());
  if (!capture->error().empty()) reader.cut_off();
  auto recording = reader.finish();
  if (!recording) return recording.trouble();
  if (!capture->has_times()) {
    for (RecordedFrame& frame : recording->frames) frame.at.reset(), frame.times.clear();
    recording->notes.emplace_back("it has simple packets of pcapng, which have no times");
  }
  for (const int link_type : unknown)
    recording->notes.push_back(fmt::format("what has link type {} was left out", link_type));
  if (!capture->error().empty()) recording->notes.push_back(capture->error());
  return recording;
}

}  // namespace s7200::tools
