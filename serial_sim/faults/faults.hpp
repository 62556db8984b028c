// The faults at work on a line.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/uart.hpp"

namespace s7200::serial {

/// Makes each injected fault happen, by disturbing the line's level or what a sender does, and counts how often it did.
///
/// An exchange is a request, which is what the PLC's peers send, and an answer, which is what the PLC sends. Several PLCs on
/// the line count as one here. A Requester says when an exchange begins. For any other peer it begins with the first
/// character after an answer, or after more than 3.5 characters of silence; a PLC that speaks unasked begins one in the
/// same way.
///
/// To whoever handles the events: those of its own number go to handle().
class Faults final : private Interference {
 public:
  /// SplitMix64 (Steele, Lea, Flood 2014): the same figures on every computer, and a state of eight bytes.
  class Chance {
   public:
    explicit Chance(std::uint64_t seed = 0) : state_(seed) {}
    std::uint64_t draw();
    /// True with this probability.
    bool hits(double probability);
    bool operator==(const Chance&) const = default;

   private:
    std::uint64_t state_;
  };

  static constexpr int kAnyDriver = -1;

  struct Injected {
    Fault fault;
    Time at = 0;                   ///< when it was injected
    int driver = kAnyDriver;       ///< of the station that it is about
    Chance chance;                 ///< what is left of it to chance
    std::uint64_t exchanges = 0;   ///< begun since the injection
    bool applies = false;          ///< in the present exchange
    Time next = kNever;            ///< when it happens by itself, not with a character
    bool hit = false;              ///< of noise: whether a bit is inverted then
    std::uint64_t count = 0;       ///< how often it happened: bits, characters, glitches, exchanges with echo …
    std::uint64_t impossible = 0;  ///< how often it could not, for want of such a bit in the format
    bool operator==(const Injected&) const = default;
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    std::vector<Injected> injected;             // in the order of injection
    int announcer = -1;                         ///< driver of the Requester that began the present exchange, or -1
    bool begun = false;                         ///< there was an exchange at all
    std::array<std::uint32_t, 2> characters{};  ///< of request and answer so far
    std::array<Time, 2> sent_until{};           ///< end of the last of them
    bool operator==(const State&) const = default;
  };

  /// `owner`: its number in the queue. Nothing is owned.
  Faults(Line& line, EventQueue& queue, EventOwner owner) : line_(line), queue_(queue), owner_(owner) {}

  /// The characters of this UART are answers. Noise and lengths in bits go by the rate of the first one. Not owned.
  void add_plc(const Uart& plc) { plcs_.push_back(&plc); }

  /// Several may be at work at once. With a `driver` the fault is about what that station sends, its clock or its adapter,
  /// whatever its own `of` and `station` say; characters and exchanges are counted as without it.
  void inject(const Fault& fault, Time now, int driver = kAnyDriver);

  /// No fault any more, and the line is whole again.
  void clear(Time now);

  void handle(const Event& event);

  const State& state() const { return state_; }

  /// Line and queue are restored by their owner.
  void restore(const State& state);

 private:
  void exchange_begins(int driver, Time at) override;
  Mishap character_begins(int driver, const SerialFormat& format, Time at) override;
  std::int32_t clock_error(int driver) const override;
  bool echoes(int driver) const override;

  bool is_plc(int driver) const;
  SerialFormat plc_format() const { return plcs_.empty() ? SerialFormat{} : plcs_.front()->state().format; }
  bool begins_unannounced(Half half, int driver, const SerialFormat& format, Time at) const;
  void begin_exchange(Time at);
  void disturb_sender(Injected& injected, std::uint32_t number, const BitClock& clock, Mishap& mishap);
  void disturb_line(Injected& injected, const BitClock& clock, Time start);
  void disturb(Injected& injected, const BitClock& clock, Time at);
  void invert_bit(Injected& injected, int bit, const BitClock& clock, Time start);
  void collide(Injected& injected, const BitClock& clock, Time at);
  std::vector<std::uint8_t> uncalled_bytes(Injected& injected);
  void plan_noise(Injected& injected, Time from);
  void make_noise(Injected& injected);
  void schedule();
  void listen_in();

  Line& line_;
  EventQueue& queue_;
  EventOwner owner_;
  std::vector<const Uart*> plcs_;
  State state_;
};

}  // namespace s7200::serial
