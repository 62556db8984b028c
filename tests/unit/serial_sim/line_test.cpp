#include "serial_sim/line/line.hpp"

#include <gtest/gtest.h>

#include <random>

namespace s7200::serial::line_test {
namespace {

TEST(Line, IdlesAtMark) {
  const Line line;
  EXPECT_TRUE(line.level(0));
  EXPECT_EQ(line.falling_edge(0), kNever);
}

TEST(Line, EdgeCountsFromItsOwnInstant) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 200, true);
  EXPECT_TRUE(line.level(99));
  EXPECT_FALSE(line.level(100));
  EXPECT_FALSE(line.level(199));
  EXPECT_TRUE(line.level(200));
}

TEST(Line, FallingEdgeIsTheFirstAtOrAfterTheInstant) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 200, true);
  line.drive(0, 300, false);
  EXPECT_EQ(line.falling_edge(0), 100);
  EXPECT_EQ(line.falling_edge(100), 100);
  EXPECT_EQ(line.falling_edge(101), 300);
  EXPECT_EQ(line.falling_edge(301), kNever);
}

TEST(Line, DrivingTheLevelThatIsThereMakesNoEdge) {
  Line line;
  line.drive(0, 50, true);
  EXPECT_EQ(line, Line{});
}

TEST(Line, TwoEdgesOfADriverAtOneInstantAreNone) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 200, true);
  line.drive(0, 200, false);
  line.drive(0, 300, true);
  EXPECT_FALSE(line.level(200));
  EXPECT_EQ(line.falling_edge(101), kNever);
}

TEST(Line, TakesAsManyDriversAsAnRs485Segment) {
  Line line;
  for (int driver = Line::kDrivers - 1; driver >= 0; --driver) {
    const Time from = 100 + 10 * Time{driver};
    line.drive(driver, from, false);
    line.drive(driver, from + 10, true);
  }
  EXPECT_EQ(line.falling_edge(0), 100);
  EXPECT_FALSE(line.level(100 + 10 * Line::kDrivers - 1));
  EXPECT_TRUE(line.level(100 + 10 * Line::kDrivers));
  EXPECT_TRUE(line.level_without(5, 155));
  EXPECT_FALSE(line.level_without(4, 155));
}

TEST(Line, ADriverThatNeverDroveHoldsMark) {
  Line line;
  line.drive(0, 100, false);
  EXPECT_TRUE(line.level_of(7, 100));
  EXPECT_FALSE(line.level_without(7, 100));
  Line longer = line;
  longer.drive(7, 200, false);
  EXPECT_FALSE(longer == line);
  longer.drive(7, 200, true);
  EXPECT_TRUE(longer == line && line == longer);
}

TEST(Line, WhatADriverHearsOfTheOthersIsNotItsOwnCharacter) {
  Line line;
  const BitTimes times{BitClock{}};
  line.drive(3, character_levels(times.clock.format, 0x55, false), times, 1000);
  for (Time at = 0; at < 2 * kMillisecond; at += 10 * kMicrosecond) EXPECT_TRUE(line.level_without(3, at)) << at;
  EXPECT_FALSE(line.level_without(4, 1000));
  line.drive(4, 500 * kMicrosecond, false);
  EXPECT_TRUE(line.level_without(3, 499 * kMicrosecond));
  EXPECT_FALSE(line.level_without(3, 500 * kMicrosecond));
}

TEST(Line, IsAtSpaceWhileAnyDriverIs) {
  Line line;
  line.drive(0, 100, false);
  line.drive(1, 150, false);
  line.drive(0, 200, true);
  line.drive(1, 250, true);
  EXPECT_FALSE(line.level(220));
  EXPECT_TRUE(line.level(250));
}

TEST(Line, FallingEdgeUnderAnotherDriversSpaceIsNone) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 300, true);
  line.drive(1, 200, false);
  line.drive(1, 250, true);
  line.drive(1, 400, false);
  EXPECT_EQ(line.falling_edge(101), 400);
}

TEST(Line, HandingOverSpaceFromOneDriverToAnotherIsNoFallingEdge) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 200, true);
  line.drive(1, 200, false);
  line.drive(1, 300, true);
  EXPECT_FALSE(line.level(200));
  EXPECT_EQ(line.falling_edge(101), kNever);
}

TEST(Line, DriverStuckAtSpaceHidesEveryFallingEdge) {
  Line line;
  line.drive(0, 10, false);
  for (Time at = 100; at < 1000; at += 10) line.drive(1, at, at % 20 != 0);
  EXPECT_EQ(line.falling_edge(11), kNever);
}

