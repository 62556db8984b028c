// Captures of serial lines and of Modbus TCP, read by libpcap.
#include <fmt/format.h>
#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/serial_links.hpp"

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

/// The IP packet in a packet of the link layer, if there is one.
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
  bool out_of_step = false;  ///< where the next message begins is not known
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
      ++others_;
  }

  /// The capture lacks everything after the last frame of each connection.
  void cut_off() {
    for (const auto& [connection, frame] : last_) recording_.frames[frame].more_was_lost = true;
    serial_.cut_off();
  }

  /// The recording. Nothing with `why` set if several devices are captured and none is known to be the line.
  std::optional<LineRecording> finish(std::string& why) {
    if (!serial_.finish(recording_, why)) return {};
    note_left_out(others_, fmt::format("not of TCP port {}", choices_.tcp_port));
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
      return;
    }
    if (segment.data.empty()) return;
    const auto ahead = static_cast<std::int32_t>(segment.sequence - stream.next.value_or(segment.sequence));
    if (ahead > 0) lose(stream, place, "segments before it are missing");
    const auto sent_again = static_cast<std::size_t>(std::max<std::int64_t>(0, -std::int64_t{ahead}));
    if (sent_again >= segment.data.size()) return;
    stream.next = segment.sequence + static_cast<std::uint32_t>(segment.data.size());
    Data data = segment.data.subspan(sent_again);
    if (stream.out_of_step) {
      const auto begin = first_message_in(data);
      if (!begin) return;
      data = data.subspan(*begin);
      stream.reader = {};
      stream.out_of_step = false;
    }
    stream.reader.take(data);
    while (const auto message = stream.reader.next())
      add({.at = at,
           .direction = asks ? Direction::Request : Direction::Answer,
           .bytes = modbus::rtu_frame(message->unit, message->pdu),
           .place = place,
           .stream = stream.connection,
           .exchange = modbus::exchange_of(*message)});
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
  std::map<std::uint32_t, std::size_t> last_;  // frame of each connection
  std::map<std::string, Losses> losses_;       // by their reason
  std::uint32_t connections_ = 0;
  std::size_t others_ = 0, broken_ = 0;
};

/// The part of a capture that libpcap reads at once: it refuses a pcapng whose interfaces have several link types.
struct CapturePart {
  std::string_view bytes;
  std::vector<std::size_t> numbers{};  ///< of its packets in the whole file; empty: all of them, from 1 on
  std::string own_bytes{};             ///< of a part that is not the whole file
};

/// Numbers in the order of bytes that a section has.
class PcapNgNumbers {
 public:
  explicit PcapNgNumbers(std::string_view file) : file_(file) {}
  std::uint32_t get(std::size_t at, std::size_t bytes) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value = value << 8 | static_cast<std::uint8_t>(file_[at + (big_endian ? i : bytes - 1 - i)]);
    return value;
  }
  void put(std::string& block, std::size_t at, std::uint32_t value) const {
    for (std::size_t i = 0; i < 4; ++i) block[at + i] = static_cast<char>(value >> 8 * (big_endian ? 3 - i : i));
  }
  bool big_endian = false;

 private:
  std::string_view file_;
};

