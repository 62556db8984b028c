#include "interpreter/base/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace s7200::event_queue_test {
namespace {

constexpr EventOwner kFirst{3}, kNext{4}, kLast{700};

std::vector<Event> drained(EventQueue queue) {
  std::vector<Event> events;
  while (queue.next() != kNever) events.push_back(queue.pop());
  return events;
}

TEST(EventQueue, TheSameInstantIsOrderedByOwnerAndThenByWhat) {
  EventQueue queue;
  queue.schedule(10, kLast, 0);
  queue.schedule(10, kNext, 2);
  queue.schedule(10, kFirst, 9);
  queue.schedule(10, kNext, 1);
  queue.schedule(9, kLast, 5);
  const std::vector<Event> expected{{9, kLast, 5}, {10, kFirst, 9}, {10, kNext, 1}, {10, kNext, 2}, {10, kLast, 0}};
  EXPECT_EQ(drained(queue), expected);
}

TEST(EventQueue, SchedulingAgainMovesAnEventAndCancellingRemovesIt) {
  EventQueue queue;
  queue.schedule(10, kFirst, 0);
  queue.schedule(20, kFirst, 1);
  queue.schedule(5, kFirst, 1);
  queue.schedule(30, kNext, 0);
  queue.cancel(kFirst, 0);
  queue.cancel(kFirst, 7);
  const std::vector<Event> expected{{5, kFirst, 1}, {30, kNext, 0}};
  EXPECT_EQ(drained(queue), expected);
}

TEST(EventQueue, AnEventThatIsNotPendingMayBeAddedWithoutASearch) {
  EventQueue added, scheduled;
  constexpr Event kEvents[] = {{10, kNext, 0},  {10, kFirst, 3},    {5, kLast, 0},
                               {10, kFirst, 1}, {kNever, kNext, 1}, {20, kLast, 1}};
  for (const Event& event : kEvents) {
    added.add(event.at, event.owner, event.what);
    scheduled.schedule(event.at, event.owner, event.what);
    EXPECT_TRUE(added == scheduled);
  }
}

TEST(EventQueue, HoldsTheEventsOfManyOwners) {
  EventQueue queue;
  constexpr int kOwners = 500;
  for (int i = 0; i < kOwners; ++i) queue.schedule(kOwners - i, static_cast<EventOwner>(i), 0);
  for (int i = 0; i < kOwners; ++i) queue.schedule(1000 + i * 7 % kOwners, static_cast<EventOwner>(i), 1);
  const std::vector<Event> events = drained(queue);
  ASSERT_EQ(events.size(), 2U * kOwners);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.at < b.at; }));
  EXPECT_EQ(events.front(), (Event{1, static_cast<EventOwner>(kOwners - 1), 0}));
}

TEST(EventQueue, TwoWithTheSameEventsAreEqualHoweverTheyCameIn) {
  EventQueue one, other;
  one.schedule(1, kFirst, 0);
  one.schedule(2, kNext, 0);
  other.schedule(2, kNext, 0);
  other.schedule(3, kLast, 0);
  other.schedule(1, kFirst, 0);
  EXPECT_FALSE(one == other);
  other.cancel(kLast, 0);
  EXPECT_TRUE(one == other);
}

}  // namespace
}  // namespace s7200::event_queue_test