TEST(Line, ForgettingThePastKeepsThePresentLevel) {
  Line line;
  line.drive(0, 100, false);
  line.drive(1, 150, false);
  line.drive(1, 160, true);
  line.drive(0, 500, true);
  line.forget(300);
  EXPECT_FALSE(line.level(300));
  EXPECT_TRUE(line.level(500));
}

TEST(Line, EdgeAtTheInstantOfForgettingStays) {
  Line line;
  line.drive(0, 100, false);
  line.forget(100);
  EXPECT_EQ(line.falling_edge(100), 100);
}

struct Listener final : LineListener {
  Time told = kNever;
  Time needed = kNever;
  void line_changed(Time at) override { told = at; }
  Time needs_from() const override { return needed; }
};

TEST(Line, TellsWhoeverListensOfEachNewEdge) {
  Line line;
  Listener listener;
  line.attach(listener);
  line.drive(2, 70, false);
  EXPECT_EQ(listener.told, 70);
  line.detach(listener);
  line.drive(2, 80, true);
  EXPECT_EQ(listener.told, 70);
}

TEST(Line, ForgetsNothingAListenerNeeds) {
  Line line;
  Listener listener;
  listener.needed = 100;
  line.attach(listener);
  line.drive(0, 100, false);
  line.drive(0, 200, true);
  line.forget(1000);
  EXPECT_EQ(line.falling_edge(100), 100);
}

TEST(Line, CopyHasTheLevelsAndNoListeners) {
  Line line;
  Listener listener;
  line.attach(listener);
  line.drive(0, 100, false);
  Line copy = line;
  EXPECT_EQ(copy, line);
  copy.drive(0, 200, true);
  EXPECT_EQ(listener.told, 100);
}

TEST(Line, AssignmentLeavesItsListenersAttached) {
  Line line;
  Listener listener;
  line.attach(listener);
  line = Line{};
  line.drive(0, 100, false);
  EXPECT_EQ(listener.told, 100);
}

constexpr auto kInverts = Disturbance::Effect::Inverts;
constexpr auto kHoldsSpace = Disturbance::Effect::HoldsSpace;
constexpr auto kCuts = Disturbance::Effect::Cuts;

TEST(DisturbedLine, InversionTurnsTheLevelBothWaysUntilBeforeItsEnd) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 300, true);
  line.disturb({kInverts, 50, 60});
  line.disturb({kInverts, 150, 200});
  for (const auto& [at, mark] :
       {std::pair{49, true}, {50, false}, {59, false}, {60, true}, {149, false}, {150, true}, {199, true}, {200, false}})
    EXPECT_EQ(line.level(at), mark) << at;
  EXPECT_EQ(line.falling_edge(0), 50);
  EXPECT_EQ(line.falling_edge(51), 100);
  EXPECT_EQ(line.falling_edge(101), 200) << "the end of an inversion is an edge";
  EXPECT_EQ(line.falling_edge(201), kNever);
}

TEST(DisturbedLine, EdgeThatMeetsTheBeginOfAnInversionIsNone) {
  Line line;
  line.drive(0, 100, false);
  line.drive(0, 200, true);
  line.disturb({kInverts, 100, 200});
  EXPECT_EQ(line.falling_edge(0), kNever);
  line.drive(0, 300, false);
  EXPECT_EQ(line.falling_edge(0), 300);
}

TEST(DisturbedLine, TwoInversionsAtOnceUndoEachOtherAndTwoInARowAreOne) {
  Line line;
  line.disturb({kInverts, 100, 300});
  line.disturb({kInverts, 200, 400});
  EXPECT_TRUE(line.level(250));
  EXPECT_EQ(line.falling_edge(101), 300);
  line.disturb({kInverts, 400, 500});
  EXPECT_FALSE(line.level(400));
  EXPECT_EQ(line.falling_edge(301), kNever) << "the one hands over to the next";
}

TEST(DisturbedLine, HeldLineIsAtSpaceWhateverElseInvertsIt) {
  Line line;
  line.disturb({kHoldsSpace, 100, 200});
  line.disturb({kInverts, 120, 140});
  EXPECT_FALSE(line.level(130));
  EXPECT_EQ(line.falling_edge(0), 100);
  EXPECT_EQ(line.falling_edge(101), kNever);
}

