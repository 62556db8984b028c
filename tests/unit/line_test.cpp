#include "serial_sim/line.hpp"

#include <gtest/gtest.h>

namespace s7200::serial {
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

}  // namespace
}  // namespace s7200::serial
