// Memory that both the main program and interrupt routines use, or two interrupt routines: what one looks through before
// either side is changed, whether there is a race (races.hpp) or not.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/flow/calls.hpp"

namespace s7200 {

/// The other areas are the CPU's and the field's too, and each side has its own accumulators and local memory.
inline constexpr Areas kSharedAreas =
    set_of(Area::V) | set_of(Area::M) | set_of(Area::S) | set_of(Area::Q) | set_of(Area::T) | set_of(Area::C);

struct SharedMemory {
  /// The uses by the main program, or by one interrupt routine, with all that it calls.
  struct Side {
    std::uint32_t routine = 0;              ///< 0, or the interrupt routine: in ControlFlow::routines
    std::vector<std::uint32_t> reads, writes;  ///< by op; one that changes memory is in both
  };

  std::size_t entry = 0;    ///< in CrossReference::entries
  std::vector<Side> sides;  ///< two or more, the main program first; at least one writes
};

/// Of kSharedAreas, by address; what pointers may reach is left out.
std::vector<SharedMemory> shared_memory(const Facts& facts, const Calls& calls, const CrossReference& reference);

}  // namespace s7200
