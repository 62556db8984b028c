#include "tools/debugger/plc_requests.hpp"

#include <algorithm>
#include <utility>

#include "serial_sim/modbus/crc.hpp"
#include "tools/views/broadcast.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kShortest = 4;       // station, function, CRC
constexpr std::uint8_t kException = 0x80;  // of the function in an answer

bool is_for_one_station(PlcRequests::Frame frame) {
  return frame.size() >= kShortest && modbus::crc_ok(frame) && !is_broadcast(frame);
}

}  // namespace

bool may_answer(PlcRequests::Frame frame, PlcRequests::Frame request) {
  return request.size() >= 2 && frame[0] == request[0] && (frame[1] & ~kException) == (request[1] & ~kException);
}

bool asks_something_else(PlcRequests::Frame frame, PlcRequests::Frame request) {
  return is_for_one_station(frame) && !may_answer(frame, request);
}

PlcRequests::PlcRequests(Others others) : others_(std::move(others)) {
  for (serial::Simulation* const station : others_.stations)
    for (std::uint8_t port = 0; port < station->cpu().program().model->ports; ++port)
      if (const serial::SharedLine* const line = &station->plc().line(port); std::ranges::find(lines_, line) == lines_.end())
        lines_.push_back(line);
  forget();
}

void PlcRequests::forget() {
  state_ = {};
  state_.sending.resize(others_.stations.size());
  state_.last.resize(lines_.size());
}

std::size_t PlcRequests::line_of(std::size_t station, std::uint8_t port) const {
  const auto line = std::ranges::find(lines_, &others_.stations[station]->plc().line(port));
  return static_cast<std::size_t>(line - lines_.begin());
}

void PlcRequests::note(std::size_t station, const TraceRecord& record) {
  if (gives_up(station, record)) state_.last[line_of(station, record.port)]->given_up = true;
  switch (record.kind) {
    case TraceKind::Transmit:
    case TraceKind::CharacterSent:
    case TraceKind::TransmitEnd:
      return note_sender(station, record);
    case TraceKind::CharacterReceived:
    case TraceKind::CharacterIgnored:
    case TraceKind::CharacterDropped:
      return note_heard(station, record);
    default:
      return;
  }
}

bool PlcRequests::gives_up(std::size_t station, const TraceRecord& record) const {
  const bool is_end = record.kind == TraceKind::TransmitEnd, is_transmit = record.kind == TraceKind::Transmit || is_end;
  const bool is_heard = record.kind == TraceKind::CharacterReceived || record.kind == TraceKind::CharacterIgnored ||
                        record.kind == TraceKind::CharacterDropped;
  if (!is_transmit && !is_heard) return false;
  const std::optional<Request>& last = state_.last[line_of(station, record.port)];
  if (!last || !last->waits()) return false;
  if (is_end) return ends_request(station, record);
  if (is_transmit) return last->station == station;
  const serial::Line& line = others_.stations[station]->plc().line(record.port).line();
  return master_asks(line, last->end) ||
         others_.host_has_sent(line, last->end, [&](Frame frame) { return asks_something_else(frame, last->frame); });
}

bool PlcRequests::ends_request(std::size_t station, const TraceRecord& record) const {
  const std::optional<Transmission>& sent = sending(station, record.port);
  return record.kind == TraceKind::TransmitEnd && sent && is_request(station, record.port, *sent);
}

/// One that was cut off by STOP or by a loss of power has no end.
bool PlcRequests::is_sending(std::size_t line) const {
  for (std::size_t station = 0; station < others_.stations.size(); ++station) {
    const serial::Plc& plc = others_.stations[station]->plc();
    for (std::uint8_t port = 0; port < plc.cpu().program().model->ports; ++port)
      if (sending(station, port) && line_of(station, port) == line && plc.powered() &&
          plc.cpu().state().port[port].transmitting)
        return true;
  }
  return false;
}

