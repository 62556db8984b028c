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
    Frame    ///< characters on the port
  };
  Time wait = 0;  ///< since the one before was over
  What what{};
  std::uint32_t place = 0;
  std::vector<std::uint8_t> bytes{};
  Time gap = 0;  ///< between the characters of a frame

  bool operator==(const Stimulus&) const = default;
};

/// In their order. A frame is over when its answer has come and the line was silent for 3.5 characters, or when no answer
/// has begun within kPatience of its end.
using Trial = std::vector<Stimulus>;

inline constexpr Time kPatience = 60 * kMillisecond;

}  // namespace s7200::tools
