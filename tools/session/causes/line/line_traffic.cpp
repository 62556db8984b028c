#include "tools/session/causes/line/line_traffic.hpp"

#include <algorithm>

namespace s7200::tools {

void LineTraffic::note(std::size_t station, const TraceRecord& record) {
  note_masters();
  note_hosts();
  const bool has_port = record.port < history_.station(station).cpu().program().model->ports;
  if (!has_port || history_.requests().line_of(station, record.port) != line_) return;
  if (is_heard(record))
    heard_.push_back(
        {{Asker::Kind::Plc, station}, {record.byte, record.parity_error, record.framing_error, record.since, record.at}});
  note_plc(station, record);
}

void LineTraffic::note_plc(std::size_t station, const TraceRecord& record) {
  if (record.kind == TraceKind::Transmit) {
    sent_.push_back({.by = Asker{Asker::Kind::Plc, station},
                     .driver = history_.station(station).plc().driver(record.port),
                     .from = record.at,
                     .to = record.at,
                     .goes_on = true});
    if (record.count == 0) sent_.back().break_by = record.op;
    return;
  }
  const bool is_character = record.kind == TraceKind::CharacterSent, is_end = record.kind == TraceKind::TransmitEnd;
  const auto own = std::find_if(sent_.rbegin(), sent_.rend(), [&](const Sent& one) { return one.is_of_plc(station); });
  if (!(is_character || is_end) || own == sent_.rend()) return;  // none: of a transmission that began before
  own->goes_on = !is_end;
  if (!is_character) return;
  own->bytes.push_back(record.byte);
  own->to = record.at;
}

/// A master that asks again forgets what it has asked before.
void LineTraffic::note_masters() {
  for (const SimulatedMaster& master : history_.requests().masters_on(line_)) {
    const serial::Exchange& exchange = master.requester->exchange();
    if (exchange.request.empty()) continue;
    const auto last = std::find_if(sent_.rbegin(), sent_.rend(), [&](const Sent& one) { return one.by == master.asker; });
    const bool known = last != sent_.rend() && last->from == exchange.request_start;
    if (!known)
      sent_.push_back({.by = master.asker,
                       .driver = master.driver,
                       .from = exchange.request_start,
                       .to = exchange.request_start,
                       .bytes = serial::bytes_of(exchange.request)});
    Sent& one = known ? *last : sent_.back();
    one.goes_on = exchange.request_end <= exchange.request_start;
    if (!one.goes_on) one.to = exchange.request_end;
  }
}

void LineTraffic::note_hosts() {
  for (const std::size_t host : history_.hosts_on(history_.requests().lines()[line_]->line())) {
    const std::vector<ReceivedCharacter>& received = history_.hosts()[host]->state().received;
    std::size_t& noted = waiting_[host];
    for (noted = std::min(noted, received.size()); noted < received.size(); ++noted)
      heard_.push_back({{Asker::Kind::Bridge, host}, received[noted]});
  }
}

void LineTraffic::append_hosts() {
  const Time now = history_.now().time;
  for (const std::size_t host : history_.hosts_on(history_.requests().lines()[line_]->line()))
    for (const SentByHost& frame : history_.sent_by_host(host, since_))
      sent_.push_back({.by = Asker{Asker::Kind::Bridge, host},
                       .driver = history_.hosts()[host]->driver(),
                       .from = frame.from,
                       .to = frame.to,
                       .bytes = frame.bytes,
                       .goes_on = frame.to > now});
}

/// STOP and a loss of power cut off what a PLC sends.
void LineTraffic::end() {
  note_masters();
  note_hosts();
  append_hosts();
  for (Sent& one : sent_)
    if (one.is_of_any_plc() && one.goes_on) one.goes_on = history_.requests().is_sending(line_);
  std::ranges::stable_sort(sent_, {}, &Sent::from);
  join_frames();
}

/// A program may send each part of a frame with an XMT of its own, when event 9 tells that the one before it has left.
bool LineTraffic::goes_on_with(const Sent& sent, const Sent& next) const {
  if (!sent.is_of_any_plc() || sent.by != next.by || sent.break_by || next.break_by) return false;
  const std::uint8_t port = history_.requests().port_on(line_, sent.by->number).value();
  return next.from - sent.to < history_.station(sent.by->number).plc().port_format(port).silence();
}

void LineTraffic::join_frames() {
  std::vector<Sent> frames;
  for (Sent& next : sent_) {
    if (frames.empty() || !goes_on_with(frames.back(), next)) {
      frames.push_back(std::move(next));
      continue;
    }
    Sent& frame = frames.back();
    frame.bytes.insert(frame.bytes.end(), next.bytes.begin(), next.bytes.end());
    frame.to = next.to;
    frame.goes_on = next.goes_on;
  }
  sent_ = std::move(frames);
}

std::vector<ReceivedCharacter> LineTraffic::heard_by(const Asker& who, Time from, Time to) const {
  std::vector<ReceivedCharacter> heard;
  for (const auto& [by, character] : heard_)
    if (by == who && character.start >= from && character.start < to) heard.push_back(character);
  return heard;
}

}  // namespace s7200::tools