bool PlcRequests::master_asks(const serial::Line& line, Time since) const {
  const auto asks = [&](const serial::Requester& requester) {
    return requester.asks() && requester.exchange().request_start >= since;
  };
  const auto is_asking = [&](const serial::Simulation* station) {
    return station->has_master() && &station->line().line() == &line && asks(station->master());
  };
  return std::ranges::any_of(others_.stations, is_asking) ||
         std::ranges::any_of(others_.pollers,
                             [&](const serial::Poller* poller) { return poller->is_on(line) && asks(poller->requester()); });
}

void PlcRequests::note_sender(std::size_t station, const TraceRecord& record) {
  std::optional<Transmission>& sending = state_.sending[station].at(record.port);
  if (record.kind == TraceKind::Transmit) {
    sending = {.from = record.at, .to = record.at};
  } else if (record.kind == TraceKind::CharacterSent && sending) {
    sending->bytes.push_back(record.byte);
    sending->to = record.at;
  } else if (sending) {
    note_end(station, record.port, *std::exchange(sending, std::nullopt));
  }
}

/// What is no request is taken for the answer to the one that waits.
void PlcRequests::note_end(std::size_t station, std::uint8_t port, Transmission sent) {
  std::optional<Request>& last = state_.last[line_of(station, port)];
  if (is_request(station, port, sent))
    last = {.station = station, .frame = std::move(sent.bytes), .end = sent.to};
  else if (last && last->waits())
    last->answer = {sent.from, sent.to};
}

/// Any character that a PLC does not send itself. A damaged one is no answer, and of one that another PLC is sending that
/// is not known yet.
void PlcRequests::note_heard(std::size_t station, const TraceRecord& record) {
  const std::size_t line = line_of(station, record.port);
  std::optional<Request>& last = state_.last[line];
  if (!last || last->given_up || record.since < last->end) return;
  const Time silence = others_.stations[station]->plc().port_format(record.port).silence();
  const bool damaged = record.parity_error || record.framing_error;
  if (last->waits() && !damaged && !is_sending(line)) last->answer = {record.since, record.since};
  if (last->answer && record.since - last->answer->to < silence) last->answer->to = std::max(last->answer->to, record.at);
}

bool PlcRequests::is_request(std::size_t station, std::uint8_t port, const Transmission& sent) const {
  return is_for_one_station(sent.bytes) && !is_answer(station, port, sent);
}

bool PlcRequests::has_asked(const serial::Requester& requester, const Transmission& answer) const {
  const serial::Exchange& exchange = requester.exchange();
  const bool answered = !exchange.response.empty() && exchange.response_start < answer.from;
  return (requester.asks() || !answered) && may_answer(answer.bytes, serial::bytes_of(exchange.request));
}

/// Somebody else has asked for it: the simulated master of a line, one that polls, another PLC, or one on a bridge whose
/// last frame is not the answer to the PLC's own request. What the PLC has asked before it asks again.
bool PlcRequests::is_answer(std::size_t station, std::uint8_t port, const Transmission& sent) const {
  const serial::Plc& plc = others_.stations[station]->plc();
  const serial::SharedLine& here = plc.line(port);
  for (const serial::Simulation* const other : others_.stations)
    if (other->has_master() && &other->line() == &here && has_asked(other->master(), sent)) return true;
  for (const serial::Poller* const poller : others_.pollers)
    if (poller->is_on(here.line()) && has_asked(poller->requester(), sent)) return true;
  const std::optional<Request>& last = state_.last[line_of(station, port)];
  const bool own = last && last->station == station;
  if (last && !own && last->waits() && may_answer(sent.bytes, last->frame)) return true;
  if (own && std::ranges::equal(sent.bytes, last->frame)) return false;
  const Time until = last && last->answer ? last->answer->to : last ? last->end : 0;
  const Time after = last ? until + plc.port_format(port).character_time() : 0;
  return others_.host_has_sent(here.line(), after,
                               [&](Frame frame) { return is_for_one_station(frame) && may_answer(sent.bytes, frame); });
}

}  // namespace s7200::tools
