#include "serial_sim/peers/requester.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "serial_sim/modbus/request.hpp"

namespace s7200::serial::requester_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};
constexpr EventOwner kSlaveUart{0}, kMasterUart{1}, kMaster{2};

using serial::Frame;
using serial::to_frame;

/// A master, and a second UART that plays a script: what it hears is kept, and `answer` is sent `delay` after the
/// character of the request that is `after` in number.
struct Conversation {
  Line line;
  EventQueue queue;
  Uart slave_uart{line, queue, kSlaveUart, 0};
  Uart master_uart{line, queue, kMasterUart, 1};
  Requester master{master_uart, queue, kMaster};

  std::size_t after = 0;
  Time delay = 5 * kMillisecond;
  Frame answer;
  Time answer_gap = 0;

  std::vector<ReceivedCharacter> heard;
  std::size_t answered = 0;
  Time now = 0;

  Conversation() {
    slave_uart.configure(k8E1, 0);
    master_uart.configure(k8E1, 0);
  }

  void answer_next(Time at) {
    if (answered == 0) slave_uart.enable_receiver(false, at);
    const serial::FrameCharacter& character = answer[answered++];
    if (character.wrong_parity) {
      slave_uart.send_with_wrong_parity(character.byte, at);
    } else {
      slave_uart.send(character.byte, at);
    }
  }

  void slave(const Uart::Report& report) {
    if (report.received) {
      heard.push_back(*report.received);
      if (heard.size() == after && !answer.empty()) answer_next(report.received->end + delay);
    }
    if (report.sent) {
      if (answered < answer.size()) {
        answer_next(*report.sent + answer_gap);
      } else {
        slave_uart.enable_receiver(true, *report.sent);
      }
    }
  }

  void step() {
    const Event event = queue.pop();
    EXPECT_GE(event.at, now);
    now = event.at;
    switch (event.owner) {
      case kSlaveUart:
        slave(slave_uart.handle(event));
        break;
      case kMasterUart:
        master.on(master_uart.handle(event));
        break;
      default:
        master.handle(event);
        break;
    }
  }

  const Exchange& exchange(const Request& request) {
    heard.clear();
    answered = 0;
    after = request.frame.size();
    master.start(request, now);
    while (master.busy()) step();
    return master.exchange();
  }
};

const Bytes kRequest = modbus::rtu_frame(1, modbus::read_holding_registers(10, 1));
const Bytes kAnswer{0x01, 0x03, 0x02, 0x12, 0x34, 0xB5, 0x33};

Request request_of(const Bytes& bytes) { return {.frame = to_frame(bytes)}; }

Bytes bytes_of(const std::vector<ReceivedCharacter>& heard) {
  Bytes bytes;
  for (const ReceivedCharacter& character : heard) bytes.push_back(character.byte);
  return bytes;
}

TEST(Requester, SendsTheRequestWithoutGapsAndHearsTheAnswer) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.now = 3 * kMillisecond;
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_EQ(bytes_of(talk.heard), kRequest);
  EXPECT_EQ(exchange.request, to_frame(kRequest));
  EXPECT_EQ(exchange.response_bytes(), kAnswer);
  EXPECT_EQ(exchange.request_start, 3 * kMillisecond);
  EXPECT_EQ(exchange.request_end, 3 * kMillisecond + 8 * k8E1.character_time());
  EXPECT_FALSE(exchange.timed_out || exchange.too_long || exchange.parity_error() || exchange.framing_error());
}

TEST(Requester, GivenUpBeforeItsFirstCharacterNothingIsSent) {
  Conversation talk;
  talk.master.start(request_of(kRequest), kMillisecond);
  talk.master.give_up(kMillisecond);
  EXPECT_FALSE(talk.master.busy());
  EXPECT_TRUE(talk.master.exchange().given_up);
  EXPECT_EQ(talk.queue.next(), kNever);
}

