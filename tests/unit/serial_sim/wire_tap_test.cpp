#include "serial_sim/line/wire_tap.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/line/uart.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::serial::wire_tap_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

std::string text_of(Wire wire, Time at, bool mark) {
  constexpr std::array<std::string_view, kWires> kNames{"rx", "tx", "line"};
  return fmt::format("{} {}{}", at, kNames[static_cast<std::size_t>(wire)], mark ? '1' : '0');
}

/// Both directions; the line apart.
struct Record final : WireSink {
  std::vector<std::string> edges, line;
  Time until = 0;

  std::vector<int> drivers, line_drivers;  ///< of the edges to space

  void edge(Wire wire, Time at, bool mark, int driver) override {
    EXPECT_GE(at, until) << "told before as settled";
    if (!mark) (wire == Wire::Line ? line_drivers : drivers).push_back(driver);
    (wire == Wire::Line ? line : edges).push_back(text_of(wire, at, mark));
  }
  void settled(Time now, const SerialFormat&) override {
    EXPECT_GE(now, until);
    until = now;
  }
  void finish() override {}
};

struct Probe {
  Line line;
  WireTap tap{line, 0};
  Record record;
  Probe() { tap.watch(&record, 0); }
};

using Edges = std::vector<std::string>;

TEST(WireTap, EdgesOfSeveralDriversComeInTheOrderOfTime) {
  Probe probe;
  probe.line.drive(0, 100, false);
  probe.line.drive(0, 300, true);
  probe.line.drive(1, 50, false);
  probe.line.drive(1, 200, true);
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.edges, (Edges{"50 rx0", "100 tx0", "200 rx1", "300 tx1"}));
}

TEST(WireTap, AnEdgeWaitsUntilItIsDue) {
  Probe probe;
  probe.line.drive(1, 50, false);
  probe.line.drive(1, 200, true);
  probe.tap.settle(200, k8E1);
  EXPECT_EQ(probe.record.edges, (Edges{"50 rx0"}));
  probe.tap.settle(201, k8E1);
  EXPECT_EQ(probe.record.edges, (Edges{"50 rx0", "200 rx1"}));
}

TEST(WireTap, RxIsSpaceWhileAnyOtherDriverIs) {
  Probe probe;
  probe.line.drive(1, 100, false);
  probe.line.drive(2, 150, false);
  probe.line.drive(1, 200, true);
  probe.line.drive(2, 250, true);
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.edges, (Edges{"100 rx0", "250 rx1"}));
}

TEST(WireTap, EdgesAtOneInstantAreOneChangeOfEachWire) {
  Probe probe;
  probe.line.drive(1, 100, false);
  probe.line.drive(1, 200, true);
  probe.line.drive(2, 200, false);
  probe.line.drive(0, 200, false);
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.edges, (Edges{"100 rx0", "200 tx0"}));
}

TEST(WireTap, AnEdgeToSpaceSaysWhoDrivesTheLineThere) {
  Probe probe;
  probe.line.drive(3, 100, false);
  probe.line.drive(3, 200, true);
  probe.line.drive(0, 300, false);
  probe.line.drive(0, 400, true);
  probe.line.drive(1, 500, false);
  probe.line.drive(3, 550, false);
  probe.line.drive(1, 600, true);
  probe.line.drive(3, 650, true);
  probe.line.disturb({Disturbance::Effect::HoldsSpace, 700, 800});
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.drivers, (std::vector<int>{3, 0, 1, Line::kNobody}));
}

TEST(WireTap, TheLineIsWhatAllMakeOfItAndSaysWhoHoldsItAtSpace) {
  Probe probe;
  probe.line.drive(0, 100, false);
  probe.line.drive(1, 150, false);
  probe.line.drive(0, 200, true);
  probe.line.drive(1, 250, true);
  probe.line.drive(0, 400, false);
  probe.line.drive(1, 420, false);
  probe.line.drive(1, 440, true);
  probe.line.drive(0, 600, true);
  probe.line.drive(1, 700, false);
  probe.line.drive(1, 800, true);
  probe.line.disturb({Disturbance::Effect::Inverts, 450, 500});
  probe.line.disturb({Disturbance::Effect::HoldsSpace, 900, 950});
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.line, (Edges{"100 line0", "250 line1", "400 line0", "450 line1", "500 line0", "600 line1",
                                      "700 line0", "800 line1", "900 line0", "950 line1"}));
  EXPECT_EQ(probe.record.line_drivers, (std::vector<int>{0, 0, 0, 1, Line::kNobody}));
}

