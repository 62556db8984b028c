#include "serial_sim/modbus/gateway.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus::gateway_test {
namespace {

using serial::to_hex;

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};
constexpr Time kTimeout = 100 * kMillisecond;
constexpr Time kQuiet = 20 * kMillisecond;

/// `00 01 | 00 00 | 00 06 | 01 | 03 00 00 00 02`
Bytes message(std::uint16_t transaction, std::uint8_t unit, const Bytes& pdu) { return to_bytes({transaction, unit, pdu}); }

/// A gateway and a line that takes 10 ms to send any frame and on which `slave` answers at once.
struct Bench {
  Gateway gateway{kTimeout};
  LineTurns::Line line{.now = kSecond, .format = k8E1, .quiet_time = kQuiet};
  Bytes slave;
  std::size_t error_at = SIZE_MAX;
  std::vector<Bytes> sent;
  std::vector<Time> sent_at;
  std::vector<Gateway::Answer> answers;
  Time sending_until = 0;

  void step(Time by = kMillisecond) {
    line.now += by;
    if (line.sending && line.now >= sending_until) {
      line.sending = false;
      line.quiet_since = sending_until;
      (void)gateway.turn(line);
      for (std::size_t i = 0; i < slave.size(); ++i) {
        gateway.received({.byte = slave[i], .parity_error = i == error_at, .start = line.now}, line.format);
        line.now += line.format.character_time();
        line.quiet_since = line.now;
      }
    }
    const Bytes frame = gateway.turn(line);
    if (!frame.empty()) {
      EXPECT_FALSE(line.sending);
      EXPECT_GE(line.now - line.quiet_since, kQuiet);
      sent.push_back(frame);
      sent_at.push_back(line.now);
      line.sending = true;
      sending_until = line.now + 10 * kMillisecond;
    }
    for (Gateway::Answer& answer : gateway.take_answers()) answers.push_back(std::move(answer));
  }
  void run(Time time) {
    for (const Time end = line.now + time; line.now < end;) step();
  }
  /// The only answer; empty if there are none or several.
  std::string answer() const { return answers.size() == 1 ? to_hex(answers[0].bytes) : ""; }
};

const Bytes kRead = read_holding_registers(0, 2);
const Bytes kReadAnswer = rtu_frame(1, Bytes{3, 4, 0, 1, 0, 2});

TEST(Gateway, PutsAnRtuFrameOnTheLineAndTheAnswerIntoAMessage) {
  Bench bench;
  bench.slave = kReadAnswer;
  bench.gateway.take(7, message(0x1234, 1, kRead));
  bench.run(100 * kMillisecond);
  ASSERT_EQ(bench.sent.size(), 1U);
  EXPECT_EQ(bench.sent[0], rtu_frame(1, kRead));
  EXPECT_EQ(bench.answer(), "12 34 00 00 00 07 01 03 04 00 01 00 02");
  EXPECT_EQ(bench.answers[0].client, 7U);
  EXPECT_EQ(bench.gateway.counts().answers, 1U);
  EXPECT_EQ(bench.gateway.open(7), 0U);
}

TEST(Gateway, AnAnswerMayBeginInTheSameStretchOfTimeInWhichItsRequestEnds) {
  Bench bench;
  bench.gateway.take(7, message(1, 1, kRead));
  bench.step();
  ASSERT_EQ(bench.sent.size(), 1U);
  bench.line.now += 200 * kMillisecond;
  bench.line.sending = false;
  bench.line.quiet_since = bench.line.now - 50 * kMillisecond;
  for (const std::uint8_t byte : kReadAnswer)
    bench.gateway.received({.byte = byte, .start = bench.line.quiet_since}, bench.line.format);
  bench.step();
  EXPECT_EQ(bench.answer(), "00 01 00 00 00 07 01 03 04 00 01 00 02");
}

TEST(Gateway, ExceptionsOfTheSlaveAreAnswersToo) {
  Bench bench;
  bench.slave = rtu_frame(1, Bytes{0x83, 2});
  bench.gateway.take(7, message(1, 1, kRead));
  bench.run(100 * kMillisecond);
  EXPECT_EQ(bench.answer(), "00 01 00 00 00 03 01 83 02");
}

TEST(Gateway, ASilentSlaveIsException0BWhenTheTimeIsOver) {
  Bench bench;
  bench.gateway.take(7, message(9, 1, kRead));
  bench.run(10 * kMillisecond + kTimeout - kMillisecond);
  EXPECT_TRUE(bench.answers.empty());
  bench.run(5 * kMillisecond);
  EXPECT_EQ(bench.answer(), "00 09 00 00 00 03 01 83 0b");
  EXPECT_EQ(bench.gateway.counts().silent, 1U);
}

