#include "serial_sim/line/uart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace s7200::serial::uart_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};
constexpr SerialFormat k8N1{9600, 8, Parity::None, 1};
constexpr SerialFormat k8O1{9600, 8, Parity::Odd, 1};
constexpr SerialFormat k7E1{9600, 7, Parity::Even, 1};
constexpr SerialFormat k7O1{9600, 7, Parity::Odd, 1};
const std::vector<SerialFormat> kFormats{k8E1, k8N1, k8O1, k7E1, k7O1};

constexpr Time kBit = k8E1.bit_times(1);
constexpr int kNoise = 3;
constexpr EventOwner kSender{0}, kReceiver{1}, kThird{2};

SerialFormat at_baud(SerialFormat format, double baud) {
  format.baud = static_cast<std::uint32_t>(baud);
  return format;
}

std::string name_of(const SerialFormat& format) {
  const char* parity = format.parity == Parity::None ? "N" : format.parity == Parity::Even ? "E" : "O";
  return std::to_string(format.baud) + " " + std::to_string(format.data_bits) + parity + std::to_string(format.stop_bits);
}

/// A sender and a receiver that is off while the test does not say otherwise, and what they reported.
struct Wire {
  Line line;
  EventQueue queue;
  Uart sender{line, queue, kSender, 0};
  Uart receiver{line, queue, kReceiver, 1};
  std::vector<ReceivedCharacter> heard;
  std::vector<Time> sent;
  Time now = 0;

  Wire(const SerialFormat& sends_as, const SerialFormat& receives_as) {
    sender.configure(sends_as, 0);
    receiver.configure(receives_as, 0);
    sender.enable_receiver(false, 0);
  }
  explicit Wire(const SerialFormat& format) : Wire(format, format) {}

  bool step() {
    if (queue.next() == kNever) return false;
    const Event event = queue.pop();
    EXPECT_GE(event.at, now);
    now = event.at;
    Uart& uart = event.owner == kSender ? sender : receiver;
    const Uart::Report report = uart.handle(event);
    if (report.received) heard.push_back(*report.received);
    if (report.sent) sent.push_back(*report.sent);
    return true;
  }

  void run() {
    while (step()) {
    }
  }

  void run_until(Time end) {
    while (queue.next() <= end) step();
  }

  void send(std::uint8_t byte, Time at) {
    sender.send(byte, at);
    run();
  }

  /// Characters one after the other without a gap.
  void send_all(const std::vector<std::uint8_t>& bytes, Time at = 0) {
    for (const std::uint8_t byte : bytes) {
      sender.send(byte, at);
      while (sender.state().sending) step();
      at = now;
    }
    run();
  }

  int errors() const {
    int count = 0;
    for (const ReceivedCharacter& character : heard) count += character.parity_error || character.framing_error;
    return count;
  }
};

