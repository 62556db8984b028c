#include "serial_sim/line/frame_splitter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace s7200::serial {
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

/// The PLC and a peer that send what the test says, and the frames it became.
struct Wires {
  Line line;
  Sender plc{line, 0}, peer{line, 1};
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
      std::string text = frame.wire == Wire::Rx ? "rx" : "tx";
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
  EXPECT_EQ(wires.all(), (Texts{"rx 01 02 03", "rx 04"}));
}

TEST(FrameSplitter, EachWireHasFramesOfItsOwn) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x02});
  Wires::send(wires.plc, end + 1000, {0x81});
  EXPECT_EQ(wires.all(), (Texts{"rx 01 02", "tx 81"}));
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
  EXPECT_EQ(wires.all(), (Texts{"tx 68 16", "rx e5", "tx 10 16", "rx e5"}));
}

TEST(FrameSplitter, ACharacterInTheMiddleOfAnotherDoesNotEndItsFrame) {
  Wires wires;
  Wires::send(wires.peer, 1000, {0x01, 0x02, 0x03});
  Wires::send(wires.plc, 1000 + kCharacter / 2, {0x81});
  EXPECT_EQ(wires.all(), (Texts{"rx 01 02 03", "tx 81"}));
}

TEST(FrameSplitter, FramesAreToldInTheOrderOfTheirBeginnings) {
  Wires wires;
  Wires::send(wires.peer, 1000, Bytes(30, 0x55));
  Wires::send(wires.plc, 1000 + 5 * kCharacter, {0x81});
  Texts rx_then_tx{"rx", "tx 81"};
  for (int i = 0; i < 30; ++i) rx_then_tx[0] += " 55";
  for (Time now = 0; now < 60 * kCharacter; now += kCharacter / 3) wires.tap.settle(now, k8E1);
  EXPECT_EQ(wires.told(), rx_then_tx);
}

TEST(FrameSplitter, AFrameIsToldAsSoonAsItsSilenceIsOver) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01});
  wires.tap.settle(end + kSilence, k8E1);
  EXPECT_TRUE(wires.frames.empty());
  wires.tap.settle(end + kSilence + kCharacter + 1, k8E1);
  EXPECT_EQ(wires.told(), (Texts{"rx 01"}));
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
  ASSERT_EQ(wires.all(), (Texts{"rx 01 00"}));
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
  EXPECT_EQ(wires.told(), (Texts{"tx 01 02", "tx 03 04"}));
}

TEST(FrameSplitter, AnUnfinishedCharacterAtTheEndIsNone) {
  Wires wires;
  const Time end = Wires::send(wires.peer, 1000, {0x01, 0x02});
  EXPECT_EQ(wires.all(end - kCharacter / 2), (Texts{"rx 01"}));
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
}  // namespace s7200::serial