TEST(DisturbedLine, CutLineIsAtMarkWhateverDrivesIt) {
  Line line;
  line.drive(0, 100, false);
  line.disturb({kHoldsSpace, 150, 250});
  line.disturb({kCuts, 50, 200});
  EXPECT_TRUE(line.level(100));
  EXPECT_TRUE(line.level(199));
  EXPECT_EQ(line.falling_edge(0), 200) << "the cut ends on a line at space";
}

TEST(DisturbedLine, ForeverLastsForever) {
  Line line;
  line.disturb({kCuts, 50, kNever});
  line.drive(0, 100, false);
  line.forget(1'000'000);
  EXPECT_TRUE(line.level(2'000'000));
  EXPECT_EQ(line.falling_edge(0), kNever);
}

TEST(DisturbedLine, ForgettingThePastKeepsThePresentLevelAndInventsNoEdge) {
  Line line;
  line.drive(0, 50, false);
  line.drive(0, 300, true);
  line.disturb({kInverts, 60, 70});
  line.disturb({kInverts, 100, 5000});
  line.forget(1000);
  EXPECT_FALSE(line.level(1000));
  EXPECT_EQ(line.falling_edge(0), kNever);
  EXPECT_TRUE(line.level(5000));
  line.forget(6000);
  EXPECT_EQ(line, Line{});
}

TEST(DisturbedLine, EdgeAtTheInstantOfForgettingStays) {
  Line line;
  line.drive(0, 50, false);
  line.disturb({kInverts, 80, 100});
  line.forget(100);
  EXPECT_EQ(line.falling_edge(100), 100);
}

TEST(DisturbedLine, HealedLineIsAsItIsDriven) {
  Line line;
  line.drive(0, 100, false);
  line.disturb({kCuts, 50, kNever});
  line.disturb({kInverts, 500, 600});
  line.heal(300);
  EXPECT_TRUE(line.level(299));
  EXPECT_FALSE(line.level(300));
  EXPECT_FALSE(line.level(550));
}

// --- drivers that disagree, with levels left to chance ---

constexpr Time kEdge = 10;  // from one edge of a driver to its next one
constexpr int kEdges = 100;

/// Space and mark in turn, from `at` on; the driver is on all the while.
void drive_in_turn(Line& line, int driver, Time at) {
  for (int i = 0; i <= kEdges; ++i) line.drive(driver, at + i * kEdge, i % 2 != 0 || i == kEdges);
  line.occupy(driver, at, at + kEdges * kEdge);
}

/// On, at mark.
void hold_mark(Line& line, int driver, Time until = kEdges * kEdge) { line.occupy(driver, 0, until); }

/// How many of the spaces of drive_in_turn() a listener finds at mark, of those that begin in [from, to).
int spaces_lost(const Line& line, int listener, Time from = 0, Time to = kEdges * kEdge) {
  int lost = 0;
  for (Time at = from; at < to; at += 2 * kEdge) lost += line.level(at + kEdge / 2, listener);
  return lost;
}

TEST(ContestedLine, DriversThatDisagreeGiveMarkOrSpaceByChance) {
  Line line;
  line.leave_contention_to_chance(1);
  hold_mark(line, 0);
  drive_in_turn(line, 1, 0);
  EXPECT_GT(spaces_lost(line, 2), 10);
  EXPECT_LT(spaces_lost(line, 2), 40);
}

TEST(Line, SinceWhenTheCableIsCutIsKnownUntilItIsWholeAgain) {
  Line line;
  EXPECT_FALSE(line.separation(0));
  line.separate(100, 0b1010);
  line.separate(300, 0);
  EXPECT_FALSE(line.separation(99));
  ASSERT_TRUE(line.separation(100));
  EXPECT_EQ(line.separation(299)->at, 100);
  EXPECT_EQ(line.separation(299)->far, 0b1010u);
  EXPECT_FALSE(line.separation(300));
  line.forget(200);
  EXPECT_EQ(line.separation(200)->at, 100) << "in force, however long ago it began";
}

TEST(ContestedLine, DriversOnDifferentPartsOfACutCableDoNotDisagree) {
  Line line;
  line.leave_contention_to_chance(1);
  line.separate(0, 0b1010);
  hold_mark(line, 0);
  drive_in_turn(line, 1, 0);
  EXPECT_EQ(spaces_lost(line, 3), 0) << "with the one that sends";
  EXPECT_EQ(spaces_lost(line, 2), kEdges / 2) << "with the one that is at mark: nothing is heard";
}

