#include "serial_sim/line/frame_splitter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace s7200::serial::frame_splitter_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};
constexpr Time kCharacter = k8E1.character_time(), kSilence = k8E1.silence();

using Bytes = std::vector<std::uint8_t>;
using Texts = std::vector<std::string>;

struct Sender {
  EventQueue queue;
  Uart uart;
  Sender(Line& line, int driver) : uart(line, queue, EventOwner{}, driver) { uart.enable_receiver(false, 0); }
};

/// The PLC and two peers that send what the test says, and the frames it became.
struct Wires {
  Line line;
  Sender plc{line, 0}, peer{line, 1}, other{line, 2};
  WireTap tap{line, 0};
  std::vector<WireFrame> frames;
  FrameSplitter splitter{[this](const WireFrame& frame) { frames.push_back(frame); }};

  Wires() { tap.watch(&splitter, 0); }

  /// The end of the last stop bit.
  static Time send(Sender& sender, Time at, const Bytes& bytes, const SerialFormat& format = k8E1) {
    sender.uart.configure(format, at);
    for (const std::uint8_t byte : bytes) {
      sender.uart.send(byte, at);
      at = sender.queue.next();
      sender.uart.handle(sender.queue.pop());
    }
    return at;
  }

  Texts told() const {
    Texts texts;
    for (const WireFrame& frame : frames) {
      std::string text = frame.driver == 0 ? "plc" : "peer";
      for (const ReceivedCharacter& character : frame.characters) text += fmt::format(" {:02x}", character.byte);
      texts.push_back(text);
    }
    return texts;
  }

  Texts all(Time until = 10 * kSecond) {
    tap.settle(until, k8E1);
    splitter.finish();
    return told();
  }
};

TEST(FrameSplitter, SilenceOfThreeAndAHalfCharactersEndsAFrame) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x02});
  const Time next = Wires::send(wires.peer, end + kSilence, {0x03});
  Wires::send(wires.peer, next + kSilence + 1, {0x04});
  EXPECT_EQ(wires.all(), (Texts{"peer 01 02 03", "peer 04"}));
}

TEST(FrameSplitter, EachStationHasFramesOfItsOwn) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x02});
  Wires::send(wires.plc, end + 1000, {0x81});
  EXPECT_EQ(wires.all(), (Texts{"peer 01 02", "plc 81"}));
  EXPECT_EQ(wires.frames[0].start(), 1000);
  EXPECT_EQ(wires.frames[0].end, end);
  EXPECT_EQ(wires.frames[1].start(), end + 1000);
}

TEST(FrameSplitter, TheOtherEndEndsAFrameHoweverSoonTheNextOneFollows) {
  Wires wires;
  const Time request = Wires::send(wires.plc, 1000, {0x68, 0x16});
  const Time accepted = Wires::send(wires.peer, request + 1000, {0xE5});
  const Time poll = Wires::send(wires.plc, accepted, {0x10, 0x16});
  Wires::send(wires.peer, poll, {0xE5});
  EXPECT_EQ(wires.all(), (Texts{"plc 68 16", "peer e5", "plc 10 16", "peer e5"}));
}

TEST(FrameSplitter, AnotherStationOnTheSameWireEndsAFrameHoweverSoonItFollows) {
  Wires wires;
  const Time request = Wires::send(wires.peer, 1000, {0x01, 0x03});
  const Time answer = Wires::send(wires.other, request, {0x81, 0x02});
  Wires::send(wires.peer, answer + 1000, {0x04});
  EXPECT_EQ(wires.all(), (Texts{"peer 01 03", "peer 81 02", "peer 04"}));
}

TEST(FrameSplitter, ADisturbanceDoesNotEndTheFrameOfAStation) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x03});
  wires.line.disturb({Disturbance::Effect::HoldsSpace, end + 1000, end + 1000 + kCharacter / 2});
  Wires::send(wires.peer, end + 2 * kCharacter, {0x04});
  const Texts told = wires.all();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(told[0].starts_with("peer 01 03")) << told[0];
  EXPECT_TRUE(told[0].ends_with("04")) << told[0];
}

TEST(FrameSplitter, ACharacterOfAnotherStationThatBeginsWithinOneDoesNotEndItsFrame) {
  Wires wires;
  Wires::send(wires.peer, 1000, {0x01, 0x02, 0x03});
  Wires::send(wires.other, 1000 + kCharacter / 2, {0x81});
  EXPECT_EQ(wires.all().size(), 1U);
}

TEST(FrameSplitter, StationsThatSendAtTheSameTimeAreHeardAsTheLineHasIt) {
  Wires wires;
  Wires::send(wires.plc, 1000, {0xF0, 0x0F, 0x55});
  Wires::send(wires.peer, 1000, {0x3C, 0xFF, 0x55});
  EXPECT_EQ(wires.all(), (Texts{"plc 30 0f 55"}));
  EXPECT_FALSE(wires.frames[0].characters[0].parity_error) << "the two parity bits are the same";
}

