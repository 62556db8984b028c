// Waits of interrupts: by hand, and compared with queues that are served step by step.
#include "interpreter/analysis/times/interrupt_waits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>

#include "interpreter/base/split_mix.hpp"

namespace s7200::test::interrupt_waits_test {
namespace {

using Sources = std::vector<InterruptSource>;

TEST(InterruptWaits, ThoseOfTheSameQueueAndOfTheQueuesBeforeAreServedFirst) {
  const Sources sources{{Queue::Timed, 50, 4}, {Queue::Timed, 50, 3}, {Queue::Communication, 10, 2}};
  EXPECT_EQ(interrupt_wait(sources, Queue::Timed, 4, 1)->longest, 1 + 3 + 2);
  EXPECT_EQ(interrupt_wait(sources, Queue::Timed, 3, 1)->longest, 1 + 4 + 2);
  EXPECT_EQ(interrupt_wait(sources, Queue::Communication, 2, 5)->longest, 5) << "timed ones do not come before it";
  EXPECT_EQ(interrupt_wait(sources, Queue::Timed, 4, 11)->longest, 11 + 3 + 2 * 2) << "two characters by then";
}

TEST(InterruptWaits, WhatWaitsPilesUpWhileInterruptsAreKeptAway) {
  const Sources sources{{Queue::Timed, 5, 2}, {Queue::Timed, 5, 2}};
  const auto wait = interrupt_wait(sources, Queue::Timed, 2, 10);
  EXPECT_EQ(wait->longest, 12);
  EXPECT_EQ(wait->waiting_in_queue, 5U) << "six by the time 10, at which the first is served";
}

TEST(InterruptWaits, RoutinesThatNeedAllTimeHaveNoBound) {
  EXPECT_TRUE(interrupt_wait({{Queue::Timed, 5, 4}}, Queue::Timed, 4, 1));
  EXPECT_FALSE(interrupt_wait({{Queue::Timed, 5, 5}}, Queue::Timed, 5, 1));
  EXPECT_FALSE(interrupt_wait({{Queue::Timed, 5, 3}, {Queue::Communication, 5, 2}}, Queue::Timed, 3, 1));
  EXPECT_TRUE(interrupt_wait({{Queue::Timed, 5, 3}, {Queue::Communication, 5, 2}}, Queue::Communication, 2, 1));
}

/// The longest wait by source, when events come with these distances from the first of their kind on.
std::vector<Time> served(const Sources& sources, std::uint64_t chance, Time kept_away, Time until) {
  struct Waiting {
    Time since;
    std::size_t source;
  };
  std::vector<Time> longest(sources.size(), 0), next;
  for (const InterruptSource& source : sources)
    next.push_back(static_cast<Time>(draw_split_mix(chance) % static_cast<std::uint64_t>(source.period)));
  std::array<std::deque<Waiting>, kQueues> queues;
  Time free_at = *std::ranges::min_element(next) + kept_away;  // kept away when the first one comes
  for (Time now = 0; now < until; ++now) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (next[i] != now) continue;
      queues[static_cast<std::size_t>(sources[i].queue)].push_back({now, i});
      next[i] += sources[i].period + (draw_split_mix(chance) % 8 == 0 ? 1 : 0);
    }
    const auto first = std::ranges::find_if(queues, [](const auto& queue) { return !queue.empty(); });
    if (now < free_at || first == queues.end()) continue;
    const Waiting begins = first->front();
    first->pop_front();
    longest[begins.source] = std::max(longest[begins.source], now - begins.since);
    free_at = now + sources[begins.source].routine;
  }
  return longest;
}

TEST(InterruptWaits, NoQueueThatIsServedStepByStepTakesLonger) {
  std::uint64_t chance = 1;
  const auto below = [&](int limit) {
    return static_cast<Time>(draw_split_mix(chance) % static_cast<std::uint64_t>(limit));
  };
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    Sources sources;
    for (int count = 0; count < 4; ++count) {
      const Time period = 10 + below(50);
      sources.push_back({static_cast<Queue>(below(kQueues)), period, 1 + below(static_cast<int>(period / 2))});
    }
    const Time kept_away = below(60);
    const std::vector<Time> seen = served(sources, chance, kept_away, 3000);
    for (std::size_t which = 0; which < sources.size(); ++which) {
      Time begun = 0;
      for (const InterruptSource& source : sources)
        if (source.queue > sources[which].queue) begun = std::max(begun, source.routine);
      const auto wait = interrupt_wait(sources, sources[which].queue, sources[which].routine, kept_away + begun);
      if (!wait) continue;
      ++compared;
      EXPECT_LE(seen[which], wait->longest) << "programs " << i << ", event " << which;
    }
  }
  EXPECT_GT(compared, 200);
}

}  // namespace
}  // namespace s7200::test::interrupt_waits_test
