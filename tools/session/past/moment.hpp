// A place in a run.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

#include "interpreter/base/time.hpp"

namespace s7200::tools {

/// A place in a run. Instructions may take no time, and several actions may come between two of them: so it takes more than
/// the time to name one.
struct Moment {
  std::uint64_t instructions = 0;  ///< executed before, by all stations
  std::size_t actions = 0;         ///< done before
  bool settled = false;            ///< interrupts that were due have been taken: it is exactly in front of an instruction
  Time time = 0;                   ///< the earliest clock of all stations
  bool stopped = false;            ///< the only CPU is in STOP, to which it may go in no time

  /// `instructions` of one that a Journal has noted of a system: where nobody looks at instructions its CPUs run ahead of
  /// one another, so such a moment is known by its time and the actions before it.
  static constexpr std::uint64_t kNotCounted = ~std::uint64_t{0};
  bool is_counted() const { return instructions != kNotCounted; }

  /// The order in which a run comes by; two of one run are never unordered.
  auto operator<=>(const Moment&) const = default;
};

}  // namespace s7200::tools
