#include "tools/session/stops/asked_by_bridges.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "tools/session/past/line_times.hpp"
#include "tools/views/broadcast.hpp"

namespace s7200::tools {

void AskedByBridges::begin(Time now, const std::vector<HeardFrames::Frame>& before) {
  talks_.assign(of_plcs().lines().size(), {});
  for (const HeardFrames::Frame& frame : before) {
    const bool sends = history().station(frame.station).cpu().state().port[frame.port].transmitting;
    if (!sends && now < frame.end + host_timeout()) note_frame(frame);
  }
}

// --- what the bridges of a line are doing ---

AskedByBridges::Phase AskedByBridges::after(Phase phase, Event event) {
  const bool has_answered = phase == Phase::Answered || phase == Phase::AnsweringFurther;
  switch (event) {
    case Event::AnswerBegins:
    case Event::OtherAsks:
      return has_answered ? phase : Phase::Silent;
    case Event::PieceBegins:
      return has_answered ? Phase::AnsweringFurther : Phase::AskingFurther;
    case Event::RequestEnds:
      return phase == Phase::AnsweringFurther ? Phase::Answered : Phase::Asked;
    case Event::AnswerEnds:
      return Phase::Answered;
    case Event::BroadcastEnds:
      return phase == Phase::AnsweringFurther ? Phase::Answered : Phase::Silent;
    case Event::BridgeBegins:
    case Event::TimeOutEnds:
      break;
  }
  return Phase::Silent;
}

/// What is asked before there is an answer gives the request up.
void AskedByBridges::happens(std::size_t line, Event event) {
  Talk& talk = talks_[line];
  const bool ends_wait = event == Event::BridgeBegins || event == Event::OtherAsks || event == Event::TimeOutEnds;
  const bool given_up = talk.phase == Phase::Asked && ends_wait;
  talk.phase = after(talk.phase, event);
  if (given_up) tell({.line = line, .frame = talk.request, .asker = asker_of(talk)});
}

// --- what a PLC has sent, or hears ---

/// Another PLC may have heard the end of the frame before.
void AskedByBridges::note_record(std::size_t station, const TraceRecord& record) {
  const bool heard = is_heard(record);
  if (!heard && record.kind != TraceKind::TransmitEnd) return;
  const std::size_t line = of_plcs().line_of(station, record.port);
  const Talk& talk = talks_[line];
  const bool is_between = talk.phase == Phase::Asked || talk.phase == Phase::Answered;
  if (!is_between || (heard && record.since < talk.end)) return;
  const auto event = begun_by(line, station, record);
  if (!event) return;
  const bool is_answer = talk.phase == Phase::Asked && *event == Event::AnswerBegins;
  if (is_answer && !heard) judge(line, of_plcs().sending(station, record.port));
  happens(line, *event);
}

/// A damaged character is no answer, and of one that a PLC is sending that is not known yet.
std::optional<AskedByBridges::Event> AskedByBridges::begun_by(std::size_t line, std::size_t station,
                                                              const TraceRecord& record) const {
  if (!is_heard(record)) return of_plcs().ends_request(station, record) ? Event::OtherAsks : Event::AnswerBegins;
  if (of_plcs().master_asks(line, 0)) return Event::OtherAsks;
  if (host_that_sent(line, record.since))
    return record.since < talks_[line].next_piece_until ? Event::PieceBegins : Event::BridgeBegins;
  if (record.parity_error || record.framing_error || of_plcs().is_sending(line)) return {};
  return Event::AnswerBegins;
}

/// What the line makes of it on the way to the bridge is not known.
void AskedByBridges::judge(std::size_t line, const std::optional<SentByPlc>& answer) const {
  if (!answer) return;
  const Talk& talk = talks_[line];
  if (std::string wrong = wrong_with(talk.rtu, answer->bytes, ""); !wrong.empty())
    tell({.line = line, .frame = talk.request, .asker = asker_of(talk), .wrong = std::move(wrong), .answer = answer->bytes});
}

// --- what a bridge has sent ---

/// All stations on its line hear it, one of them later than another.
void AskedByBridges::note_frame(const HeardFrames::Frame& frame) {
  const std::size_t line = of_plcs().line_of(frame.station, frame.port);
  Talk& talk = talks_[line];
  const Time character = history().station(frame.station).plc().port_format(frame.port).character_time();
  const auto host = host_that_sent(line, frame.end - character);  // who is set otherwise hears an end later
  if (!host || frame.end <= talk.end) return;
  talk.host = *host;
  talk.end = frame.end;
  talk.rtu.clear();
  const bool is_whole = history().has_sent(*host, [&](std::span<const std::uint8_t> sent) {
    if (is_rtu_frame(sent)) talk.rtu.assign(sent.begin(), sent.end());
    return !talk.rtu.empty();
  });
  talk.next_piece_until = is_whole ? 0 : frame.end + kNextPiece;
  const Event event = ended_by(line, frame.end, character);
  if (event == Event::RequestEnds && talk.phase != Phase::AnsweringFurther) note_request(talk, frame.bytes);
  happens(line, event);
}

/// It is a request, unless somebody on the line has just asked.
AskedByBridges::Event AskedByBridges::ended_by(std::size_t line, Time end, Time character) const {
  if (answers(line, end, character)) return Event::AnswerEnds;
  return history().has_sent(talks_[line].host, is_broadcast) ? Event::BroadcastEnds : Event::RequestEnds;
}

void AskedByBridges::note_request(Talk& talk, const std::vector<std::uint8_t>& piece) const {
  const bool goes_on = talk.phase == Phase::AskingFurther, begins_unknown = goes_on && talk.request.empty();
  if (!goes_on) talk.request.clear();
  if (!begins_unknown) talk.request.insert(talk.request.end(), piece.begin(), piece.end());
}

void AskedByBridges::look(Time now) {
  for (std::size_t line = 0; line < talks_.size(); ++line) {
    const bool is_over = talks_[line].phase == Phase::Asked && now - talks_[line].end >= host_timeout();
    if (is_over && !of_plcs().is_sending(line)) happens(line, Event::TimeOutEnds);
  }
}

Time AskedByBridges::next_timeout() const {
  Time next = kNever;
  for (const Talk& talk : talks_)
    if (talk.phase == Phase::Asked) next = std::min(next, talk.end + host_timeout());
  return next;
}

bool AskedByBridges::has_patient_one() const {
  return std::ranges::find(talks_, Phase::Asked, &Talk::phase) != talks_.end();
}

/// A bridge on a line that was sending then, or later.
std::optional<std::size_t> AskedByBridges::host_that_sent(std::size_t line, Time after) const {
  for (const std::size_t host : history().hosts_on(of_plcs().lines()[line]->line()))
    if (history().hosts()[host]->sent_until() > after) return host;
  return {};
}

/// What has ended then on a line is the answer to a simulated master, or to a program.
bool AskedByBridges::answers(std::size_t line, Time end, Time character) const {
  const bool is_for_master = std::ranges::any_of(of_plcs().masters_on(line), [&](const SimulatedMaster& master) {
    const bool polls = master.asker.kind == Asker::Kind::Poller;
    const serial::Requester& requester = *master.requester;
    if (!polls) return requester.busy();
    return requester.asks() || requester.exchange().response_end + character > end;
  });
  const auto& last = of_plcs().last(line);
  return is_for_master || (last && last->answer && end > last->end && end < last->answer->to + character);
}

}  // namespace s7200::tools
