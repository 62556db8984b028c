#include "tools/recordings/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "serial_sim/pc_protocol/answer.hpp"
#include "serial_sim/pc_protocol/command.hpp"

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

ReadFrame read_modbus(const RecordedFrame& frame, const RecordedFrame* open) {
  const Data bytes(frame.bytes);
  ReadFrame read{.frame = &frame};
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
  const bool whole = modbus::first_request(bytes) == bytes.size();
  if (frame.direction == Direction::Answer || (frame.direction == Direction::Unknown && !whole)) {
    read.text = !crc ? "wrong CRC, or not a whole frame" : "an answer without its request";
    return read;
  }
  read.direction = Direction::Request;
  read.station = bytes[0];
  read.right = crc;
  read.text = crc ? modbus_request_text(bytes) : "wrong CRC, or not a whole frame";
  return read;
}

// --- PPI ---

std::string s7_text(Data pdu) {
  if (pdu.size() < s7::kRequestHead || pdu[0] != s7::kProtocol) return fmt::format("{} bytes", pdu.size());
  if (pdu[1] == s7::kUserData) return "user data";
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
  ReadFrame read{.frame = &frame};
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
  read.right = true;
  read.direction = request ? Direction::Request : open != nullptr ? Direction::Answer : Direction::Unknown;
  const std::string what = !body->data.empty()                                ? s7_text(body->data)
                           : !request                                         ? "no data"
                           : (body->function & ppi::kService) == ppi::kStatus ? "status?"
                                                                              : "poll";
  if (request) read.station = body->destination;
  read.text = fmt::format("{} to {}, function {:02X}: {}", body->source, body->destination, body->function, what);
  return read;
}

// --- the Freeport protocol of the PC ---

ReadFrame read_freeport_pc(const RecordedFrame& frame, const RecordedFrame* open) {
  ReadFrame read{.frame = &frame};
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

constexpr std::array kProtocols{RecordedProtocol{"modbus", read_modbus}, RecordedProtocol{"ppi", read_ppi},
                                RecordedProtocol{"freeport-pc", read_freeport_pc}};

}  // namespace

std::span<const RecordedProtocol> recorded_protocols() { return kProtocols; }

const RecordedProtocol* find_recorded_protocol(std::string_view name) {
  const auto found = std::ranges::find(kProtocols, name, &RecordedProtocol::name);
  return found == kProtocols.end() ? nullptr : &*found;
}

std::vector<ReadFrame> conversation(const LineRecording& recording, const RecordedProtocol& protocol) {
  std::vector<ReadFrame> all;
  std::map<std::uint32_t, std::size_t> open;  // by connection
  for (const RecordedFrame& frame : recording.frames) {
    const auto waits = open.find(frame.stream);
    ReadFrame read = protocol.read(frame, waits == open.end() ? nullptr : all[waits->second].frame);
    if (read.direction == Direction::Answer) {
      read.other = waits->second;
      all[waits->second].other = all.size();
      open.erase(waits);
    } else if (read.direction == Direction::Request) {
      open[frame.stream] = all.size();
    }
    all.push_back(std::move(read));
  }
  return all;
}

std::optional<Time> silence(const ReadFrame& before, const ReadFrame& after, const Stamps& stamps) {
  if (!before.frame->at || !after.frame->at) return {};
  const RecordedFrame& between = stamps.at_end ? *after.frame : *before.frame;
  return std::max<Time>(0,
                        *after.frame->at - *before.frame->at - static_cast<Time>(between.bytes.size()) * stamps.character);
}

}  // namespace s7200::tools
