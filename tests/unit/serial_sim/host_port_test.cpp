#include "serial_sim/peers/host_port.hpp"

#include <gtest/gtest.h>

#include "tests/support/slave_bench.hpp"

namespace s7200::serial::host_port_test {
namespace {

using Fault = HostCharacter::Fault;

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};
constexpr SerialFormat k8O2{9600, 8, Parity::Odd, 2};
constexpr SerialFormat k8N2{19200, 8, Parity::None, 2};
constexpr EventOwner kOtherUart{0}, kHostUart{1};

std::vector<HostCharacter> characters(const Bytes& bytes, const SerialFormat& format = k8E1) {
  std::vector<HostCharacter> all;
  for (const std::uint8_t byte : bytes) all.push_back({byte, format, Fault::None});
  return all;
}

/// The port, and another UART that hears it and may answer.
struct Wire {
  Line line;
  EventQueue queue;
  Uart other{line, queue, kOtherUart, 0};
  Uart uart{line, queue, kHostUart, 2};
  HostPort port{uart};
  std::vector<ReceivedCharacter> heard;

  Wire() { other.configure(k8E1, 0); }

  void run(Time end = kNever) {
    while (queue.next() < end) {
      const Event event = queue.pop();
      if (event.owner == kHostUart)
        port.on(uart.handle(event));
      else if (const auto report = other.handle(event); report.received)
        heard.push_back(*report.received);
    }
  }
};

TEST(HostPort, CharactersFollowEachOtherBackToBackFromTheInstantGiven) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(characters({1, 2, 3}), kMillisecond);
  wire.port.send(characters({4}), kMillisecond);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(wire.heard[i].byte, i + 1);
    EXPECT_EQ(wire.heard[i].start, kMillisecond + static_cast<Time>(i) * k8E1.character_time());
  }
  EXPECT_FALSE(wire.port.sending());
}

TEST(HostPort, WhatASenderHasWaitingIsCountedAndCanBeDropped) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  const auto of = [](std::uint64_t sender, Bytes bytes) {
    std::vector<HostCharacter> all = characters(bytes);
    for (HostCharacter& character : all) character.sender = sender;
    return all;
  };
  wire.port.send(of(7, {1, 2, 3}), 0);
  wire.port.send(of(8, {4}), 0);
  wire.port.send(of(7, {5}), 0);
  EXPECT_EQ(wire.port.waiting(7), 3U);  // besides the one on the line
  EXPECT_EQ(wire.port.waiting(8), 1U);
  EXPECT_EQ(wire.port.drop(7), 3U);
  EXPECT_EQ(wire.port.waiting(7), 0U);
  EXPECT_EQ(wire.port.drop(7), 0U);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 2U);
  EXPECT_EQ(wire.heard[0].byte, 1);
  EXPECT_EQ(wire.heard[1].byte, 4);
  EXPECT_EQ(wire.port.waiting(8), 0U);
  EXPECT_TRUE(wire.port.state().waiting.empty());
}

TEST(HostPort, LaterCharactersBeginWhenTheyCome) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(characters({1}), 0);
  wire.run();
  wire.port.send(characters({2}), 5 * kMillisecond);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 2U);
  EXPECT_EQ(wire.heard[1].start, 5 * kMillisecond);
}

TEST(HostPort, EachCharacterHasTheFormatItWasSentIn) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(characters({0x55}, k8O2), 0);
  wire.port.send(characters({0x33}, k8E1), 0);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 2U);
  EXPECT_TRUE(wire.heard[0].parity_error);
  EXPECT_FALSE(wire.heard[1].parity_error);
  EXPECT_EQ(wire.heard[1].start, k8O2.character_time());
}

TEST(HostPort, HearsOthersWithTimesAndErrorsButNotItself) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(characters({1}), 0);
  wire.run();
  wire.other.send(0xA5, 10 * kMillisecond);
  wire.run();
  wire.other.send_with_wrong_parity(0x5A, 20 * kMillisecond);
  EXPECT_EQ(wire.port.character_due(), 20 * kMillisecond + k8E1.half_bits(21));
  wire.run();
  wire.other.send_without_stop_bit(0x0F, 30 * kMillisecond);
  wire.run();
  const auto received = wire.port.take_received();
  ASSERT_EQ(received.size(), 3U);
  EXPECT_EQ(received[0],
            (ReceivedCharacter{.byte = 0xA5, .start = 10 * kMillisecond, .end = 10 * kMillisecond + k8E1.half_bits(21)}));
  EXPECT_TRUE(received[1].parity_error);
  EXPECT_EQ(received[1].byte, 0x5A);
  EXPECT_TRUE(received[2].framing_error);
  EXPECT_EQ(received[2].byte, 0x0F);
  EXPECT_TRUE(wire.port.take_received().empty());
  EXPECT_EQ(wire.port.character_due(), kNever);
}

TEST(HostPort, IsDeafUntilAttachedAndWhileItSends) {
  Wire wire;
  wire.other.send(1, 0);
  wire.run();
  wire.port.attach(k8E1, 5 * kMillisecond);
  wire.port.send(characters({2, 3, 4}), 5 * kMillisecond);
  wire.other.send(0xFF, 6 * kMillisecond);
  wire.run();
  EXPECT_TRUE(wire.port.take_received().empty());
}

