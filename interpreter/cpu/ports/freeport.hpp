// The ports in Freeport mode: control byte, character reception, XMT (facts 2). kPorts says what differs between them; a CPU
// has the first CpuModel::ports of them. RCV is in message_receiver.hpp.
//
// Not documented, modelled so:
// - Transmit complete (event 9, SM4.5) comes at the end of the last stop bit.
//   [Freeport.XmtSendsFromItsEndAndEvent9ComesAtTheEndOfTheLastStopBit]
// - The transmit buffer is read character by character while sending. [Freeport.TheBufferIsReadWhileSending]
// - The port does not hear itself: its receiver is off from XMT until transmit complete.
//   [Freeport.TransmitterIdleIsZeroWhileSendingAndTheReceiverIsOff]
// - SM3.0 only shows parity errors; a character with a bad stop bit is passed on as it was sampled.
//   [Choices.ABadStopBitIsNotAParityError]
// - A character received while its event, 8 or 25, is not attached leaves SMB2 and SM3.0 alone.
//   [Freeport.ACharacterThatNoRoutineWaitsForLeavesSMB2Alone]
// - XMT and RCV while the port is not in Freeport mode are error 0009, or 000B on port 1.
//   [Freeport.XmtWithoutFreeportModeIs0009, Receive.WithoutFreeportModeItIs0009]
//
// A port that is not in Freeport mode speaks PPI (ppi.hpp).
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::freeport {

/// XMT: `table` is the place of the number of characters, 0 to 255; the characters follow it. 0 sends a break of 16 bit
/// times (A5E00066097-02, 9-189). The port's error `busy` if it is not free(), 0091 for a table that runs past the end of
/// its area.
void transmit(Core& core, std::uint8_t port, std::uint32_t table);

/// Whether XMT and RCV can begin: in Freeport mode, neither sending nor receiving a message.
bool free(const Core& core, std::uint8_t port);

/// Reports of the line.
void character_received(Core& core, std::uint8_t port, const ReceivedCharacter& character);
void character_sent(Core& core, std::uint8_t port, Time at);

/// A character that the line brings while the receiver is off, or the PLC has no power: nothing but the record of it.
void character_missed(const Core& core, std::uint8_t port, const ReceivedCharacter& character, bool powered);

/// Records what has become of a received character.
void trace_character(const Core& core, std::uint8_t port, const ReceivedCharacter& character, TraceKind kind);

/// Makes the ports follow their control bytes after something other than the program may have written them.
void follow_control(Core& core);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);
void enter_stop(Core& core);
void begin_service(Core& core, const QueuedInterrupt& interrupt);

}  // namespace s7200::freeport
