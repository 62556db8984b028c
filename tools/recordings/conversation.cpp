#include "tools/recordings/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "serial_sim/pc_protocol/answer.hpp"
#include "serial_sim/pc_protocol/command.hpp"
#include "tools/recordings/westinghouse.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

// --- Modbus ---

constexpr std::size_t kShortestRtu = 4;

/// `station 1, read holding registers 40001, 10 of them`
std::string modbus_request_text(Data frame) {
  const std::uint8_t station = frame[0], function = frame[1];
  const modbus::FunctionRow* row = modbus::find_function(function);
  std::string text = station == modbus::kBroadcast ? "all stations" : fmt::format("station {}", station);
  if (row == nullptr) return text + fmt::format(", function {}", function);
  text += fmt::format(", {}", row->name);
  if (frame.size() < kShortestRtu + 4) return text;
  const std::uint16_t first = load16(&frame[2]), second = load16(&frame[4]);
  for (const modbus::AreaRow& area : modbus::areas()) {
    const bool reads = area.read == row->function, one = area.write_one == row->function,
               many = area.write_many == row->function;
    if (!reads && !one && !many) continue;
    const std::string notation = modbus::notation({area.area, first});
    text += " " + (notation.empty() ? fmt::format("{} on the wire", first) : notation);
    text += one ? fmt::format(" = 16#{:04X}", second) : fmt::format(", {} of them", second);
  }
  return text;
}

/// As long as its function says, if that does.
bool has_length_of_request(Data bytes) {
  if (bytes.size() < kShortestRtu || (bytes[1] & modbus::kExceptionFlag) != 0) return false;
  const modbus::Extent extent = modbus::extent_of_request(bytes);
  return extent == modbus::Extent::Unknown ||
         (extent == modbus::Extent::Whole &&
          modbus::extent_of_request(bytes.first(bytes.size() - 1)) == modbus::Extent::Part);
}

ReadFrame read_modbus(const RecordedFrame& frame, const RecordedFrame* open) {
  const Data bytes(frame.bytes);
  ReadFrame read;
  if (open != nullptr && frame.direction != Direction::Request) {
    const modbus::Answer answer = modbus::check_answer(open->bytes, bytes);
    const bool fits = answer.verdict == modbus::Verdict::Right || answer.verdict == modbus::Verdict::Exception;
    if (fits || frame.direction == Direction::Answer) {
      read.direction = Direction::Answer;
      read.right = fits;
      read.text = modbus::describe(open->bytes, bytes);
      return read;
    }
  }
  const bool crc = bytes.size() >= kShortestRtu && modbus::crc_ok(bytes);
  const bool whole = crc && has_length_of_request(bytes);
  if (frame.direction == Direction::Answer || (frame.direction == Direction::Unknown && !whole)) {
    read.text = !crc ? "wrong CRC, or not a whole frame" : "an answer without its request";
    return read;
  }
  read.direction = Direction::Request;
  read.station = bytes[0];
  read.needs_no_answer = bytes[0] == modbus::kBroadcast;
  read.right = crc;
  read.text = crc ? modbus_request_text(bytes) : "wrong CRC, or not a whole frame";
  return read;
}

/// Only what the function says of its length counts: part of a long frame may have a right CRC by chance.
std::size_t first_modbus_message(Data bytes, const RecordedFrame* open) {
  const auto answers = [&](std::size_t length) {
    const modbus::Verdict verdict = modbus::check_answer(open->bytes, bytes.first(length)).verdict;
    return verdict == modbus::Verdict::Right || verdict == modbus::Verdict::Exception;
  };
  constexpr std::size_t kLongest = 2 * modbus::kLongestRtuFrame;  // PLCs with limits of their own
  for (std::size_t length = kShortestRtu; length <= std::min(bytes.size(), kLongest); ++length) {
    if (open != nullptr && answers(length)) return length;
    const Data first = bytes.first(length);
    if (modbus::extent_of_request(first) == modbus::Extent::Whole && has_length_of_request(first) && modbus::crc_ok(first))
      return length;
  }
  return 0;
}

