// Races: memory that the main program and an interrupt routine share, and that the main program does not read or write in
// one instruction.
//
// An interrupt may come between any two instructions of the main program and its subroutines, unless DISI keeps it away. An
// interrupt routine runs to its end before another one starts (facts 3.2), so two of them do not disturb each other.
// Accumulators, the logic stack and SMB1 are saved around it, and local memory is its own.
//
// Looked at are V, M, S, Q, T and C memory: what the main program reads and writes back, also single bits, and bytes, words
// and double words that it reads and writes over, accesses in parts, or keeps something in for a while. The main program is
// followed in the order of its text, with its subroutines where they are called, their local memory and their parameters.
//
// Bits that one side only sets and the other one only resets are a handshake and no race, and so are the buffers of XMT and
// RCV. DTCH keeps an interrupt away until ATCH, as DISI does until ENI.
//
// Of some findings only a run can tell whether anything is lost: `suspected`. So it is where a pointer may lead to several
// places (pointers.hpp), where a table or a string says how far it goes, where a comparison alone decides whether memory is
// written, and where memory is written over with what does not depend on it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/flow/calls.hpp"

namespace s7200 {

struct Race {
  enum class Kind : std::uint8_t {
    LostUpdate,   ///< the main program reads, and writes later what depends on it: what the interrupt wrote between is lost
    Overwritten,  ///< the main program reads, uses that, and writes something else over it: what came between was never read
    Scratch,      ///< the main program writes, and reads it later for its own use; between them the interrupt writes it
    TornRead,     ///< the main program reads parts of what the interrupt writes as a whole
    TornWrite     ///< the interrupt reads as a whole what the main program writes in parts
  };

  Kind kind = Kind::LostUpdate;
  Bits bits;                          ///< what is shared, as programs name it
  std::uint32_t first = 0, last = 0;  ///< ops of the main program; the interrupt does harm between them
  std::uint32_t interrupt = 0;        ///< the op of the interrupt routine, or of a subroutine of it
  std::uint32_t routine = 0;          ///< the interrupt routine, in ControlFlow::routines
  std::uint8_t event = 0;             ///< that starts it
  bool suspected = false;             ///< only a run can tell
};

/// By the ops of the main program, each pair of them once for each interrupt routine. Empty without an ENI. If `waiter` asks
/// to end, those that were found by then.
std::vector<Race> find_races(const Facts& facts, const Calls& calls, const Waiter& waiter = {});

}  // namespace s7200
