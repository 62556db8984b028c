// The interface of the device on the CPU's port. serial_sim implements it; the CPU knows nothing about wires.
#pragma once

#include <cstdint>

#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/time.hpp"

namespace s7200 {

/// A character as the receiver saw it.
struct ReceivedCharacter {
  std::uint8_t byte = 0;
  bool parity_error = false;
  bool framing_error = false;  ///< the stop bit was found at space level
  Time start = 0;              ///< falling edge of the start bit
  Time end = 0;                ///< middle of the stop bit, when the receiver reports it
  bool line_break = false;     ///< the line was at space all the time, to the stop bit: it reads 00 with a framing error

  bool operator==(const ReceivedCharacter&) const = default;
};

class SerialPort {
 public:
  virtual ~SerialPort() = default;

  /// Takes effect with the next character in either direction that begins after `at`.
  virtual void configure(const SerialFormat& format, Time at) = 0;

  /// Half duplex: the receiver is off while the port sends. A character being received is lost.
  virtual void enable_receiver(bool enabled, Time at) = 0;

  /// Sends a byte, whose start bit begins at `at`. The port reports when the last stop bit has ended.
  virtual void send(std::uint8_t byte, Time at) = 0;

  /// Holds the line at space for `bit_times` bits, then reports as for a character.
  virtual void send_break(int bit_times, Time at) = 0;
};

}  // namespace s7200
