// A master at work on the line: it asks the same requests in turn, for as long as time passes.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "serial_sim/peers/answer.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::serial {

/// The requests of a poller, and how often it sends them.
struct PollPlan {
  std::vector<Request> requests;  ///< at least one
  std::optional<Time> pause{};    ///< between an exchange and the next request; default_quiet() if not given
  Time starts = kSecond;          ///< time of the first request after power-up: programs have set their ports by then
  Time every = 0;                 ///< a round of all requests begins no sooner than so long after the one before
};

/// Sends requests in rounds. The owner passes events of this poller's number to handle(), and calls go_on() after each event
/// of its requester.
class Poller {
 public:
  /// Plain, so that a snapshot is a copy. The request of another master answers nothing.
  struct State {
    std::size_t next = 0;  ///< request
    Time round_begin = 0;
    bool waiting = true;  ///< for the moment of the next request
    std::uint64_t asked = 0, answered = 0, refused = 0, wrong = 0;
    Time least_latency = kNever, most_latency = 0;  ///< of answers that are not wrong
    bool operator==(const State&) const = default;
  };

  /// What a poller uses of its line. Wiring, not state.
  struct Wiring {
    std::function<SerialFormat()> format = [] { return SerialFormat{}; };  ///< of the next exchange
    std::function<Verdict(const Exchange&)> verdict = [](const Exchange&) { return Verdict::Right; };  ///< of an answered
                                                                                                       ///< request
  };

  /// `owner` is the poller's number in the queue. Neither reference is owned.
  Poller(Uart& uart, Requester& requester, EventQueue& queue, EventOwner owner, PollPlan plan, Wiring wiring);

  /// Sends the first request at `at`.
  void start(Time at);

  /// The requester has lost power: the poller sends no more requests.
  void power_off();

  /// Starts a round with its first request at `at`.
  void begin_round(Time at);

  void go_on(Time now);
  void handle(const Event& event);

  /// The one under way, or the last one, is its exchange.
  const Requester& requester() const { return requester_; }

  bool is_on(const Line& line) const { return &uart_.line() == &line; }
  int driver() const { return uart_.driver(); }
  const SerialFormat& format() const { return uart_.state().format; }

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  void count(const Exchange& exchange);
  void await(Time at);

  Uart& uart_;
  Requester& requester_;
  EventQueue& queue_;
  EventOwner owner_;
  PollPlan plan_;
  Wiring wiring_;
  State state_;
};

}  // namespace s7200::serial