// --- PPI ---

/// An answer that ends within its head.
bool cut_short(Data pdu) {
  return pdu.size() >= s7::kRequestHead && pdu.size() < s7::kAnswerHead && pdu[0] == s7::kProtocol && pdu[1] == s7::kAnswer;
}

std::string s7_text(Data pdu) {
  if (pdu.size() < s7::kRequestHead || pdu[0] != s7::kProtocol) return fmt::format("{} bytes", pdu.size());
  if (pdu[1] == s7::kUserData) return "user data";
  if (cut_short(pdu)) return "an answer without its error code";
  const bool answer = pdu[1] == s7::kAnswer;
  const std::size_t head = answer ? s7::kAnswerHead : s7::kRequestHead;
  if (pdu.size() <= head) return answer ? fmt::format("error {:04X}", load16(&pdu[10])) : "an empty request";
  const std::uint8_t function = pdu[head];
  const std::string name = function == s7::kRead    ? "read"
                           : function == s7::kWrite ? "write"
                           : function == s7::kRun   ? "RUN"
                           : function == s7::kStop  ? "STOP"
                           : function == s7::kSetup ? "set up"
                                                    : fmt::format("function {:02X}", function);
  if (answer || (function != s7::kRead && function != s7::kWrite)) return name;
  std::string text = name;
  for (std::size_t at = head + 2; at + s7::kVariableBytes <= pdu.size() && pdu[at] == s7::kVariableHead[0];
       at += s7::kVariableBytes) {
    const auto area = std::ranges::find(s7::kWireAreas, pdu[at + 8], &s7::WireArea::code);
    const std::uint32_t address = load32(&pdu[at + 8]) & 0xFF'FFFF;
    const bool known = area != s7::kWireAreas.end();
    const bool element = known && info(area->area).element != 0;
    text += fmt::format(" {}", known ? info(area->area).name : fmt::format("area 16#{:02X} ", pdu[at + 8]));
    text += element                   ? fmt::format("{}", address)
            : pdu[at + 3] == s7::kBit ? fmt::format("{}.{}", address / 8, address % 8)
                                      : fmt::format("B{}", address / 8);
    text += fmt::format(":{}", load16(&pdu[at + 4]));
  }
  return text;
}

ReadFrame read_ppi(const RecordedFrame& frame, const RecordedFrame* open) {
  ReadFrame read;
  const Data bytes(frame.bytes);
  if (bytes.size() == 1 && bytes[0] == ppi::kAccepted) {
    read.direction = open != nullptr ? Direction::Answer : Direction::Unknown;
    read.right = true;
    read.text = "accepted";
    return read;
  }
  const auto body = ppi::frame_length(bytes) == bytes.size() ? ppi::body_of(bytes) : std::nullopt;
  if (!body) {
    read.text = "not a frame: its length, check sum or end is wrong";
    return read;
  }
  const bool request = (body->function & ppi::kIsRequest) != 0;
  read.right = !cut_short(body->data);
  read.direction = request ? Direction::Request : open != nullptr ? Direction::Answer : Direction::Unknown;
  const std::string what = !body->data.empty()                                ? s7_text(body->data)
                           : !request                                         ? "no data"
                           : (body->function & ppi::kService) == ppi::kStatus ? "status?"
                                                                              : "poll";
  if (request) read.station = body->destination;
  read.text = fmt::format("{} to {}, function {:02X}: {}", body->source, body->destination, body->function, what);
  return read;
}

std::size_t first_ppi_message(Data bytes, const RecordedFrame*) {
  const auto length = ppi::frame_length(bytes);
  return length && *length <= bytes.size() ? *length : 0;
}

// --- the Freeport protocol of the PC ---

