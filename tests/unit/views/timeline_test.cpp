// What `--timeline` shows of an exchange, and that it keeps no more than that.
#include "tools/views/timeline.hpp"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tests/support/slave_bench.hpp"

namespace s7200::tools {
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
  EXPECT_NE(text.find("RCV ends: 1 characters, status 16#02"), std::string::npos) << text;
  EXPECT_EQ(to_json(report, {})[0]["kind"], "dropped");
}

TEST_F(TimelineOf, WhatHappensAfterTheEndIsNotShown) {
  character(kMillisecond, TraceKind::CharacterSent);
  timeline_.end();
  timeline_.record({.at = 2 * kMillisecond, .kind = TraceKind::EventLost, .event = kTimed});
  EXPECT_EQ(timeline_.report().rows.size(), 1U);
}

}  // namespace
}  // namespace s7200::tools
