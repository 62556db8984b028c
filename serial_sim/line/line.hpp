// The two wires of an RS-485 line, as a level over time.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interpreter/base/time.hpp"
#include "serial_sim/line/character.hpp"

namespace s7200::serial {

class Interference;

/// A listener that hears the line.
class LineListener {
 public:
  /// A driver has got new edges, the first at `at`, which may lie in the future.
  virtual void line_changed(Time at) = 0;

  /// Levels before this instant matter no more to this listener; kNever when only those to come do.
  virtual Time needs_from() const = 0;

  /// Whether the listener waits to be told that past levels can no longer change, as a tap does.
  virtual bool waits_for_settled_levels() const { return false; }

 protected:
  ~LineListener() = default;
};

/// A disturbance of the wire during [from, to), whoever drives it. A cut outranks a hold, a hold an
/// inversion; two inversions at once undo each other.
struct Disturbance {
  enum class Effect : std::uint8_t {
    Inverts,     ///< mark becomes space and space mark
    HoldsSpace,  ///< another driver, or a short circuit, pulls the line to space
    Cuts,        ///< receivers find mark, the level of a line that no station drives
  };
  Effect effect{};
  Time from = 0, to = kNever;

  bool operator==(const Disturbance&) const = default;
};

/// Each driver holds the line at mark (true, the idle level) or space (false). A driver that marks is as good as one that
/// is switched off: the line is at space while any driver is. Two senders at once collide bit by bit.
/// Not documented, modelled so: two active drivers that disagree give space, where a real RS-485 line has no defined level,
/// unless that is left to chance. [Uart.TwoSendersAtOnceGiveTheBitsBothMark]
///
/// Who listens is wiring, not state: a copy of a line has its levels and no listeners, and assigning to a line leaves its
/// listeners attached. So a snapshot is a copy, and going back to it an assignment.
class Line {
 public:
  static constexpr int kDrivers = 32;  ///< at most: what an RS-485 segment takes

  /// Lets driver `driver` hold `mark` from `at` on. `at` is not before that driver's last edge; it may lie in the future.
  /// Every listener is told, so that this is all it takes to send, to collide or to make noise.
  void drive(int driver, Time at, bool mark);

  /// Drives a whole character from `at` on, with levels as in character_levels(). A character without a stop bit ends where
  /// the stop bit would end.
  void drive(int driver, unsigned levels, const BitTimes& times, Time at);

  /// Listeners keep what they have heard: `from` should not lie before now. Every listener is told. Does nothing if from >=
  /// to.
  void disturb(const Disturbance& disturbance);

  /// Ends every disturbance at `at`, whatever caused it; later ones are removed.
  void heal(Time at);

  /// The interference that disturbs stations and their characters, or null. Like listeners it is wiring, not state, and is
  /// not owned.
  Interference* interference() const { return wiring_.interference; }
  void set_interference(Interference* interference) { wiring_.interference = interference; }

  /// Cuts the cable from `at` on: the drivers of `far`, a bit each, and all others neither hear each other nor disagree. 0
  /// makes it whole again. Instants ascend. Every listener is told.
  void separate(Time at, std::uint32_t far);

  /// The drivers that do not hear the others from an instant on, as in separate().
  struct Separation {
    Time at = 0;
    std::uint32_t far = 0;
    bool operator==(const Separation&) const = default;
  };
  /// The separation in force at an instant that is not forgotten; nothing while the cable is whole.
  std::optional<Separation> separation(Time at) const;

  /// Leaves to chance, from now on, the level of a bit for which active drivers disagree: mark or space, for all receivers
  /// on their part of the cable alike. The same seed gives the same levels.
  void leave_contention_to_chance(std::uint64_t seed) {
    contention_ = {.seed = seed, .on_until = std::vector<Time>(kDrivers)};
  }

  /// Driver `driver` is switched on from `from` to `to`, for a character whose edges it has already.
  void occupy(int driver, Time from, Time to) {
    if (!contention_.on_until.empty()) contend(driver, from, to);
  }