ReadFrame read_freeport_pc(const RecordedFrame& frame, const RecordedFrame* open) {
  ReadFrame read;
  const Data bytes(frame.bytes);
  if (const auto command = pc_protocol::parse_command(bytes)) {
    read.direction = Direction::Request;
    read.right = true;
    read.station = command->station;
    read.text =
        fmt::format("station {}, {} {}", command->station, command->type == pc_protocol::Type::Read ? "read" : "write",
                    pc_protocol::notation(command->address));
    return read;
  }
  if (open == nullptr) {
    read.text = "neither a command nor an answer to one";
    return read;
  }
  const serial::Answer answer = pc_protocol::check_answer(open->bytes, bytes, bytes.back());
  read.direction = Direction::Answer;
  read.right = answer.verdict == serial::Verdict::Right || answer.verdict == serial::Verdict::Exception;
  if (answer.verdict == serial::Verdict::Exception)
    read.text = std::string(pc_protocol::refusal_name(answer.exception));
  else
    read.text = !read.right ? answer.fault : answer.bytes.empty() ? "done" : serial::to_hex(answer.bytes);
  return read;
}

std::size_t first_freeport_pc_message(Data bytes, const RecordedFrame* open) {
  const std::size_t length = open == nullptr ? pc_protocol::kCommandLength : pc_protocol::kAnswerLength;
  return length <= bytes.size() ? length : 0;
}

// --- all of them ---

/// A protocol whose frames say all by themselves.
template <ReadFrame (*Read)(const RecordedFrame&, const RecordedFrame*), std::size_t (*First)(Data, const RecordedFrame*)>
class PlainReader final : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override { return Read(frame, open); }
  std::size_t first_message(Data bytes, const RecordedFrame* open) const override { return First(bytes, open); }
};

template <class Reader>
std::unique_ptr<FrameReader> make() {
  return std::make_unique<Reader>();
}

constexpr std::array kProtocols{
    RecordedProtocol{"modbus", make<PlainReader<read_modbus, first_modbus_message>>},
    RecordedProtocol{"ppi", make<PlainReader<read_ppi, first_ppi_message>>},
    RecordedProtocol{"freeport-pc", make<PlainReader<read_freeport_pc, first_freeport_pc_message>>},
    RecordedProtocol{"pc1000-lan", pc1000_lan_reader},
    RecordedProtocol{"westnet", westnet_reader},
    RecordedProtocol{"pc500-loader", pc500_loader_reader},
    RecordedProtocol{"hppc", hppc_reader},
};

/// The first characters of a frame, which is left with the others.
RecordedFrame take_first(RecordedFrame& frame, std::size_t count, const Stamps& stamps) {
  const auto at = static_cast<std::ptrdiff_t>(count);
  RecordedFrame first = frame;
  first.bytes.resize(count);
  std::erase_if(first.damaged, [&](std::size_t place) { return place >= count; });
  frame.bytes.erase(frame.bytes.begin(), frame.bytes.begin() + at);
  std::erase_if(frame.damaged, [&](std::size_t place) { return place < count; });
  for (std::size_t& place : frame.damaged) place -= count;
  if (!frame.times.empty()) {
    first.times.resize(count);
    frame.times.erase(frame.times.begin(), frame.times.begin() + at);
    frame.at = frame.times.empty() ? std::nullopt : std::optional(frame.times.front());
  } else if (frame.at && stamps.at_end) {
    *first.at -= static_cast<Time>(frame.bytes.size()) * stamps.character;
  } else if (frame.at) {
    *frame.at += static_cast<Time>(count) * stamps.character;
  }
  return first;
}

Time begin_of(const RecordedFrame& frame, const Stamps& stamps) {
  const auto characters = static_cast<Time>(frame.times.empty() ? frame.bytes.size() : 1);
  return *frame.at - (stamps.at_end ? characters * stamps.character : 0);
}

