// What `--timeline` shows of an exchange, and that it keeps no more than that.
#include "tools/views/timeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/support/slave_bench.hpp"

namespace s7200::tools::timeline_test {
namespace {

using Kind = TimelineRow::Kind;

constexpr std::uint8_t kReceived = 8, kTimed = 10;

class TimelineOf : public testing::Test {
 protected:
  void SetUp() override { timeline_.begin(); }

  void character(Time at, TraceKind kind = TraceKind::CharacterReceived) {
    timeline_.record({.at = at, .kind = kind, .byte = 0x55, .since = at - kMillisecond});
    if (kind == TraceKind::CharacterReceived)
      timeline_.record({.at = at, .kind = TraceKind::EventOccurred, .event = kReceived});
  }
  /// An interrupt that begins `waited` after its event and takes 10 us.
  void service(Time event, std::uint8_t number, Time waited) {
    timeline_.record({.at = event + waited, .kind = TraceKind::ServiceBegin, .event = number, .routine = 1, .since = event});
    timeline_.record({.at = event + waited + 10 * kMicrosecond,
                      .kind = TraceKind::ServiceEnd,
                      .event = number,
                      .routine = 1,
                      .since = event + waited});
  }

  Timeline timeline_{test::compile("MEND\n"), nullptr};
};

TEST_F(TimelineOf, TheLineOfTheProgramStandsBesideXmtAndSmb30) {
  timeline_.record({.at = 1, .kind = TraceKind::Transmit, .op = 0, .count = 3});
  timeline_.record({.at = 2, .kind = TraceKind::PortControl, .byte = 9, .op = 0});
  const TimelineReport report = timeline_.report();
  ASSERT_EQ(report.rows.size(), 2U);
  EXPECT_EQ(report.rows[0].why, "line 1: MEND");
  EXPECT_TRUE(report.rows[1].text.ends_with("  line 1: MEND")) << report.rows[1].text;
}

TEST_F(TimelineOf, ScansAreCountedAndNotKept) {
  for (int scan = 0; scan <= 1'000'000; ++scan)
    timeline_.record({.at = scan * kMillisecond, .kind = TraceKind::ScanBegin, .count = static_cast<std::uint64_t>(scan)});
  const TimelineReport report = timeline_.report();
  EXPECT_TRUE(report.rows.empty());
  EXPECT_EQ(report.scans, 1'000'000U);
  EXPECT_EQ(report.shortest_scan, kMillisecond);
}

TEST_F(TimelineOf, AWaitForEniOrForAnotherRoutineSaysSo) {
  timeline_.record({.kind = TraceKind::ModeChange, .code = 1});
  timeline_.record({.at = kMillisecond, .kind = TraceKind::EventOccurred, .event = kTimed});
  timeline_.record({.at = 2 * kMillisecond, .kind = TraceKind::Enable, .code = 1});
  service(kMillisecond, kTimed, kMillisecond);
  character(2 * kMillisecond + 5 * kMicrosecond);
  service(2 * kMillisecond + 5 * kMicrosecond, kReceived, 5 * kMicrosecond);
  const TimelineReport report = timeline_.report();
  ASSERT_EQ(report.rows.size(), 3U);
  EXPECT_EQ(report.rows[1].why, "no ENI until ENI in line 1");
  EXPECT_EQ(report.rows[2].why, "INT 1 of event 10 until then");
}

TEST_F(TimelineOf, CharactersInARowAreOneRowAndTheirInterruptsToo) {
  for (Time at = kMillisecond; at <= 3 * kMillisecond; at += kMillisecond) {
    character(at);
    service(at, kReceived, at == kMillisecond ? 5 * kMicrosecond : 0);
  }
  const TimelineReport report = timeline_.report();
  ASSERT_EQ(report.rows.size(), 1U);
  EXPECT_EQ(report.rows[0].characters.size(), 3U);
  EXPECT_EQ(report.rows[0].served, 3U);
  EXPECT_EQ(report.rows[0].longest_wait, 5 * kMicrosecond);
}

TEST_F(TimelineOf, OfTooManyRowsTheFirstAndTheLastAreShown) {
  constexpr std::size_t kRows = 100'000;
  for (std::size_t row = 0; row < kRows; ++row) {
    const Time at = static_cast<Time>(row + 1) * kMillisecond;
    timeline_.record({.at = at, .kind = TraceKind::EventOccurred, .event = kTimed, .routine = 1});
    service(at, kTimed, 0);
    timeline_.record({.at = at, .kind = TraceKind::Transmit, .count = 1});
  }
  const TimelineReport report = timeline_.report();
  ASSERT_EQ(report.rows.size(), TimelineReport::kMostRows + 1);
  const TimelineRow& left_out = report.rows[TimelineReport::kMostRows / 2];
  EXPECT_EQ(left_out.kind, Kind::LeftOut);
  EXPECT_EQ(left_out.text, "… 199000 rows left out");
  EXPECT_EQ(left_out.at, 251 * kMillisecond);
  EXPECT_EQ(report.rows.front().at, kMillisecond);
  EXPECT_EQ(report.rows.back().at, static_cast<Time>(kRows) * kMillisecond);
  EXPECT_EQ(report.served, kRows);
  const auto json = to_json(report, {});
  EXPECT_EQ(json[TimelineReport::kMostRows / 2]["kind"], "left out");
}

TEST_F(TimelineOf, OfTooManyCharactersTheFirstAreShownAndAllAreCounted) {
  for (Time at = 1; at <= 10'000; ++at) character(at, TraceKind::CharacterSent);
  const TimelineReport report = timeline_.report();
  ASSERT_EQ(report.rows.size(), 1U);
  EXPECT_EQ(report.rows[0].characters.size() + report.rows[0].more_characters, 10'000U);
  EXPECT_LE(report.rows[0].characters.size(), TimelineRow::kMostCharacters);
  EXPECT_NE(to_text(report, {}, false).find("… 10000"), std::string::npos);
}

TEST_F(TimelineOf, AnInterruptFindsItsEventHoweverMuchWasSentMeanwhile) {
  timeline_.record({.at = kMillisecond, .kind = TraceKind::EventOccurred, .event = kTimed, .routine = 1});
  for (Time at = kMillisecond + 1; at <= kMillisecond + 500; ++at) character(at, TraceKind::CharacterSent);
  service(kMillisecond, kTimed, 600);
  const TimelineReport report = timeline_.report();
  EXPECT_EQ(report.rows.front().served, 1U);
  EXPECT_EQ(report.longest_wait, 600);
}

TEST_F(TimelineOf, EachPortHasItsOwnRows) {
  for (const std::uint8_t port : std::array<std::uint8_t, 3>{0, 1, 1}) {
    timeline_.record({.at = kMillisecond, .kind = TraceKind::CharacterSent, .byte = 0x41, .port = port});
    timeline_.record({.at = kMillisecond, .kind = TraceKind::CharacterIgnored, .byte = 0x42, .port = port});
  }
  const std::string text = to_text(timeline_.report(), {}, false);
  for (const char* row : {" sent      41", " port 1 sent      41", "event 8 is not attached", "event 25 is not attached"})
    EXPECT_NE(text.find(row), std::string::npos) << row << text;
  const auto json = to_json(timeline_.report(), {});
  EXPECT_FALSE(json[0].contains("port"));
  EXPECT_EQ(json[2]["port"], 1);
}

TEST_F(TimelineOf, WhatRcvDropsIsARowOfItsOwn) {
  character(1 * kMillisecond, TraceKind::CharacterDropped);
  character(2 * kMillisecond, TraceKind::CharacterDropped);
  character(3 * kMillisecond, TraceKind::CharacterReceived);
  timeline_.record({.at = 3 * kMillisecond, .kind = TraceKind::ReceiveEnd, .byte = 2, .count = 1});
  const TimelineReport report = timeline_.report();
  ASSERT_EQ(report.rows.size(), 3U);
  EXPECT_EQ(report.rows[0].characters.size(), 2U);
  const std::string text = to_text(report, {}, false);
  EXPECT_NE(text.find("RCV waits for the start of a message"), std::string::npos) << text;
  EXPECT_NE(text.find("RCV ends: 1 character, status 16#02"), std::string::npos) << text;
  EXPECT_EQ(to_json(report, {})[0]["kind"], "dropped");
}

TEST_F(TimelineOf, WhatHappensAfterTheEndIsNotShown) {
  character(kMillisecond, TraceKind::CharacterSent);
  timeline_.end();
  timeline_.record({.at = 2 * kMillisecond, .kind = TraceKind::EventLost, .event = kTimed});
  EXPECT_EQ(timeline_.report().rows.size(), 1U);
}

/// An exchange with our slave, seen from every instruction.
TimelineReport report_of(const std::string& frame) {
  test::SlaveBench bench(test::slave_text());
  bench.start();
  Timeline timeline(test::compile(test::slave_text()), nullptr, Timeline::Looks::AtInstructions);
  bench.cpu().set_sink(&timeline);
  timeline.begin();
  bench.send({.frame = serial::parse_hex_frame(frame).frame, .timeout = 100 * kMillisecond});
  timeline.end();
  bench.cpu().set_sink(nullptr);
  return timeline.report();
}

std::vector<TimelineRow> rows_of(const TimelineReport& report, Kind kind) {
  std::vector<TimelineRow> rows;
  std::ranges::copy_if(report.rows, std::back_inserter(rows), [&](const TimelineRow& row) { return row.kind == kind; });
  return rows;
}

TEST(TimelineOfInstructions, TheScanThatAnswersShowsItsWay) {
  const auto ways = rows_of(report_of("0103000a0001a408"), Kind::Way);
  ASSERT_EQ(ways.size(), 1U);
  EXPECT_TRUE(ways[0].text.starts_with("main program: network 2, CALL 51 in line ")) << ways[0].text;
  EXPECT_NE(ways[0].text.find("CALL 63 in line 138, network 7"), std::string::npos) << ways[0].text;
}

TEST(TimelineOfInstructions, AFrameWithoutAnswerSaysWhatDecidedThat) {
  const TimelineReport report = report_of("0103000a00010000");
  const auto rows = rows_of(report, Kind::Unanswered);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].text, "no answer to 8 characters");
  EXPECT_TRUE(rows[0].why.starts_with("JMP 255 in line 141 (LDW= AC0, 0: ")) << rows[0].why;
  const auto json = to_json(report, {});
  EXPECT_TRUE(std::ranges::any_of(json, [](const auto& row) { return row["kind"] == "unanswered" && row.contains("why"); }));
  EXPECT_TRUE(rows_of(report_of("0103000a0001a408"), Kind::Unanswered).empty());
}

/// Sends two characters and hears nothing meanwhile.
TEST(TimelineOfInstructions, ACharacterThatComesWhileThePortSendsSaysThatItsReceiverIsOff) {
  test::SlaveBench bench(test::slave_text());
  bench.start();
  Timeline timeline(test::compile(test::slave_text()), nullptr, Timeline::Looks::AtInstructions);
  bench.cpu().set_sink(&timeline);
  timeline.begin();
  serial::Simulation& simulation = bench.simulation();
  simulation.master().start({.frame = serial::parse_hex_frame("0103000a0001a408").frame}, simulation.time());
  while (!bench.state().port[0].transmitting) simulation.run_until(simulation.time() + 100 * kMicrosecond);
  simulation.host_port().attach({9600, 8, Parity::Even, 1}, simulation.time());
  const serial::HostCharacter character{.byte = 0x55, .format = {9600, 8, Parity::Even, 1}};
  simulation.host_port().send({&character, 1}, simulation.time());
  bench.run_for(20 * kMillisecond);
  const auto rows = rows_of(timeline.report(), Kind::Ignored);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].why, "the receiver is off while the port sends");
  EXPECT_EQ(rows[0].characters[0].byte, 0x55);
  bench.cpu().set_sink(nullptr);
}

TEST(TimelineOfStations, RowsAreInTheOrderOfTimeWithTheNameOfEachBesideThem) {
  const auto sent = [](Time at) { return TimelineRow{.at = at, .kind = Kind::Sent, .characters = {{.byte = 0x41}}}; };
  const std::vector<StationTimeline> stations{{"master", {.rows = {sent(1 * kMillisecond), sent(3 * kMillisecond)}}},
                                              {"slave12", {.rows = {sent(2 * kMillisecond)}}}};
  const std::string text = to_text(stations, {}, false);
  const auto first = text.find("master   sent"), second = text.find("slave12  sent"), third = text.rfind("master   sent");
  ASSERT_NE(second, std::string::npos) << text;
  EXPECT_TRUE(first < second && second < third) << text;
  EXPECT_NE(text.find("ms  station  at the port"), std::string::npos) << text;
  const auto json = to_json(stations, {});
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[1]["station"], "slave12");
  EXPECT_FALSE(to_json(stations[0].report, {})[0].contains("station")) << "one that is alone needs no name";
}

}  // namespace
}  // namespace s7200::tools::timeline_test
