#include "serial_sim/line/wire_tap.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "serial_sim/line/uart.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::serial {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};

struct Record final : WireSink {
  std::vector<std::string> edges;
  Time until = 0;

  void edge(Wire wire, Time at, bool mark) override {
    EXPECT_GE(at, until) << "told before as settled";
    edges.push_back(fmt::format("{} {}{}", at, wire == Wire::Rx ? "rx" : "tx", mark ? '1' : '0'));
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
}  // namespace s7200::serial
