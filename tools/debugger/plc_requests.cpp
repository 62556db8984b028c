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

/// Station and function are those of the request.
bool may_answer(PlcRequests::Frame answer, PlcRequests::Frame request) {
  return request.size() >= 2 && answer[0] == request[0] && (answer[1] & ~kException) == (request[1] & ~kException);
}

}  // namespace

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

void PlcRequests::note_sender(std::size_t station, const TraceRecord& record) {
  std::optional<Transmission>& sending = state_.sending[station].at(record.port);
  std::optional<Request>& last = state_.last[line_of(station, record.port)];
  if (record.kind == TraceKind::TransmitEnd) return note_end(station, record.port, std::exchange(sending, std::nullopt));
  if (record.kind == TraceKind::Transmit) {
    sending = {.from = record.at, .to = record.at};
    if (last && last->waits()) last->next_from = last->next_to = record.at;
  } else if (sending) {
    sending->bytes.push_back(record.byte);
    sending->to = record.at;
    if (last && last->next_from == sending->from) last->next_to = record.at;
  }
}

void PlcRequests::note_end(std::size_t station, std::uint8_t port, std::optional<Transmission> sent) {
  if (!sent || !is_for_one_station(sent->bytes) || is_answer(station, port, *sent)) return;
  state_.last[line_of(station, port)] = {.station = station, .frame = std::move(sent->bytes), .end = sent->to};
}

/// Any character that a PLC does not send itself. A damaged one is no answer.
void PlcRequests::note_heard(std::size_t station, const TraceRecord& record) {
  std::optional<Request>& last = state_.last[line_of(station, record.port)];
  if (!last || record.since < last->end) return;
  const Time silence = others_.stations[station]->plc().port_format(record.port).silence();
  const bool damaged = record.parity_error || record.framing_error;
  if (last->waits() && !damaged) last->next_from = last->next_to = record.since;
  if (!last->waits() && record.since - last->next_to < silence) last->next_to = std::max(last->next_to, record.at);
}

/// Somebody else has asked for it: the simulated master of a line, one that polls, another PLC, or one on a bridge whose
/// last frame is not the answer to the PLC's own request.
bool PlcRequests::is_answer(std::size_t station, std::uint8_t port, const Transmission& sent) const {
  const auto has_asked = [&](const serial::Requester& requester) {
    const serial::Exchange& exchange = requester.exchange();
    const bool answered = !exchange.response.empty() && exchange.response_start < sent.from;
    return requester.asks() || (!answered && may_answer(sent.bytes, serial::bytes_of(exchange.request)));
  };
  const serial::Plc& plc = others_.stations[station]->plc();
  const serial::SharedLine& here = plc.line(port);
  for (const serial::Simulation* const other : others_.stations)
    if (other->has_master() && &other->line() == &here && has_asked(other->master())) return true;
  for (const serial::Poller* const poller : others_.pollers)
    if (poller->is_on(here.line()) && has_asked(poller->requester())) return true;
  const std::optional<Request>& last = state_.last[line_of(station, port)];
  const bool open = last && last->station != station && last->next_from >= sent.from;
  if (open && may_answer(sent.bytes, last->frame)) return true;
  const Time after = last ? std::max(last->end, last->next_to) + plc.port_format(port).character_time() : 0;
  return others_.host_has_sent(here.line(), after,
                               [&](Frame frame) { return is_for_one_station(frame) && may_answer(sent.bytes, frame); });
}

}  // namespace s7200::tools
