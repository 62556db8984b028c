// Characters to edges, and edges to characters.
#pragma once

#include <cstdint>
#include <optional>

#include "interpreter/base/event_queue.hpp"
#include "interpreter/base/serial_format.hpp"
#include "interpreter/cpu/serial_port.hpp"
#include "serial_sim/line.hpp"

namespace s7200::serial {

/// One UART on the line: a sender and a receiver. Wrong baud rates, wrong parity, noise, breaks and collisions need no code
/// of their own, they are levels.
///
/// Receiver: waits for a falling edge, looks half a bit later whether the start bit is still there (else it was a glitch),
/// then samples the middle of each bit and reports in the middle of the (first) stop bit. After a stop bit at space level it
/// waits for the next falling edge, as for any character.
class Uart final : public SerialPort {
 public:
  /// What handle() reports back to the owner.
  struct Report {
    std::optional<ReceivedCharacter> received;
    std::optional<Time> sent;  ///< end of the last stop bit (or of the break)
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    SerialFormat format{};
    bool receiver_enabled = true;
    bool receiving = false;      ///< a start edge was seen and its character is not complete
    Time start_edge = kNever;    ///< of the character being received, or awaited at a known future instant
    Time listen_from = 0;        ///< edges before this are past
    bool sending = false;
    Time send_end = 0;
    bool operator==(const State&) const = default;
  };

  /// `driver`: which of the line's drivers this UART is. Neither reference is owned.
  Uart(Line& line, EventQueue& queue, EventOwner owner, int driver);

  void configure(const SerialFormat& format) override;
  void enable_receiver(bool enabled, Time at) override;
  void send(std::uint8_t byte, Time at) override;
  void send_break(int bit_times, Time at) override;

  /// A character with its parity bit the wrong way round, for tests of the other end. Needs a format with parity.
  void send_with_wrong_parity(std::uint8_t byte, Time at);

  /// Some driver has put new edges on the line: a waiting receiver looks again.
  void line_changed();

  /// An event of this UART's owner is due.
  Report handle(const Event& event);

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  Line& line_;
  EventQueue& queue_;
  EventOwner owner_;
  int driver_;
  State state_;
};

}  // namespace s7200::serial