TEST(Gateway, AnswersThatAreDamagedOrAnotherStationsAreException0B) {
  std::vector<Bytes> wrong{rtu_frame(2, Bytes{3, 4, 0, 1, 0, 2}), rtu_frame(1, Bytes{4, 4, 0, 1, 0, 2}), kReadAnswer,
                           Bytes{1}, Bytes(300, 1)};
  wrong[2].back() ^= 1;
  for (const Bytes& answer : wrong) {
    Bench bench;
    bench.slave = answer;
    bench.gateway.take(7, message(9, 1, kRead));
    bench.run(kSecond);
    EXPECT_EQ(bench.answer(), "00 09 00 00 00 03 01 83 0b") << to_hex(answer);
    EXPECT_EQ(bench.gateway.counts().damaged, 1U);
  }
  Bench bench;
  bench.slave = kReadAnswer;
  bench.error_at = 3;
  bench.gateway.take(7, message(9, 1, kRead));
  bench.run(kSecond);
  EXPECT_EQ(bench.answer(), "00 09 00 00 00 03 01 83 0b");
}

TEST(Gateway, UnitsThatNoSlaveMayHaveAreException0AAtOnce) {
  for (const std::uint8_t unit : {std::uint8_t{248}, std::uint8_t{255}}) {
    Bench bench;
    bench.gateway.take(7, message(1, unit, kRead));
    bench.step();
    EXPECT_EQ(bench.answer(), unit == 248 ? "00 01 00 00 00 03 f8 83 0a" : "00 01 00 00 00 03 ff 83 0a");
    bench.run(kSecond);
    EXPECT_TRUE(bench.sent.empty());
  }
}

TEST(Gateway, BroadcastsAreSentAndNotAnswered) {
  Bench bench;
  bench.gateway.take(7, message(1, 0, write_register(0, 5)));
  bench.gateway.take(7, message(2, 1, kRead));
  bench.run(kSecond);
  ASSERT_EQ(bench.sent.size(), 2U);
  EXPECT_EQ(bench.sent[0], rtu_frame(0, write_register(0, 5)));
  EXPECT_EQ(bench.gateway.counts().broadcasts, 1U);
  ASSERT_EQ(bench.answers.size(), 1U);  // the other's
  EXPECT_EQ(bench.answers[0].bytes[1], 2);
}

TEST(Gateway, RequestsMayComeByteByByteAndSeveralAtOnce) {
  Bench bench;
  bench.slave = kReadAnswer;
  Bytes stream;
  for (std::uint16_t i = 0; i < 3; ++i) {
    const Bytes one = message(i, 1, kRead);
    stream.insert(stream.end(), one.begin(), one.end());
  }
  for (const std::uint8_t byte : stream) {
    bench.gateway.take(7, {&byte, 1});
    EXPECT_LE(bench.gateway.open(7), 3U);
  }
  EXPECT_FALSE(bench.gateway.partial(7));
  bench.run(kSecond);
  ASSERT_EQ(bench.answers.size(), 3U);
  for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(bench.answers[i].bytes[1], i);
}

