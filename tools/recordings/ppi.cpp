#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

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

/// Of a frame without data.
std::string_view function_text(std::uint8_t function) {
  if ((function & ppi::kIsRequest) == 0) {
    switch (function) {
      case ppi::kSlave:
        return "a slave";
      case ppi::kNoResource:
        return "no resource";
      case ppi::kNoService:
        return "no such service";
      default:
        return "no data";
    }
  }
  switch (function & ppi::kService) {
    case ppi::kStatus:
      return "status?";
    case ppi::kAnswerLow:
    case ppi::kAnswerHigh:
      return "poll";
    default:
      return "a service that is not known";
  }
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
  if (const auto token = ppi::token_of(bytes)) {
    read.direction = Direction::Request;
    read.right = read.needs_no_answer = true;
    read.station = token->destination;
    read.text = fmt::format("token from station {} to station {}", token->source, token->destination);
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
  if (request) read.station = body->destination;
  read.needs_no_answer = request && body->destination == ppi::kEveryStation;
  read.text = fmt::format("{} to {}, function {:02X}: {}", body->source, body->destination, body->function,
                          body->data.empty() ? function_text(body->function) : s7_text(body->data));
  return read;
}

std::size_t first_ppi_message(Data bytes, const RecordedFrame*) {
  const auto length = ppi::frame_length(bytes);
  return length && *length <= bytes.size() ? *length : 0;
}

}  // namespace

std::unique_ptr<FrameReader> ppi_reader() { return std::make_unique<PlainReader<read_ppi, first_ppi_message>>(); }

}  // namespace s7200::tools
