// A UART turns characters into edges, and edges into characters.
#pragma once

#include <cstdint>
#include <optional>

#include "interpreter/base/event_queue.hpp"
#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/serial_port.hpp"
#include "serial_sim/line/character.hpp"
#include "serial_sim/line/interference.hpp"
#include "serial_sim/line/line.hpp"

namespace s7200::serial {

/// One UART on the line: a sender and a receiver. Wrong baud rates, wrong parity, noise, breaks and collisions need no code
/// of their own, they are levels.
///
/// Receiver: waits for a falling edge, looks half a bit later whether the start bit is still there (else it was a glitch),
/// then samples the middle of each bit and reports in the middle of the (first) stop bit. After a stop bit at space level it
/// waits for the next falling edge, as for any character. It hears its own sender too, unless it is switched off.
/// Not documented, modelled so: space in every sample, from the start bit to the stop bit, is a break; whether the line
/// stays at space after the middle of the stop bit does not matter. [Uart.SpaceInEverySampleIsABreak]
///
/// A character is three events at most: start bit verified, stop bit sampled, character sent. The first is left out when it
/// is certain what it finds: the start bit is that of a character alone on the line.
class Uart final : public SerialPort, private LineListener {
 public:
  /// What handle() has found, for the owner.
  struct Report {
    std::optional<ReceivedCharacter> received;
    std::optional<Time> sent;  ///< end of the last stop bit (or of the break)
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    SerialFormat format{};         ///< of the next character in either direction
    BitClock receiving_as{};       ///< of the character being received, or certain to be
    std::int32_t clock_error = 0;  ///< of the receiver while it awaits a character, in millionths
    bool receiving = false;        ///< a start bit was verified and its character is not complete
    bool certain = false;          ///< the start bit awaited needs no event to verify it
    Time start_edge = kNever;      ///< of the character being received, or awaited at a known future instant
    Time listen_from = 0;          ///< edges before this are past
    Time off_from = kNever;        ///< the receiver is switched off from then on
    bool sending = false;
    Time send_end = 0;  ///< end of the last stop bit (or break) sent so far
    bool operator==(const State&) const = default;

    bool receiver_enabled() const { return off_from == kNever; }
  };

  /// `driver` is the number of this UART's driver on the line. Neither reference is owned; both outlive the UART. It listens
  /// to the line from now on, or from plug_in() on: each listener costs time at every edge.
  Uart(Line& line, EventQueue& queue, EventOwner owner, int driver, bool plugged_in = true);
  ~Uart() override;
  Uart(const Uart&) = delete;
  Uart& operator=(const Uart&) = delete;

  void plug_in();

  /// A bystander hears of others' characters that are lost because the receiver is off. It only looks on, and each look
  /// costs time; so it is asked first.
  class Bystander {
   public:
    virtual bool looks() const = 0;
    /// A character was lost; its end is the instant of the loss: its start edge, or when the receiver was switched off.
    virtual void missed(const ReceivedCharacter& character) = 0;

   protected:
    ~Bystander() = default;
  };
  /// The bystander is wiring, not state, and is not owned; null: there is none.
  void set_bystander(Bystander* bystander) { bystander_ = bystander; }

  /// A character whose start bit has been verified before `at` is still received in the old format.
  void configure(const SerialFormat& format, Time at) override;
  void enable_receiver(bool enabled, Time at) override;
  void send(std::uint8_t byte, Time at) override;
  void send_break(int bit_times, Time at) override;

  /// Holds the line at space from `at` on, until end_break() says when that ends.
  void begin_break(Time at);
  /// The line is at mark from `at` on; `sent` is reported like the end of a character.
  void end_break(Time at, Time sent);

  /// A character with its parity bit the wrong way round, for tests of the other end. Needs a format with parity.
  void send_with_wrong_parity(std::uint8_t byte, Time at);

  /// A character with its (first) stop bit at space, which takes a bit longer, so that the next start bit has an edge.
  void send_without_stop_bit(std::uint8_t byte, Time at);

  /// The instant when the character being received will be complete; kNever when none has begun.
  Time character_due() const;

  /// The earliest instant of the next report, unless something is done to the UART: the end of the character that it sends
  /// or receives.
  Time next_report() const;

  /// A request begins with the next character: faults count exchanges.
  void begin_exchange(Time at);

  /// The station cannot help hearing itself: its receiver should stay on while it sends.
  bool hears_itself() const { return line_.interference() != nullptr && line_.interference()->echoes(driver_); }

  int driver() const { return driver_; }
  const Line& line() const { return line_; }

  /// Whether another station, or a disturbance, holds the line at space.
  bool others_space(Time at) const { return !line_.level_without(driver_, at); }

  /// The station loses power: the UART falls silent in the middle of a character, and hears nothing.
  void power_off(Time at);

  /// Handles an event that is due for this UART's owner.
  Report handle(const Event& event);

  const State& state() const { return state_; }

  /// Line and queue are restored by their owner.
  void restore(const State& state) {
    state_ = state;
    missed_until_ = 0;
  }

 private:
  enum What : std::uint8_t { kStartCheck, kStopSample, kSent };

  void line_changed(Time at) override;
  Time needs_from() const override { return state_.start_edge; }

  void listen_again(Time now);
  void await_start_edge();
  void check_start_bit(Time now);
  void expect_stop_bit(const BitTimes& times);
  ReceivedCharacter take_character(Time now);
  ReceivedCharacter character_of_others(Time start, const BitClock& clock) const;
  void look_for_missed(Time at);
  void tell_missed(ReceivedCharacter character, Time lost_at);
  void expect(What what, Time at);
  Time start_check() const;
  Time last_sample() const;
  BitClock clock_of_character() const;
  void expect_nothing();
  void abandon_character();
  void listen_no_more();

  void put_character(unsigned levels, Time at);
  void put_character_with_mishaps(unsigned levels, Time at);
  Time drive_character(unsigned levels, const BitClock& clock, Time at);
  std::int32_t clock_error() const;
  void sends_until(Time end);
  static const BitTimes& times_of(const BitClock& clock, BitTimes& known);

  Line& line_;
  EventQueue& queue_;
  EventOwner owner_;
  int driver_;
  bool plugged_in_ = false;
  Bystander* bystander_ = nullptr;
  Time missed_until_ = 0;  ///< of what the bystander has been told
  State state_;
  BitTimes sending_times_{};
  mutable BitTimes receiving_times_{};
};

}  // namespace s7200::serial
