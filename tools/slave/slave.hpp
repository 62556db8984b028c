// A slave to talk to, wherever it is: a program in simulation, a serial device or pty, a TCP server.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "serial_sim/peers/requester.hpp"

namespace s7200::tools {

/// The way to the slave is broken: no such device, connection refused, peer gone. what() says what, where, and what to do.
struct SlaveUnreachable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A slave was there, and went within an exchange. The next exchange tries to reach it again.
struct SlaveLost : SlaveUnreachable {
  using SlaveUnreachable::SlaveUnreachable;
};

/// Bytes in hex, the first sixteen at most.
std::string beginning_in_hex(Bytes bytes);

/// The remark on an exchange before which `bytes` had come unasked; empty if there were none.
std::string ignored_text(const Bytes& bytes);

/// Whether characters are a complete answer in the protocol that is spoken.
using IsComplete = bool (*)(std::span<const std::uint8_t> response);

class Slave {
 public:
  virtual ~Slave() = default;

  /// Runs one exchange from now to its end: the answer is complete, or did not begin within the time-out. Times in the
  /// result are of now(). Throws SlaveUnreachable; std::invalid_argument when such a request cannot go this way.
  virtual serial::Exchange exchange(const serial::Request& request) = 0;

  /// The transmission that came unasked since the last request began and was not received yet, or the next one to come. In
  /// the result the request is empty, and its times are when this was called. Throws as exchange() does.
  virtual serial::Exchange receive(const serial::Listening& listening) = 0;

  /// Drops the unasked bytes that have come so far.
  virtual void forget_unasked() {}

  /// Waits without sending anything.
  virtual void wait(Time duration) = 0;

  /// Nanoseconds since the connection was made: simulated for a program, of the host's clock for all others.
  virtual Time now() const = 0;

  /// The pause that a master leaves between an answer and its next request by default.
  virtual Time pause() const = 0;

  /// What the last exchange met besides its answer, for people: `ignored an answer to transaction 7`. Mostly empty.
  virtual std::string remark() const { return {}; }

  /// Whether whoever has made it wants it to end. What is under way ends early then.
  virtual bool stop_requested() const { return false; }

  /// The name of the slave for headings and messages: `modbus_slave.stl`, `/dev/ttyUSB0 9600 8E1`, `127.0.0.1:502`.
  virtual std::string name() const = 0;
};

/// A slave in simulation: its times are exact, and 0 is its power-up.
class SlaveInSimulation : public Slave {
 public:
  /// The format in which the master talks on the slave's line now.
  virtual SerialFormat format() const = 0;
};

}  // namespace s7200::tools
