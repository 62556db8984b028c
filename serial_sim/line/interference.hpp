// The interface through which faults disturb stations and the characters that they send.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "serial_sim/line/character.hpp"

namespace s7200::serial {

/// The change that a fault makes to a character that is to be sent.
struct Mishap {
  Time delay = 0;                           ///< it begins so much later
  std::vector<std::uint8_t> before, after;  ///< the sender sends these too
  Time pause = 0;                           ///< of the line, in front of the characters after it
  bool lost = false;                        ///< its time passes, the line stays at mark
  std::optional<std::uint8_t> instead{};    ///< what is sent in its place
};

/// A UART asks its line's Interference, when there is one.
class Interference {
 public:
  /// An exchange begins: the station on `driver` is about to send a request.
  virtual void exchange_begins(int driver, Time at) = 0;

  /// The station on `driver` begins the character `byte` at `at`.
  virtual Mishap character_begins(int driver, const SerialFormat& format, std::uint8_t byte, Time at) = 0;

  /// Millionths by which the clock of the station on `driver` is too fast; negative when it is slow.
  virtual std::int32_t clock_error(int driver) const = 0;

  /// The station on `driver` hears what it sends, whether it wants to or not.
  virtual bool echoes(int driver) const = 0;

 protected:
  ~Interference() = default;
};

/// A station that knows how long the frame is that it sends.
class FrameSender {
 public:
  /// Characters of the frame after the one that it has given last; nothing if that is not known.
  virtual std::optional<std::size_t> characters_left() const = 0;

 protected:
  ~FrameSender() = default;
};

}  // namespace s7200::serial
