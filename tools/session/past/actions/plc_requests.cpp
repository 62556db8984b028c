#include "tools/session/past/actions/plc_requests.hpp"

#include <algorithm>
#include <utility>

#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tools/views/broadcast.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kShortest = 4;       // station, function, CRC
constexpr std::uint8_t kException = 0x80;  // of the function in an answer
constexpr std::size_t kLongest = 256;      // MODBUS over Serial Line V1.02, 2.5.1
constexpr std::size_t kMostHeard = 1024;   // of what never ends; checkpoints keep it
constexpr std::size_t kAskedBefore = 3;    // requests of a line whose answers may still come

bool is_for_one_station(PlcRequests::Frame frame) { return is_rtu_frame(frame) && !is_broadcast(frame); }

}  // namespace

bool is_rtu_frame(PlcRequests::Frame frame) { return frame.size() >= kShortest && modbus::crc_ok(frame); }

bool may_answer(PlcRequests::Frame frame, PlcRequests::Frame request) {
  return request.size() >= 2 && frame[0] == request[0] && (frame[1] & ~kException) == (request[1] & ~kException);
}

bool asks_something_else(PlcRequests::Frame frame, PlcRequests::Frame request) {
  return is_rtu_frame(frame) && !may_answer(frame, request);
}

/// The one reason to ignore a character that hides what others send is that the port sends itself.
bool is_heard(const TraceRecord& record) {
  if (record.kind == TraceKind::CharacterIgnored) return Ignored{record.code} != Ignored::WhileSending;
  return record.kind == TraceKind::CharacterReceived || record.kind == TraceKind::CharacterDropped;
}

PlcRequests::PlcRequests(Others others) : others_(std::move(others)) {
  for (serial::Simulation* const station : others_.stations)
    for (std::uint8_t port = 0; port < station->cpu().program().model->ports; ++port)
      if (const serial::SharedLine* const line = &station->plc().line(port); std::ranges::find(lines_, line) == lines_.end())
        lines_.push_back(line);
  for (const serial::SharedLine* const line : lines_) masters_.push_back(find_masters_on(*line));
  forget();
}

/// Stations on one line have the same master of `send`.
std::vector<SimulatedMaster> PlcRequests::find_masters_on(const serial::SharedLine& line) const {
  std::vector<SimulatedMaster> masters;
  for (std::size_t number = 0; number < others_.stations.size() && masters.empty(); ++number) {
    const serial::Simulation& station = *others_.stations[number];
    if (station.has_master() && &station.line() == &line)
      masters.push_back({.asker = {Asker::Kind::Send, number},
                         .requester = &station.master(),
                         .driver = station.master_uart().driver(),
                         .format = &station.master_uart().state().format});
  }
  for (std::size_t number = 0; number < others_.pollers.size(); ++number) {
    const serial::Poller& poller = *others_.pollers[number];
    if (poller.is_on(line.line()))
      masters.push_back({.asker = {Asker::Kind::Poller, number},
                         .requester = &poller.requester(),
                         .driver = poller.driver(),
                         .format = &poller.format()});
  }
  return masters;
}

std::optional<std::uint8_t> PlcRequests::port_on(std::size_t line, std::size_t station) const {
  const serial::Plc& plc = others_.stations[station]->plc();
  for (std::uint8_t port = 0; port < plc.cpu().program().model->ports; ++port)
    if (&plc.line(port) == lines_[line]) return port;
  return {};
}

void PlcRequests::forget() {
  state_ = {};
  state_.hearing.resize(others_.stations.size());
  state_.sending.resize(others_.stations.size());
  state_.last.resize(lines_.size());
  state_.before.resize(lines_.size());
  state_.asked.resize(lines_.size());
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
    default:
      if (!is_heard(record)) return;
      note_hearing(station, record);
      note_heard(station, record);
  }
}

