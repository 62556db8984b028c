// How a character looks on the wire.
#pragma once

#include <cstdint>

#include "interpreter/base/time.hpp"

namespace s7200 {

enum class Parity : std::uint8_t { None, Even, Odd };

struct SerialFormat {
  std::uint32_t baud = 9600;   ///< bits a second
  std::uint8_t data_bits = 8;  ///< 7 or 8, sent LSB first
  Parity parity = Parity::Even;
  std::uint8_t stop_bits = 1;  ///< 1 or 2; the S7-200 always sends one (S7-200 manual, SMB30)

  bool operator==(const SerialFormat&) const = default;

  /// Start bit, data bits, parity bit, stop bits: 11 for 8E1, 10 for 8N1.
  constexpr int bits() const { return 1 + data_bits + (parity == Parity::None ? 0 : 1) + stop_bits; }

  /// Where edge `half_bits / 2` lies behind the start edge, rounded to the nanosecond and never accumulated.
  constexpr Time half_bits(std::int64_t count) const { return (count * kSecond + baud) / (2 * std::int64_t{baud}); }
  constexpr Time bit_times(std::int64_t count) const { return half_bits(2 * count); }

  constexpr Time character_time() const { return bit_times(bits()); }

  /// The Modbus RTU silence of 3.5 characters.
  constexpr Time silence() const { return half_bits(7 * std::int64_t{bits()}); }

  /// The parity bit that belongs to `byte`.
  constexpr bool parity_bit(std::uint8_t byte) const {
    const bool odd_ones = __builtin_parity(byte) != 0;
    return parity == Parity::Odd ? !odd_ones : odd_ones;
  }
};

}  // namespace s7200