/// A pcapng by the link types of its interfaces, with their packets. Any other file, or one that is broken, is one part.
std::vector<CapturePart> parts_of(std::string_view file) {
  constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kSimplePacket = 3, kPacket = 6;
  constexpr std::size_t kHead = 8, kShortest = 16;
  std::map<std::uint32_t, CapturePart> by_link;
  std::map<std::uint32_t, std::uint32_t> interfaces;        // of a link type's part: how many so far
  std::vector<std::pair<std::uint32_t, std::uint32_t>> of;  // interface of the section: link type, number in its part
  std::string_view section;
  std::size_t number = 0;
  PcapNgNumbers numbers(file);
  std::vector<CapturePart> whole;
  whole.push_back({.bytes = file});
  for (std::size_t at = 0; at < file.size();) {
    if (at + kShortest > file.size()) return whole;
    const bool begins = numbers.get(at, 4) == kSection;
    if (begins) numbers.big_endian = file[at + kHead] == '\x1A';
    const std::uint32_t type = numbers.get(at, 4), length = numbers.get(at + 4, 4);
    if ((type == kInterface || type == kPacket) && length < kShortest + 4) return whole;
    if (length < 12 || length > file.size() - at) return whole;
    const std::string_view block = file.substr(at, length);
    if (begins) {
      if (!section.empty()) return whole;  // libpcap reads several, if they are alike
      section = block;
    } else if (type == kInterface) {
      const std::uint32_t link = numbers.get(at + kHead, 2);
      of.emplace_back(link, interfaces[link]++);
      by_link[link].own_bytes += block;
    } else if (type == kPacket || type == kSimplePacket) {
      ++number;
      const std::uint32_t interface = type == kPacket ? numbers.get(at + kHead, 4) : 0;
      if (interface >= of.size()) return whole;
      const auto& [link, place] = of[interface];
      std::string& bytes = by_link[link].own_bytes;
      bytes += block;
      if (type == kPacket) numbers.put(bytes, bytes.size() - block.size() + kHead, place);
      by_link[link].numbers.push_back(number);
    }
    at += length;
  }
  if (by_link.size() < 2 || section.empty()) return whole;
  std::vector<CapturePart> parts;
  for (auto& [link, part] : by_link) {
    part.own_bytes.insert(0, section);
    if (!part.numbers.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

bool is_known(int link_type) {
  return SerialLinks::carry(link_type) || link_type == DLT_EN10MB || link_type == DLT_LINUX_SLL ||
         link_type == DLT_LINUX_SLL2 || link_type == DLT_RAW || link_type == DLT_IPV4 || link_type == DLT_IPV6;
}

/// The packets of a part, one after the other.
class CaptureReader {
 public:
  struct Packet {
    std::size_t number = 0;
    Time at = 0;
    Data data{};  ///< until the next one is read
  };

  /// Opens a part. Null with `why` set if it is not a capture.
  static std::unique_ptr<CaptureReader> open(CapturePart part, std::string& why) {
    auto reader = std::unique_ptr<CaptureReader>(new CaptureReader(std::move(part)));
    return reader->open_file(why) ? std::move(reader) : nullptr;
  }

  int link_type() const { return link_type_; }
  /// The error that ended the reading of the part; empty if there was none.
  const std::string& error() const { return error_; }
  /// The present packet; nothing at the end.
  const std::optional<Packet>& packet() const { return packet_; }

  /// Reads the next packet. Returns false and sets `why` if its time is one that no recording has.
  bool read_next(std::string& why) {
    pcap_pkthdr* head = nullptr;
    const u_char* data = nullptr;
    const int result = pcap_next_ex(capture_.get(), &head, &data);
    packet_.reset();
    if (result == PCAP_ERROR)
      error_ = fmt::format("after packet {} the file cannot be read: {}", last_, pcap_geterr(capture_.get()));
    if (result != 1) return true;
    last_ = read_ < part_.numbers.size() ? part_.numbers[read_] : read_ + 1;
    ++read_;
    if (std::abs(head->ts.tv_sec) >= kFurthestTime / kSecond) {
      why = fmt::format("packet {}: {} s since 1970 is not a time of a recording", last_, head->ts.tv_sec);
      return false;
    }
    packet_ = {.number = last_, .at = head->ts.tv_sec * kSecond + head->ts.tv_usec, .data = Data(data, head->caplen)};
    return true;
  }

 private:
  explicit CaptureReader(CapturePart part) : part_(std::move(part)) {
    if (!part_.own_bytes.empty()) part_.bytes = part_.own_bytes;
  }

  bool open_file(std::string& why) {
    std::array<char, PCAP_ERRBUF_SIZE> error{};
    std::FILE* file = ::fmemopen(const_cast<char*>(part_.bytes.data()), part_.bytes.size(), "rb");
    if (file == nullptr) return why = "out of memory", false;
    capture_.reset(pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, error.data()));
    if (!capture_) {
      std::fclose(file);
      why = error.data();
      return false;
    }
    link_type_ = pcap_datalink(capture_.get());
    return true;
  }

  struct Close {
    void operator()(pcap_t* capture) const { pcap_close(capture); }
  };

  CapturePart part_;
  std::unique_ptr<pcap_t, Close> capture_;
  int link_type_ = 0;
  std::size_t read_ = 0, last_ = 0;
  std::optional<Packet> packet_;
  std::string error_;
};

using CaptureReaders = std::vector<std::unique_ptr<CaptureReader>>;

/// The part whose packet is the next one of the file; null at its end.
CaptureReader* next_part(const CaptureReaders& parts) {
  CaptureReader* next = nullptr;
  for (const auto& part : parts)
    if (part->packet() && (next == nullptr || part->packet()->number < next->packet()->number)) next = part.get();
  return next;
}

}  // namespace

bool looks_like_pcap(std::string_view bytes) {
  using namespace std::string_view_literals;
  for (const std::string_view magic :
       {"\xA1\xB2\xC3\xD4"sv, "\xD4\xC3\xB2\xA1"sv, "\xA1\xB2\x3C\x4D"sv, "\x4D\x3C\xB2\xA1"sv, "\x0A\x0D\x0D\x0A"sv})
    if (bytes.starts_with(magic)) return true;
  return false;
}

std::optional<LineRecording> read_pcap(std::string_view bytes, const ReadingChoices& choices, std::string& why) {
  CaptureReaders parts;
  std::vector<int> unknown_link_types;
  for (CapturePart& each : parts_of(bytes)) {
    auto part = CaptureReader::open(std::move(each), why);
    if (!part) return {};
    if (!is_known(part->link_type()))
      unknown_link_types.push_back(part->link_type());
    else if (part->read_next(why))
      parts.push_back(std::move(part));
    else
      return {};
  }
  if (parts.empty() && !unknown_link_types.empty()) {
    why = fmt::format(
        "link type {} is not one of 147 to 162 (serial), 250 (RTAC serial), 189, 220 and 249 (USB), Ethernet, "
        "Linux cooked or raw IP",
        unknown_link_types.front());
    return {};
  }
  PacketFrames reader(choices);
  while (CaptureReader* const part = next_part(parts)) {
    reader.take(part->packet()->number, part->packet()->at, part->link_type(), part->packet()->data);
    if (!part->read_next(why)) return {};
  }
  const auto broken = std::ranges::find_if(parts, [](const auto& part) { return !part->error().empty(); });
  if (broken != parts.end()) reader.cut_off();
  auto recording = reader.finish(why);
  if (!recording) return {};
  for (const int link_type : unknown_link_types)
    recording->notes.push_back(fmt::format("what has link type {} was left out", link_type));
  if (broken != parts.end()) recording->notes.push_back((*broken)->error());
  return recording;
}

}  // namespace s7200::tools