TEST(Requester, GivenUpOnTheLineTheCharacterThatHasBegunIsTheLastAndTheNextRequestComesAfterIt) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.master.start(request_of(kRequest), 0);
  while (talk.heard.size() < 2) talk.step();
  talk.master.give_up(talk.now);
  EXPECT_FALSE(talk.master.busy());
  const Time end = talk.master_uart.state().send_end;
  EXPECT_EQ(end, 2 * k8E1.character_time()) << "its stop bit lasts still";
  EXPECT_FALSE(talk.master.exchange().timed_out);
  talk.master.start(request_of({0x41}), end);  // while it lasts
  while (talk.master.busy()) talk.step();
  EXPECT_EQ(bytes_of(talk.heard), (Bytes{kRequest[0], kRequest[1], 0x41}));
  EXPECT_FALSE(talk.master.exchange().given_up);
}

TEST(Requester, GivenUpWhileItWaitsTheAnswerIsUnasked) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.after = kRequest.size();
  talk.master.start(request_of(kRequest), 0);
  while (talk.master.state().phase != Requester::Phase::Waiting) talk.step();
  talk.master.give_up(talk.now);
  while (talk.master.heard().size() < kAnswer.size()) talk.step();
  EXPECT_TRUE(talk.master.exchange().response.empty());
  EXPECT_EQ(serial::bytes_of(talk.master.heard()), kAnswer);
}

TEST(Requester, LatencyIsFromTheLastStopBitToTheFirstStartEdge) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  // The script counts its delay from the middle of the request's last stop bit.
  const Time half_a_bit = k8E1.character_time() - k8E1.half_bits(21);
  EXPECT_EQ(exchange.latency(), talk.delay - half_a_bit);
  EXPECT_EQ(exchange.response_start, exchange.request_end + *exchange.latency());
  EXPECT_EQ(exchange.response_end, exchange.response_start + 7 * k8E1.character_time());
}

TEST(Requester, DoesNotHearItself) {
  Conversation talk;
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_TRUE(exchange.response.empty());
}

TEST(Requester, NoticesAnAnswerThatBeginsBeforeItsLastStopBitEnds) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.delay = 0;
  EXPECT_TRUE(talk.exchange(request_of(kRequest)).early);
  talk.delay = k8E1.half_bits(1);
  EXPECT_FALSE(talk.exchange(request_of(kRequest)).early);
}

TEST(Requester, SilenceEndsTheAnswer) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_EQ(talk.now, exchange.response_end + k8E1.silence());
}

TEST(Requester, PausesShorterThanTheSilenceBelongToTheAnswer) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.answer_gap = k8E1.silence() - kMicrosecond;
  EXPECT_EQ(talk.exchange(request_of(kRequest)).response_bytes(), kAnswer);
}

TEST(Requester, LongerPauseEndsTheAnswer) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.answer_gap = k8E1.silence() + kMicrosecond;
  EXPECT_EQ(talk.exchange(request_of(kRequest)).response_bytes(), Bytes{0x01});
}

TEST(Requester, SilenceCanBeSet) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.answer_gap = 40 * kMillisecond;
  Request request = request_of(kRequest);
  request.silence = 50 * kMillisecond;
  EXPECT_EQ(talk.exchange(request).response_bytes(), kAnswer);
}

TEST(Requester, NoAnswerTimesOut) {
  Conversation talk;
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_TRUE(exchange.timed_out);
  EXPECT_EQ(exchange.latency(), std::nullopt);
  EXPECT_EQ(talk.now, exchange.request_end + kSecond);
}

TEST(Requester, AnswerThatBeginsJustInTimeIsHeard) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  Request request = request_of(kRequest);
  request.timeout = talk.delay;
  EXPECT_EQ(talk.exchange(request).response_bytes(), kAnswer);
}

TEST(Requester, AnswerThatBeginsTooLateIsATimeout) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  Request request = request_of(kRequest);
  request.timeout = talk.delay - kMillisecond;
  EXPECT_TRUE(talk.exchange(request).timed_out);
}

