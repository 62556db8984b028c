#include "serial_sim/system/plc.hpp"

#include <algorithm>
#include <utility>

namespace s7200::serial {

Plc::Port::Port(Dispatcher& events, SharedLine& shared_line, Plc& plc, std::uint8_t its_number)
    : of(plc),
      number(its_number),
      line(shared_line),
      owner(events.add(Rank::Uart, plc)),
      uart(line.line(), events.queue(), owner, line.add_driver()),
      tap(line.line(), uart.driver()) {
  uart.enable_receiver(false, 0);
  uart.set_bystander(this);
  line.faults().add_plc(uart);
}

void Plc::Port::configure(const SerialFormat& format) {
  uart.configure(format);
  if (follower) follower(format);
}

Plc::Plc(Dispatcher& events, std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field)
    : ports_(ports_on(lines, events)),
      cpu_(std::move(program), events.queue(), events.add(Rank::Cpu, *this), devices()),
      field_(std::move(field), cpu_, events.queue(), events.add(Rank::Field, *this)) {}

std::vector<std::unique_ptr<Plc::Port>> Plc::ports_on(std::span<SharedLine* const> lines, Dispatcher& events) {
  std::vector<std::unique_ptr<Port>> ports;
  for (SharedLine* const line : lines)
    ports.push_back(std::make_unique<Port>(events, *line, *this, static_cast<std::uint8_t>(ports.size())));
  return ports;
}

Ports Plc::devices() const {
  Ports devices{};
  std::transform(ports_.begin(), ports_.end(), devices.begin(), [](const auto& port) { return port.get(); });
  return devices;
}

void Plc::power_up(const RetentiveMemory* memory) {
  cpu_.power_up(true, memory);
  field_.power_up();
}

SerialFormat Plc::port_format(std::uint8_t port) const {
  const Freeport& freeport = cpu_.state().port.at(port);
  return freeport.active ? freeport.format : SerialFormat{};
}

void Plc::settle(Time until) {
  for (const auto& port : ports_) port->tap.settle(until, port->uart.state().format);
}

void Plc::handle(const Event& event) {
  const Rank rank = Dispatcher::rank_of(event.owner);
  if (rank == Rank::Cpu) return cpu_.handle(event);
  if (rank == Rank::Field) return field_.handle(event);
  for (std::uint8_t port = 0; port < ports_.size(); ++port)
    if (ports_[port]->owner == event.owner) return hear(port, event);
}

void Plc::hear(std::uint8_t port, const Event& event) {
  const Uart::Report report = ports_[port]->uart.handle(event);
  ports_[port]->line.note_activity(report);
  if (report.received) cpu_.character_received(*report.received, port);
  if (report.sent) cpu_.character_sent(*report.sent, port);
}

Plc::State Plc::state() const {
  State state{cpu_.state(), {}, field_.state()};
  for (std::size_t port = 0; port < ports_.size(); ++port) state.uart[port] = ports_[port]->uart.state();
  return state;
}

void Plc::restore(const State& state, Time now) {
  cpu_.restore(state.cpu);
  field_.restore(state.field);
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    ports_[port]->uart.restore(state.uart[port]);
    ports_[port]->tap.go_back(now);
  }
}

}  // namespace s7200::serial
