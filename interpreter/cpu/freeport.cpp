// Port 0 in Freeport mode: SMB30, character reception (event 8), XMT (event 9). Facts 2.
//
// Not documented, modelled so:
// - Transmit complete (event 9, SM4.5) comes with the end of the last stop bit.
//   [Freeport.XmtSendsFromItsEndOnAndEvent9ComesWithTheEndOfTheLastStopBit]
// - The transmit buffer is read character by character while sending. [Freeport.TheBufferIsReadWhileSending]
// - The port does not hear itself: its receiver is off from XMT until transmit complete.
//   [Freeport.TransmitterIdleIsZeroWhileSendingAndTheReceiverIsOff]
// - SM3.0 shows parity errors only; a character with a bad stop bit is handed over as it was sampled.
//   [Choices.ABadStopBitIsNoParityError]
// - A character received while event 8 is not attached leaves SMB2 and SM3.0 alone.
//   [Freeport.ACharacterThatNoRoutineWaitsForLeavesSMB2Alone]
// - XMT while the port is not in Freeport mode is error 0009. [Freeport.XmtWithoutFreeportModeIs0009]
// Not modelled: the PPI protocol. In PPI mode characters from the line are ignored.
#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

constexpr std::uint32_t kPortControl = image::kSM + 30;
constexpr std::uint8_t kTransmitterIdle = 0x20;  // SM4.5
constexpr int kBreakBits = 16;                   // A5E00066097-02, 9-189
constexpr std::uint8_t kReceiveEvent = 8, kTransmitEvent = 9;

bool is_freeport(std::uint8_t control) { return (control & 3) == 1; }

/// SMB30: p p d b b b m m.
SerialFormat format_of(std::uint8_t control, const CpuModel& model) {
  static constexpr Parity kParity[] = {Parity::None, Parity::Even, Parity::None, Parity::Odd};
  return {.baud = model.baud[(control >> 2) & 7],
          .data_bits = static_cast<std::uint8_t>(control & 0x20 ? 7 : 8),
          .parity = kParity[control >> 6],
          .stop_bits = 1};
}

}  // namespace

void run_with_port_control(Cpu& cpu, const Op& op) {
  const std::uint8_t before = cpu.s.image[kPortControl];
  if (op.has_pointer)
    run_with_pointers(cpu, op);
  else
    op.instruction->body(cpu, op);
  if (cpu.s.image[kPortControl] != before) cpu.port_control_written(before);
}

void Cpu::port_control_written(std::uint8_t before) {
  std::uint8_t& control = s.image[kPortControl];
  if (s.in_interrupt && is_freeport(control) && !is_freeport(before)) {
    control = before;
    return run_error(RunError::FreeportInInterrupt);
  }
  take_port_control(s.time);
}

void Cpu::follow_port_control(Time at) {
  const bool open = is_freeport(s.image[kPortControl]);
  if (s.image[kPortControl] != s.port.control || s.port.active != open) take_port_control(at);
}

void Cpu::take_port_control(Time at) {
  s.port.control = s.image[kPortControl];
  s.port.active = is_freeport(s.port.control);
  s.port.format = format_of(s.port.control, *program_->model);
  port_.configure(s.port.format);
  port_.enable_receiver(s.port.active && !s.port.transmitting, at);
  trace({.at = at, .kind = TraceKind::PortControl, .byte = s.port.control});
  attend();
}

/// In STOP the port falls back to PPI (facts 2.1).
void Cpu::close_port() {
  s.port.active = false;
  s.port.transmitting = false;
  s.image[image::kSM4] |= kTransmitterIdle;
  port_.enable_receiver(false, s.time);
}

void Cpu::transmit(std::uint32_t table) {
  const std::uint8_t count = s.image[table];
  if (!s.port.active || s.port.transmitting) return run_error(RunError::PortBusy);
  if (!in_area(table, count + 1u)) return run_error(RunError::OperandRange);
  s.port.transmitting = true;
  s.port.buffer = table + 1;
  s.port.left = count;
  s.image[image::kSM4] &= static_cast<std::uint8_t>(~kTransmitterIdle);
  port_.enable_receiver(false, s.time);
  trace({.at = s.time, .kind = TraceKind::Transmit, .count = count});
  s.port.sending_break = count == 0;
  if (s.port.sending_break)
    port_.send_break(kBreakBits, s.time);
  else
    send_next_character(s.time);
  attend();
}

void Cpu::send_next_character(Time at) {
  s.port.on_line = s.image[s.port.buffer];
  port_.send(s.port.on_line, at);
  ++s.port.buffer;
  --s.port.left;
}

void Cpu::character_sent(Time at) {
  if (!s.port.transmitting) return;
  if (!s.port.sending_break) trace({.at = at, .kind = TraceKind::CharacterSent, .byte = s.port.on_line});
  if (s.port.left != 0) return send_next_character(at);
  s.port.transmitting = false;
  s.image[image::kSM4] |= kTransmitterIdle;
  port_.enable_receiver(s.port.active, at);
  trace({.at = at, .kind = TraceKind::TransmitEnd});
  occurred(kTransmitEvent, at);
}

void Cpu::character_received(const ReceivedCharacter& character) {
  const bool heard = s.port.active && s.attached[kReceiveEvent] != kNotAttached;
  trace({.at = character.end,
         .kind = heard ? TraceKind::CharacterReceived : TraceKind::CharacterIgnored,
         .byte = character.byte,
         .parity_error = character.parity_error,
         .framing_error = character.framing_error,
         .since = character.start});
  if (heard) occurred(kReceiveEvent, character.end, character.byte, character.parity_error);
}

}  // namespace s7200