TEST(Requester, GlitchIsNoAnswer) {
  Conversation talk;
  Request request = request_of(kRequest);
  request.timeout = 10 * kMillisecond;
  const Time timeout = 8 * k8E1.character_time() + request.timeout;
  talk.line.drive(3, timeout - kMicrosecond, false);
  talk.line.drive(3, timeout + kMicrosecond, true);
  EXPECT_TRUE(talk.exchange(request).timed_out);
  EXPECT_LE(talk.now, timeout + k8E1.bit_times(1));
}

TEST(Requester, GapBetweenTheCharactersOfTheRequest) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  Request request = request_of(kRequest);
  request.gap = 2 * kMillisecond;
  const Exchange& exchange = talk.exchange(request);
  EXPECT_EQ(exchange.request_end, 8 * k8E1.character_time() + 7 * request.gap);
  for (std::size_t count = 1; count < talk.heard.size(); ++count) {
    EXPECT_EQ(talk.heard[count].start - talk.heard[count - 1].start, k8E1.character_time() + request.gap);
  }
  EXPECT_EQ(exchange.response_bytes(), kAnswer);
}

TEST(Requester, AnswerOf1024CharactersIsHeardInFull) {
  Conversation talk;
  talk.answer = to_frame(Bytes(1024, 0x5A));
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_EQ(exchange.response.size(), 1024U);
  EXPECT_FALSE(exchange.too_long);
}

TEST(Requester, AnAnswerIsIntactUnlessItIsCutOffOrACharacterIsDamaged) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  EXPECT_EQ(talk.exchange(request_of(kRequest)).damage(), "");
  talk.answer[3].wrong_parity = true;
  EXPECT_EQ(talk.exchange(request_of(kRequest)).damage(), "characters with wrong parity");
  talk.answer = to_frame(Bytes(1025, 0x5A));
  EXPECT_EQ(talk.exchange(request_of(kRequest)).damage(), "an answer without end, cut off");
}

TEST(Requester, AnswerThatDoesNotEndIsCutOff) {
  Conversation talk;
  talk.answer = to_frame(Bytes(1025, 0x5A));
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_EQ(exchange.response.size(), 1024U);
  EXPECT_TRUE(exchange.too_long);
  EXPECT_FALSE(talk.master.busy());
}

TEST(Requester, SendsTheMarkedCharacterWithWrongParity) {
  Conversation talk;
  const Frame frame = serial::parse_hex_frame("01 03p 00").frame;
  talk.exchange({.frame = frame});
  ASSERT_EQ(talk.heard.size(), 3U);
  EXPECT_FALSE(talk.heard[0].parity_error);
  EXPECT_TRUE(talk.heard[1].parity_error);
  EXPECT_EQ(talk.heard[1].byte, 0x03);
  EXPECT_FALSE(talk.heard[2].parity_error);
}

TEST(Requester, TellsOfParityErrorsInTheAnswer) {
  Conversation talk;
  talk.answer = serial::parse_hex_frame("01 83p 02").frame;
  const Exchange& exchange = talk.exchange(request_of(kRequest));
  EXPECT_TRUE(exchange.parity_error());
  EXPECT_FALSE(exchange.framing_error());
  EXPECT_EQ(exchange.response_bytes(), (Bytes{0x01, 0x83, 0x02}));
}

TEST(Requester, WrongBaudRateIsErrorsOrSilenceAndEnds) {
  for (const std::uint32_t baud : {4800U, 19200U}) {
    Conversation talk;
    SerialFormat format = k8E1;
    format.baud = baud;
    talk.slave_uart.configure(format, 0);
    talk.answer = to_frame(kAnswer);
    talk.after = 1;
    EXPECT_NE(talk.exchange(request_of(kRequest)).response_bytes(), kAnswer);
    EXPECT_FALSE(talk.master.busy());
  }
}

