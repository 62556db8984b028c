#include "serial_sim/system/stations.hpp"

#include <utility>

namespace s7200::serial {

PeerStation::PeerStation(Dispatcher& events, SharedLine& line, bool plugged_in)
    : line_(line),
      queue_(events.shared_queue()),
      uart_(line.line(), queue_, events.add(Rank::Uart, *this), line.add_driver(), plugged_in) {}

Uart::Report PeerStation::hear(const Event& event) {
  const Uart::Report report = uart_.handle(event);
  line_.note_activity(report);
  return report;
}

RequesterStation::RequesterStation(Dispatcher& events, SharedLine& line)
    : PeerStation(events, line), requester_(uart_, queue_, events.add(Rank::Peer, *this)) {
  line.add_master(requester_);
}

void RequesterStation::handle(const Event& event) {
  if (Dispatcher::rank_of(event.owner) == Rank::Peer) return requester_.handle(event);
  requester_.on(hear(event), line_.another_sends(requester_));
}

void RequesterStation::restore(const State& state) {
  uart_.restore(state.uart);
  requester_.restore(state.requester);
}

PollerStation::PollerStation(Dispatcher& events, SharedLine& line, PollPlan plan, Poller::Wiring wiring)
    : PeerStation(events, line),
      requester_owner_(events.add(Rank::Peer, *this)),
      requester_(uart_, queue_, requester_owner_),
      poller_(uart_, requester_, queue_, events.add(Rank::Peer, *this), std::move(plan), std::move(wiring)) {
  line.add_master(requester_);
}

void PollerStation::handle(const Event& event) {
  if (Dispatcher::rank_of(event.owner) == Rank::Uart)
    requester_.on(hear(event), line_.another_sends(requester_));
  else if (event.owner == requester_owner_)
    requester_.handle(event);
  else
    return poller_.handle(event);
  poller_.go_on(event.at);
}

void PollerStation::power_off(Time at) {
  powered_ = false;
  uart_.power_off(at);
  requester_.power_off(at);
  poller_.power_off();
}

void PollerStation::power_on(Time at, Time first) {
  powered_ = true;
  uart_.enable_receiver(true, at);
  poller_.begin_round(first);
}

void PollerStation::restore(const State& state) {
  uart_.restore(state.uart);
  requester_.restore(state.requester);
  poller_.restore(state.poller);
  powered_ = state.powered;
}

ResponderStation::ResponderStation(Dispatcher& events, SharedLine& line, std::unique_ptr<Automaton> automaton)
    : PeerStation(events, line),
      tap_(line.line(), uart_.driver()),
      responder_(uart_, queue_, events.add(Rank::Peer, *this), std::move(automaton)) {
  line.add_plc(uart_, this);
}

std::optional<std::size_t> ResponderStation::characters_left() const {
  const Responder::State& state = responder_.state();
  return state.transmission.bytes.size() - state.sent;
}

void ResponderStation::handle(const Event& event) {
  if (Dispatcher::rank_of(event.owner) == Rank::Peer) return responder_.handle(event);
  responder_.on(hear(event));
}

void ResponderStation::power_off(Time at) {
  powered_ = false;
  uart_.power_off(at);
  responder_.power_off(at);
}

void ResponderStation::power_on(Time at) {
  powered_ = true;
  responder_.power_on(at);
  uart_.enable_receiver(true, at);
}

void ResponderStation::restore(const State& state, Time now) {
  uart_.restore(state.uart);
  tap_.go_back(now);
  responder_.restore(state.responder);
  powered_ = state.powered;
}

HostStation::HostStation(Dispatcher& events, SharedLine& line) : PeerStation(events, line, false), port_(uart_) {}

void HostStation::restore(const State& state) {
  uart_.restore(state.uart);
  port_.restore(state.port);
}

}  // namespace s7200::serial
