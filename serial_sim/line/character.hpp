// A character on the wire: when its bits are, and their levels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interpreter/base/serial_format.hpp"

namespace s7200::serial {

/// Bit times of a station whose clock is off: `clock_error` millionths faster than its format says.
struct BitClock {
  SerialFormat format{};
  std::int32_t clock_error = 0;

  bool operator==(const BitClock&) const = default;

  /// The length of a number of half bits, as in SerialFormat::half_bits: rounded to the nanosecond, never accumulated.
  Time half_bits(std::int64_t count) const {
    if (clock_error == 0) return format.half_bits(count);
    __extension__ using Wide = __int128;
    const Wide per_half_bit = Wide{2} * format.baud * (1'000'000 + clock_error);
    return static_cast<Time>((Wide{count} * kSecond * 1'000'000 + per_half_bit / 2) / per_half_bit);
  }
  Time bit_times(std::int64_t count) const { return half_bits(2 * count); }
  Time character_time() const { return bit_times(format.bits()); }
};

/// Number of the (first) stop bit; the start bit is bit 0.
constexpr int first_stop_bit(const SerialFormat& format) { return format.bits() - format.stop_bits; }

/// The levels of a character from its start bit, in bit 0, to its first stop bit: 1 is mark. `data` fits the format.
unsigned character_levels(const SerialFormat& format, std::uint8_t data, bool parity_bit);

/// The instants of a character's bits, counted from its start edge and computed once for a clock.
struct BitTimes {
  BitTimes() : BitTimes(BitClock{}) {}
  explicit BitTimes(const BitClock& of);
  bool operator==(const BitTimes& other) const { return clock == other.clock; }

  Time begin_of_bit(int bit) const { return half_bits[static_cast<std::size_t>(2 * bit)]; }
  Time middle_of_bit(int bit) const { return half_bits[static_cast<std::size_t>(2 * bit + 1)]; }

  BitClock clock;
  int bits = 0, stop_bit = 0;  ///< of the clock's format: how many, and the number of the first stop bit
  std::array<Time, 2 * (SerialFormat::kMostBits + 1) + 1> half_bits{};  ///< the time of each number of half bits
};

}  // namespace s7200::serial