TEST(Requester, ExchangesFollowEachOther) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  for (int count = 0; count < 100; ++count) {
    const Exchange& exchange = talk.exchange(request_of(kRequest));
    ASSERT_EQ(bytes_of(talk.heard), kRequest);
    ASSERT_EQ(exchange.response_bytes(), kAnswer);
  }
}

TEST(Requester, RequestBeginsWhenItWasToldTo) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.after = kRequest.size();
  talk.master.start(request_of(kRequest), 7 * kSecond);
  EXPECT_TRUE(talk.master.busy());
  while (talk.master.busy()) talk.step();
  EXPECT_EQ(talk.heard.front().start, 7 * kSecond);
  EXPECT_EQ(talk.master.exchange().request_start, 7 * kSecond);
}

TEST(Requester, ContinuingFromASnapshotGivesTheSameExchange) {
  Conversation talk;
  talk.answer = to_frame(kAnswer);
  talk.after = kRequest.size();
  talk.master.start(request_of(kRequest), 0);
  for (int steps = 0; talk.master.busy(); ++steps) {
    const Line line = talk.line;
    const EventQueue queue = talk.queue;
    const Uart::State slave_uart = talk.slave_uart.state();
    const Uart::State master_uart = talk.master_uart.state();
    const Requester::State master = talk.master.state();
    const auto heard = talk.heard;
    const std::size_t answered = talk.answered;
    const Time now = talk.now;

    while (talk.master.busy()) talk.step();
    const Exchange straight = talk.master.exchange();
    ASSERT_EQ(straight.response_bytes(), kAnswer);

    const auto go_back = [&] {
      talk.line = line;
      talk.queue = queue;
      talk.slave_uart.restore(slave_uart);
      talk.master_uart.restore(master_uart);
      talk.master.restore(master);
      talk.heard = heard;
      talk.answered = answered;
      talk.now = now;
    };
    go_back();
    while (talk.master.busy()) talk.step();
    ASSERT_EQ(talk.master.exchange(), straight) << steps;

    go_back();
    talk.step();
  }
}

// --- what comes unasked ---

/// The slave sends, the next character when the one before is over; everything up to `until` happens.
void transmit(Conversation& talk, const Bytes& bytes, Time at, Time until) {
  talk.answer = to_frame(bytes);
  talk.answered = 0;
  talk.answer_next(at);
  while (talk.queue.next() <= until) talk.step();
  talk.now = until;
}

const Exchange& listen(Conversation& talk, const Listening& listening) {
  talk.master.listen(listening, talk.now);
  while (talk.master.busy()) talk.step();
  return talk.master.exchange();
}

TEST(MasterListening, TakesWhatCameBeforeItWasListenedTo) {
  Conversation talk;
  transmit(talk, {0x41, 0x42}, kMillisecond, 100 * kMillisecond);
  EXPECT_EQ(talk.master.heard().size(), 2U);
  const Exchange& exchange = listen(talk, {});
  EXPECT_EQ(exchange.response_bytes(), (Bytes{0x41, 0x42}));
  EXPECT_TRUE(exchange.request.empty());
  EXPECT_EQ(exchange.request_end, 100 * kMillisecond);
  EXPECT_EQ(exchange.response_start, kMillisecond);
  EXPECT_EQ(exchange.response_end, kMillisecond + 2 * k8E1.character_time());
  EXPECT_FALSE(exchange.timed_out || exchange.too_long);
  EXPECT_EQ(talk.now, 100 * kMillisecond) << "no time passes";
  EXPECT_TRUE(talk.master.heard().empty());
}

TEST(MasterListening, WaitsForWhatIsStillToComeAndForItsEnd) {
  Conversation talk;
  talk.answer = to_frame(Bytes{0x41, 0x42, 0x43});
  talk.answer_next(20 * kMillisecond);
  const Exchange& exchange = listen(talk, {.timeout = 50 * kMillisecond});
  EXPECT_EQ(exchange.response_bytes(), (Bytes{0x41, 0x42, 0x43}));
  EXPECT_EQ(exchange.latency(), 20 * kMillisecond);
  EXPECT_EQ(talk.now, exchange.response_end + k8E1.silence());
}

