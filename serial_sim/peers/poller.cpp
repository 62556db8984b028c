#include "serial_sim/peers/poller.hpp"

#include <algorithm>
#include <utility>

#include "serial_sim/peers/quiet_time.hpp"

namespace s7200::serial {

Poller::Poller(Uart& uart, Requester& requester, EventQueue& queue, EventOwner owner, PollPlan plan, Wiring wiring)
    : uart_(uart), requester_(requester), queue_(queue), owner_(owner), plan_(std::move(plan)), wiring_(std::move(wiring)) {}

void Poller::start(Time at) {
  state_ = {};
  await(at);
}

void Poller::power_off() {
  state_.waiting = true;
  queue_.cancel(owner_, 0);
}

void Poller::begin_round(Time at) {
  state_.next = 0;
  await(at);
}

void Poller::handle(const Event& event) {
  state_.waiting = false;
  if (state_.next == 0) state_.round_begin = event.at;
  ++state_.asked;
  uart_.configure(wiring_.format(), event.at);
  requester_.start(plan_.requests[state_.next], event.at);
}

void Poller::go_on(Time now) {
  if (state_.waiting || requester_.busy()) return;
  count(requester_.exchange());
  const Time begin = now + plan_.pause.value_or(default_quiet(uart_.state().format));
  state_.next = (state_.next + 1) % plan_.requests.size();
  await(state_.next == 0 ? std::max(begin, state_.round_begin + plan_.every) : begin);
}

void Poller::count(const Exchange& exchange) {
  const auto latency = exchange.latency();
  if (!latency || exchange.of_another_master) return;
  ++state_.answered;
  const Verdict verdict = wiring_.verdict(exchange);
  state_.refused += verdict == Verdict::Exception;
  if (verdict == Verdict::Wrong) {
    ++state_.wrong;  // what came may be the end of what others said
    return;
  }
  state_.least_latency = std::min(state_.least_latency, *latency);
  state_.most_latency = std::max(state_.most_latency, *latency);
}

void Poller::await(Time at) {
  state_.waiting = true;
  queue_.schedule(at, owner_, 0);
}

}  // namespace s7200::serial