std::vector<std::uint8_t> every_byte(int data_bits) {
  std::vector<std::uint8_t> bytes;
  for (int byte = 0; byte < 1 << data_bits; ++byte) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

std::vector<std::uint8_t> bytes_of(const std::vector<ReceivedCharacter>& heard) {
  std::vector<std::uint8_t> bytes;
  for (const ReceivedCharacter& character : heard) bytes.push_back(character.byte);
  return bytes;
}

TEST(Uart, EveryByteArrivesWithinFourPercentOfTheBaudRate) {
  for (const SerialFormat& format : kFormats) {
    for (const double baud : {9600 * 0.96, 9600 * 0.98, 9600.0, 9600 * 1.02, 9600 * 1.04}) {
      Wire wire(at_baud(format, baud), format);
      const auto bytes = every_byte(format.data_bits);
      wire.send_all(bytes);
      EXPECT_EQ(bytes_of(wire.heard), bytes) << name_of(format) << " from " << baud;
      EXPECT_EQ(wire.errors(), 0) << name_of(format) << " from " << baud;
    }
  }
}

TEST(Uart, ErrorsAppearFromSixToEightPercentOn) {
  for (const SerialFormat& format : kFormats) {
    for (const double baud : {9600 * 0.92, 9600 * 1.08}) {
      Wire wire(at_baud(format, baud), format);
      const auto bytes = every_byte(format.data_bits);
      wire.send_all(bytes);
      EXPECT_TRUE(wire.errors() > 0 || bytes_of(wire.heard) != bytes) << name_of(format) << " from " << baud;
    }
  }
  for (const double baud : {9600 * 0.94, 9600 * 1.06}) {
    Wire wire(at_baud(k8E1, baud), k8E1);
    wire.send_all(every_byte(8));
    EXPECT_GT(wire.errors(), 0) << baud;
  }
}

TEST(Uart, HalfOrDoubleBaudRateGivesErrorsOrGarbageAndEnds) {
  for (const auto& [from, to] :
       {std::pair{9600, 19200}, std::pair{19200, 9600}, std::pair{115200, 300}, std::pair{300, 115200}}) {
    Wire wire(at_baud(k8E1, from), at_baud(k8E1, to));
    wire.send_all(every_byte(8));
    EXPECT_NE(bytes_of(wire.heard), every_byte(8)) << from << " to " << to;
    EXPECT_GT(wire.errors(), 0) << from << " to " << to;
    EXPECT_EQ(wire.queue.next(), kNever);
  }
}

TEST(Uart, EveryBaudRateOfThePort) {
  for (const double baud : {300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200}) {
    Wire wire(at_baud(k8E1, baud));
    wire.send_all(every_byte(8));
    EXPECT_EQ(bytes_of(wire.heard), every_byte(8)) << baud;
    EXPECT_EQ(wire.errors(), 0) << baud;
  }
}

TEST(Uart, TwoStopBitsAreHeardByAReceiverOfOne) {
  SerialFormat two_stop_bits = k8N1;
  two_stop_bits.stop_bits = 2;
  for (const auto& [from, to] : {std::pair{two_stop_bits, k8N1}, std::pair{two_stop_bits, two_stop_bits}}) {
    Wire wire(from, to);
    wire.send_all(every_byte(8));
    EXPECT_EQ(bytes_of(wire.heard), every_byte(8));
    EXPECT_EQ(wire.errors(), 0);
  }
}

TEST(Uart, SevenBitFormatSendsTheLowSevenBits) {
  Wire wire(k7E1);
  wire.send(0xC1, 0);
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].byte, 0x41);
  EXPECT_FALSE(wire.heard[0].parity_error);
}

TEST(Uart, ReportsInTheMiddleOfTheStopBitAndSentAtItsEnd) {
  Wire wire(k8E1);
  wire.send(0x55, 1000);
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].start, 1000);
  EXPECT_EQ(wire.heard[0].end, 1000 + k8E1.half_bits(21));
  EXPECT_EQ(wire.sent, std::vector<Time>{1000 + k8E1.bit_times(11)});
}

TEST(Uart, EdgesLieAtWholeBitsBehindTheStart) {
  Wire wire(k8E1);
  wire.sender.send(0x55, 0);
  for (int bit = 0; bit < 10; bit += 2) EXPECT_EQ(wire.line.falling_edge(k8E1.bit_times(bit)), k8E1.bit_times(bit));
}

TEST(Uart, EvenParityReadAsOddIsAnErrorInEveryCharacter) {
  Wire wire(k8E1, k8O1);
  wire.send_all(every_byte(8));
  EXPECT_EQ(bytes_of(wire.heard), every_byte(8));
  EXPECT_EQ(wire.errors(), 256);
}

TEST(Uart, NoParityReadAsEvenGoesWrong) {
  Wire wire(k8N1, k8E1);
  wire.send_all(every_byte(8));
  EXPECT_GT(wire.errors(), 0);
}

TEST(Uart, WrongParityIsHeardAsParityErrorOnly) {
  Wire wire(k8E1);
  wire.sender.send_with_wrong_parity(0x37, 0);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].byte, 0x37);
  EXPECT_TRUE(wire.heard[0].parity_error);
  EXPECT_FALSE(wire.heard[0].framing_error);
}