Time end_of(const RecordedFrame& frame, const Stamps& stamps) {
  if (!frame.times.empty()) return frame.times.back() + (stamps.at_end ? 0 : stamps.character);
  return *frame.at + (stamps.at_end ? 0 : static_cast<Time>(frame.bytes.size()) * stamps.character);
}

}  // namespace

std::span<const RecordedProtocol> recorded_protocols() { return kProtocols; }

const RecordedProtocol* find_recorded_protocol(std::string_view name) {
  const auto found = std::ranges::find(kProtocols, name, &RecordedProtocol::name);
  return found == kProtocols.end() ? nullptr : &*found;
}

Conversation::Stream& Conversation::stream_of(const RecordedFrame& frame) {
  Stream& stream = streams_[frame.stream];
  if (!stream.reader) stream.reader = protocol_.reader();
  return stream;
}

ReadFrame Conversation::what_it_says(Stream& stream, const RecordedFrame& frame) const {
  ReadFrame read = stream.reader->read(frame, stream.open ? &*stream.open : nullptr);
  const bool echoes = read.direction == Direction::Answer && frame.direction == Direction::Unknown && stream.open &&
                      frame.bytes == stream.open->bytes;
  const auto waited = echoes ? silence(*stream.open, frame, stamps_) : std::nullopt;
  if (!waited || *waited <= stamps_.timeout) return read;
  read = stream.reader->read(frame, nullptr);
  read.repeats = stream.number;
  read.text += fmt::format("; repeated after {}, or its late echo", format_duration(*waited));
  return read;
}

ReadFrame Conversation::read(Stream& stream, RecordedFrame frame) {
  ReadFrame read = what_it_says(stream, frame);
  if (!frame.damaged.empty()) {
    read.right = false;
    const bool all = frame.damaged.size() == frame.bytes.size();
    read.text = fmt::format("{} damaged{}{}", all ? "it is" : fmt::format("character {} is", frame.damaged.front() + 1),
                            read.text.empty() ? "" : "; ", read.text);
  }
  if (last_) read.silence = silence(*last_, frame, stamps_);
  if (read.direction == Direction::Answer && stream.open) {
    read.other = stream.number;
    read.latency = silence(*stream.open, frame, stamps_);
    stream.open.reset();
  } else if (read.direction == Direction::Request) {
    stream.open.reset();
    if (!read.needs_no_answer) stream.open = frame;
    stream.number = count_;
  }
  ++count_;
  last_ = frame;
  read.frame = std::move(frame);
  return read;
}

std::vector<ReadFrame> Conversation::take_complete(RecordedFrame& frame) {
  Stream& stream = stream_of(frame);
  std::vector<ReadFrame> all;
  while (!frame.bytes.empty()) {
    const std::size_t length = stream.reader->first_message(frame.bytes, stream.open ? &*stream.open : nullptr);
    if (length == 0) break;
    all.push_back(read(stream, take_first(frame, length, stamps_)));
  }
  return all;
}

std::vector<ReadFrame> Conversation::add(RecordedFrame frame) {
  std::vector<ReadFrame> all;
  Stream& stream = stream_of(frame);
  const bool has_characters = frame.direction == Direction::Unknown && !frame.times.empty();
  if (has_characters || stream.reader->messages_share_frames()) all = take_complete(frame);
  if (!frame.bytes.empty()) all.push_back(read(stream, std::move(frame)));
  return all;
}

std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol, const Stamps& stamps) {
  Conversation reading(protocol, stamps);
  std::vector<ReadFrame> all;
  for (const RecordedFrame& frame : recording.frames)
    for (ReadFrame& read : reading.add(frame)) {
      if (read.other) all[*read.other].other = all.size();
      all.push_back(std::move(read));
    }
  return all;
}

std::optional<Time> silence(const RecordedFrame& before, const RecordedFrame& after, const Stamps& stamps) {
  if (!before.at || !after.at) return {};
  return std::max<Time>(0, begin_of(after, stamps) - end_of(before, stamps));
}

}  // namespace s7200::tools
