// The values that reach an op: what the pointers of a program, and what they are made of, may hold in front of it.
//
// A program is followed op by op, in numbers that it moves, adds, shifts and compares; where ways meet, what either brings
// is possible. With power flow and without it are two ways: after `LDW> VW0, 9` and `MOVW 0, VW0`, VW0 is at most 9. In a
// FOR loop with a known number of passes, what a pass adds is known; other loops go on to what the program compares with, or
// to the end of the area.
//
// Assumed is what pointers.hpp assumes: that only the program sets the pointers that it sets, and what it counts (INCW, +I).
// These and the accumulators keep their values from one scan to the next. Of other memory nothing is known at the start of a
// scan: a master may have written it. Also nothing is known of what an interrupt routine writes (in front of an op of the
// main program), of the buffers of RCV, NETR and NETW, and of memory that the CPU or the field changes. A scan ends at its
// end, at END or at STOP: one that a run-time error, the watchdog or a power failure ends in its middle is left out.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/value_set.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/waiter.hpp"

namespace s7200 {

struct MemoryAccess;

class Pointers;

/// Where operands that a pointer leads to may begin: bytes of the image, from `from` until before `to`.
struct PointerTarget {
  std::uint32_t from = 0, to = 0;

  bool operator==(const PointerTarget&) const = default;
};

/// What pointers with these values lead to. Those that point nowhere are left out.
std::vector<PointerTarget> places_of(const Program& program, const ValueSet& addresses);

class ReachingValues {
 public:
  /// `effects`: effects_of() each op. `pointers`: what is known of them at any time. The program has no errors. If `waiter`
  /// asks to end, nothing is known.
  ReachingValues(const Program& program, const ControlFlow& flow, const std::vector<std::vector<MemoryAccess>>& effects,
                 const Pointers& pointers, const Waiter& waiter);

  /// What the pointer at `at`, through which op number `op` goes, may hold. Nothing if no way leads to the op.
  std::optional<ValueSet> pointer(std::uint32_t op, std::uint32_t at) const;

  /// How often the FOR `op` runs at most; nothing if that is not known.
  std::optional<std::int64_t> passes(std::uint32_t op) const;

 private:
  friend class ValueFollower;
  std::map<std::pair<std::uint32_t, std::uint32_t>, ValueSet> pointers_{};  // by op and place
  std::map<std::uint32_t, std::int64_t> passes_{};                          // by FOR
};

/// Whether the passes of the FOR `op`, and what they call, write neither its index nor its final value, and nothing else
/// leads into the loop. A pointer that may lead anywhere in an area is taken not to lead there.
bool counts_its_passes(const ControlFlow& flow, const Program& program,
                       const std::vector<std::vector<MemoryAccess>>& effects, std::uint32_t op);

}  // namespace s7200