TEST(Uart, GlitchShorterThanHalfABitIsIgnored) {
  Wire wire(k8E1);
  wire.line.drive(kNoise, 1000, false);
  wire.line.drive(kNoise, 1000 + kBit * 49 / 100, true);
  wire.run();
  EXPECT_TRUE(wire.heard.empty());
  wire.send(0x42, 10 * kBit);
  EXPECT_EQ(bytes_of(wire.heard), std::vector<std::uint8_t>{0x42});
}

TEST(Uart, GlitchLongerThanHalfABitIsACharacter) {
  Wire wire(k8E1);
  wire.line.drive(kNoise, 1000, false);
  wire.line.drive(kNoise, 1000 + kBit * 51 / 100, true);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].byte, 0xFF);
  EXPECT_TRUE(wire.heard[0].parity_error);
}

TEST(Uart, BreakIsOneZeroCharacterWithFramingError) {
  Wire wire(k8E1);
  wire.sender.send_break(16, 1000);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].byte, 0);
  EXPECT_TRUE(wire.heard[0].framing_error);
  EXPECT_EQ(wire.sent, std::vector<Time>{1000 + k8E1.bit_times(16)});
}

TEST(Uart, SpaceInEverySampleIsABreak) {
  for (const SerialFormat& format : kFormats) {
    const auto heard_as_break = [&](auto send) {
      Wire wire(format);
      send(wire.sender);
      wire.run();
      return wire.heard.size() == 1 && wire.heard[0].line_break;
    };
    EXPECT_TRUE(heard_as_break([](Uart& sender) { sender.send_break(16, 0); }));
    EXPECT_TRUE(heard_as_break([&](Uart& sender) { sender.send_break(format.bits(), 0); }));
    EXPECT_FALSE(heard_as_break([&](Uart& sender) { sender.send_break(format.bits() - 1, 0); })) << "its stop bit is a mark";
    EXPECT_FALSE(heard_as_break([](Uart& sender) { sender.send(0, 0); }));
    EXPECT_FALSE(heard_as_break([](Uart& sender) { sender.send_without_stop_bit(3, 0); }));
  }
}

TEST(Uart, CharacterAfterABreakIsHeard) {
  Wire wire(k8E1);
  wire.sender.send_break(16, 0);
  wire.run();
  wire.send(0x42, wire.sent.back() + kBit);
  ASSERT_EQ(wire.heard.size(), 2U);
  EXPECT_EQ(wire.heard[1].byte, 0x42);
  EXPECT_FALSE(wire.heard[1].framing_error);
}

