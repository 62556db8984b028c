// Forced values, which a programming device sets and which hold until it takes them back (S7-200 system manual,
// "Forcing Specific Values").
//
// Any input and output points may be forced, and up to sixteen values of V and M memory (bytes, words, double words) and of
// AI and AQ (words). The CPU applies them
// - to the inputs where they are read: at the start of the scan and by immediate contacts and BIR,
// - to the outputs where they are written: at the end of the scan, by immediate coils and BIW, and in STOP,
// - to memory after the program, when the communication is processed, and to what a programming device writes;
//   the program may change it in between.
// They are kept in the EEPROM: power off does not end them. A running pulse output keeps its point.
//
// Not documented, modelled so:
// - Interrupts and high-speed counters see the terminal, not the forced input. [Forcing.EdgesAndCountersSeeTheTerminal]
// - The image register of a forced output gets the forced value at the end of the scan, with the point.
//   [Forcing.AnOutputAndItsImageAreForcedAtTheEndOfTheScan]
// - A forced analog input has its value at once, an analog output whenever it is written.
//   [Forcing.AnalogValuesAreForcedAtOnce]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interpreter/cpu/core.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::forcing {

/// Whether a CPU can force this: points, and values of memory as above.
bool possible(const MemoryRange& place);

/// Forces a value. Returns false if there is no room for another value of memory. A value that overlaps another takes its
/// place.
bool add(Forcing& forcing, const MemoryRange& place, std::uint32_t value);

/// Points bit by bit, then values of memory.
std::vector<Assignment> listed(const Forcing& forcing);

/// add(), and what follows from it at once.
bool force(Core& core, const MemoryRange& place, std::uint32_t value);

/// Takes back what overlaps the place; whether there was anything.
bool unforce(Core& core, const MemoryRange& place);

/// An input byte as the CPU reads it, of what its terminals have.
inline std::uint8_t input(const State& s, std::uint32_t byte) { return s.forcing.inputs.over(byte, s.terminals[byte]); }

/// An output byte as it is written.
inline std::uint8_t output(const State& s, std::uint32_t byte, std::uint8_t value) {
  return s.forcing.outputs.over(byte, value);
}

/// Puts what is forced over bytes that were taken from the image at `at`.
void put_over(const State& s, std::uint32_t at, std::span<std::uint8_t> bytes);

/// A place as those outside see it, at terminals or as a master: what is forced is as it is forced, though the program may
/// have put something else there in this scan. What people look at and check is this; what instructions find is the image.
std::vector<std::uint8_t> seen_outside(const State& s, const MemoryRange& place);

/// Writes the forced values of memory.
void apply(Core& core);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);
void end_scan(Core& core);

}  // namespace s7200::forcing
