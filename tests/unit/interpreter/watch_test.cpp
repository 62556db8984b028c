// How closely sinks look at instructions, and who is told of them.
#include "interpreter/trace/fan_out.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::watch_test {
namespace {

/// Keeps what it is told of instructions.
class Watcher final : public TraceSink {
 public:
  explicit Watcher(Watch closely) : closely_(closely) {}
  bool before(std::uint32_t) override {
    ++asked;
    return true;
  }
  void instruction(const InstructionRecord& record) override { told.push_back(record); }
  bool wants_instructions() const override { return wants; }
  Watch watch() const override { return closely_; }

  bool wants = true;
  int asked = 0;
  std::vector<InstructionRecord> told;

 private:
  Watch closely_;
};

constexpr std::string_view kProgram =
    "LD SM0.0\nAW= VW0, 7\n= M0.0\nMOVW VW0, VW2\nLDN M0.0\n+I 1, VW2\nATCH 0, 10\nMEND\nINT 0\nLD SM0.0\nINCW VW4\nRETI\n";

State after_scans(TraceSink* sink) {
  Plc plc(kProgram);
  plc.set("VW0", 7);
  plc.cpu.set_sink(sink);
  plc.run_scans(2);
  return plc.cpu.state();
}

TEST(WatchTest, WhoLooksAtTheFlowIsToldWhatContactsSawAndNoOtherValues) {
  Watcher flow(Watch::Flow);
  after_scans(&flow);
  ASSERT_EQ(flow.told.size(), 16U);
  EXPECT_EQ(flow.told[0].value[0], 1U);
  EXPECT_EQ(flow.told[1].value[0], 7U);
  EXPECT_EQ(flow.told[1].value[1], 7U);
  EXPECT_TRUE(flow.told[2].top);
  EXPECT_TRUE(flow.told[3].powered);
  EXPECT_EQ(flow.told[4].value[0], 1U);
  EXPECT_FALSE(flow.told[5].powered);
  for (const std::size_t other : {2U, 3U, 5U, 6U, 7U})
    for (const auto& value : flow.told[other].value) EXPECT_FALSE(value) << other;
}

TEST(WatchTest, WhoLooksAtValuesIsToldThoseOfBoxesAndCoilsToo) {
  Watcher values(Watch::Values);
  after_scans(&values);
  EXPECT_EQ(values.told[2].value[0], 1U);
  EXPECT_EQ(values.told[3].value[0], 7U);
  EXPECT_EQ(values.told[3].value[1], 7U) << "after it";
}

TEST(WatchTest, OnlyWhoMayStopTheCpuIsAskedBefore) {
  Watcher flow(Watch::Flow), values(Watch::Values), stops(Watch::Stops);
  for (Watcher* sink : {&flow, &values, &stops}) after_scans(sink);
  EXPECT_EQ(flow.asked, 0);
  EXPECT_EQ(values.asked, 0);
  EXPECT_EQ(stops.asked, 16);
}

TEST(WatchTest, HowCloselyItIsWatchedChangesNothingOfTheRun) {
  const State alone = after_scans(nullptr);
  for (const Watch closely : {Watch::Flow, Watch::Values, Watch::Stops}) {
    Watcher sink(closely);
    EXPECT_EQ(after_scans(&sink), alone);
  }
}

TEST(WatchTest, OfSeveralTheOneThatLooksClosestCountsAndAllAreTold) {
  Watcher flow(Watch::Flow), stops(Watch::Stops);
  FanOut all;
  all.add(&flow);
  all.add(&stops);
  EXPECT_EQ(all.watch(), Watch::Stops);
  EXPECT_EQ(&all.watcher(), &all);
  after_scans(&all);
  EXPECT_EQ(flow.told.size(), 16U);
  EXPECT_EQ(stops.told.size(), 16U);
}

TEST(WatchTest, TheOnlyOneThatWantsInstructionsIsToldOfThemDirectly) {
  Watcher flow(Watch::Flow), stops(Watch::Stops);
  stops.wants = false;
  FanOut inner, all;
  inner.add(&flow);
  all.add(&stops);
  all.add(&inner);
  EXPECT_EQ(all.watch(), Watch::Flow);
  EXPECT_EQ(&all.watcher(), &flow);
  after_scans(&all);
  EXPECT_EQ(flow.told.size(), 16U);
  EXPECT_TRUE(stops.told.empty());
}

}  // namespace
}  // namespace s7200::test::watch_test
