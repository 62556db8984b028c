// The faults at work on a line.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "serial_sim/faults/answer_change.hpp"
#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/uart.hpp"

namespace s7200::serial {

/// One effect of a fault: it disturbs the wire, or a sender, during [from, to).
struct FaultHappening {
  std::uint32_t character = 0;  ///< of the request or the answer, or of what its station has sent in this exchange, from 1;
                                ///< 0: at an instant, or in all of the exchange that begins
  Time from = 0, to = 0;
  std::uint64_t times = 1;  ///< as Faults::Injected::count has it
};

class FaultWatcher;

/// Makes each injected fault happen, by disturbing the line's level or what a sender does, and counts how often it did.
///
/// An exchange is a request, which is what the PLC's peers send, and an answer, which is what the PLC sends. Several PLCs on
/// the line count as one here, but for their master, a peer of the others: set_master() says who it is, else it is who
/// speaks before anyone has asked. A Requester says when an exchange begins. For any other peer it begins with the first
/// character after an answer, or after over 3.5 characters of silence; a PLC that speaks unasked begins one so, too.
///
/// To whoever handles the events: those of its own number go to handle().
class Faults final : private Interference {
 public:
  /// SplitMix64 (Steele, Lea, Flood 2014): the same figures on every computer, and a state of eight bytes.
  class Chance {
   public:
    explicit Chance(std::uint64_t seed = 0) : state_(seed) {}
    std::uint64_t draw();
    /// Draws at random: true with this probability.
    bool hits(double probability);
    bool operator==(const Chance&) const = default;

   private:
    std::uint64_t state_;
  };

  static constexpr int kAnyDriver = -1;

  struct Injected {
    Fault fault;
    Time at = 0;                        ///< when it was injected
    int driver = kAnyDriver;            ///< of the station that it is about
    Chance chance;                      ///< what is left of it to chance
    std::uint64_t exchanges = 0;        ///< begun since the injection
    bool applies = false;               ///< in the present exchange
    std::uint32_t characters = 0;       ///< that its station has sent in the present exchange
    Time next = kNever;                 ///< when it happens by itself, not with a character
    bool hit = false;                   ///< of noise: whether a bit is inverted then
    std::uint64_t count = 0;            ///< how often it happened: bits, characters, glitches, exchanges with echo …
    Time last_begin = 0, last_end = 0;  ///< of what it has done to the wire
    std::uint64_t impossible = 0;       ///< how often it could not, for want of such a bit, or of such an answer
    bool operator==(const Injected&) const = default;
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    std::vector<Injected> injected;             // in the order of injection
    int announcer = -1;                         ///< driver of the Requester that began the present exchange, or -1
    bool begun = false;                         ///< an exchange has begun
    int master = -1;                            ///< driver of the station that asks the others, or -1
    std::array<std::uint32_t, 2> characters{};  ///< of request and answer so far
    std::array<Time, 2> sent_until{};           ///< end of the last of them
    AnswerInProgress answer{};                  ///< while there is a fault of whole answers
    bool operator==(const State&) const = default;
  };

  /// `owner` is the faults' number in the queue. Nothing is owned.
  Faults(Line& line, EventQueue& queue, EventOwner owner) : line_(line), queue_(queue), owner_(owner) {}

  /// The characters of this UART are answers, unless it is the master among several. Noise and lengths in bits go by the
  /// rate of the first one. Only answers of a `sender` can be changed as a whole. Not owned.
  void add_plc(const Uart& plc, const FrameSender* sender = nullptr);

  /// The characters of the station `driver` are requests; those of all other PLCs are answers.
  void set_master(int driver) { state_.master = driver; }

  /// Several may be at work at once. With a `driver` the fault is about what that station sends, its clock or its adapter,
  /// whatever its own `of` and `station` say: only that station's characters count, and exchanges as without it.
  void inject(const Fault& fault, Time now, int driver = kAnyDriver);

  /// Removes all faults and makes the line whole again.
  void clear(Time now);

  void handle(const Event& event);

  const State& state() const { return state_; }

  /// The watcher that is told of each effect of a fault, or null. Wiring, not state; not owned.
  void set_watcher(FaultWatcher* watcher) { watcher_ = watcher; }

  /// Line and queue are restored by their owner.
  void restore(const State& state);

 private:
  void exchange_begins(int driver, Time at) override;
  Mishap character_begins(int driver, const SerialFormat& format, std::uint8_t byte, Time at) override;
  std::int32_t clock_error(int driver) const override;
  bool echoes(int driver) const override;

  bool is_plc(int driver) const { return (plc_drivers_ >> driver & 1U) != 0; }
  bool has_several_plcs() const { return std::popcount(plc_drivers_) > 1; }
  bool answers(int driver) const { return is_plc(driver) && driver != state_.master; }
  SerialFormat plc_format() const { return first_plc_ ? first_plc_->state().format : SerialFormat{}; }
  bool begins_unannounced(Half half, int driver, const SerialFormat& format, Time at) const;
  void begin_exchange(Time at);
  void happens(Injected& injected, const FaultHappening& what);
  void disturb_wire(Injected& injected, std::uint32_t character, const Disturbance& disturbance);
  void disturb_sender(Injected& injected, std::uint32_t number, const BitClock& clock, Time at, Mishap& mishap);
  bool follow_answer(int driver, std::uint8_t byte);
  void change_answer(int driver, const BitClock& clock, Time at, Mishap& mishap);
  void disturb_line(Injected& injected, std::uint32_t number, const BitClock& clock, Time start);
  void disturb(Injected& injected, std::uint32_t number, const BitClock& clock, Time at);
  void invert_bit(Injected& injected, std::uint32_t number, int bit, const BitClock& clock, Time start);
  void collide(Injected& injected, std::uint32_t number, const BitClock& clock, Time at);
  std::vector<std::uint8_t> uncalled_bytes(Injected& injected);
  void plan_noise(Injected& injected, Time from);
  void make_noise(Injected& injected);
  void schedule();
  void listen_in();

  Line& line_;
  EventQueue& queue_;
  EventOwner owner_;
  const Uart* first_plc_ = nullptr;
  std::uint32_t plc_drivers_ = 0;                             // a bit each
  std::array<const FrameSender*, Line::kDrivers> senders_{};  // by driver; null: none
  FaultWatcher* watcher_ = nullptr;
  State state_;
};

/// Sees what the faults of a line do, when it is decided and before anyone hears it.
class FaultWatcher {
 public:
  virtual void fault_happens(const Faults::Injected& fault, const FaultHappening& what) = 0;

  /// All faults were removed at `at`.
  virtual void faults_cleared(Time at) = 0;

 protected:
  ~FaultWatcher() = default;
};

}  // namespace s7200::serial
