#include "serial_sim/system/stations.hpp"

#include <utility>

namespace s7200::serial {

RequesterStation::RequesterStation(Dispatcher& events, SharedLine& line)
    : line_(line),
      queue_(events.shared_queue()),
      uart_(line.line(), queue_, events.add(Rank::Uart, *this), line.add_driver()),
      requester_(uart_, queue_, events.add(Rank::Peer, *this)) {}

void RequesterStation::handle(const Event& event) {
  if (Dispatcher::rank_of(event.owner) == Rank::Peer) return requester_.handle(event);
  const Uart::Report report = uart_.handle(event);
  line_.note_activity(report);
  requester_.on(report);
}

void RequesterStation::restore(const State& state) {
  uart_.restore(state.uart);
  requester_.restore(state.requester);
}

PollerStation::PollerStation(Dispatcher& events, SharedLine& line, PollPlan plan, Poller::Wiring wiring)
    : line_(line),
      queue_(events.shared_queue()),
      uart_(line.line(), queue_, events.add(Rank::Uart, *this), line.add_driver()),
      requester_owner_(events.add(Rank::Peer, *this)),
      requester_(uart_, queue_, requester_owner_),
      poller_(uart_, requester_, queue_, events.add(Rank::Peer, *this), std::move(plan), std::move(wiring)) {}

void PollerStation::handle(const Event& event) {
  if (Dispatcher::rank_of(event.owner) == Rank::Uart) {
    const Uart::Report report = uart_.handle(event);
    line_.note_activity(report);
    requester_.on(report);
  } else if (event.owner == requester_owner_) {
    requester_.handle(event);
  } else {
    return poller_.handle(event);
  }
  poller_.go_on(event.at);
}

void PollerStation::restore(const State& state) {
  uart_.restore(state.uart);
  requester_.restore(state.requester);
  poller_.restore(state.poller);
}

ResponderStation::ResponderStation(Dispatcher& events, SharedLine& line, std::unique_ptr<Automaton> automaton)
    : line_(line),
      queue_(events.shared_queue()),
      uart_(line.line(), queue_, events.add(Rank::Uart, *this), line.add_driver()),
      tap_(line.line(), uart_.driver()),
      responder_(uart_, queue_, events.add(Rank::Peer, *this), std::move(automaton)) {
  line.faults().add_plc(uart_);
}

void ResponderStation::handle(const Event& event) {
  if (Dispatcher::rank_of(event.owner) == Rank::Peer) return responder_.handle(event);
  const Uart::Report report = uart_.handle(event);
  line_.note_activity(report);
  responder_.on(report);
}

void ResponderStation::restore(const State& state, Time now) {
  uart_.restore(state.uart);
  tap_.go_back(now);
  responder_.restore(state.responder);
}

HostStation::HostStation(Dispatcher& events, SharedLine& line)
    : line_(line),
      queue_(events.shared_queue()),
      uart_(line.line(), queue_, events.add(Rank::Uart, *this), line.add_driver(), false),
      port_(uart_) {}

void HostStation::handle(const Event& event) {
  const Uart::Report report = uart_.handle(event);
  line_.note_activity(report);
  port_.on(report);
}

void HostStation::restore(const State& state) {
  uart_.restore(state.uart);
  port_.restore(state.port);
}

}  // namespace s7200::serial