TEST(WireTap, TheLineIsThatOfItsPartOfTheCable) {
  Probe probe;
  probe.line.separate(50, 0b100);
  probe.line.drive(2, 100, false);
  probe.line.drive(1, 150, false);
  probe.line.drive(1, 200, true);
  probe.line.drive(2, 250, true);
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.line, (Edges{"150 line0", "200 line1"}));
}

TEST(WireTap, WhatBefallsTheLineIsOnRx) {
  Probe probe;
  probe.line.drive(0, 100, false);
  probe.line.drive(0, 400, true);
  probe.line.drive(1, 500, false);
  probe.line.drive(1, 900, true);
  probe.line.disturb({Disturbance::Effect::Inverts, 200, 300});
  probe.line.disturb({Disturbance::Effect::Cuts, 600, 700});
  probe.tap.settle(1000, k8E1);
  EXPECT_EQ(probe.record.edges,
            (Edges{"100 tx0", "200 rx0", "300 rx1", "400 tx1", "500 rx0", "600 rx1", "700 rx0", "900 rx1"}));
}

TEST(WireTap, WhatWasBeforeItWatchedIsNotTold) {
  Line line;
  WireTap tap(line, 0);
  Record record;
  line.drive(1, 50, false);
  line.drive(1, 100, true);
  line.drive(1, 200, false);
  tap.watch(&record, 150);
  tap.settle(1000, k8E1);
  EXPECT_EQ(record.edges, (Edges{"200 rx0"}));
}

TEST(WireTap, ALevelThatBeganBeforeItWatchedIsToldFromThere) {
  Line line;
  WireTap tap(line, 0);
  Record record;
  line.drive(1, 50, false);
  line.drive(1, 300, true);
  tap.watch(&record, 150);
  tap.settle(1000, k8E1);
  EXPECT_EQ(record.edges, (Edges{"150 rx0", "300 rx1"}));
}

TEST(WireTap, ASinkThatWatchesWhileTheLineGoesBackIsToldWhatDiffersFromWhatItWasToldLast) {
  struct Levels final : WireSink {
    std::vector<std::string> edges;
    void edge(Wire wire, Time at, bool mark, int) override {
      if (wire != Wire::Line) edges.push_back(text_of(wire, at, mark));
    }
    void settled(Time, const SerialFormat&) override {}
    void finish() override {}
  } levels;
  Line line;
  WireTap tap(line, 0);
  tap.watch(&levels, 0);
  line.drive(1, 100, false);
  tap.settle(150, k8E1);
  const Line at_space = line;
  line.drive(1, 200, true);
  tap.settle(250, k8E1);
  line = at_space;
  tap.go_back(150);
  line.drive(1, 300, true);
  tap.settle(400, k8E1);
  EXPECT_EQ(levels.edges, (Edges{"100 rx0", "200 rx1", "150 rx0", "300 rx1"}));
  line = at_space;
  tap.go_back(150);
  tap.settle(250, k8E1);
  levels.edges.clear();
  line = at_space;
  tap.go_back(150);
  tap.settle(250, k8E1);
  EXPECT_TRUE(levels.edges.empty()) << "it knows that the line is at space";
}

TEST(WireTap, NothingTellsThatTheLineIsWatched) {
  test::SlaveBench plain(test::slave_text()), watched(test::slave_text());
  Record record;
  watched.simulation().set_wire_sink(&record);
  for (test::SlaveBench* bench : {&plain, &watched}) {
    bench->simulation().power_up();
    bench->simulation().run_until(kSecond);
    bench->ask_raw("0103000a0002e409");
    bench->ask_raw("01030000007d85eb");
  }
  EXPECT_GT(record.edges.size(), 500U);
  EXPECT_EQ(record.until, watched.simulation().time());
  EXPECT_TRUE(plain.simulation().snapshot() == watched.simulation().snapshot());
}

TEST(WireTap, HowOftenTheSimulationComesBackChangesNothing) {
  Record whole, sliced;
  for (auto [record, slice] : {std::pair{&whole, 10 * kSecond}, std::pair{&sliced, 37 * kMicrosecond}}) {
    test::SlaveBench bench(test::slave_text());
    bench.simulation().set_wire_sink(record);
    bench.simulation().power_up();
    bench.simulation().configure_master(k8E1);
    bench.simulation().master().start({.frame = serial::parse_hex_frame("0103000a0002e409").frame}, 200 * kMillisecond);
    while (bench.simulation().time() < kSecond)
      bench.simulation().run_until(std::min(kSecond, bench.simulation().time() + slice));
  }
  EXPECT_GT(whole.edges.size(), 50U);
  EXPECT_EQ(whole.edges, sliced.edges);
}

}  // namespace
}  // namespace s7200::serial::wire_tap_test
