// What HDEF, HSC, PLS and ATCH access besides their operands: the special memory, inputs and outputs of the high-speed
// counter or the pulse output that they name, and the input whose edge is an event (facts 3.1, 10.4).
//
// The inputs are the points themselves: counters and events look at them at any time, whatever the image register says.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interpreter/analysis/effects/effects.hpp"

namespace s7200 {

/// `image`: the memory that the op finds; empty: any. Of any other op nothing.
std::vector<MemoryAccess> accesses_of_fast_units(const Program& program, const Op& op, std::span<const std::uint8_t> image);

/// The place of SMW168 or SMW178, which says where in V the profile of a PLS begins; nothing of another op, and on a CPU
/// without profiles.
std::optional<std::uint32_t> profile_pointer_of(const Program& program, const Op& op);

struct Facts;

/// Replaces the V memory in which a PLS may find its profile by that in which it finds it, as far as the program writes only
/// constants to the control byte, to SMW168 or SMW178, and to the first byte of the profile, which counts its segments. What
/// is left in doubt stays an access through a pointer, which is that word.
void shorten_profiles(Facts& facts);

/// Why it is in doubt; nothing if it is not.
std::optional<Pointers::Unknown> unknown_profile(const Facts& facts, std::uint32_t op);

}  // namespace s7200
