#include "tools/host/pace.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace s7200::tools::pace_test {
namespace {

using namespace std::chrono_literals;

TEST(Pace, SimulatedTimeIsTheClockTimesTheSpeed) {
  for (const double speed : {0.5, 1.0, 20.0}) {
    const Pace pace(7 * kSecond, speed);
    const auto begin = pace.when(7 * kSecond);
    EXPECT_EQ(pace.at(begin), 7 * kSecond);
    EXPECT_EQ(pace.at(begin + 2s), 7 * kSecond + static_cast<Time>(2e9 * speed));
    EXPECT_EQ(pace.when(7 * kSecond + static_cast<Time>(2e9 * speed)), begin + 2s);
    EXPECT_GE(pace.at(pace.when(8 * kSecond + 1)), 8 * kSecond + 1) << "an instant is over when it is waited for";
  }
  EXPECT_EQ(Pace(0, 1).when(kNever), Pace::Clock::time_point::max());
}

TEST(Pace, WhatIsTooFarAwayForTheClockIsNever) {
  constexpr Time k3000h = 3000 * 3600 * kSecond;
  EXPECT_EQ(Pace(0, 0.001).when(k3000h), Pace::Clock::time_point::max());
  EXPECT_EQ(Pace(0, 1).when(kNever - 1), Pace::Clock::time_point::max());
  EXPECT_LT(Pace(0, 1).when(k3000h), Pace::Clock::time_point::max());
  EXPECT_EQ(Pace(kSecond, 1000).at(Pace::Clock::time_point::max()), kNever);
  const Pace late(kNever - kMillisecond, 1000);
  EXPECT_GE(late.next_goal(kNever - kMillisecond), kNever - kMillisecond);
  EXPECT_EQ(late.at(Pace::Clock::now() + 1s), kNever);
}

TEST(Pace, ALittleBehindIsMadeUpFor) {
  Pace pace(0, 1);
  EXPECT_FALSE(pace.reached(0, Pace::Clock::now()));
  EXPECT_EQ(pace.report().drift, 0);
}

TEST(Pace, FarBehindIsGivenUpAndIsDrift) {
  Pace pace(0, 2);
  const auto begin = Pace::Clock::now();
  std::this_thread::sleep_for(Pace::kBearable + 50ms);
  EXPECT_LE(pace.next_goal(0), 500 * kMillisecond) << "no more at once than is bearable";
  EXPECT_TRUE(pace.reached(kMillisecond, begin));
  EXPECT_GE(pace.report().drift, 599 * kMillisecond);
  EXPECT_GE(pace.report().worst_lag, 300 * kMillisecond);
  EXPECT_LT(pace.at(pace.when(kMillisecond)), 2 * kMillisecond) << "it goes on from where it is";
}

}  // namespace
}  // namespace s7200::tools::pace_test
