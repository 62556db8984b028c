// A station on the line that answers: an automaton on a UART.
#pragma once

#include <memory>

#include "interpreter/base/event_queue.hpp"
#include "serial_sim/line/uart.hpp"
#include "serial_sim/peers/automaton.hpp"

namespace s7200::serial {

/// Lets an automaton answer on a line. The owner passes reports of the UART to on(), and events of this responder's number
/// to handle().
///
/// A station with a half duplex line has its receiver off while it sends. A station with a full duplex line hears on: on the
/// shared line, characters that come back as they were sent are its own, and others are another station's.
class Responder {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    AutomatonValue automaton;
    Transmission transmission{};
    std::size_t sent = 0;          ///< characters of it
    std::uint8_t on_the_line = 0;  ///< the character being sent, or sent last
    bool operator==(const State&) const = default;
  };

  /// `owner` is the responder's number in the queue, for its own timers. Neither reference is owned.
  Responder(Uart& uart, EventQueue& queue, EventOwner owner, std::unique_ptr<Automaton> automaton);

  Automaton& automaton() { return *state_.automaton; }
  const Automaton& automaton() const { return *state_.automaton; }

  /// The sync signal of the line has changed.
  void sync(bool high, Time at);

  /// The station loses power, or has power again.
  void power_off(Time at);
  void power_on(Time at);

  void on(const Uart::Report& report);
  void handle(const Event& event);

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  enum What : std::uint8_t { kSend, kWake };

  bool sending() const { return state_.sent < state_.transmission.bytes.size() || uart_.state().sending; }
  bool is_own(const ReceivedCharacter& character) const;
  void send_next(Time at);
  void look();

  Uart& uart_;
  EventQueue& queue_;
  EventOwner owner_;
  State state_;
};

}  // namespace s7200::serial
