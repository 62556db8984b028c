#include "serial_sim/modbus/gateway.hpp"

#include <utility>

#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus {
namespace {

/// Station, PDU, CRC: of the station asked, with the function asked for, or its exception.
bool answers(std::span<const std::uint8_t> frame, const TcpMessage& request) {
  return frame.size() >= 4 && crc_ok(frame) && frame[0] == request.unit && (frame[1] & 0x7F) == (request.pdu[0] & 0x7F);
}

/// Whether no slave can answer: no slave has the station, or the request is a broadcast that needs an answer.
bool has_no_path(const TcpMessage& request) {
  if (request.unit != kBroadcast) return request.unit > kLastStation;
  const FunctionRow* const function = find_function(request.pdu[0]);
  return function != nullptr && !function->broadcast;
}

}  // namespace

void Gateway::take(Client client, std::span<const std::uint8_t> bytes) {
  MbapReader& stream = streams_[client];
  stream.take(bytes);
  take_requests(client, stream);
}

void Gateway::take_requests(Client client, MbapReader& stream) {
  while (turns_.open(client) < kMostOpen) {
    auto request = stream.next();
    if (!request) return;
    ++counts_.requests;
    if (has_no_path(*request)) {
      ++counts_.no_path;
      answer(client, exception_to(*request, GatewayException::PathUnavailable));
      continue;
    }
    const std::uint64_t tag = next_tag_++;
    turns_.ask(client, {rtu_frame(request->unit, request->pdu), request->unit != kBroadcast, tag});
    asked_.emplace(tag, std::move(*request));
  }
}

void Gateway::forget(Client client) {
  for (const std::uint64_t tag : turns_.forget(client)) asked_.erase(tag);
  streams_.erase(client);
}

std::string Gateway::error(Client client) const {
  const auto found = streams_.find(client);
  return found == streams_.end() ? std::string{} : found->second.error();
}

bool Gateway::wants_more(Client client) const { return turns_.open(client) < kMostOpen && error(client).empty(); }

std::size_t Gateway::open(Client client) const { return turns_.open(client); }

std::size_t Gateway::waiting(Client client) const {
  const auto found = streams_.find(client);
  return turns_.waiting(client) + (found == streams_.end() ? 0 : found->second.pending());
}

bool Gateway::partial(Client client) const {
  const auto found = streams_.find(client);
  return found != streams_.end() && found->second.pending() != 0 && turns_.open(client) < kMostOpen;
}

Bytes Gateway::turn(const LineTurns::Line& line) {
  Bytes frame = turns_.turn(line);
  for (const LineTurns::Outcome& outcome : turns_.take_outcomes()) settle(outcome);
  for (auto& [client, stream] : streams_) take_requests(client, stream);
  return frame;
}

void Gateway::settle(const LineTurns::Outcome& outcome) {
  const TcpMessage request = std::move(asked_.extract(outcome.tag).mapped());
  switch (outcome.result) {
    case LineTurns::Result::Sent:
      ++counts_.broadcasts;
      return;
    case LineTurns::Result::Answered:
      if (answers(outcome.answer, request)) {
        ++counts_.answers;
        return answer(outcome.client,
                      {request.transaction, request.unit, Bytes(outcome.answer.begin() + 1, outcome.answer.end() - 2)});
      }
      [[fallthrough]];
    case LineTurns::Result::Damaged:
      ++counts_.damaged;
      break;
    case LineTurns::Result::Silent:
    case LineTurns::Result::Blocked:
      ++counts_.silent;
      break;
  }
  if (request.unit != kBroadcast) answer(outcome.client, exception_to(request, GatewayException::TargetFailedToRespond));
}

std::vector<Gateway::Answer> Gateway::take_answers() { return std::exchange(answers_, {}); }

}  // namespace s7200::modbus