bool PlcRequests::gives_up(std::size_t station, const TraceRecord& record) const {
  const bool is_end = record.kind == TraceKind::TransmitEnd, is_transmit = record.kind == TraceKind::Transmit || is_end;
  if (!is_transmit && !is_heard(record)) return false;
  const std::size_t line = line_of(station, record.port);
  const std::optional<Request>& last = state_.last[line];
  if (!last || !last->waits()) return false;
  if (is_end) return ends_request(station, record);
  if (is_transmit) return last->station == station;
  return master_asks(line, last->end) || others_.host_has_sent(lines_[line]->line(), last->end, [&](Frame frame) {
    return asks_something_else(frame, last->frame);
  });
}

bool PlcRequests::ends_request(std::size_t station, const TraceRecord& record) const {
  const std::optional<SentByPlc>& sent = sending(station, record.port);
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

bool PlcRequests::master_asks(std::size_t line, Time since) const {
  return std::ranges::any_of(masters_on(line), [&](const SimulatedMaster& master) {
    return master.requester->asks() && master.requester->exchange().request_start >= since;
  });
}

void PlcRequests::note_sender(std::size_t station, const TraceRecord& record) {
  std::optional<SentByPlc>& sending = state_.sending[station].at(record.port);
  if (record.kind == TraceKind::Transmit) {
    sending = {.from = record.at, .to = record.at};
  } else if (record.kind == TraceKind::CharacterSent && sending) {
    sending->bytes.push_back(record.byte);
    sending->to = record.at;
  } else if (sending) {
    note_end(station, record.port, *std::exchange(sending, std::nullopt));
  }
}

/// What is no request is taken for the answer to the one that waits, unless it began before, or answers another one.
void PlcRequests::note_end(std::size_t station, std::uint8_t port, SentByPlc sent) {
  const std::size_t line = line_of(station, port);
  std::optional<Request>& last = state_.last[line];
  if (is_request(station, port, sent)) {
    const bool is_for_all = is_broadcast(sent.bytes);
    if (last && !last->answer) note_asked(line, {last->start, last->frame, last->station});
    state_.before[line] = std::move(last);
    last = {.station = station, .frame = std::move(sent.bytes), .start = sent.from, .end = sent.to, .given_up = is_for_all};
  } else if (last && last->waits() && sent.from >= last->end) {
    const bool is_another_ones = asks_something_else(sent.bytes, last->frame) && is_late_answer(station, line, sent.bytes);
    if (!is_another_ones) last->answer = {sent.from, sent.to};
  }
}

void PlcRequests::note_hearing(std::size_t station, const TraceRecord& record) {
  Hearing& hearing = state_.hearing[station].at(record.port);
  const Time silence = others_.stations[station]->plc().port_format(record.port).silence();
  if (record.since >= hearing.to + silence) hearing.bytes.clear();
  if (hearing.bytes.size() < kMostHeard) hearing.bytes.push_back(record.byte);
  hearing.to = record.at;
}

/// Any character that a PLC does not send itself. A damaged one is no answer, and of one that another PLC is sending that
/// is not known yet.
void PlcRequests::note_heard(std::size_t station, const TraceRecord& record) {
  const std::size_t line = line_of(station, record.port);
  std::optional<Request>& last = state_.last[line];
  note_masters(line);
  if (!last || last->given_up || record.since < last->end) return;
  if (station == last->station && last->heard.bytes.size() <= kLongest) {
    last->heard.bytes.push_back(record.byte);
    last->heard.to = record.at;
    last->heard.parity_error |= record.parity_error;
    last->heard.framing_error |= record.framing_error;
  }
  const Time silence = others_.stations[station]->plc().port_format(record.port).silence();
  const bool damaged = record.parity_error || record.framing_error;
  if (last->waits() && !damaged && !is_sending(line)) last->answer = {record.since, record.since};
  if (last->answer && record.since - last->answer->to < silence) last->answer->to = std::max(last->answer->to, record.at);
}

/// What the masters in the simulation are asking on a line, and whether what has come so far is the answer.
void PlcRequests::note_masters(std::size_t line) {
  for (const SimulatedMaster& master : masters_on(line)) {
    const serial::Exchange& exchange = master.requester->exchange();
    if (exchange.request.empty()) continue;
    const auto known = std::ranges::find(state_.asked[line], exchange.request_start, &Asked::start);
    if (known == state_.asked[line].end()) {
      note_asked(line, {.start = exchange.request_start, .frame = bytes_of(exchange.request)});
      continue;
    }
    const Bytes response = exchange.response_bytes();
    known->answered |= response.size() >= 2 && may_answer(response, known->frame);
  }
}

void PlcRequests::note_asked(std::size_t line, Asked asked) {
  std::vector<Asked>& all = state_.asked[line];
  if (all.size() == kAskedBefore) all.erase(all.begin());
  all.push_back(std::move(asked));
}

/// To a request that was given up. Its form tells it from a request to the same station, which the sender may have.
bool PlcRequests::is_late_answer(std::size_t station, std::size_t line, Frame sent) const {
  const auto has_the_form = [&](Frame request) {
    return may_answer(sent, request) && modbus::check_answer(request, sent).verdict != modbus::Verdict::Wrong;
  };
  const std::optional<Request>& last = state_.last[line];
  if (last && last->station != station && last->given_up && has_the_form(last->frame)) return true;
  return std::ranges::any_of(state_.asked[line], [&](const Asked& asked) {
    return asked.by != station && !asked.answered && has_the_form(asked.frame);
  });
}

bool PlcRequests::is_request(std::size_t station, std::uint8_t port, const SentByPlc& sent) const {
  return is_broadcast(sent.bytes) || (is_rtu_frame(sent.bytes) && !is_answer(station, port, sent));
}

/// What a master takes for its answer, or gives up for, is not always what a PLC sends for it: noise may come before.
bool PlcRequests::has_asked(const serial::Requester& requester, const SentByPlc& answer) const {
  const serial::Exchange& exchange = requester.exchange();
  const Bytes request = serial::bytes_of(exchange.request), response = exchange.response_bytes();
  const bool answered = exchange.response_start < answer.from && is_rtu_frame(response) && may_answer(response, request);
  return (requester.asks() || !answered) && may_answer(answer.bytes, request);
}

/// Somebody else has asked for it: the simulated master of a line, one that polls, another PLC, or one on a bridge whose
/// last frame is not the answer to the PLC's own request. What the PLC has asked before it asks again.
bool PlcRequests::is_answer(std::size_t station, std::uint8_t port, const SentByPlc& sent) const {
  const serial::Plc& plc = others_.stations[station]->plc();
  const serial::SharedLine& here = plc.line(port);
  const std::size_t line = line_of(station, port);
  const auto is_asker = [&](const SimulatedMaster& master) { return has_asked(*master.requester, sent); };
  if (std::ranges::any_of(masters_on(line), is_asker)) return true;
  if (is_late_answer(station, line, sent.bytes)) return true;
  const std::optional<Request>& last = state_.last[line];
  const bool own = last && last->station == station;
  if (last && !own && last->waits() && may_answer(sent.bytes, last->frame)) return true;
  if (own && std::ranges::equal(sent.bytes, last->frame)) return false;
  const Time until = last && last->answer ? last->answer->to : last ? last->end : 0;
  const Time after = last ? until + plc.port_format(port).character_time() : 0;
  return others_.host_has_sent(here.line(), after,
                               [&](Frame frame) { return is_for_one_station(frame) && may_answer(sent.bytes, frame); });
}

std::string wrong_with(std::span<const std::uint8_t> request, std::span<const std::uint8_t> answer,
                       std::string_view damage) {
  if (!damage.empty() || !is_rtu_frame(request)) return std::string(damage);
  return modbus::check_answer(request, answer).fault;
}

}  // namespace s7200::tools
