// The format of a character on the wire.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "interpreter/base/time.hpp"

namespace s7200 {

enum class Parity : std::uint8_t { None, Even, Odd };

/// The words for a parity, as in options and scenarios: `none`, `even`, `odd`.
inline constexpr std::array<std::string_view, 3> kParityWords{"none", "even", "odd"};
inline constexpr std::string_view word_of(Parity parity) { return kParityWords[static_cast<std::size_t>(parity)]; }

struct SerialFormat {
  std::uint32_t baud = 9600;   ///< bits a second
  std::uint8_t data_bits = 8;  ///< 7 or 8, sent LSB first
  Parity parity = Parity::Even;
  std::uint16_t stop_bits = 1;  ///< 1 or 2; the S7-200 always sends one (S7-200 manual, SMB30)

  /// Compares all members in one go, because several formats are compared for each character: there are no gaps between
  /// members.
  constexpr bool operator==(const SerialFormat& other) const {
    return std::bit_cast<std::uint64_t>(*this) == std::bit_cast<std::uint64_t>(other);
  }

  static constexpr int kMostBits = 12;  ///< 8E2

  /// Start bit, data bits, parity bit, stop bits: 11 for 8E1, 10 for 8N1.
  constexpr int bits() const { return 1 + data_bits + (parity == Parity::None ? 0 : 1) + stop_bits; }

  /// The time of `count` half bits from the start edge; rounded to the nanosecond once, so errors never add up.
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

/// A format in words: `9600 baud, 8 data bits, even parity, 1 stop bit`
std::string format_text(const SerialFormat& format);

/// The format of a character as text: `8E1`
std::string character_text(const SerialFormat& format);

}  // namespace s7200
