// Chance that is the same on every computer: SplitMix64 (Steele, Lea, Flood 2014), with a state of eight bytes.
#pragma once

#include <cstdint>

namespace s7200 {

inline constexpr std::uint64_t kSplitMixStep = 0x9E37'79B9'7F4A'7C15;

/// The random number that follows from a state; all 64 bits are evenly distributed.
constexpr std::uint64_t split_mix(std::uint64_t state) {
  state = (state ^ state >> 30) * 0xBF58'476D'1CE4'E5B9;
  state = (state ^ state >> 27) * 0x94D0'49BB'1331'11EB;
  return state ^ state >> 31;
}

/// Advances the state and returns the next random number.
constexpr std::uint64_t draw_split_mix(std::uint64_t& state) { return split_mix(state += kSplitMixStep); }

}  // namespace s7200
