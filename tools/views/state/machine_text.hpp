// The state of the machine in words: registers, logic stack, port, where it stands.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "interpreter/program/operands/address.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/views/program/listing.hpp"

namespace s7200::tools {

/// A moment as text: `412.345678 ms`
std::string moment_text(Time time);

/// An interrupt event as text: `event 8 (port 0: character received)`
std::string event_text(std::uint8_t event);

/// An interrupt in a queue, with its character if it has one: `event 8 (port 0: character received) 41`
std::string waiting_text(const QueuedInterrupt& entry);

/// What the receive message service waits for: `the start of a message: an idle line of 5 ms, then the character 16#02`,
/// `the first character of a message, 16#02; the break before it has come`, `the end of its message: the character 16#0D or
/// 10 characters (2 so far)`; empty if it is off.
std::string awaited_text(const MessageReceiver& message, const ReceiveChoices& choices);

/// The place of the CPU: `412.345678 ms  scan 7  INT 123  S0=1`, and the line it stands in front of: `>  1242  INCB VB101
/// // one more`.
std::string place_text(const Cpu& cpu, const Listing& listing);

/// The registers as text: time, place, calls, accumulators, flags, interrupts.
std::string registers_text(const Cpu& cpu, const Listing& listing);

/// The nine levels of the logic stack, top first.
std::string stack_text(const State& state);

/// A port's control byte in words: `SMB30 = 16#09: Freeport, 9600 baud, 8 data bits, no parity`
std::string control_byte_text(const State& state, std::size_t port);

/// SMB30 in words, receiver, transmitter, and what the master on the line is doing.
std::string port_text(const serial::Simulation& simulation);

/// Special memory in words, a line for each byte that has bits: `SM0.0 always 1, SM0.1 first scan`; nothing for other areas.
std::string special_text(const Cpu& cpu, const MemoryRange& range);

/// The symbol of the address that a range begins at; null without one.
const stl::Symbol* symbol_of(const Program& program, const MemoryRange& range);

/// The symbol of an address: `Speed`; empty without one.
std::string symbol_name(const Program& program, const MemoryRange& range);

/// The symbol of an address with its comment: `Speed  // of the pump`; empty without one.
std::string symbol_text(const Program& program, const MemoryRange& range);

/// A watched value, bytes as MemoryRange::bytes_in() gives them: `1`, `16#05 (5)`, `16#FFFB (-5)`, several as hex bytes. A
/// double word that the program uses as a real is shown as one too: `16#3FC00000 (1069547520, 1.5)`.
std::string value_text(const Program& program, const MemoryRange& range, std::span<const std::uint8_t> bytes);

}  // namespace s7200::tools