TEST(ContestedLine, DriversThatDisagreeOnOnePartAreNotHeardOnTheOther) {
  for (const std::uint32_t far : {0b0111U, 0b11000U}) {
    Line line;
    line.leave_contention_to_chance(1);
    line.separate(0, far);
    hold_mark(line, 0);
    drive_in_turn(line, 1, 0);
    drive_in_turn(line, 3, 0);
    EXPECT_GT(spaces_lost(line, 2), 10);
    EXPECT_EQ(spaces_lost(line, 4), 0);
  }
}

TEST(ContestedLine, ACutInTheMiddleOfACharacterEndsTheDisagreementAndMendingBringsItBack) {
  constexpr Time kCut = 30 * kEdge, kMended = 60 * kEdge;
  Line line;
  line.leave_contention_to_chance(1);
  hold_mark(line, 0);
  drive_in_turn(line, 1, 0);
  line.separate(kCut, 0b1010);
  line.separate(kMended, 0);
  EXPECT_GT(spaces_lost(line, 3, 0, kCut), 2);
  EXPECT_EQ(spaces_lost(line, 3, kCut, kMended), 0);
  EXPECT_GT(spaces_lost(line, 3, kMended), 2);
}

TEST(ContestedLine, ADriverThatLosesPowerDisagreesNoMore) {
  constexpr Time kOff = 30 * kEdge;
  Line line;
  line.leave_contention_to_chance(1);
  hold_mark(line, 0);
  drive_in_turn(line, 1, 0);
  line.release(0, kOff);
  EXPECT_GT(spaces_lost(line, 2, 0, kOff), 2);
  EXPECT_EQ(spaces_lost(line, 2, kOff), 0);
}

TEST(ContestedLine, HealingALineLeavesItsDriversAsTheyAre) {
  Line line;
  line.leave_contention_to_chance(1);
  hold_mark(line, 0);
  drive_in_turn(line, 1, 0);
  const int lost = spaces_lost(line, 2);
  line.disturb({.effect = Disturbance::Effect::Inverts, .from = 10'000, .to = 20'000});
  line.heal(0);
  EXPECT_EQ(spaces_lost(line, 2), lost);
}

TEST(DisturbedLine, TellsWhoeverListens) {
  Line line;
  Listener listener;
  line.attach(listener);
  line.disturb({kInverts, 70, 80});
  EXPECT_EQ(listener.told, 70);
  line.disturb({kInverts, 90, 90});
  EXPECT_EQ(listener.told, 70) << "nothing happens";
  line.heal(75);
  EXPECT_EQ(listener.told, 75);
}

/// What the line should be at, from the list of all that was done to it.
bool expected_level(bool driven, const std::vector<Disturbance>& disturbances, Time at) {
  bool mark = driven;
  for (const auto effect : {kInverts, kHoldsSpace, kCuts})
    for (const Disturbance& d : disturbances)
      if (d.effect == effect && d.from <= at && at < d.to) mark = effect == kInverts ? !mark : effect == kCuts;
  return mark;
}

TEST(DisturbedLine, IsAtTheLevelThatAllDisturbancesTogetherLeaveAndFallsWhereThatFalls) {
  std::mt19937_64 random(1);
  const auto below = [&](std::uint64_t end) { return static_cast<Time>(random() % end); };
  for (int round = 0; round < 3000; ++round) {
    Line driven;
    for (int driver = 0; driver < 2; ++driver) {
      Time at = 0;
      for (int edge = 0; edge < 6; ++edge) driven.drive(driver, at += 1 + below(8), edge % 2 != 0);
    }
    Line line = driven;
    std::vector<Disturbance> disturbances;
    for (Time count = below(7); count > 0; --count) {
      const Time from = below(40), length = 1 + below(15);
      disturbances.push_back({static_cast<Disturbance::Effect>(below(3)), from, below(20) == 0 ? kNever : from + length});
      line.disturb(disturbances.back());
    }
    if (below(8) == 0) {
      const Time healed = below(50);
      line.heal(healed);
      for (Disturbance& d : disturbances) d.to = std::min(d.to, healed);
    }
    const Time forgotten = below(30);
    line.forget(forgotten);
    const auto level = [&](Time at) { return expected_level(driven.level(at), disturbances, at); };
    Time next = kNever;
    for (Time at = 70; at > forgotten; --at) {
      ASSERT_EQ(line.level(at), level(at)) << "round " << round << " at " << at;
      if (!level(at) && level(at - 1)) next = at;
      ASSERT_EQ(line.falling_edge(at), next) << "round " << round << " from " << at;
    }
  }
}

}  // namespace
}  // namespace s7200::serial::line_test