TEST(Uart, NoMarkBetweenABreakAndACharacterMeansNoStartEdge) {
  Wire wire(k8E1);
  wire.sender.send_break(16, 0);
  wire.run();
  wire.send(0b1111'1110, wire.sent.back());  // mark from its second data bit on, parity bit included
  EXPECT_EQ(wire.heard.size(), 1U);
}

struct ThreeUarts : Wire {
  Uart other{line, queue, kThird, 2};
  ThreeUarts() : Wire(k8N1) {
    other.configure(k8N1, 0);
    other.enable_receiver(false, 0);
  }
  void run_all() {
    while (queue.next() != kNever) {
      if (const Event event = queue.pop(); event.owner == kThird) {
        other.handle(event);
      } else {
        queue.schedule(event.at, event.owner, event.what);
        step();
      }
    }
  }
};

TEST(Uart, TwoSendersAtOnceGiveTheBitsBothMark) {
  ThreeUarts wire;
  wire.sender.send(0b1100'1010, 1000);
  wire.other.send(0b1010'1110, 1000);
  wire.run_all();
  EXPECT_EQ(bytes_of(wire.heard), std::vector<std::uint8_t>{0b1000'1010});
}

TEST(Uart, StartEdgeOfAnotherDriverThatComesEarlierIsTaken) {
  ThreeUarts wire;
  wire.sender.send(0xFF, 5 * kBit);
  wire.other.send(0xF0, 0);
  wire.run_all();
  ASSERT_FALSE(wire.heard.empty());
  EXPECT_EQ(wire.heard[0].start, 0);
  EXPECT_EQ(wire.heard[0].byte, 0xE0);  // bit 4 is the other's start bit
}

TEST(Uart, AwaitedStartEdgeThatIsTakenBackIsNoStart) {
  Wire wire(k8N1);
  wire.line.drive(kNoise, kBit, false);
  wire.line.drive(kNoise, kBit, true);
  wire.line.drive(kNoise, kBit + kBit / 4, false);
  wire.line.drive(kNoise, 3 * kBit, true);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].start, kBit + kBit / 4);
}

TEST(Uart, HearsItsOwnSenderUnlessSwitchedOff) {
  Wire wire(k8E1);
  wire.sender.enable_receiver(true, 0);
  wire.receiver.enable_receiver(false, 0);
  wire.send(0x42, 0);
  EXPECT_EQ(bytes_of(wire.heard), std::vector<std::uint8_t>{0x42});
}

TEST(Uart, HearsNothingWhileItsReceiverIsOff) {
  Wire wire(k8E1);
  wire.receiver.enable_receiver(false, 0);
  wire.send_all({1, 2, 3});
  EXPECT_TRUE(wire.heard.empty());
  wire.receiver.enable_receiver(true, wire.now);
  wire.send(4, wire.now);
  EXPECT_EQ(bytes_of(wire.heard), std::vector<std::uint8_t>{4});
}

TEST(Uart, SwitchedOffInMidCharacterLosesIt) {
  Wire wire(k8E1);
  wire.sender.send(0x42, 0);
  wire.run_until(5 * kBit);
  wire.receiver.enable_receiver(false, 5 * kBit);
  wire.receiver.enable_receiver(true, 5 * kBit + 10);
  EXPECT_TRUE(wire.heard.empty());
}

TEST(Uart, SwitchedOffAtAComingInstantStillHearsWhatEndsBefore) {
  Wire wire(k8E1);
  wire.sender.send(0x42, 0);
  wire.run_until(10 * kBit);
  wire.receiver.enable_receiver(false, 11 * kBit);
  wire.run();
  EXPECT_EQ(bytes_of(wire.heard), std::vector<std::uint8_t>{0x42});
}

TEST(Uart, CharacterLostToSwitchingOffDoesNotComeBackWithALaterEdge) {
  Wire wire(k8E1);
  wire.sender.send(0x42, 0);
  wire.run_until(5 * kBit);
  wire.receiver.enable_receiver(false, 6 * kBit);
  wire.line.drive(kNoise, 5 * kBit + kBit / 2, false);
  wire.line.drive(kNoise, 8 * kBit, true);
  EXPECT_GT(wire.queue.next(), 5 * kBit);
  wire.run();
  EXPECT_TRUE(wire.heard.empty());
}

TEST(Uart, SwitchedOnInMidCharacterFindsTheNextFallingEdge) {
  Wire wire(k8N1);
  wire.receiver.enable_receiver(false, 0);
  wire.sender.send(0b1101'1110, 0);  // space in bit 0 and bit 5, that is bit times 1 and 6 after the start
  wire.run_until(3 * kBit);
  wire.receiver.enable_receiver(true, 3 * kBit);
  wire.run();
  ASSERT_EQ(wire.heard.size(), 1U);
  EXPECT_EQ(wire.heard[0].start, k8N1.bit_times(6));
  EXPECT_EQ(wire.heard[0].byte, 0xFF);
}

TEST(Uart, SwitchedOnDuringSpaceWaitsForTheLineToFallAgain) {
  Wire wire(k8N1);
  wire.receiver.enable_receiver(false, 0);
  wire.sender.send(0xF0, 0);
  wire.run_until(2 * kBit);
  wire.receiver.enable_receiver(true, 2 * kBit);
  wire.run();
  EXPECT_TRUE(wire.heard.empty());
}

TEST(Uart, NewFormatHoldsForACharacterWhoseStartBitIsStillToCome) {
  Wire wire(k8E1, at_baud(k8E1, 300));
  wire.sender.send(0x42, 1000);
  wire.receiver.configure(k8E1, 0);
  wire.run();
  EXPECT_EQ(bytes_of(wire.heard), std::vector<std::uint8_t>{0x42});
}

TEST(Uart, NewFormatLeavesTheCharacterUnderWayAlone) {
  Wire wire(k8E1);
  wire.sender.send(0x42, 0);
  wire.run_until(5 * kBit);
  wire.receiver.configure(at_baud(k7O1, 38400), 5 * kBit);
  wire.sender.configure(at_baud(k7O1, 38400), 5 * kBit);
  wire.run();
  wire.send(0x31, wire.now);
  EXPECT_EQ(bytes_of(wire.heard), (std::vector<std::uint8_t>{0x42, 0x31}));
  EXPECT_EQ(wire.errors(), 0);
}

/// Someone asks for edges: whatever was only implied is revealed.
void look_at(const Wire& wire) { wire.line.next_change(0); }

TEST(Uart, HearsTheSameWhetherAnyoneLooksAtTheLineOrNot) {
  for (const SerialFormat& sends_as : kFormats)
    for (const SerialFormat& receives_as : {sends_as, k8E1, at_baud(sends_as, 9600 * 1.03), at_baud(sends_as, 19200)})
      for (const std::uint8_t byte : std::initializer_list<std::uint8_t>{0x00, 0x01, 0x42, 0x55, 0x7F}) {
        Wire alone(sends_as, receives_as), watched(sends_as, receives_as);
        for (Wire* wire : {&alone, &watched}) wire->sender.send(byte, 1000);
        bool more = true;
        while (more) {
          look_at(watched);
          more = watched.step();
          ASSERT_EQ(alone.step(), more);
          ASSERT_EQ(alone.heard, watched.heard);
          ASSERT_EQ(alone.receiver.state(), watched.receiver.state());
          ASSERT_EQ(alone.queue, watched.queue);
        }
        EXPECT_EQ(alone.line, watched.line);
      }
}

TEST(Uart, WhatHappensDuringACharacterMeetsItsLevels) {
  const auto noise = [](Wire& wire, Time at) {
    wire.line.drive(kNoise, at, false);
    wire.line.drive(kNoise, at + kBit / 2, true);
  };
  const auto cut = [](Wire& wire, Time at) {
    wire.line.disturb({.effect = Disturbance::Effect::Cuts, .from = at, .to = at + 2 * kBit});
  };
  const auto loss = [](Wire& wire, Time at) { wire.sender.power_off(at); };
  const auto parting = [](Wire& wire, Time at) { wire.line.separate(at, 1); };
  for (const auto& happens : std::initializer_list<std::function<void(Wire&, Time)>>{noise, cut, loss, parting})
    for (Time at = kBit / 4; at < 12 * kBit; at += kBit / 4) {
      Wire alone(k8E1), watched(k8E1);
      for (Wire* wire : {&alone, &watched}) {
        wire->sender.send(0x35, 0);
        if (wire == &watched) look_at(*wire);
        wire->run_until(at - 1);
        happens(*wire, at);
        wire->run();
      }
      EXPECT_EQ(alone.heard, watched.heard) << at;
      EXPECT_EQ(alone.line, watched.line) << at;
    }
}

/// Somebody else is to send long after what the test is about: no start bit of now is alone on the line.
void fill_the_future(Wire& wire) {
  wire.line.drive(kNoise + 1, 1000 * kBit, false);
  wire.line.drive(kNoise + 1, 1001 * kBit, true);
}

TEST(Uart, ACertainStartBitIsVerifiedLikeAnyOther) {
  const auto noise = [](Wire& wire, Time at) {
    wire.line.drive(kNoise, at, false);
    wire.line.drive(kNoise, at + kBit / 3, true);
  };
  const auto cut = [](Wire& wire, Time at) {
    wire.line.disturb({.effect = Disturbance::Effect::Cuts, .from = at, .to = at + kBit / 3});
  };
  const auto format = [](Wire& wire, Time at) { wire.receiver.configure(at_baud(k7O1, 38400), at); };
  const auto off = [](Wire& wire, Time at) { wire.receiver.enable_receiver(false, at); };
  const auto off_and_on = [](Wire& wire, Time at) {
    wire.receiver.enable_receiver(false, at);
    wire.receiver.enable_receiver(true, at);
  };
  const auto loss = [](Wire& wire, Time at) { wire.sender.power_off(at); };
  for (const auto& happens :
       std::initializer_list<std::function<void(Wire&, Time)>>{noise, cut, format, off, off_and_on, loss})
    for (Time at = kBit / 8; at < 12 * kBit; at += kBit / 8) {
      Wire alone(k8E1), among_others(k8E1);
      fill_the_future(among_others);
      for (Wire* wire : {&alone, &among_others}) {
        wire->sender.send(0x35, 0);
        wire->run_until(at - 1);
        happens(*wire, at);
        wire->run_until(900 * kBit);
      }
      EXPECT_EQ(alone.heard, among_others.heard) << at;
    }
}

TEST(Uart, TenThousandCharactersWithoutAGapDoNotDrift) {
  Wire wire(k8E1);
  for (int count = 0; count < 10'000; ++count) {
    const Time start = wire.sent.empty() ? 0 : wire.sent.back();
    wire.send(static_cast<std::uint8_t>(count * 7), start);
    ASSERT_EQ(wire.heard.size(), wire.sent.size());
    ASSERT_EQ(wire.heard.back().start, start);
    ASSERT_EQ(wire.heard.back().byte, static_cast<std::uint8_t>(count * 7));
  }
  EXPECT_EQ(wire.errors(), 0);
}

TEST(Uart, CharacterIsThreeEventsAndTwoWhenItIsAloneOnTheLine) {
  Wire alone(k8E1), among_others(k8E1);
  fill_the_future(among_others);
  const auto events_of_a_character = [](Wire& wire) {
    wire.sender.send(0x42, 0);
    int events = 0;
    for (; wire.queue.next() < 900 * kBit; ++events) wire.step();
    return events;
  };
  EXPECT_EQ(events_of_a_character(alone), 2);
  EXPECT_EQ(events_of_a_character(among_others), 3);
}

TEST(Uart, RemembersNoMoreOfTheLineThanItNeeds) {
  Wire wire(k8E1);
  for (int count = 0; count < 100; ++count) wire.send(0x55, wire.now);
  EXPECT_EQ(wire.line, Line{});
}

TEST(Uart, ContinuingFromASnapshotGivesTheSameReports) {
  Wire wire(k8E1, at_baud(k8E1, 9700));
  wire.send_all({1, 2, 3});
  for (const Time into_character : {Time{0}, kBit / 4, kBit, 7 * kBit, 11 * kBit - kBit / 4}) {
    wire.sender.send(0xA7, wire.now);
    wire.run_until(wire.now + into_character);

    const Line line = wire.line;
    const EventQueue queue = wire.queue;
    const Uart::State sender = wire.sender.state();
    const Uart::State receiver = wire.receiver.state();
    const Time now = wire.now;

    const auto rest = [&] {
      wire.heard.clear();
      wire.sent.clear();
      wire.run();
      wire.send_all({0x55, 0x00, 0xFF}, wire.now);
      return std::pair{wire.heard, wire.sent};
    };
    const auto first = rest();
    wire.line = line;
    wire.queue = queue;
    wire.sender.restore(sender);
    wire.receiver.restore(receiver);
    wire.now = now;
    EXPECT_EQ(rest(), first);
  }
}

/// The receiver once more, written without events: over the whole history of the line, from one end to the other.
std::vector<ReceivedCharacter> decode(const Line& history, std::vector<Time> edges, const SerialFormat& format) {
  std::sort(edges.begin(), edges.end());
  std::vector<ReceivedCharacter> heard;
  Time from = 0;
  for (const Time edge : edges) {
    const bool falls = edge >= from && history.level(edge - 1) && !history.level(edge);
    if (!falls) continue;
    const auto sample = [&](int bit) { return history.level(edge + format.half_bits(2 * bit + 1)); };
    from = edge + format.half_bits(1);
    if (sample(0)) continue;
    ReceivedCharacter character{.start = edge};
    int bit = 1;
    for (int place = 0; place < format.data_bits; ++place)
      character.byte |= static_cast<std::uint8_t>(sample(bit++) << place);
    if (format.parity != Parity::None) character.parity_error = sample(bit++) != format.parity_bit(character.byte);
    character.framing_error = !sample(bit);
    character.line_break = true;
    for (int each = 0; each <= bit; ++each) character.line_break &= !sample(each);
    from = character.end = edge + format.half_bits(2 * bit + 1);
    heard.push_back(character);
  }
  return heard;
}

TEST(Uart, HearsInNoiseWhatADecoderOfTheWholeHistoryFinds) {
  std::mt19937 random(7200);
  const auto up_to = [&](Time limit) { return static_cast<Time>(random() % static_cast<std::uint32_t>(limit)); };
  for (std::size_t round = 0; round < 200; ++round) {
    const SerialFormat format = kFormats[round % kFormats.size()];
    Wire wire(format);
    Line history;
    std::vector<Time> edges;
    std::array<Time, Line::kDrivers> last{};
    const auto drive = [&](int driver, bool mark) {
      Time& at = last.at(static_cast<std::size_t>(driver));
      at = std::max(at, wire.now) + up_to(round % 2 == 0 ? kBit : 8 * kBit);
      wire.line.drive(driver, at, mark);
      history.drive(driver, at, mark);
      edges.push_back(at);
    };
    for (int count = 0; count < 200; ++count) {
      const int driver = static_cast<int>(random() % 3);
      drive(driver == 1 ? kNoise : driver, random() % 3 != 0);
      if (random() % 4 == 0) wire.step();
    }
    for (const int driver : {0, 2, kNoise}) drive(driver, true);
    wire.run();
    ASSERT_EQ(wire.heard, decode(history, edges, format)) << "round " << round;
    ASSERT_FALSE(wire.heard.empty());
  }
}

struct Missed final : Uart::Bystander {
  bool looks() const override { return looking; }
  void missed(const ReceivedCharacter& character) override { all.push_back(character); }
  bool looking = true;
  std::vector<ReceivedCharacter> all;
};

TEST(Uart, ACharacterThatBeginsWhileTheReceiverIsOffIsToldToABystanderAndToNobodyElse) {
  Wire wire(k8E1);
  Missed missed;
  wire.receiver.set_bystander(&missed);
  wire.receiver.enable_receiver(false, 0);
  wire.send_all({0x41, 0x00, 0xFF}, kBit);
  EXPECT_TRUE(wire.heard.empty());
  ASSERT_EQ(missed.all.size(), 3U);
  EXPECT_EQ(missed.all[0], (ReceivedCharacter{.byte = 0x41, .start = kBit, .end = kBit}));
  EXPECT_EQ(missed.all[1].byte, 0x00);
  EXPECT_EQ(missed.all[2].byte, 0xFF);
  missed.looking = false;
  wire.send(0x41, 50 * kBit);
  EXPECT_EQ(missed.all.size(), 3U);
}

TEST(Uart, ACharacterThatIsCutOffBySwitchingTheReceiverOffIsToldWithThatInstant) {
  Wire wire(k8E1);
  Missed missed;
  wire.receiver.set_bystander(&missed);
  wire.sender.send(0x41, kBit);
  wire.run_until(4 * kBit);
  wire.receiver.enable_receiver(false, 4 * kBit);
  wire.run();
  EXPECT_TRUE(wire.heard.empty());
  ASSERT_EQ(missed.all.size(), 1U);
  EXPECT_EQ(missed.all[0], (ReceivedCharacter{.byte = 0x41, .start = kBit, .end = 4 * kBit}));
}

TEST(Uart, ItsOwnCharactersAreNotMissedWhileItSends) {
  Wire wire(k8E1);
  Missed missed;
  wire.sender.set_bystander(&missed);  // its receiver is off
  wire.receiver.enable_receiver(false, 0);
  wire.send_all({0x41, 0x42});
  EXPECT_TRUE(missed.all.empty());
  wire.sender.send(0x55, wire.now + kBit);
  wire.receiver.send(0x43, wire.now + 3 * kBit);
  wire.run();
  ASSERT_EQ(missed.all.size(), 1U) << "only the other one's";
  EXPECT_EQ(missed.all[0].byte, 0x43);
}

}  // namespace
}  // namespace s7200::serial::uart_test
