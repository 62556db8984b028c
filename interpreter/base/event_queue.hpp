// Which events come next, and when. Events are plain data, so a queue can be copied with the state it belongs to.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "interpreter/base/time.hpp"

namespace s7200 {

/// Who handles an event. Events at the same instant are handled in the order below: the wire settles first, then its
/// listeners, then the CPU, then the inputs from the field, then the driver of the test. The field comes after the CPU
/// because the CPU's own events were decided earlier and an input at the same instant must not change them. Which interrupt
/// is served first does not depend on this order (interrupts::occurred).
enum class EventOwner : std::uint8_t { Faults, PlcUart, MasterUart, HostUart, Cpu, Field, Master };

struct Event {
  Time at = kNever;
  EventOwner owner{};
  std::uint8_t what = 0;  ///< the owner's own numbering

  bool operator==(const Event&) const = default;
};

/// Pending events, earliest first. Events at the same instant are ordered by owner, then by `what`.
/// Each (owner, what) is pending at most once; scheduling it again moves it.
class EventQueue {
 public:
  void schedule(Time at, EventOwner owner, std::uint8_t what) {
    cancel(owner, what);
    assert(size_ < events_.size());
    const Event event{at, owner, what};
    std::size_t place = size_++;
    for (; place > 0 && before(events_[place - 1], event); --place) events_[place] = events_[place - 1];
    events_[place] = event;
  }

  void cancel(EventOwner owner, std::uint8_t what) {
    std::size_t found = 0;
    while (found < size_ && !(events_[found].owner == owner && events_[found].what == what)) ++found;
    if (found == size_) return;
    for (--size_; found < size_; ++found) events_[found] = events_[found + 1];
    events_[size_] = Event{};
  }

  /// When the next event is due; kNever when none is pending.
  Time next() const { return size_ == 0 ? kNever : events_[size_ - 1].at; }

  Event pop() {
    assert(size_ > 0);
    const Event event = events_[--size_];
    events_[size_] = Event{};
    return event;
  }

  bool operator==(const EventQueue&) const = default;

 private:
  static bool before(const Event& a, const Event& b) {
    if (a.at != b.at) return a.at < b.at;
    if (a.owner != b.owner) return a.owner < b.owner;
    return a.what < b.what;
  }

  std::array<Event, 32> events_{};  // latest first, so that the next one is at the end
  std::size_t size_ = 0;
};

}  // namespace s7200
