#include "tools/session/causes/line/two_masters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

std::string name_of_plc(const History& history, std::size_t plc) {
  const auto is_it = [&](const LineStation& one) {
    return one.kind == LineStation::Kind::Plc && one.number == plc && !one.name.empty();
  };
  const auto found = std::ranges::find_if(history.line_stations(), is_it);
  return found == history.line_stations().end() ? "the program" : stl::printable(found->name);
}

constexpr Time kLately = 10 * kSecond;

Asker bridge(std::size_t host) { return {Asker::Kind::Bridge, host}; }

/// A master on a bridge, something else than it may answer.
bool has_asked(const History& history, std::size_t host, PlcRequests::Frame answered, Time since) {
  return std::ranges::any_of(history.sent_by_host(host, since),
                             [&](const SentByHost& sent) { return asks_something_else(sent.bytes, answered); });
}

/// Who else asks on the line of a PLC: those that poll, a PLC whose program has asked, and those on bridges.
std::vector<std::string> other_masters(const History& history, std::size_t station) {
  const std::size_t line = history.requests().line_of(station, history.station(station).port());
  std::vector<std::string> names;
  for (const SimulatedMaster& master : history.requests().masters_on(line))
    if (master.asker.kind == Asker::Kind::Poller) names.push_back(history.name_of(master.asker));
  const std::optional<PlcRequests::Request>& last = history.requests().last(line);
  if (last) names.push_back(name_of_plc(history, last->station));
  const PlcRequests::Frame of_plc = last ? PlcRequests::Frame(last->frame) : PlcRequests::Frame();
  const Time now = history.now().time;
  for (const std::size_t host : history.hosts_on(history.requests().lines()[line]->line()))
    if (has_asked(history, host, of_plc, now - std::min(now, kLately))) names.push_back(history.name_of(bridge(host)));
  return names;
}

/// A request of another master that was on the line while an exchange heard what it took for its answer.
struct OtherRequest {
  std::string by{};
  std::optional<std::size_t> plc{};  ///< whose program has asked
  Time start = 0;
};

/// The earliest one; nothing if there was none.
std::optional<OtherRequest> other_request(const History& history, std::size_t line, const serial::Exchange& exchange) {
  std::optional<OtherRequest> first;
  const auto take = [&](OtherRequest request, Time end) {
    const bool is_under_way = end < request.start;
    if (request.start >= exchange.response_end || (!is_under_way && end <= exchange.response_start)) return;
    if (!first || request.start < first->start) first = std::move(request);
  };
  for (const SimulatedMaster& master : history.requests().masters_on(line)) {
    const serial::Exchange& asked = master.requester->exchange();
    if (master.asker.kind != Asker::Kind::Poller || asked.request.empty()) continue;
    take({.by = history.name_of(master.asker), .start = asked.request_start}, asked.request_end);
  }
  for (const std::size_t host : history.hosts_on(history.requests().lines()[line]->line()))
    for (const SentByHost& sent : history.sent_by_host(host, exchange.request_start))
      if (asks_something_else(sent.bytes, serial::bytes_of(exchange.request)))
        take({.by = history.name_of(bridge(host)), .start = sent.from}, sent.to);
  if (const auto& last = history.requests().last(line))
    take({.by = name_of_plc(history, last->station), .plc = last->station, .start = last->start}, last->end);
  return first;
}

/// The PLC on the line that has sent something since, and is not the one that has asked; empty if there is none.
std::string sender_since(const History& history, std::size_t line, Time since, std::optional<std::size_t> asker) {
  for (std::size_t station = 0; station < history.stations(); ++station) {
    const serial::Plc& plc = history.station(station).plc();
    const auto port = history.requests().port_on(line, station);
    if (station != asker && port && plc.state().uart.at(*port).send_end > since) return name_of_plc(history, station);
  }
  return {};
}

/// Whose request an exchange has taken for its answer, or who has sent into that; empty if nobody has.
std::string mixed_text(const History& history, std::size_t line, const serial::Exchange& exchange) {
  if (exchange.response.empty() || exchange.request.empty()) return {};
  const auto other = other_request(history, line, exchange);
  if (!other) return {};
  if (other->start <= exchange.response_start)
    return fmt::format("sent by {}: a request of its own, not an answer; two masters are on this line", other->by);
  const Bytes response = exchange.response_bytes();
  const bool is_answer = response.size() >= 2 && may_answer(response, serial::bytes_of(exchange.request));
  const std::string sender = sender_since(history, line, exchange.response_start, other->plc);
  const std::string what = (is_answer ? "an answer" : "a frame") + (sender.empty() ? "" : " of " + sender);
  return fmt::format("{}, into which {} sent a request of its own from {} on; two masters are on this line", what, other->by,
                     moment_text(other->start));
}

}  // namespace

std::string other_master_text(const History& history, std::size_t station) {
  const std::vector<std::string> names = other_masters(history, station);
  if (names.empty()) return {};
  return fmt::format(
      "{} masters are on this line: {} {} there too; frames may collide, and 'send' takes the next one for its answer\n",
      names.size() == 1 ? "two" : fmt::to_string(names.size() + 1), list_text(names), names.size() == 1 ? "asks" : "ask");
}

bool took_a_request_for_its_answer(const History& history, std::size_t station, const serial::Exchange& exchange) {
  if (exchange.response.empty() || exchange.request.empty()) return false;
  const auto other = other_request(history, history.requests().line_of(station, history.station(station).port()), exchange);
  return other && other->start <= exchange.response_start;
}

std::string not_an_answer_text(const History& history, std::size_t station, const serial::Exchange& exchange) {
  const std::size_t line = history.requests().line_of(station, history.station(station).port());
  const std::string text = mixed_text(history, line, exchange);
  return text.empty() ? "" : fmt::format("         {}\n", text);
}

std::string not_an_answer_text(const History& history, const Asker& asker, const std::vector<std::uint8_t>& answer) {
  if (answer.empty() || asker.kind != Asker::Kind::Poller) return {};
  const serial::Poller& poller = *history.pollers()[asker.number].poller;
  const serial::Exchange& exchange = poller.requester().exchange();
  const std::vector<const serial::SharedLine*>& lines = history.requests().lines();
  for (std::size_t line = 0; line < lines.size(); ++line)
    if (poller.is_on(lines[line]->line()) && exchange.response_bytes() == answer) return mixed_text(history, line, exchange);
  return {};
}

}  // namespace s7200::tools
