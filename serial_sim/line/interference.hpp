// What can disturb stations and the characters they send: where faults reach the UARTs.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/base/serial_format.hpp"

namespace s7200::serial {

/// Bit times of a station whose clock is off: `clock_error` millionths faster than its format says.
struct BitClock {
  SerialFormat format{};
  std::int32_t clock_error = 0;

  bool operator==(const BitClock&) const = default;

  /// As SerialFormat::half_bits: rounded to the nanosecond, never accumulated.
  Time half_bits(std::int64_t count) const {
    if (clock_error == 0) return format.half_bits(count);
    __extension__ using Wide = __int128;
    const Wide per_half_bit = Wide{2} * format.baud * (1'000'000 + clock_error);
    return static_cast<Time>((Wide{count} * kSecond * 1'000'000 + per_half_bit / 2) / per_half_bit);
  }
  Time bit_times(std::int64_t count) const { return half_bits(2 * count); }
  Time character_time() const { return bit_times(format.bits()); }
};

/// What becomes of a character that is to be sent.
struct Mishap {
  Time delay = 0;                           ///< it begins so much later
  std::vector<std::uint8_t> before, after;  ///< the sender sends these too
  bool lost = false;                        ///< its time passes, the line stays at mark
};

/// A UART asks its line's Interference, when there is one.
class Interference {
 public:
  /// An exchange begins: the station on `driver` is about to send a request.
  virtual void exchange_begins(int driver, Time at) = 0;

  /// The station on `driver` begins a character at `at`.
  virtual Mishap character_begins(int driver, const SerialFormat& format, Time at) = 0;

  /// Millionths by which the clock of the station on `driver` is too fast; negative when it is slow.
  virtual std::int32_t clock_error(int driver) const = 0;

  /// The station on `driver` hears what it sends, whether it wants to or not.
  virtual bool echoes(int driver) const = 0;

 protected:
  ~Interference() = default;
};

}  // namespace s7200::serial
