// The bytes of a word, and words low byte first, as some protocols have them. `bytes.hpp` has the S7-200's own order.
#pragma once

#include <cstdint>

namespace s7200 {

constexpr std::uint8_t low_byte(std::uint64_t word) { return static_cast<std::uint8_t>(word & 0xFF); }

/// Bits 8 to 15.
constexpr std::uint8_t high_byte(std::uint64_t word) { return static_cast<std::uint8_t>(word >> 8 & 0xFF); }

inline std::uint16_t load16_low_first(const std::uint8_t* from) {
  return static_cast<std::uint16_t>(from[0] | from[1] << 8);
}

}  // namespace s7200
