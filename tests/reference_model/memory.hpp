// Memory of the reference CPU: each area is a byte vector of its own, with its real size (facts 1.1, 1.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/reference_model/cpu_kind.hpp"

namespace s7200::reference {

using Bytes = std::vector<std::uint8_t>;

struct Memory {
  explicit Memory(const CpuKind& kind)
      : I(kind.points),
        Q(kind.points),
        SM(kind.SM),
        S(kind.S),
        V(kind.V),
        L(kind.L),
        AI(kind.analog),
        AQ(kind.analog),
        T(2 * kind.timers),
        C(2 * kind.timers),
        timer_bits(kind.timers / 8),
        counter_bits(kind.timers / 8),
        HC(kind.HC),
        input_points(kind.points),
        output_points(kind.points) {}

  Bytes I, Q, M = Bytes(32), SM, S, V;
  Bytes L;  ///< of the routine that runs
  Bytes AI, AQ;
  Bytes T, C;  ///< current values, two bytes each
  Bytes timer_bits, counter_bits;
  Bytes HC, AC = Bytes(16);  ///< four bytes each; the low byte of AC0 is the fourth
  Bytes input_points, output_points;
};

/// Where a value is.
struct Place {
  Bytes* bytes = nullptr;
  std::size_t at = 0;
};

/// Where a bit is: `number` counts the bits of the area from bit 0 of its first byte.
struct BitPlace {
  Bytes* bytes = nullptr;
  std::size_t number = 0;
};

inline bool holds(const Place& first, std::size_t count) { return first.at + count <= first.bytes->size(); }

inline std::uint32_t read(const Place& place, std::size_t width) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value = value << 8 | place.bytes->at(place.at + i);
  return value;
}

inline void write(const Place& place, std::size_t width, std::uint32_t value) {
  for (std::size_t i = 0; i < width; ++i)
    place.bytes->at(place.at + i) = static_cast<std::uint8_t>(value >> (8 * (width - 1 - i)));
}

inline bool read(const BitPlace& bit) { return (bit.bytes->at(bit.number / 8) >> (bit.number % 8)) & 1; }

inline void write(const BitPlace& bit, bool value) {
  std::uint8_t& byte = bit.bytes->at(bit.number / 8);
  const int mask = 1 << (bit.number % 8);
  byte = static_cast<std::uint8_t>(value ? byte | mask : byte & ~mask);
}

}  // namespace s7200::reference
