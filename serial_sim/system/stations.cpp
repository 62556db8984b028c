#include "serial_sim/system/stations.hpp"

namespace s7200::serial {

RequesterStation::RequesterStation(Dispatcher& events, SharedLine& line)
    : line_(line),
      uart_(line.line(), events.queue(), events.add(Rank::Uart, *this), line.add_driver()),
      requester_(uart_, events.queue(), events.add(Rank::Peer, *this)) {}

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

HostStation::HostStation(Dispatcher& events, SharedLine& line)
    : line_(line),
      uart_(line.line(), events.queue(), events.add(Rank::Uart, *this), line.add_driver(), false),
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
