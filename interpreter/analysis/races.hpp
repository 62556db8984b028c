// Races: memory that the main program and an interrupt routine share, and that the main program does not read or write in
// one instruction.
//
// An interrupt may come between any two instructions of the main program and its subroutines, unless DISI keeps it away. An
// interrupt routine runs to its end before another one starts (facts 3.2), so two of them do not disturb each other.
// Accumulators, the logic stack and SMB1 are saved around it, and local memory is its own.
//
// Looked at are V, M, S, Q, T and C memory: what the main program reads and writes back, also single bits, and bytes, words
// and double words that it reads and writes over, accesses in parts, or keeps something in for a while. The main program is
// followed in the order of its text, with its subroutines where they are called, their local memory and their parameters, as
// deep as the CPU nests calls; routines that call themselves too. What is not followed is said. What has power flow in the
// first scan only is left out.
//
// Bits that one side only sets and the other one only resets are a handshake and no race, and so are the buffers of XMT and
// RCV. DTCH keeps an interrupt away until ATCH, as DISI does until ENI.
//
// Of some findings only a run can tell whether anything is lost: `suspected`. So it is where a pointer may lead to several
// places (pointers.hpp), where a table or a string says how far it goes, where a comparison alone decides whether memory is
// written, where memory is written over with what does not depend on it, and of two words that are written together: a run
// tells whether a value comes of them that comes of neither order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/flow/calls.hpp"

namespace s7200 {

/// The steps into which a program is unfolded, with subroutines where they are called: 24 MB. More calls are not followed.
inline constexpr std::size_t kMostStepsOfRaces = 1'000'000;

struct Race {
  enum class Kind : std::uint8_t {
    LostUpdate,   ///< the main program reads, and writes later what depends on it: what the interrupt wrote between is lost
    Overwritten,  ///< the main program reads, uses that, and writes something else over it: what came between was never read
    Scratch,      ///< the main program writes, and reads it later for its own use; between them the interrupt writes it
    TornRead,     ///< the main program reads parts of what the interrupt writes as a whole
    TornWrite,    ///< the interrupt reads as a whole what the main program writes in parts
    MixedRead     ///< the main program works out a value from two words that the interrupt writes together
  };

  Kind kind = Kind::LostUpdate;
  Bits bits;                          ///< what is shared, as programs name it
  std::uint32_t first = 0, last = 0;  ///< ops of the main program; the interrupt does harm between them
  std::uint32_t interrupt = 0;        ///< the op of the interrupt routine, or of a subroutine of it
  std::uint32_t routine = 0;          ///< the interrupt routine, in ControlFlow::routines
  std::uint8_t event = 0;             ///< that starts it
  bool suspected = false;             ///< only a run can tell
  std::optional<Bits> with{};         ///< of MixedRead: the second word
};

/// A CALL that was not followed: what is shared there was not looked at.
struct NotFollowed {
  enum class Reason : std::uint8_t {
    DeeperThanTheCpuCalls,  ///< it is below as many calls as the CPU nests: run-time error 0008, and nothing is called
    TooManySteps            ///< the program is unfolded to so many instructions that no more calls are followed
  };

  Reason reason = Reason::DeeperThanTheCpuCalls;
  std::uint32_t call = 0;     ///< its op
  std::uint32_t routine = 0;  ///< what it calls, in ControlFlow::routines
  std::uint32_t from = 0;     ///< the main program or the interrupt routine from which it was reached, likewise

  bool operator==(const NotFollowed&) const = default;
};

struct Races {
  std::vector<Race> races;                ///< by the ops of the main program, each pair once for each interrupt routine
  std::vector<NotFollowed> not_followed;  ///< of the main program first, in the order in which they were met
};

/// Both empty without an ENI. If `waiter` asks to end, those that were found by then.
Races find_races(const Facts& facts, const Calls& calls, const Waiter& waiter = {});

}  // namespace s7200
