#include "serial_sim/modbus/line_turns.hpp"

#include <gtest/gtest.h>

#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus::line_turns_test {
namespace {

const Bytes kAnswer = rtu_frame(1, Bytes{3, 2, 0, 7});

/// A line that takes 10 ms for a request; the slave answers after 5 ms, or not at all.
struct Bench {
  LineTurns turns{kSecond};
  LineTurns::Line line{.now = kSecond, .format = {9600, 8, Parity::Even, 1}, .quiet_time = kMillisecond};
  bool slave_answers = true;
  Time sent_at = 0;
  std::vector<std::uint64_t> sent;  ///< the tags, which the frames carry as their station
  std::vector<LineTurns::Outcome> outcomes;

  void ask(std::uint64_t client, std::uint64_t tag, bool wants_answer = true) {
    turns.ask(client, {rtu_frame(static_cast<std::uint8_t>(tag), Bytes{3}), wants_answer, tag});
  }
  void run(Time time) {
    for (const Time end = line.now + time; line.now < end;) step();
  }
  void step() {
    line.now += kMillisecond;
    if (line.sending && line.now >= sent_at + 10 * kMillisecond) {
      line.sending = false;
      line.quiet_since = line.now;
    }
    if (slave_answers && sent_at != 0 && line.now == sent_at + 15 * kMillisecond)
      for (const std::uint8_t byte : kAnswer) {
        turns.received({.byte = byte, .start = line.now}, line.format);
        line.quiet_since = line.now;
      }
    const Bytes frame = turns.turn(line);
    if (!frame.empty()) {
      sent.push_back(frame[0]);
      sent_at = line.now;
      line.sending = true;
    }
    for (auto& outcome : turns.take_outcomes()) outcomes.push_back(std::move(outcome));
  }
};

TEST(LineTurns, ABroadcastLeavesTheSlavesTimeAndThenTheLineQuiet) {
  Bench bench;
  bench.line.quiet_time = 50 * kMillisecond;  // as at a low rate
  bench.ask(1, 1, false);
  bench.ask(1, 2);
  bench.run(50 * kMillisecond);
  const Time broadcast = bench.sent_at;
  bench.run(kSecond);
  EXPECT_EQ(bench.sent, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(bench.sent_at, broadcast + 10 * kMillisecond + LineTurns::kTurnaround + bench.line.quiet_time);
}

TEST(LineTurns, AfterARequestInVainTheLineIsLeftQuietOnceMore) {
  Bench bench;
  bench.slave_answers = false;
  bench.line.quiet_time = 50 * kMillisecond;
  bench.ask(1, 1);
  bench.ask(1, 2);
  bench.run(1050 * kMillisecond);
  const Time first = bench.sent_at;
  EXPECT_EQ(bench.sent.size(), 1U);
  bench.run(kSecond);
  EXPECT_EQ(bench.sent_at, first + 10 * kMillisecond + kSecond + bench.line.quiet_time);
}

TEST(LineTurns, WhatIsStillToGoOutIsKnown) {
  Bench bench;
  bench.ask(1, 11);
  bench.ask(1, 12);
  bench.ask(2, 21);
  EXPECT_EQ(bench.turns.waiting(1), 8U);
  EXPECT_TRUE(bench.turns.unsent(1));
  bench.run(5 * kMillisecond);  // one of each client, and the second of the first
  EXPECT_EQ(bench.turns.waiting(1), 4U);
  bench.run(32 * kMillisecond);
  EXPECT_EQ(bench.turns.waiting(1), 4U);
  EXPECT_EQ(bench.turns.waiting(2), 0U);
  bench.run(16 * kMillisecond);
  EXPECT_EQ(bench.turns.waiting(1), 0U);
  EXPECT_EQ(bench.turns.open(1), 1U);
  bench.run(kSecond);
  EXPECT_FALSE(bench.turns.unsent(1));
  EXPECT_EQ(bench.turns.waiting(3), 0U);
}

TEST(LineTurns, WhoStopsWaitingHearsNoAnswerWhereverItsRequestIs) {
  for (const Time when : {0, 5, 12, 16}) {  // in the queue, being sent, waiting for the answer, within the answer
    Bench bench;
    bench.ask(1, 11);
    bench.run(when * kMillisecond);
    EXPECT_EQ(bench.turns.stop_waiting(1), 1U) << when;
    EXPECT_EQ(bench.turns.stop_waiting(1), 0U) << when;
    EXPECT_EQ(bench.turns.open(1), 0U);
    bench.ask(1, 12);
    bench.run(kSecond);
    ASSERT_EQ(bench.outcomes.size(), 1U) << when;
    EXPECT_EQ(bench.outcomes[0].tag, 12U);
    EXPECT_EQ(bench.outcomes[0].answer, kAnswer);
    EXPECT_EQ(bench.sent.size(), when == 0 ? 1U : 2U);
  }
}

TEST(LineTurns, WhoStopsWaitingGivesUpNeitherBroadcastsNorWhatOthersAsk) {
  Bench bench;
  bench.ask(1, 11);
  bench.ask(1, 12, false);
  bench.ask(1, 13);
  bench.ask(2, 21);
  EXPECT_EQ(bench.turns.stop_waiting(1), 2U);
  bench.run(15 * kMillisecond);
  bench.ask(1, 14, false);
  bench.run(kSecond);
  EXPECT_EQ(bench.sent, (std::vector<std::uint64_t>{12, 21, 14}));
  EXPECT_EQ(bench.outcomes.size(), 3U);
  bench.ask(1, 15, false);
  bench.step();
  EXPECT_EQ(bench.turns.stop_waiting(1), 0U) << "a broadcast that is being sent";
  EXPECT_EQ(bench.turns.open(1), 1U);
}

TEST(LineTurns, ALateAnswerIsWaitedForThoughNoOneWantsIt) {
  Bench bench;
  bench.slave_answers = false;
  bench.ask(1, 11);
  bench.run(20 * kMillisecond);
  bench.turns.stop_waiting(1);
  bench.ask(2, 21);
  bench.run(LineTurns::kLateAnswer - 20 * kMillisecond);
  EXPECT_EQ(bench.sent.size(), 1U);
  bench.run(20 * kMillisecond);
  EXPECT_EQ(bench.sent.size(), 2U) << "but not for all of the timeout";
}

}  // namespace
}  // namespace s7200::modbus::line_turns_test
