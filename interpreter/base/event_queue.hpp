// A queue of events in the order of their times. Events are plain data, so a queue can be copied with the state it belongs
// to.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interpreter/base/time.hpp"

namespace s7200 {

/// The handler of an event: a number from the owner of the queue. At the same instant the lower number comes first.
enum class EventOwner : std::uint16_t {};

struct Event {
  Time at = kNever;
  EventOwner owner{};
  std::uint8_t what = 0;  ///< the owner's own numbering

  bool operator==(const Event&) const = default;
};

/// Pending events, earliest first; the same instant is ordered by owner, then by `what`.
/// Each (owner, what) is pending at most once: scheduling it again moves it. So there are never more events than owners have
/// kinds of them, a handful each, and a search from one end to the other is the fastest.
class EventQueue {
 public:
  EventQueue() {
    events_.reserve(32);  // more than a PLC and its peers ever have
    events_.push_back(kLast);
  }

  void schedule(Time at, EventOwner owner, std::uint8_t what) {
    std::size_t place = place_of(owner, what);
    if (place == events_.size()) return insert({at, owner, what});
    const Event event{at, owner, what};
    for (; before(events_[place - 1], event); --place) events_[place] = events_[place - 1];
    for (; place + 1 < events_.size() && before(event, events_[place + 1]); ++place) events_[place] = events_[place + 1];
    events_[place] = event;
  }

  /// Adds an event that is known not to be pending, without a search for it.
  void add(Time at, EventOwner owner, std::uint8_t what) {
    assert(place_of(owner, what) == events_.size());
    insert({at, owner, what});
  }

  void cancel(EventOwner owner, std::uint8_t what) {
    const std::size_t found = place_of(owner, what);
    if (found < events_.size()) events_.erase(events_.begin() + static_cast<std::ptrdiff_t>(found));
  }

  /// The time of the next event; kNever when none is pending.
  Time next() const { return events_.back().at; }

  /// The next event; at least one must be pending.
  const Event& front() const { return events_.back(); }

  Event pop() {
    assert(events_.size() > 1);
    const Event event = events_.back();
    events_.pop_back();
    return event;
  }

  bool operator==(const EventQueue&) const = default;

 private:
  /// Never comes, and is there so that there is always a next one, and one later than any other.
  static constexpr Event kLast{kNever, EventOwner{0xFFFF}, 0xFF};

  void insert(const Event& event) {
    events_.push_back(event);
    Event* place = &events_.back();
    for (; before(place[-1], event); --place) place[0] = place[-1];
    *place = event;
  }

  std::size_t place_of(EventOwner owner, std::uint8_t what) const {
    std::size_t place = 1;
    while (place < events_.size() && !(events_[place].owner == owner && events_[place].what == what)) ++place;
    return place;
  }

  static bool before(const Event& a, const Event& b) {
    if (a.at != b.at) return a.at < b.at;
    if (a.owner != b.owner) return a.owner < b.owner;
    return a.what < b.what;
  }

  std::vector<Event> events_;  // latest first, so that the next one is at the end
};

}  // namespace s7200