TEST(Gateway, ClientsTakeTurnsHoweverMuchOneAsks) {
  Bench bench;
  bench.slave = kReadAnswer;
  for (std::uint16_t i = 0; i < 10; ++i) bench.gateway.take(1, message(i, 1, kRead));
  bench.gateway.take(2, message(100, 1, kRead));
  bench.gateway.take(3, message(200, 1, kRead));
  bench.run(2 * kSecond);
  std::vector<std::uint64_t> order;
  for (const auto& answer : bench.answers) order.push_back(answer.client);
  EXPECT_EQ(order, (std::vector<std::uint64_t>{1, 2, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(Gateway, TakesNoMoreThanSixteenRequestsOfAClientAndKeepsTheRest) {
  Bench bench;
  bench.slave = kReadAnswer;
  for (std::uint16_t i = 0; i < 40; ++i) bench.gateway.take(1, message(i, 1, kRead));
  EXPECT_EQ(bench.gateway.open(1), Gateway::kMostOpen);
  EXPECT_FALSE(bench.gateway.wants_more(1));
  EXPECT_FALSE(bench.gateway.partial(1)) << "it waits for us, not we for it";
  bench.run(10 * kSecond);
  EXPECT_EQ(bench.answers.size(), 40U);
  EXPECT_TRUE(bench.gateway.wants_more(1));
}

TEST(Gateway, WhatAClientThatHasGoneAskedIsDropped) {
  Bench bench;
  bench.slave = kReadAnswer;
  for (std::uint16_t i = 0; i < 5; ++i) bench.gateway.take(1, message(i, 1, kRead));
  bench.run(2 * kMillisecond);
  ASSERT_EQ(bench.sent.size(), 1U);
  bench.gateway.take(2, message(7, 1, kRead));
  bench.gateway.forget(1);
  EXPECT_EQ(bench.gateway.open(1), 0U);
  bench.run(kSecond);
  EXPECT_EQ(bench.sent.size(), 2U);
  ASSERT_EQ(bench.answers.size(), 1U);
  EXPECT_EQ(bench.answers[0].client, 2U);
}

TEST(Gateway, ALineThatIsNeverQuietIsException0BAndNothingIsSent) {
  Bench bench;
  bench.gateway.take(1, message(1, 1, kRead));
  for (int i = 0; i < 300; ++i) {
    bench.line.quiet_since = bench.line.now;
    bench.step();
  }
  EXPECT_TRUE(bench.sent.empty());
  EXPECT_EQ(bench.answer(), "00 01 00 00 00 03 01 83 0b");
}

TEST(Gateway, ReadsOfUnit0GetExceptionAAtOnceBecauseNobodyAnswersABroadcast) {
  for (const std::uint8_t function : Bytes{1, 2, 3, 4}) {
    Bench bench;
    bench.gateway.take(1, message(1, 0, {function, 0x00, 0x05, 0x00, 0x01}));
    bench.step();
    EXPECT_EQ(bench.answer(), "00 01 00 00 00 03 00 " + to_hex(Bytes{static_cast<std::uint8_t>(function | 0x80)}) + " 0a");
    EXPECT_TRUE(bench.sent.empty());
    EXPECT_EQ(bench.gateway.counts().no_path, 1U);
  }
}

TEST(Gateway, ABroadcastThatCannotBeSentIsNotAnsweredEither) {
  Bench bench;
  bench.gateway.take(1, message(1, 0, write_register(0, 5)));
  for (int i = 0; i < 300; ++i) {
    bench.line.quiet_since = bench.line.now;
    bench.step();
  }
  EXPECT_TRUE(bench.sent.empty());
  EXPECT_TRUE(bench.answers.empty());
  EXPECT_EQ(bench.gateway.open(1), 0U);
  EXPECT_EQ(bench.gateway.counts().silent, 1U);
}

TEST(Gateway, WhatIsNoModbusTcpIsSaid) {
  const auto error_of = [](const Bytes& bytes) {
    Gateway gateway{kTimeout};
    gateway.take(1, bytes);
    EXPECT_EQ(gateway.open(1), 0U);
    EXPECT_EQ(gateway.wants_more(1), gateway.error(1).empty());
    return gateway.error(1);
  };
  EXPECT_EQ(error_of({0, 1, 0, 1, 0, 6, 1, 3, 0, 0, 0, 1}), "protocol 1 instead of 0");
  EXPECT_EQ(error_of({0, 1, 0, 0, 0, 0}), "length 0; 2 to 254 are possible");
  EXPECT_EQ(error_of({0, 1, 0, 0, 0, 1, 1}), "length 1; 2 to 254 are possible");
  EXPECT_EQ(error_of({0, 1, 0, 0, 0, 255, 1}), "length 255; 2 to 254 are possible");
  EXPECT_EQ(error_of({0, 1, 0, 0, 0, 254, 1}), "");
  EXPECT_EQ(error_of({0, 1, 0, 0, 0}), "");
}

TEST(Gateway, TheLongestPduFitsBothWays) {
  Bench bench;
  Bytes pdu(kLongestPdu, 0x55);
  pdu[0] = 0x41;
  bench.slave = rtu_frame(1, pdu);
  bench.gateway.take(1, message(1, 1, pdu));
  bench.run(2 * kSecond);
  ASSERT_EQ(bench.sent.size(), 1U);
  EXPECT_EQ(bench.sent[0].size(), kLongestRtuFrame);
  ASSERT_EQ(bench.answers.size(), 1U);
  EXPECT_EQ(bench.answers[0].bytes, message(1, 1, pdu));
}

}  // namespace
}  // namespace s7200::modbus::gateway_test