  /// Driver `driver` is switched off at `at`, in the middle of a character or not. It has no edges after that.
  void release(int driver, Time at);

  static constexpr int kWholeCable = -1;
  static constexpr int kNobody = -1;

  /// The level at an instant; an edge counts from its own instant on. `listener`: the driver of the station that hears it;
  /// without one the cable counts as whole, here and below.
  bool level(Time at, int listener = kWholeCable) const;

  /// Whether a character alone on the undisturbed line has the start bit that begins at `start` and lasts beyond `until`:
  /// as long as no listener is told of a change by then, that stays so.
  bool has_start_bit_alone(Time start, Time until) const {
    return implied_.any() && implied_.start == start && implied_.in_start_bit(until);
  }

  /// The level in the middle of each bit, up to the first stop bit, of a character that begins at `start`: that of the start
  /// bit in bit 0.
  unsigned levels(Time start, const BitTimes& times, int listener = kWholeCable) const;

  /// The level that driver `driver` holds, whatever the other drivers do.
  bool level_of(int driver, Time at) const;

  /// The level as it would be without driver `driver`: what it hears of the others and of disturbances.
  bool level_without(int driver, Time at) const;

  /// The driver with the lowest number that holds the line at space on driver `driver`'s part of the cable, or kNobody.
  int space_holder(int driver, Time at) const { return space_holder_of(audible(driver, at), at); }
  /// The driver with the lowest number besides `driver` that holds the line at space, as `driver` hears it, or kNobody.
  int space_holder_besides(int driver, Time at) const { return space_holder_of(audible(driver, at) & ~(1U << driver), at); }

  /// First known edge of any driver, or start or end of a disturbance, at or after `from`; kNever when there is none.
  Time next_change(Time from) const;

  /// First known change from mark to space at or after `from`; kNever when there is none.
  Time falling_edge(Time from, int listener = kWholeCable) const;

  /// Tells the line that it is `now`: past edges that no listener needs may be removed.
  void forget(Time now);
  /// Something disturbs it, or will: what is past of that goes with forget(), too.
  bool disturbed() const { return disturbed_; }

  void attach(LineListener& listener);
  void detach(LineListener& listener);

  /// Whether any listener waits for settled levels.
  bool watched() const { return wiring_.watched; }

  bool operator==(const Line& other) const;

 private:
  struct Driver {
    bool mark_before = true;  // level ahead of the first edge kept
    std::vector<Time> edges;  // in order of time; each one changes the level
    bool operator==(const Driver&) const = default;

    bool level_after(std::size_t edge_count) const { return mark_before != (edge_count % 2 != 0); }
    std::size_t edges_until(Time at) const;
    bool level(Time at) const { return level_after(edges_until(at)); }
    unsigned levels(std::span<const Time> at) const;
    Time next_edge(Time from, bool mark) const;
    void add(Time at, bool mark);
    void forget(Time before);
    void release(Time at);
  };

  /// All drivers, by number. A driver that is missing at the end of the list has always held mark; lists that differ only in
  /// such drivers are equal.
  struct Drivers {
    std::vector<Driver> all;
    bool operator==(const Drivers& other) const;
  };

  /// A character of a driver that is alone on an undisturbed line. Its edges are not needed while listeners ask only for its
  /// start and the levels at the centres of its bits; any other question or action reveals it, which turns it into edges.
  struct Implied {
    int driver = kNone;
    unsigned levels = 0;
    Time start = 0, last_edge = 0;
    BitTimes times;

    static constexpr int kNone = -1;
    bool any() const { return driver != kNone; }
    bool in_start_bit(Time at) const { return at >= start && at < start + times.begin_of_bit(1); }
  };

  /// Periods as a list of their starts and ends, in turn.
  struct Periods {
    bool lasts_before = false;  // ahead of the first one kept
    std::vector<Time> changes;  // in order of time
    bool operator==(const Periods&) const = default;

    bool lasts(Time at) const;
    bool none() const { return !lasts_before && changes.empty(); }
    Time next_change(Time from) const;
    void unite(Time from, Time to);
    void invert(Time from, Time to);
    void end(Time at);
    void forget(Time before);

