// Local memory: 64 bytes of each routine that runs, in the image at image::kL (facts 1.2; S7-200 manual A5E00307987, 31).
//
// Not documented, modelled so: a level of calls finds in its local memory what the last routine of that level left there; at
// power-up it is 0. [LocalMemory.ARoutineFindsWhatTheLastOneOfItsLevelLeft]
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "interpreter/cpu/core.hpp"

namespace s7200::local_memory {

/// Whose memory it is that the image has: number in State::local. The main program and its subroutines, by the depth of
/// their calls, then an interrupt routine and the one that it calls.
std::size_t level(const State& s);

/// The routine that runs will not go on for now: it calls another, or ends.
void put_aside(Core& core);

/// Takes up the memory of the present level: the same memory again, or that of another routine, after the level has changed.
void take_up(Core& core);

/// A routine that has begun and has not ended.
struct OpenRoutine {
  std::uint32_t first = 0;            ///< its SBR or INT; of the main program its first op
  std::optional<std::uint32_t> call;  ///< the CALL that it was entered by
  std::span<const std::uint8_t, std::tuple_size_v<LocalMemory>> memory;
  bool runs = false;  ///< the innermost: its memory is in the image
};

/// The main program and all that has been entered since, the innermost last. They are views of `s`.
std::vector<OpenRoutine> open_routines(const Program& program, const State& s);

}  // namespace s7200::local_memory
