// What is done to a PLC from outside, as plain data.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/time.hpp"

namespace s7200::tools {

struct Stimulus {
  enum class What : std::uint8_t {
    Input,   ///< a byte of input points; `place` is its number
    Memory,  ///< bytes of the image from `place` on: memory as a panel sets it, or an analog input
    Frame,   ///< characters on the port
    Break,   ///< the line at the port is at space for kBreak
    Power    ///< power fails for a moment; retentive memory is kept
  };
  Time wait = 0;  ///< since the one before was over
  What what{};
  std::uint32_t place = 0;
  std::vector<std::uint8_t> bytes{};
  Time gap = 0;               ///< between the characters of a frame
  std::uint16_t damaged = 0;  ///< number of the character of a frame whose parity bit is wrong, from 1; 0: none
  bool bad_stop = false;      ///< it is its stop bit that is wrong; what follows such a character comes after a gap
  bool other_port = false;    ///< a frame or break comes at the other port than frames usually do

  bool operator==(const Stimulus&) const = default;
};

/// Stimuli in their order. A frame is over when its answer has come and the line was silent for 3.5 characters, or when no
/// answer has begun within kPatience of its end.
using Trial = std::vector<Stimulus>;

inline constexpr Time kPatience = 60 * kMillisecond;

/// Longer than a character at 300 baud.
inline constexpr Time kBreak = 40 * kMillisecond;

/// After power-up, until a program is taken to be ready: then a power failure is over.
inline constexpr Time kReady = kSecond;

}  // namespace s7200::tools