TEST(MasterListening, NothingComesWithinTheTimeout) {
  Conversation talk;
  const Exchange& exchange = listen(talk, {.timeout = 50 * kMillisecond});
  EXPECT_TRUE(exchange.timed_out);
  EXPECT_EQ(talk.now, 50 * kMillisecond);
}

TEST(MasterListening, TransmissionsAreDividedBySilenceAndTakenOneAfterTheOther) {
  Conversation talk;
  transmit(talk, {0x41, 0x42}, kMillisecond, 20 * kMillisecond);
  transmit(talk, {0x43}, 20 * kMillisecond, 40 * kMillisecond);
  EXPECT_EQ(listen(talk, {}).response_bytes(), (Bytes{0x41, 0x42}));
  EXPECT_EQ(listen(talk, {}).response_bytes(), (Bytes{0x43}));
  EXPECT_TRUE(listen(talk, {.timeout = kMillisecond}).timed_out);

  transmit(talk, {0x41, 0x42}, 50 * kMillisecond, 60 * kMillisecond);
  transmit(talk, {0x43}, 60 * kMillisecond, 80 * kMillisecond);
  EXPECT_EQ(listen(talk, {.silence = 20 * kMillisecond}).response_bytes(), (Bytes{0x41, 0x42, 0x43}));
}

TEST(MasterListening, AnyMomentOfATransmissionWillDoToBegin) {
  const Time length = 3 * k8E1.character_time();
  for (Time at = 0; at < length + 2 * k8E1.silence(); at += 100 * kMicrosecond) {
    Conversation talk;
    transmit(talk, {0x41, 0x42, 0x43}, kMillisecond, kMillisecond + at);
    const Exchange& exchange = listen(talk, {});
    EXPECT_EQ(exchange.response_bytes(), (Bytes{0x41, 0x42, 0x43})) << at;
    EXPECT_EQ(talk.now, std::max(kMillisecond + at, kMillisecond + length + k8E1.silence())) << at;
  }
}

TEST(MasterListening, ATransmissionThatBeginsAfterTheEndOfTheLastOneIsNotItsRest) {
  Conversation talk;
  transmit(talk, {0x41}, kMillisecond, 20 * kMillisecond);
  transmit(talk, {0x42}, 20 * kMillisecond, 20 * kMillisecond + k8E1.bit_times(3));
  EXPECT_EQ(listen(talk, {}).response_bytes(), (Bytes{0x41}));
  EXPECT_EQ(listen(talk, {}).response_bytes(), (Bytes{0x42}));
}

TEST(MasterListening, ARequestForgetsWhatCameBeforeIt) {
  Conversation talk;
  transmit(talk, {0x41}, kMillisecond, 20 * kMillisecond);
  talk.answer = to_frame(kAnswer);
  EXPECT_EQ(talk.exchange(request_of(kRequest)).response_bytes(), kAnswer);
  EXPECT_TRUE(talk.master.heard().empty());
  EXPECT_TRUE(listen(talk, {.timeout = kMillisecond}).timed_out);
}

TEST(MasterListening, WhatIsKeptHasAnEnd) {
  Conversation talk;
  for (std::size_t i = 0; i < Requester::kMostHeard + 10; ++i) {
    talk.slave_uart.send(static_cast<std::uint8_t>(i), talk.now);
    for (const Time end = talk.now + k8E1.character_time(); talk.queue.next() <= end;) talk.step();
  }
  EXPECT_EQ(talk.master.heard().size(), Requester::kMostHeard);
  const Exchange& exchange = listen(talk, {});
  EXPECT_EQ(exchange.response.size(), Requester::kLongestResponse);
  EXPECT_TRUE(exchange.too_long);
  EXPECT_EQ(listen(talk, {}).response.front().byte, Requester::kLongestResponse % 256);
}

}  // namespace
}  // namespace s7200::serial::requester_test
