#include "tools/session/causes/line/line_account.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "interpreter/trace/text/statement_text.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/received_text.hpp"

namespace s7200::tools {
namespace {

/// `8 characters from 2012.100000 ms to 2020.400000 ms`
std::string span_text(std::size_t characters, Time from, Time to) {
  return fmt::format("{} from {} to {}", characters_text(characters), moment_text(from), moment_text(to));
}

/// `none of them`, `01 83 instead of 01 03`; nothing if what was sent was heard.
std::string heard_text(const std::vector<ReceivedCharacter>& heard, const Bytes& sent) {
  if (heard.empty()) return sent.size() == 1 ? "nothing of it" : "none of them";
  if (serial::bytes_of(heard) != sent) return fmt::format("{} instead of {}", received_text(heard), serial::to_hex(sent));
  if (std::ranges::any_of(heard, &ReceivedCharacter::parity_error)) return "them with wrong parity";
  return std::ranges::any_of(heard, &ReceivedCharacter::framing_error) ? "them without a stop bit" : "";
}

/// As if it had been sent so.
Sent sent_as(const std::vector<ReceivedCharacter>& heard) {
  return {.from = heard.front().start, .to = heard.back().end, .bytes = serial::bytes_of(heard)};
}

}  // namespace

LineAccount::LineAccount(History& history, std::size_t station, std::uint8_t port)
    : history_(history),
      station_(station),
      line_(history.requests().line_of(station, port)),
      port_(port),
      traffic_(history, line_),
      faults_(history, history.station(station).plc().line(port)) {}

void LineAccount::begin() {
  traffic_.begin();
  faults_.begin();
}

void LineAccount::end() {
  traffic_.end();
  faults_.end();
}

/// What a fault makes of a character that the port sends itself is nobody's.
void LineAccount::note(std::size_t station, const TraceRecord& record) {
  traffic_.note(station, record);
  if (station != station_ || record.port != port_) return;
  const bool ignored = record.kind == TraceKind::CharacterIgnored;
  const bool own = ignored && Ignored{record.code} == Ignored::WhileSending && faults_.at_work(record.since);
  if (record.kind == TraceKind::Transmit) untaken_.clear();
  if ((ignored && !own) || record.kind == TraceKind::CharacterDropped) note_untaken(record);
}

/// A frame begins after a pause of three characters. When one ended that nobody listened to is not known.
void LineAccount::note_untaken(const TraceRecord& record) {
  const Time character = std::max(record.at - record.since, here().plc().line_format(port_).character_time());
  const auto goes_on = [&](const Untaken& last) {
    const bool same = last.first.kind == record.kind && last.first.code == record.code;
    return same && record.since - last.end <= 3 * character;
  };
  if (untaken_.empty() || !goes_on(untaken_.back())) untaken_.push_back({.first = record});
  ++untaken_.back().characters;
  untaken_.back().end = record.at;
}

// --- what has become of a request ---

std::vector<TraceLine> LineAccount::lost(const AskedRequest& request) const {
  std::vector<TraceLine> all;
  const auto add = [&](std::optional<TraceLine> one) {
    if (one) all.push_back(std::move(*one));
  };
  const bool by_itself = request.plc() == station_;
  if (request.under_way || request.end == 0) return all;
  if (auto held = answer_not_begun(request)) return add(std::move(held)), all;
  if (freeport().transmitting && !by_itself) return add(answer_going_on(request)), all;
  const Heard heard = heard_of_answer(request);
  const Sent answer = answer_to(request, heard);
  if (!answer.bytes.empty()) {
    if (!by_itself && request.wrong) add(lost_request(request));
    add(lost_answer(request, heard, answer));
  } else if (auto sent = break_instead(request)) {
    add(std::move(sent));
  } else if (by_itself) {
    add(lost_by_itself(request, heard));
  } else {
    std::optional<TraceLine> made = heard.empty() ? std::nullopt : made_by_others(request, heard);
    if (heard.empty() || made) add(lost_request(request));
    add(std::move(made));
  }
  return all;
}

/// Damaged, or of no use as it was sent.
std::optional<TraceLine> LineAccount::lost_answer(const AskedRequest& request, Heard heard, const Sent& answer) const {
  const bool by_itself = request.plc() == station_;
  if (!request.knows_response()) {
    const auto follows = [&, until = answer.to + request.format.silence()](const ReceivedCharacter& one) mutable {
      const bool is_near = one.start < until;
      if (is_near) until = one.end + request.format.silence();
      return is_near;
    };
    heard.erase(std::ranges::find_if_not(heard, follows), heard.end());
  }
  const std::string asker = by_itself ? "the program" : request.by;
  const std::string by = by_itself ? history_.name_of(*answer.by) : "the PLC";
  const std::string frames = frames_text(request, heard);
  std::string text = frames.empty() ? heard_text(heard, answer.bytes) : frames;
  const bool is_known = answer.goes_on || !is_rtu_frame(request.frame) || is_rtu_frame(answer.bytes);
  const bool is_wrong_itself = text.empty() && !is_known;
  if (is_wrong_itself) text = "them as they were sent; they are not a Modbus RTU frame with a right CRC";
  if (text.empty()) return {};
  const std::string because = is_wrong_itself || !frames.empty() ? "" : reasons(request, answer);
  return TraceLine{answer.to, fmt::format("{} sent {}, and {} heard {}{}", by,
                                          span_text(answer.bytes.size(), answer.from, answer.to), asker, text, because)};
}

LineAccount::Heard LineAccount::heard_of_answer(const AskedRequest& request) const {
  return request.knows_response() ? request.response : traffic_.heard_by(request.asker, request.end, kNever);
}

/// A Modbus RTU frame of a PLC that is no slave, as far as the system file says, and that could not be the answer.
bool LineAccount::is_request_too(const AskedRequest& request, const Sent& sent) const {
  if (!is_rtu_frame(request.frame) || !is_rtu_frame(sent.bytes) || history_.address_of(sent.by->number)) return false;
  return history_.stations() > 1 && modbus::check_answer(request.frame, sent.bytes).verdict == modbus::Verdict::Wrong;
}

/// All that the PLC sent from the beginning of the request until whoever has asked had an answer; no bytes if there is none.
Sent LineAccount::answer_to(const AskedRequest& request, const Heard& heard) const {
  Sent answer;
  for (const Sent& sent : traffic_.sent()) {
    const bool too_late = !heard.empty() && sent.from > heard.back().end;
    const bool is_by_other = !sent.is_of_any_plc() || (request.plc() != station_ && !sent.is_of_plc(station_));
    if (sent.by == request.asker || is_by_other || sent.to <= request.start || too_late || sent.bytes.empty()) continue;
    if (is_request_too(request, sent)) continue;
    if (answer.bytes.empty()) answer = {.by = sent.by, .driver = sent.driver, .from = sent.from};
    if (answer.by != sent.by) continue;
    answer.to = sent.to;
    answer.goes_on = sent.goes_on;
    answer.bytes.insert(answer.bytes.end(), sent.bytes.begin(), sent.bytes.end());
  }
  return answer;
}

/// Whoever has asked took a part of it for all.
std::optional<TraceLine> LineAccount::answer_going_on(const AskedRequest& request) const {
  const Heard heard = heard_of_answer(request);
  if (request.unanswered || heard.empty()) return {};
  Sent answer = answer_to(request, heard);
  if (answer.bytes.empty()) return made_by_others(request, heard);
  answer.to = here().system().now();
  return TraceLine{answer.to, fmt::format("the PLC has been sending since {}, {} so far, and {} heard {}{}",
                                          moment_text(answer.from), characters_text(answer.bytes.size()), request.by,
                                          received_text(heard), reasons(request, answer))};
}

/// Its XMT was executed, and no character of it has left: a fault holds it back, or whoever has asked waits no longer than
/// the first one takes. To another request the PLC does not listen meanwhile.
std::optional<TraceLine> LineAccount::answer_not_begun(const AskedRequest& request) const {
  if (!request.unanswered || request.plc() == station_ || !freeport().transmitting) return {};
  const auto is_held = [&](const Sent& sent) { return sent.is_of_plc(station_) && sent.goes_on && sent.bytes.empty(); };
  const auto held = std::ranges::find_if(traffic_.sent(), is_held);
  if (held == traffic_.sent().end() || held->break_by) return {};
  Sent answer = *held;
  answer.to = here().system().now();
  const bool is_of_another = answer.from < request.end;
  const std::vector<std::string> faults = faults_in(request, answer);
  return TraceLine{answer.to, fmt::format("the PLC has been sending since {}, and no character of it has left so far{}{}",
                                          moment_text(answer.from), is_of_another ? "; it does not listen meanwhile" : "",
                                          faults.empty() ? "" : fmt::format(": {}", fmt::join(faults, "; ")))};
}

/// A break has no characters.
std::optional<TraceLine> LineAccount::break_instead(const AskedRequest& request) const {
  if (!(request.unanswered || request.wrong)) return {};
  for (const Sent& sent : traffic_.sent()) {
    const bool meant = sent.is_of_plc(station_) || request.plc() == station_;
    if (!sent.break_by || !meant || sent.by == request.asker || sent.from < request.start) continue;
    const std::string by = sent.is_of_plc(station_) ? "the PLC" : history_.name_of(*sent.by);
    return TraceLine{sent.from,
                     fmt::format("{} sent a break: 0 characters to send for {}", by,
                                 named_in_sentence(*sent.break_by, history_.station(sent.by->number).cpu().program()))};
  }
  return {};
}

/// `2 frames without a pause between them: master sent 8 characters from …; slave1 sent 7 characters from …`: others have
/// sent all that was heard, each its part. Empty if it was one frame, or was not heard as it was sent.
std::string LineAccount::frames_text(const AskedRequest& request, const Heard& heard) const {
  if (heard.empty() || std::ranges::any_of(heard, [](const auto& one) { return one.parity_error || one.framing_error; }))
    return {};
  const Time character = request.format.character_time();
  std::vector<std::string> texts;
  Bytes all;
  Time end = 0;
  bool has_pause = false;
  for (const Sent& sent : traffic_.sent()) {
    const bool is_in = sent.from + character > heard.front().start && sent.from < heard.back().end;
    if (sent.by == request.asker || !is_in || sent.bytes.empty()) continue;
    has_pause |= !texts.empty() && sent.from - end >= request.format.silence();
    end = sent.to;
    all.insert(all.end(), sent.bytes.begin(), sent.bytes.end());
    texts.push_back(sent_text(sent));
  }
  if (texts.size() < 2 || all != serial::bytes_of(heard)) return {};
  return fmt::format("{} frames{}: {}", texts.size(), has_pause ? "" : " without a pause between them",
                     fmt::join(texts, "; "));
}

/// What was taken for the answer: faults made it, or another master sent it.
std::optional<TraceLine> LineAccount::made_by_others(const AskedRequest& request, const Heard& heard) const {
  const Sent made = sent_as(heard);
  const auto is_sent = [&](const Sent& sent) {
    return sent.is_of_any_plc() && sent.by != request.asker && sent.to > request.start && sent.from < made.to;
  };
  std::vector<std::string> causes = faults_in(request, made);
  for (std::string& other : others_in(request, made)) causes.push_back(std::move(other));
  if (causes.empty() || std::ranges::any_of(traffic_.sent(), is_sent)) return {};
  return TraceLine{made.to,
                   fmt::format("{} heard {} from {} to {}, which no S7-200 has sent: {}", request.by, received_text(heard),
                               moment_text(made.from), moment_text(made.to), fmt::join(causes, "; "))};
}

/// `scada has 9600 baud …, the port 19200 baud …`; empty if they are set alike.
std::string LineAccount::other_format(const AskedRequest& request) const {
  const SerialFormat port = here().plc().port_format(port_);
  if (request.format == port) return {};
  return fmt::format("{} has {}, the port {}", request.by, format_text(request.format), format_text(port));
}

/// Something else was sent so soon before or after it, by whoever has asked too, that the PLC took both for one frame. It
/// does not hear itself.
std::optional<TraceLine> LineAccount::without_pause(const AskedRequest& request) const {
  const Time silence = request.format.silence();
  const Sent around{.by = Asker{Asker::Kind::Plc, station_}, .from = request.start - silence, .to = request.end + silence};
  std::vector<std::string> others;
  for (const Sent& before : traffic_.sent())
    if (before.by == request.asker && before.from < request.start && !before.goes_on && before.to > around.from)
      others.push_back(sent_text(before));
  for (std::string& other : others_in(request, around)) others.push_back(std::move(other));
  if (others.empty()) return {};
  return TraceLine{request.end,
                   fmt::format("{} sent {}, and the PLC heard no pause between that and others: {}", request.by,
                               span_text(request.frame.size(), request.start, request.end), fmt::join(others, "; "))};
}

/// In PPI mode the characters of its own frames are in no record. What was heard in another format was not what was sent.
std::optional<TraceLine> LineAccount::lost_request(const AskedRequest& request) const {
  if (!here().plc().powered() || !freeport().active) return {};
  const Heard heard = traffic_.heard_by({Asker::Kind::Plc, station_}, request.start, request.end);
  const bool got_none = request.unanswered || request.wrong;
  if (const std::string other = other_format(request); !heard.empty() && !other.empty())
    return request.unanswered ? std::optional(TraceLine{request.end, other}) : std::nullopt;
  std::string text = heard.empty() ? "nothing" : heard_text(heard, request.frame);
  if (text.empty() && faults_.has_pause(request.start, request.end)) text = "them with a pause";
  if (text.empty() && request.unanswered) return without_pause(request);
  if (text.empty() || (!heard.empty() && (request.meant_damaged || !got_none))) return {};
  return TraceLine{request.end,
                   fmt::format("{} sent {}, and the PLC heard {}{}", request.by,
                               span_text(request.frame.size(), request.start, request.end), text, reasons(request, {}))};
}

/// Of its own program, which no S7-200 has answered: what it has heard may come from others, and be what a fault made of it.
std::optional<TraceLine> LineAccount::lost_by_itself(const AskedRequest& request, const Heard& heard) const {
  if (!request.unanswered) return {};
  const std::string because = reasons(request, heard.empty() ? Sent{} : sent_as(heard));
  if (!heard.empty() && because.empty()) return {};
  return TraceLine{request.end, fmt::format("the program sent {}, and has heard {} since{}",
                                            span_text(request.frame.size(), request.start, request.end),
                                            heard.empty() ? "nothing" : received_text(heard), because)};
}

// --- what is known to have disturbed it ---

/// `slave2 sent 7 characters from 2012.100000 ms to 2020.400000 ms`, `panel has been sending since 1750.000000 ms`
std::string LineAccount::sent_text(const Sent& sent) const {
  const std::string by = history_.name_of(*sent.by);
  return sent.goes_on ? fmt::format("{} has been sending since {}", by, moment_text(sent.from))
                      : fmt::format("{} sent {}", by, span_text(sent.bytes.size(), sent.from, sent.to));
}

std::vector<std::string> LineAccount::faults_in(const AskedRequest& request, const Sent& frame) const {
  return faults_.in({.from = frame.from,
                     .to = frame.to,
                     .characters = frame.bytes.size(),
                     .character = frame.goes_on ? request.format.character_time() : 0},
                    {.from = request.start, .to = request.end, .characters = request.frame.size()});
}

std::string LineAccount::cut_between(const AskedRequest& request, std::size_t station, Time from, Time to) const {
  const int driver = history_.station(station).plc().driver(history_.requests().port_on(line_, station).value());
  const std::string cut = faults_.cut_between(request.driver, driver, from, to);
  return cut.empty() ? "" : fmt::format("the cable between {} and {} {}", request.by, history_.name_of(station), cut);
}

/// Whoever sent meanwhile: neither who has asked nor who has sent the frame.
std::vector<std::string> LineAccount::others_in(const AskedRequest& request, const Sent& frame) const {
  std::vector<std::string> all;
  for (const Sent& other : traffic_.sent())
    if (other.by != request.asker && other.by != frame.by && other.overlaps(frame.from, frame.to))
      all.push_back(sent_text(other));
  return all;
}

std::string LineAccount::reasons(const AskedRequest& request, const Sent& answer) const {
  const bool answered = !answer.bytes.empty();
  const Sent asked{.by = request.asker, .from = request.start, .to = request.end, .bytes = request.frame};
  const Sent& frame = answered ? answer : asked;
  std::vector<std::string> all = faults_in(request, frame);
  if (const std::string cut = cut_between(request, station_, frame.from, frame.to); !cut.empty()) all.push_back(cut);
  if (answered && answer.from < request.end)
    all.push_back(fmt::format("{} was still sending, up to {}", request.by, moment_text(request.end)));
  if (answered && request.given_up && answer.from >= *request.given_up)
    all.push_back(fmt::format("{} had given up at {}", request.by, moment_text(*request.given_up)));
  for (std::string& other : others_in(request, frame)) all.push_back(std::move(other));
  if (const std::string other = other_format(request); !other.empty()) all.push_back(other);
  return all.empty() ? "" : fmt::format(": {}", fmt::join(all, "; "));
}

}  // namespace s7200::tools
