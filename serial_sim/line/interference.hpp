// What can disturb stations and the characters they send: where faults reach the UARTs.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "serial_sim/line/character.hpp"

namespace s7200::serial {

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
