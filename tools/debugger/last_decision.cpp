#include "tools/debugger/last_decision.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/trace/trace_reasons.hpp"

namespace s7200::tools {
namespace {

constexpr Time kEarlier = kSecond;  // who attached the routine that got a frame is mostly seen, too
constexpr Time kJust = 100 * kMillisecond;
constexpr Time kHostRequest = 2 * kSecond;  // when a master on a bridge has asked is not kept: with its time-out before now

class Reader final : public Observer {
 public:
  Reader(const History& history, std::size_t station, const std::atomic<bool>* stop_request)
      : Observer(station), reasons(history.station(station).cpu().program()), stop_request_(stop_request) {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !(stop_request_ && *stop_request_); }
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::Transmit) unanswered.clear();
    for (const auto& frame : reasons.unanswered(record)) unanswered.push_back({record.at, record.at, frame});
    reasons.note(record);
  }
  void instruction(const InstructionRecord& record) override { reasons.note(record); }

  struct Left {
    Time known = 0;  ///< since when
    Time at = 0;     ///< when nothing is known to have decided it
    TraceReasons::Unanswered frame;
  };
  /// Frames without an answer that are known since then; `last_alone`: the last of them.
  std::vector<Left> left_since(Time since, Time now, bool last_alone) const {
    std::vector<Left> all = unanswered;
    for (const auto& frame : reasons.unread()) all.push_back({frame.since, now, frame});
    std::erase_if(all, [&](const Left& one) { return one.known < since; });
    if (last_alone && all.size() > 1) all.erase(all.begin(), all.end() - 1);
    return all;
  }

  TraceReasons reasons;
  std::vector<Left> unanswered;

 private:
  const std::atomic<bool>* stop_request_;
};

/// Stops in front of an instruction, in an interrupt or not.
class Finder final : public Observer {
 public:
  Finder(const History& history, std::size_t station, std::uint32_t op, bool in_interrupt)
      : Observer(station), cpu_(history.station(station).cpu()), op_(op), in_interrupt_(in_interrupt) {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t op) override { return op != op_ || cpu_.state().in_interrupt != in_interrupt_; }

 private:
  const Cpu& cpu_;
  std::uint32_t op_;
  bool in_interrupt_;
};

bool is_bridged(const serial::Simulation& simulation) {
  return simulation.has_host_port() && simulation.host_port().state().attached;
}

/// Since when all is to be known: the scan, which an interrupt routine never outlasts, and a request without an answer.
Time beginning(const serial::Simulation& simulation) {
  const Time now = simulation.time();
  Time from = simulation.cpu().state().scan_begin;
  if (simulation.has_master()) {
    const serial::Requester& master = simulation.master();
    const serial::Exchange& exchange = master.exchange();
    const Time given_up = exchange.request_end + master.state().request.timeout;
    if (master.asks() || (exchange.timed_out && now - given_up < kJust)) from = std::min(from, exchange.request_start);
  }
  if (is_bridged(simulation)) from = std::min(from, now - std::min(now, kHostRequest));
  return from;
}

}  // namespace

DecisionSearch find_last_decision(History& history, std::size_t station, const std::atomic<bool>* stop_request) {
  const Moment start = history.now();
  const Time since = beginning(history.station(station));
  Reader reader(history, station, stop_request);
  const bool whole = history.go_to(since - std::min(since, kEarlier)) && history.play(reader, start);
  DecisionSearch search{.decision = {}, .interrupted = !whole};
  const auto in_front_of = [&](const InstructionRecord& from, std::uint32_t op, bool in_interrupt) {
    Finder finder(history, station, op, in_interrupt);
    if (history.go_to(from.at)) history.play(finder, start);
    return history.now();
  };
  const auto decision_of = [&](const TraceReasons::Cause& cause) {
    LastDecision decision{in_front_of(cause.by, cause.by.op + (cause.contacts ? 1 : 0), cause.in_interrupt), cause.text,
                          cause.by};
    if (decision.moment == start) decision.moment = in_front_of(cause.first, cause.first.op, cause.in_interrupt);
    return decision;
  };
  if (!whole) return history.go_to(start), search;
  const std::vector<Reader::Left> left = reader.left_since(since, start.time, is_bridged(history.station(station)));
  for (const Reader::Left& one : left)
    search.unanswered.push_back({one.frame.cause ? one.frame.cause->by.at : one.at, unanswered_text(one.frame)});
  const bool in_main = !history.station(station).cpu().state().in_interrupt;
  if (in_main && !left.empty() && left.back().frame.cause) search.left = decision_of(*left.back().frame.cause);
  if (const auto cause = reader.reasons.cause()) search.decision = decision_of(*cause);
  history.go_to(start);
  return search;
}

}  // namespace s7200::tools