TEST(HostPort, ReceivesInItsOwnFormatWhateverItSent) {
  Wire wire;
  wire.port.attach(k8N2, 0);
  wire.port.send(characters({1}, k8E1), 0);
  wire.run();
  wire.other.configure(k8N2, 10 * kMillisecond);
  wire.other.send(0x77, 10 * kMillisecond);
  wire.run();
  wire.port.receive_as(k8E1, 20 * kMillisecond);
  wire.other.configure(k8E1, 20 * kMillisecond);
  wire.other.send(0x78, 20 * kMillisecond);
  wire.run();
  const auto received = wire.port.take_received();
  ASSERT_EQ(received.size(), 2U);
  EXPECT_EQ(received[0].byte, 0x77);
  EXPECT_EQ(received[1].byte, 0x78);
  EXPECT_FALSE(received[0].parity_error || received[0].framing_error || received[1].parity_error);
}

TEST(HostPort, CharactersWithErrorsArriveWithThemAndTheNextOneIsWhole) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  const std::vector<HostCharacter> sent{{0x41, k8E1, Fault::WrongParity},
                                        {0x42, k8E1, Fault::NoStopBit},
                                        {0xC3, k8E1, Fault::NoStopBit},
                                        {0x44, k8E1, Fault::None}};
  wire.port.send(sent, 0);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(wire.heard[i].byte, sent[i].byte);
    EXPECT_EQ(wire.heard[i].parity_error, sent[i].fault == Fault::WrongParity);
    EXPECT_EQ(wire.heard[i].framing_error, sent[i].fault == Fault::NoStopBit);
  }
}

TEST(HostPort, AsksAProgramInASimulationAndGoesBackToASnapshot) {
  test::SlaveBench bench(test::slave_text());
  bench.start();
  Simulation& simulation = bench.simulation();
  HostPort& port = simulation.host_port();
  port.attach(bench.format(), simulation.time());
  port.send(characters(modbus::rtu_frame(1, modbus::read_holding_registers(0, 2))), simulation.time());
  bench.run_for(5 * kMillisecond);
  const Simulation::Snapshot middle = simulation.snapshot();
  Bytes answers[2];
  Time last[2] = {};
  for (int i = 0; i < 2; ++i) {
    bench.run_for(100 * kMillisecond);
    for (const ReceivedCharacter& character : port.take_received()) {
      answers[i].push_back(character.byte);
      last[i] = character.end;
    }
    simulation.restore(middle);
  }
  EXPECT_EQ(serial::to_hex(answers[0]), "01 03 04 00 00 00 00 fa 33");
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(last[0], last[1]);
}

HostCharacter break_of(std::uint64_t sender) { return {.format = k8E1, .fault = Fault::Break, .sender = sender}; }

TEST(HostPort, ABreakLastsAsLongAsItIsHeld) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(std::vector{break_of(7)}, kMillisecond);
  wire.port.send(characters({0x41}), 2 * kMillisecond);
  wire.run(50 * kMillisecond);
  EXPECT_FALSE(wire.line.level(50 * kMillisecond));
  EXPECT_TRUE(wire.port.sending());
  wire.port.end_break(7, 50 * kMillisecond, 51 * kMillisecond);
  wire.run();
  EXPECT_TRUE(wire.line.level(51 * kMillisecond));
  ASSERT_EQ(wire.heard.size(), 2U) << "a break is one character of it, whatever its length";
  EXPECT_TRUE(wire.heard[0].line_break);
  EXPECT_EQ(wire.heard[1].byte, 0x41);
  EXPECT_EQ(wire.heard[1].start, 51 * kMillisecond + mark_after_break(k8E1));
}

TEST(HostPort, ABreakIsLongerThanAnyCharacter) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(std::vector{break_of(7)}, kMillisecond);
  wire.port.end_break(7, 0, kMillisecond);
  wire.run(kMillisecond + shortest_break(k8E1) - 1);
  EXPECT_FALSE(wire.line.level(kMillisecond + shortest_break(k8E1) - 1));
  wire.run();
  EXPECT_EQ(wire.port.sent_until(), kMillisecond + shortest_break(k8E1) + mark_after_break(k8E1));
}

TEST(HostPort, ABreakBehindOtherCharactersIsAsLongAsItWasHeld) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(characters({1, 2, 3}), 0);
  const Time free = 3 * k8E1.character_time();
  wire.port.send(std::vector{break_of(7)}, 0);
  wire.port.end_break(8, kSecond, kMicrosecond);  // it is not theirs
  wire.port.end_break(7, 10 * kMillisecond, kMicrosecond);
  wire.run();
  EXPECT_EQ(wire.port.sent_until(), free + 10 * kMillisecond + mark_after_break(k8E1));
}

TEST(HostPort, ABreakThatBeganLateEndsLateToo) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.send(characters({1, 2, 3}), 0);
  const Time free = 3 * k8E1.character_time();
  wire.port.send(std::vector{break_of(7)}, 0);
  wire.run(free + kMillisecond);
  wire.port.end_break(7, free + kMillisecond, free + kMillisecond);
  wire.run();
  EXPECT_EQ(wire.port.sent_until(), 2 * free + kMillisecond + mark_after_break(k8E1));
}

TEST(HostPort, CallsOfABreakCanBeRepeated) {
  Wire wire;
  wire.port.attach(k8E1, 0);
  wire.port.repeat({.what = HostCall::What::Send, .characters = {break_of(7)}}, kMillisecond);
  wire.port.repeat({.what = HostCall::What::EndBreak, .characters = {}, .sender = 7, .lasts = 30 * kMillisecond},
                   31 * kMillisecond);
  wire.run();
  EXPECT_EQ(wire.port.sent_until(), 31 * kMillisecond + mark_after_break(k8E1));
}

}  // namespace
}  // namespace s7200::serial::host_port_test