   private:
    bool lasts_after(std::vector<Time>::const_iterator change) const;
    void toggle(Time at);
  };

  struct Contention {
    std::uint64_t seed = 0;
    std::vector<Time> on_until{};    // by driver; empty: space wins
    std::array<Periods, 2> marks{};  // where chance says mark and a driver space: on the near and the far part of the cable
    bool operator==(const Contention&) const = default;
  };

  /// The last questions and their answers. All receivers of a line ask the same, one after the other: those that await a
  /// character with the same clock have the same start edge and sample at the same instants. This is no state: it follows
  /// from the levels.
  struct Answers {
    Time falling_from = kNever, falling_edge = 0;
    Time level_at = kNever;
    bool level = true;
    std::vector<Time> levels_at;
    unsigned levels = 0;
    bool operator==(const Answers&) const { return true; }
  };

  struct Wiring {
    std::vector<LineListener*> listeners;
    bool watched = false;  // by any of them
    Interference* interference = nullptr;
    Wiring() = default;
    Wiring(const Wiring&) {}
    Wiring& operator=(const Wiring&) { return *this; }
    bool operator==(const Wiring&) const { return true; }
  };

  /// A character that begins now may be implied: no driver has edges, and nothing disturbs, cuts or contends. While there
  /// is an implied one that stays so: whatever would change it reveals that one first.
  bool may_imply() const { return busy_ == 0 && !implied_.any() && !irregular(); }
  void add_edges(int number, unsigned levels, const BitTimes& times, Time at) const;
  void reveal() const {
    if (implied_.any()) reveal_implied();
  }
  void reveal_implied() const;
  Driver& driver(int number) const;
  /// Calls `of` with each driver that has edges or holds the line at space.
  template <class Of>
  void each_busy(Of of, std::uint32_t audible = ~0U) const {
    reveal();
    for (std::uint32_t those = busy_ & audible; those != 0; those &= those - 1)
      of(drivers_.all[static_cast<std::size_t>(std::countr_zero(those))]);
  }
  void changed(int driver) const;
  void changed() const {
    answers_.falling_from = answers_.level_at = kNever;
    answers_.levels_at.clear();
  }
  bool irregular() const { return disturbed_ || !separations_.empty(); }
  std::uint32_t far_at(Time at) const;
  std::size_t part_of(int driver, Time at) const;
  std::uint32_t audible(int listener, Time at) const;
  int space_holder_of(std::uint32_t drivers, Time at) const;
  bool chance_says_mark(Time at, int listener) const;
  bool irregular_level(Time at, int listener) const;
  unsigned levels(std::span<const Time> at, int listener) const;
  unsigned sampled(std::span<const Time> at, int listener) const;
  void contend(int driver, Time from, Time to);
  void contend_anew(Time at);
  bool contend(int driver, int other, Time from, Time to);
  Time next_edge_of(int driver, Time from) const;
  Time next_separation(Time from) const;
  bool driven_level(Time at, std::uint32_t audible = ~0U) const;
  bool disturbed_level(bool driven, Time at) const;
  Time driven_falling_edge(Time from) const;
  Time irregular_falling_edge(Time from, int listener) const;
  Time space_held_from_before(Time edge) const;
  void tell(Time at) const;
  void note_whether_watched();

  Periods& periods(Disturbance::Effect effect) { return disturbances_[static_cast<std::size_t>(effect)]; }
  const Periods& periods(Disturbance::Effect effect) const { return disturbances_[static_cast<std::size_t>(effect)]; }
  void note_whether_disturbed();

  mutable Drivers drivers_;
  mutable std::uint32_t busy_ = 0;       // drivers that have edges or hold the line at space, a bit each
  mutable Implied implied_;              // what drivers_ does not have yet
  std::vector<Separation> separations_;  // in order of time
  Contention contention_;
  std::array<Periods, 3> disturbances_;  // by effect; overlapping ones are kept combined
  bool disturbed_ = false;               // there are disturbances, or marks by chance
  Wiring wiring_;
  mutable Answers answers_;
};

}  // namespace s7200::serial
