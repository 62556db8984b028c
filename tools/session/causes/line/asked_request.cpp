#include "tools/session/causes/line/asked_request.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "tools/session/past/line_times.hpp"
#include "tools/views/broadcast.hpp"

namespace s7200::tools {
namespace {

std::optional<AskedRequest> request_of(const History& history, const SimulatedMaster& master, Time now) {
  const serial::Requester& requester = *master.requester;
  const serial::Exchange& exchange = requester.exchange();
  const bool asks = requester.asks();
  if (!asks && (exchange.request.empty() || exchange.given_up)) return {};
  const Time time_out = exchange.request_end + requester.state().request.timeout;
  if (!asks && now - (exchange.timed_out ? time_out : exchange.response_end) >= kJustOver) return {};
  const Bytes frame = serial::bytes_of(exchange.request);
  const bool answered = !asks && !exchange.timed_out;
  return AskedRequest{.by = history.name_of(master.asker),
                      .asker = master.asker,
                      .driver = master.driver,
                      .frame = frame,
                      .meant_damaged = serial::has_wrong_parity(exchange.request),
                      .start = exchange.request_start,
                      .end = exchange.request_end,
                      .given_up = exchange.timed_out ? std::optional(time_out) : std::nullopt,
                      .response = exchange.response,
                      .format = *master.format,
                      .unanswered = !answered,
                      .wrong = answered && !wrong_with(frame, exchange.response_bytes(), exchange.damage()).empty(),
                      .answer_end = exchange.response_end,
                      .in_vain = exchange.timed_out,
                      .under_way = asks && requester.state().phase != serial::Requester::Phase::Waiting};
}

/// What it has heard, and no more comes.
bool is_wrong(const PlcRequests::Request& request, Time now, Time silence) {
  const auto& [bytes, to, parity_error, framing_error] = request.heard;
  if (bytes.empty() || now - to < silence) return false;
  return parity_error || framing_error || !wrong_with(request.frame, bytes, "").empty();
}

/// Of a program that has asked on a line, as the PLC at `station` sees it.
std::optional<AskedRequest> request_of_program(const History& history, std::size_t station, std::size_t line,
                                               const std::optional<PlcRequests::Request>& last, Time now,
                                               Time host_timeout) {
  if (!last || is_broadcast(last->frame)) return {};
  const bool unanswered = !last->answer;
  if (now - (unanswered ? last->end + host_timeout : last->answer->to) >= kJustOver) return {};
  const serial::Plc& asker = history.station(last->station).plc();
  const std::uint8_t port = history.requests().port_on(line, last->station).value();
  const bool is_last = &last == &history.requests().last(line);  // nothing comes any more for one before it
  return AskedRequest{.by = last->station == station ? "this PLC" : history.name_of(last->station),
                      .asker = {Asker::Kind::Plc, last->station},
                      .driver = asker.driver(port),
                      .frame = last->frame,
                      .start = last->start,
                      .end = last->end,
                      .format = asker.port_format(port),
                      .unanswered = unanswered,
                      .wrong = is_wrong(*last, now, is_last ? asker.port_format(port).silence() : 0),
                      .answer_end = last->heard.to,
                      .in_vain = last->given_up || (unanswered && now - last->end >= host_timeout),
                      .under_way = last->waits() && history.requests().is_sending(line)};
}

/// What a bridge has sent is somebody else's answer if it came while that was waited for.
bool is_answer(const History& history, std::size_t line, const SentByHost& sent) {
  const Time character = sent.format.character_time();
  const bool is_for_master = std::ranges::any_of(history.requests().masters_on(line), [&](const SimulatedMaster& master) {
    const serial::Exchange& exchange = master.requester->exchange();
    const bool heard = exchange.response_start + character > sent.from && exchange.response_start < sent.to;
    return heard || (master.requester->asks() && exchange.request_end != 0 && exchange.request_end <= sent.from);
  });
  const std::optional<PlcRequests::Request>& last = history.requests().last(line);
  if (is_for_master || !last || sent.from < last->end) return is_for_master;
  const bool heard = last->answer && sent.from < last->answer->to && sent.to + character > last->answer->from;
  return heard || (last->waits() && !asks_something_else(sent.bytes, last->frame));
}

/// When a PLC has sent something on the line after an instant last; nothing if none has.
std::optional<Time> sent_by_plc_after(const History& history, std::size_t line, Time instant) {
  std::optional<Time> last;
  for (std::size_t station = 0; station < history.stations(); ++station)
    if (const auto port = history.requests().port_on(line, station))
      if (const Time end = history.station(station).plc().state().uart.at(*port).send_end; end > instant)
        last = std::max(last.value_or(end), end);
  return last;
}

/// A master asks again because nobody has answered the request before, which has just been given up with that.
bool gives_up_with(const History& history, std::size_t line, const SentByHost& before, const SentByHost& last, Time now) {
  const bool just_begun = last.to > now && now - std::min(now, last.from) < kJustOver;
  return just_begun && !is_broadcast(before.bytes) && !is_answer(history, line, before) &&
         !sent_by_plc_after(history, line, before.to);
}

/// The last of a master on a bridge, or the one that it has just given up. Whether its answer is one is not known here.
std::optional<AskedRequest> request_of_bridge(const History& history, std::size_t host, std::size_t line, Time now,
                                              Time host_timeout) {
  std::vector<SentByHost> all = history.sent_by_host(host, now - std::min(now, 2 * host_timeout));
  const bool given_up = all.size() > 1 && gives_up_with(history, line, all.rbegin()[1], all.back(), now);
  if (given_up) all.pop_back();
  if (all.empty() || is_broadcast(all.back().bytes) || is_answer(history, line, all.back())) return {};
  const SentByHost& last = all.back();
  const Asker asker{Asker::Kind::Bridge, host};
  const auto answered = sent_by_plc_after(history, line, last.to);
  if (now - answered.value_or(last.to + 2 * host_timeout - kJustOver) >= kJustOver) return {};
  return AskedRequest{.by = history.name_of(asker),
                      .asker = asker,
                      .driver = history.hosts()[host]->driver(),
                      .frame = last.bytes,
                      .start = last.from,
                      .end = last.to > now ? 0 : last.to,
                      .format = last.format,
                      .unanswered = !answered,
                      .answer_end = answered.value_or(0),
                      .in_vain = !answered && (given_up || now - last.to >= host_timeout),
                      .under_way = last.to > now || history.requests().is_sending(line)};
}

}  // namespace

std::optional<AskedRequest> last_asked(const History& history, std::size_t station, Time host_timeout) {
  const serial::Simulation& here = history.station(station);
  const Time now = here.time();
  std::optional<AskedRequest> last;
  for (std::uint8_t port = 0; port < here.cpu().program().model->ports; ++port) {
    const auto take = [&](std::optional<AskedRequest> one) {
      const auto rank = [&](const AskedRequest& request) {
        const bool just_ended = request.wrong && now - request.answer_end < 2 * request.format.silence();
        return std::tuple(just_ended, (request.unanswered && request.end != 0) || request.wrong, request.start);
      };
      if (!one || (last && rank(*one) <= rank(*last))) return;
      last = std::move(one);
      last->port = port;
    };
    const std::size_t line = history.requests().line_of(station, port);
    take(request_of_program(history, station, line, history.requests().last(line), now, host_timeout));
    const auto before = request_of_program(history, station, line, history.requests().before(line), now, host_timeout);
    if (before && before->wrong && before->asker != history.requests().last(line)->asker()) take(before);
    for (const SimulatedMaster& master : history.requests().masters_on(line)) take(request_of(history, master, now));
    for (const std::size_t host : history.hosts_on(here.plc().line(port).line()))
      take(request_of_bridge(history, host, line, now, host_timeout));
  }
  return last;
}

}  // namespace s7200::tools
