#include "interpreter/cpu/ports/freeport.hpp"

#include <utility>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/network.hpp"
#include "interpreter/cpu/ports/message_receiver.hpp"
#include "interpreter/cpu/ports/ppi.hpp"

namespace s7200 {
namespace freeport {
namespace {

constexpr int kBreakBits = 16;

bool is_freeport(std::uint8_t control) { return (control & sm::kProtocol) == sm::kFreeport; }

SerialFormat format_of(std::uint8_t control, const CpuModel& model) {
  static constexpr Parity kParity[] = {Parity::None, Parity::Even, Parity::None, Parity::Odd};
  return {.baud = model.baud[(control & sm::kBaudRate) >> 2],
          .data_bits = static_cast<std::uint8_t>(control & sm::kSevenBits ? 7 : 8),
          .parity = kParity[(control & sm::kParity) >> 6],
          .stop_bits = 1};
}

void take_over_line(Core& core, std::uint8_t number, Time at) {
  const Freeport& port = core.s.port[number];
  core.port(number).configure(port.format, at);
  core.port(number).enable_receiver(!port.transmitting, at);
}

void take_control(Core& core, std::uint8_t number, std::uint32_t op) {
  Freeport& port = core.s.port[number];
  port.control = core.s.image[kPorts[number].control];
  const bool was_active = std::exchange(port.active, is_freeport(port.control));
  if (!port.active) message_receiver::abandon(core, number);
  port.format = format_of(port.control, core.model());
  if (port.active) {
    if (!was_active) ppi::end(core, number);
    if (port.on_wire != OnWire::Ppi) take_over_line(core, number, core.s.time);
  } else if (was_active && !port.transmitting) {
    ppi::begin(core, number, core.s.time);
  }
  network::follow_control(core, number);
  core.trace({.at = core.s.time, .kind = TraceKind::PortControl, .byte = port.control, .port = number, .op = op});
  core.attend();
}

/// The program has written the control byte, which was `before`.
void control_written(Core& core, std::uint8_t number, std::uint8_t before) {
  std::uint8_t& control = core.s.image[kPorts[number].control];
  if (core.s.in_interrupt && is_freeport(control) && !is_freeport(before)) {
    control = before;
    return core.run_error(RunError::FreeportInInterrupt);
  }
  take_control(core, number, core.loop.op);
}

/// Whatever is still on the wire leaves first.
void send_next_character(Core& core, std::uint8_t number, Time at) {
  Freeport& port = core.s.port[number];
  if (port.on_wire != OnWire::Nothing) return;
  port.on_wire = OnWire::Xmt;
  if (port.sending_break) return core.port(number).send_break(kBreakBits, at);
  port.on_line = core.s.image[port.buffer];
  ++port.buffer;
  --port.left;
  core.port(number).send(port.on_line, at);
}

Ignored reason_to_ignore(const Core& core, std::uint8_t number) {
  if (core.s.port[number].transmitting || core.s.port[number].on_wire != OnWire::Nothing) return Ignored::WhileSending;
  if (!core.s.port[number].active) return Ignored::NoPpiFrame;
  return core.program().receives_messages[number] ? Ignored::NoRcvWaits : Ignored::NotAttached;
}

void trace(const Core& core, std::uint8_t number, const ReceivedCharacter& character, TraceKind kind, Ignored why = {}) {
  core.trace({.at = character.end,
              .kind = kind,
              .byte = character.byte,
              .parity_error = character.parity_error,
              .framing_error = character.framing_error,
              .port = number,
              .code = static_cast<std::uint16_t>(why),
              .since = character.start});
}

using ControlBytes = std::array<std::uint8_t, kPorts.size()>;

ControlBytes control_bytes(const Core& core) {
  ControlBytes bytes{};
  for (std::uint8_t number = 0; number < core.port_count(); ++number) bytes[number] = core.s.image[kPorts[number].control];
  return bytes;
}

}  // namespace

void trace_character(const Core& core, std::uint8_t number, const ReceivedCharacter& character, TraceKind kind) {
  if (kind == TraceKind::CharacterIgnored) return trace(core, number, character, kind, reason_to_ignore(core, number));
  trace(core, number, character, kind);
}

void character_missed(const Core& core, std::uint8_t number, const ReceivedCharacter& character, bool powered) {
  const Ignored why = powered ? reason_to_ignore(core, number) : Ignored::NoPower;
  trace(core, number, character, TraceKind::CharacterIgnored, why);
}

bool free(const Core& core, std::uint8_t number) {
  const Freeport& port = core.s.port[number];
  return port.active && !port.transmitting && !message_receiver::active(core, number);
}

void transmit(Core& core, std::uint8_t number, std::uint32_t table) {
  Freeport& port = core.s.port[number];
  const std::uint8_t count = core.s.image[table];
  if (!free(core, number)) return core.run_error(kPorts[number].busy);
  if (!core.in_area(table, count + 1u)) return core.run_error(RunError::OperandRange);
  port.transmitting = true;
  port.buffer = table + 1;
  port.left = count;
  core.put_mask(sm::kInterruptStatus, kPorts[number].idle, false);
  core.port(number).enable_receiver(false, core.s.time);
  core.trace({.at = core.s.time, .kind = TraceKind::Transmit, .port = number, .op = core.loop.op, .count = count});
  port.sending_break = count == 0;
  send_next_character(core, number, core.s.time);
  core.attend();
}

void character_sent(Core& core, std::uint8_t number, Time at) {
  Freeport& port = core.s.port[number];
  const OnWire sent = std::exchange(port.on_wire, OnWire::Nothing);
  if (port.active && sent == OnWire::Ppi) take_over_line(core, number, at);
  if (!port.transmitting) return port.active ? void() : ppi::character_sent(core, number, at);
  const bool before_the_first = sent != OnWire::Xmt;
  if (core.sink() && !port.sending_break && !before_the_first)
    core.trace({.at = at, .kind = TraceKind::CharacterSent, .byte = port.on_line, .port = number});
  if (port.left != 0 || before_the_first) return send_next_character(core, number, at);
  port.transmitting = false;
  core.put_mask(sm::kInterruptStatus, kPorts[number].idle, true);
  core.trace({.at = at, .kind = TraceKind::TransmitEnd, .port = number});
  if (port.active)
    core.port(number).enable_receiver(true, at);
  else
    ppi::begin(core, number, at);
  interrupts::occurred(core, kPorts[number].sent, at);
}

void character_received(Core& core, std::uint8_t number, const ReceivedCharacter& character) {
  if (!core.s.port[number].active) return ppi::character_received(core, number, character);
  const std::uint8_t event = kPorts[number].received;
  const bool to_message = message_receiver::active(core, number);
  const bool raises = core.s.attached[event] != kNotAttached && (!to_message || core.model().receive.character_events);
  if (!to_message)
    trace_character(core, number, character, raises ? TraceKind::CharacterReceived : TraceKind::CharacterIgnored);
  if (to_message) message_receiver::take(core, number, character);
  if (raises) interrupts::occurred(core, event, character.end, character.byte, character.parity_error);
}

void follow_control(Core& core) {
  for (std::uint8_t number = 0; number < core.port_count(); ++number) {
    const std::uint8_t control = core.s.image[kPorts[number].control];
    const Freeport& port = core.s.port[number];
    if (control != port.control || port.active != is_freeport(control)) take_control(core, number, kNoRoutine);
  }
}

/// All transmitters are idle, and so is that of a port that the CPU does not have. The ports speak PPI.
void power_up(Core& core, const RetentiveMemory*) {
  for (const PortInfo& port : kPorts) core.put_mask(sm::kInterruptStatus, port.idle, true);
  for (std::uint8_t number = 0; number < core.port_count(); ++number) ppi::begin(core, number, core.s.time);
}

/// The port goes back to PPI in STOP (facts 2.1).
void enter_stop(Core& core) {
  for (std::uint8_t number = 0; number < core.port_count(); ++number) {
    Freeport& port = core.s.port[number];
    core.put_mask(sm::kInterruptStatus, kPorts[number].idle, true);
    if (!port.active && !port.transmitting) continue;
    port.active = false;
    port.transmitting = false;
    ppi::begin(core, number, core.s.time);
  }
}

/// SMB2 and SM3.0 get the character just before its routine starts (S7-200 manual C233-01, 9-188).
void begin_service(Core& core, const QueuedInterrupt& interrupt) {
  for (const PortInfo& port : kPorts) {
    if (interrupt.event != port.received) continue;
    core.s.image[sm::kReceivedCharacter] = interrupt.byte;
    core.put_mask(sm::kReceiveStatus, sm::kParityError, interrupt.parity_error);
  }
}

}  // namespace freeport

void run_with_port_control(Core& core, const Op& op) {
  const auto before = freeport::control_bytes(core);
  if (op.has_pointer)
    run_with_pointers(core, op);
  else
    op.direct_body()(core, op);
  for (std::uint8_t number = 0; number < core.port_count(); ++number)
    if (core.s.image[kPorts[number].control] != before[number]) freeport::control_written(core, number, before[number]);
}

}  // namespace s7200