TEST(FrameSplitter, StationsThatHaveSentAtTheSameTimeAreOneFrameUntilThereIsSilence) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x02, 0x03});
  const Time both = Wires::send(wires.plc, 1000 + kCharacter / 2, {0x81, 0x82, 0x83, 0x84});
  ASSERT_GT(both, end);
  const Time after = Wires::send(wires.other, both, {0x55});
  Wires::send(wires.plc, after + kSilence + kCharacter, {0x42});
  const Texts told = wires.all();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_TRUE(told[0].starts_with("peer ")) << told[0];
  EXPECT_EQ(told[1], "plc 42");
}

TEST(FrameSplitter, ADisturbanceDamagesWhatThePlcSendsToo) {
  Wires wires;
  Wires::send(wires.plc, 1000, {0x01, 0x02});
  const Time bit = k8E1.bit_times(1);
  wires.line.disturb(
      {Disturbance::Effect::Inverts, 1000 + kCharacter + k8E1.bit_times(3), 1000 + kCharacter + k8E1.bit_times(3) + bit});
  ASSERT_EQ(wires.all(), (Texts{"plc 01 06"}));
  EXPECT_TRUE(wires.frames[0].characters[1].parity_error);
}

TEST(FrameSplitter, FramesAreToldInTheOrderOfTheirBeginnings) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, Bytes(30, 0x55));
  Wires::send(wires.plc, end, {0x81});
  Texts one_then_the_other{"peer", "plc 81"};
  for (int i = 0; i < 30; ++i) one_then_the_other[0] += " 55";
  for (Time now = 0; now < 60 * kCharacter; now += kCharacter / 3) wires.tap.settle(now, k8E1);
  EXPECT_EQ(wires.told(), one_then_the_other);
}

TEST(FrameSplitter, AFrameIsToldAsSoonAsItsSilenceIsOver) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01});
  wires.tap.settle(end + kSilence, k8E1);
  EXPECT_TRUE(wires.frames.empty());
  wires.tap.settle(end + kSilence + kCharacter + 1, k8E1);
  EXPECT_EQ(wires.told(), (Texts{"peer 01"}));
}

TEST(FrameSplitter, AWrongRateIsReadAsThePortReadsIt) {
  Wires wires;
  const SerialFormat twice{19200, 8, Parity::Even, 1};
  Wires::send(wires.peer, 1000, {0x01, 0x03, 0x00, 0x0a}, twice);
  Line line;
  EventQueue queue;
  Uart port(line, queue, EventOwner{}, 0);
  port.configure(k8E1, 0);
  EventQueue other;
  Uart peer(line, other, EventOwner{}, 1);
  peer.enable_receiver(false, 0);
  peer.configure(twice, 0);
  Time at = 1000;
  for (const std::uint8_t byte : Bytes{0x01, 0x03, 0x00, 0x0a}) {
    peer.send(byte, at);
    at = other.next();
    peer.handle(other.pop());
  }
  std::vector<ReceivedCharacter> heard;
  while (queue.next() != kNever)
    if (const auto report = port.handle(queue.pop()); report.received) heard.push_back(*report.received);
  wires.all();
  ASSERT_EQ(wires.frames.size(), 1U);
  EXPECT_EQ(wires.frames[0].characters, heard);
  EXPECT_NE(heard[0].byte, 0x01);
}

TEST(FrameSplitter, WhatCarriesAnErrorIsInTheFrameToo) {
  Wires wires;
  wires.peer.uart.configure(k8E1, 0);
  wires.peer.uart.send_with_wrong_parity(0x01, 1000);
  wires.peer.uart.handle(wires.peer.queue.pop());
  wires.peer.uart.send_break(20, 1000 + kCharacter);
  ASSERT_EQ(wires.all(), (Texts{"peer 01 00"}));
  EXPECT_TRUE(wires.frames[0].characters[0].parity_error);
  EXPECT_TRUE(wires.frames[0].characters[1].framing_error);
}

TEST(FrameSplitter, ThePortMayBeSetAnew) {
  Wires wires;
  const SerialFormat slow{1200, 8, Parity::None, 1};
  const Time end = Wires::send(wires.plc, 1000, {0x01, 0x02});
  wires.tap.settle(end + 100 * kMillisecond, k8E1);
  wires.tap.settle(kSecond, slow);
  const Time slow_end = Wires::send(wires.plc, kSecond, {0x03, 0x04}, slow);
  wires.tap.settle(slow_end + kSecond, slow);
  EXPECT_EQ(wires.told(), (Texts{"plc 01 02", "plc 03 04"}));
}

TEST(FrameSplitter, AnUnfinishedCharacterAtTheEndIsNone) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x02});
  EXPECT_EQ(wires.all(end - kCharacter / 2), (Texts{"peer 01"}));
}

TEST(FrameSplitter, ALineThatIsNeverSilentIsCut) {
  Wires wires;
  Time at = 1000;
  for (std::size_t i = 0; i < FrameSplitter::kLongestFrame + 10; ++i) {
    at = Wires::send(wires.peer, at, {0x55});
    wires.tap.settle(at, k8E1);
    wires.line.forget(at);
  }
  wires.all(2 * at);
  ASSERT_EQ(wires.frames.size(), 2U);
  EXPECT_EQ(wires.frames[0].characters.size(), FrameSplitter::kLongestFrame);
  EXPECT_EQ(wires.frames[1].characters.size(), 10U);
}

}  // namespace
}  // namespace s7200::serial::frame_splitter_test
