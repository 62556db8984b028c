#include "serial_sim/system/plc.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/cpu/ports/ppi.hpp"

namespace s7200::serial {

Plc::Port::Port(Plc& of, std::uint8_t its_number, SharedLine& shared_line, Dispatcher& events)
    : plc(of),
      number(its_number),
      line(shared_line),
      actor(events.add(Rank::Port, of)),
      owner(events.add(Rank::Uart, of)),
      uart(line.line(), events.shared_queue(), owner, line.add_driver()),
      tap(line.line(), uart.driver()) {
  uart.enable_receiver(false, 0);
  uart.set_bystander(this);
  line.add_plc(uart, this);
}

/// The characters left of a message that XMT sends; the CPU's answers in PPI mode are not Modbus frames.
std::optional<std::size_t> Plc::Port::characters_left() const {
  const Freeport& port = plc.cpu_.state().port[number];
  return port.transmitting ? std::optional<std::size_t>(port.left) : std::nullopt;
}

void Plc::Port::configure(const SerialFormat& format, Time at) {
  act({.what = PortAction::What::Configure, .at = at, .format = format});
}
void Plc::Port::enable_receiver(bool enabled, Time at) {
  act({.what = PortAction::What::EnableReceiver, .at = at, .value = enabled});
}
void Plc::Port::send(std::uint8_t byte, Time at) { act({.what = PortAction::What::Send, .at = at, .value = byte}); }
void Plc::Port::send_break(int bit_times, Time at) {
  act({.what = PortAction::What::SendBreak, .at = at, .value = bit_times});
}

/// Does the action at once if its instant is the present one, else schedules it.
void Plc::Port::act(const PortAction& action) {
  if (action.at <= plc.handled_) return perform(action);
  actions.insert(std::ranges::upper_bound(actions, action.at, {}, &PortAction::at), action);
  plc.queue_.schedule(actions.front().at, actor, 0);
}

void Plc::Port::act_until(Time now) {
  auto next = actions.begin();
  for (; next != actions.end() && next->at <= now; ++next) perform(*next);
  actions.erase(actions.begin(), next);
  if (!actions.empty()) plc.queue_.schedule(actions.front().at, actor, 0);
}

void Plc::Port::perform(const PortAction& action) {
  switch (action.what) {
    case PortAction::What::Configure:
      uart.configure(action.format, action.at);
      if (follower) follower(action.format, action.at);
      break;
    case PortAction::What::EnableReceiver:
      uart.enable_receiver(action.value != 0, action.at);
      break;
    case PortAction::What::Send:
      uart.send(static_cast<std::uint8_t>(action.value), action.at);
      break;
    case PortAction::What::SendBreak:
      uart.send_break(action.value, action.at);
      break;
  }
}

Time Plc::Port::shortest_character() const {
  const Uart::State& state = uart.state();
  if (!state.receiver_enabled()) return kNever;
  if (shortest_ == 0 || !(known_format_ == state.format)) {
    known_format_ = state.format;
    const BitClock fastest{state.format, Fault::kLargestClockError};
    shortest_ = fastest.half_bits(2 * first_stop_bit(state.format) + 1);
  }
  return shortest_;
}

Plc::Plc(Dispatcher& events, std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field)
    : queue_(events.add_queue()),
      owner_(events.add(Rank::Cpu, *this)),
      field_owner_(events.add(Rank::Field, *this)),
      ports_(ports_on(lines, events)),
      cpu_(std::move(program), queue_, owner_, devices()),
      field_(std::move(field), cpu_, queue_, field_owner_) {}

std::vector<std::unique_ptr<Plc::Port>> Plc::ports_on(std::span<SharedLine* const> lines, Dispatcher& events) {
  std::vector<std::unique_ptr<Port>> ports;
  for (SharedLine* const line : lines)
    ports.push_back(std::make_unique<Port>(*this, static_cast<std::uint8_t>(ports.size()), *line, events));
  return ports;
}

Ports Plc::devices() const {
  Ports devices{};
  std::transform(ports_.begin(), ports_.end(), devices.begin(), [](const auto& port) { return port.get(); });
  return devices;
}

void Plc::power_up(const RetentiveMemory* memory, Time at) {
  executed_before_ = 0;
  for (const auto& port : ports_) port->framing_errors = 0;
  powered_ = true;
  cpu_.power_up(true, memory, at);
  field_.power_up(at);
}

void Plc::power_off(Time at) {
  powered_ = false;
  queue_ = {};
  output_edges_.clear();
  for (const OutputWire& wire : output_wires_) wire.end(false, at);
  for (const auto& port : ports_) {
    port->actions.clear();
    port->uart.power_off(at);
  }
}

void Plc::power_on(Time at) {
  RetentiveMemory memory = cpu_.retentive_memory();
  memory.power_off = at - cpu_.time();
  powered_ = true;
  executed_before_ = executed();
  const s7200::State before = cpu_.state();
  cpu_.power_up((before.image[sm::kScanStatus] & sm::kModeSwitchRun) != 0, &memory, at);
  // The field's levels do not depend on the PLC's power.
  for (std::uint32_t byte = 0; byte < before.terminals.size(); ++byte) cpu_.set_input(byte, before.terminals[byte], at);
  if (before.analog_terminals != s7200::State{}.analog_terminals) cpu_.poke(image::kAI, before.analog_terminals);
  field_.handle({.at = at});
}

SerialFormat Plc::port_format(std::uint8_t port) const {
  const Freeport& freeport = cpu_.state().port.at(port);
  return freeport.active ? freeport.format : ppi::format_of(cpu_.program(), port);
}

void Plc::wire_output(Dispatcher& events, const OutputPoint& output, std::function<void(bool on, Time at)> end) {
  if (output_wires_.empty()) {
    outputs_owner_ = events.add(Rank::Port, *this);
    cpu_.set_output_listener(this);
  }
  output_wires_.push_back({output, std::move(end)});
}

/// Output changes take effect when the time of the system has reached them, like what the CPU does to its ports.
void Plc::outputs_changed(std::uint32_t byte, std::uint8_t points, std::uint8_t changed, Time at) {
  for (std::size_t wire = 0; wire < output_wires_.size(); ++wire) {
    const OutputPoint& output = output_wires_[wire].output;
    if (output.byte != byte || (changed >> output.bit & 1U) == 0) continue;
    const OutputEdge edge{.wire = wire, .on = (points >> output.bit & 1U) != 0, .at = at};
    output_edges_.insert(std::ranges::upper_bound(output_edges_, at, {}, &OutputEdge::at), edge);
  }
  if (!output_edges_.empty()) carry_output_edges(handled_);
}

void Plc::carry_output_edges(Time until) {
  auto next = output_edges_.begin();
  for (; next != output_edges_.end() && next->at <= until; ++next) output_wires_[next->wire].end(next->on, next->at);
  output_edges_.erase(output_edges_.begin(), next);
  if (!output_edges_.empty()) queue_.schedule(output_edges_.front().at, outputs_owner_, 0);
}

Time Plc::may_run_until(Time horizon) const {
  Time until = kNever;
  for (const auto& port : ports_) {
    const Time shortest = port->shortest_character();
    const Time heard = shortest < kNever - horizon ? horizon + shortest : kNever;
    until = std::min({until, heard, port->uart.next_report()});
  }
  return until;
}

void Plc::set_wire_sink(WireSink* sink, std::uint8_t port) { ports_.at(port)->tap.watch(sink, cpu_.time()); }

void Plc::unwatch_lines() {
  for (std::uint8_t port = 0; port < ports_.size(); ++port) set_wire_sink(nullptr, port);
}

void Plc::settle(Time until) {
  for (const auto& port : ports_) port->tap.settle(until, port->uart.state().format);
}

void Plc::handle(const Event& event) {
  handled_ = event.at;
  if (event.owner == owner_) cpu_.handle(event);
  if (event.owner == field_owner_) field_.handle(event);
  if (!output_wires_.empty() && event.owner == outputs_owner_) carry_output_edges(event.at);
  for (std::uint8_t port = 0; port < ports_.size(); ++port) {
    if (event.owner == ports_[port]->owner) hear(port, event);
    if (event.owner == ports_[port]->actor) ports_[port]->act_until(event.at);
  }
  handled_ = -1;
}

void Plc::hear(std::uint8_t port, const Event& event) {
  const Uart::Report report = ports_[port]->uart.handle(event);
  ports_[port]->line.note_activity(report);
  if (report.received) {
    ports_[port]->framing_errors += report.received->framing_error;
    cpu_.character_received(*report.received, port);
  }
  if (report.sent) cpu_.character_sent(*report.sent, port);
}

Plc::State Plc::state() const {
  State state{cpu_.state(), {}, {}, output_edges_, field_.state(), powered_, executed_before_};
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    state.uart[port] = ports_[port]->uart.state();
    state.actions[port] = ports_[port]->actions;
    state.framing_errors[port] = ports_[port]->framing_errors;
  }
  return state;
}

void Plc::restore(const State& state, Time now) {
  cpu_.restore(state.cpu);
  output_edges_ = state.output_edges;
  field_.restore(state.field);
  powered_ = state.powered;
  executed_before_ = state.executed_before;
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    ports_[port]->uart.restore(state.uart[port]);
    ports_[port]->actions = state.actions[port];
    ports_[port]->framing_errors = state.framing_errors[port];
    ports_[port]->tap.go_back(now);
  }
}

}  // namespace s7200::serial
