#include "serial_sim/faults/faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "serial_sim/peers/host_port.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::serial::faults_test {
namespace {

constexpr SerialFormat k8E1{9600, 8, Parity::Even, 1};
constexpr SerialFormat k8N1{9600, 8, Parity::None, 1};
constexpr SerialFormat k8O1{9600, 8, Parity::Odd, 1};
constexpr SerialFormat k7O1{9600, 7, Parity::Odd, 1};
constexpr Time kBit = k8E1.bit_times(1);
constexpr Time kCharacter = k8E1.character_time();
constexpr Time ms = kMillisecond;
constexpr EventOwner kFaults{0}, kPlcUart{1}, kMasterUart{2}, kPeerUart{3}, kMaster{4};

const Bytes kRequest{0x01, 0x03, 0x00, 0xFF, 0x55, 0xAA, 0x80, 0x7F};
const Bytes kAnswer{0xFE, 0x00, 0x5A, 0xC3};

Fault fault_of(const std::string& text) {
  const ParsedFault parsed = parse_fault(text);
  EXPECT_TRUE(parsed.ok()) << text << ": " << parsed.error->message;
  return parsed.fault;
}

std::string shown(const std::vector<ReceivedCharacter>& characters) {
  std::string text;
  for (const ReceivedCharacter& c : characters)
    text += (text.empty() ? "" : " ") + serial::to_hex(Bytes{c.byte}) + (c.parity_error ? "p" : "") +
            (c.framing_error ? "f" : "");
  return text;
}

/// A master that sends kRequest, a PLC's UART that sends kAnswer 5 ms after it, and faults between them.
struct Plant {
  Line line;
  EventQueue queue;
  Uart plc{line, queue, kPlcUart, 0};
  Uart master_uart{line, queue, kMasterUart, 1};
  Requester master{master_uart, queue, kMaster};
  Faults faults{line, queue, kFaults};

  std::vector<ReceivedCharacter> heard;  ///< by the PLC, in the exchange
  std::size_t answered = 0;
  Time now = 0;
  bool answers = true;

  explicit Plant(std::initializer_list<const char*> specs = {}, const SerialFormat& format = k8E1) {
    faults.add_plc(plc);
    plc.configure(format, 0);
    master_uart.configure(format, 0);
    for (const char* spec : specs) faults.inject(fault_of(spec), 0);
  }

  void step() {
    const Event event = queue.pop();
    EXPECT_GE(event.at, now);
    now = event.at;
    switch (event.owner) {
      case kFaults:
        return faults.handle(event);
      case kPlcUart:
        return plc_reports(plc.handle(event));
      case kMasterUart:
        return master.on(master_uart.handle(event));
      default:
        return master.handle(event);
    }
  }

  void run_until(Time end) {
    while (queue.next() <= end) step();
    now = end;
  }

  /// The PLC answers `delay` after the end of the request.
  void plc_reports(const Uart::Report& report) {
    if (report.received) heard.push_back(*report.received);
    if (!report.sent || answered == 0) return;
    if (answered < kAnswer.size()) {
      plc.send(kAnswer[answered++], now);
    } else {
      answered = 0;
      plc.enable_receiver(true, now);
    }
  }

  const Exchange& exchange(const Bytes& request = kRequest) {
    heard.clear();
    master.start({.frame = serial::to_frame(request), .timeout = 50 * ms}, now);
    while (master.busy()) {
      const bool sending = master.state().phase == Requester::Phase::Sending;
      step();
      if (!answers || !sending || master.state().phase != Requester::Phase::Waiting) continue;
      run_until(now + 5 * ms);
      plc.enable_receiver(false, now);
      answered = 1;
      plc.send(kAnswer[0], now);
    }
    return master.exchange();
  }

  std::string request_heard() {
    exchange();
    return shown(heard);
  }
  std::string answer_heard() { return shown(exchange().response); }

  std::uint64_t count(std::size_t of = 0) const { return faults.state().injected.at(of).count; }
  std::uint64_t impossible(std::size_t of = 0) const { return faults.state().injected.at(of).impossible; }
};

const std::string kWholeRequest = "01 03 00 ff 55 aa 80 7f";
const std::string kWholeAnswer = "fe 00 5a c3";

TEST(Faults, WithoutAnyTheLineIsAsItWas) {
  Plant plant;
  EXPECT_EQ(plant.line.interference(), nullptr);
  EXPECT_EQ(plant.request_heard(), kWholeRequest);
  EXPECT_EQ(shown(plant.master.exchange().response), kWholeAnswer);
  EXPECT_TRUE(plant.master.exchange().echo.empty());
}

TEST(Faults, FlipChangesThatBitOfThatCharacterAndNoOther) {
  for (const char* const of : {"request", "answer"})
    for (std::size_t character = 0; character < kAnswer.size(); ++character)
      for (int bit = 0; bit < 8; ++bit) {
        const std::string text =
            "flip:character=" + std::to_string(character + 1) + ",bit=" + std::to_string(bit) + ",of=" + of;
        Plant plant({text.c_str()});
        Bytes request = kRequest, answer = kAnswer;
        const Exchange& exchange = plant.exchange();
        const bool in_request = of == std::string("request");
        const auto& disturbed = in_request ? plant.heard : exchange.response;
        (in_request ? request : answer)[character] ^= static_cast<std::uint8_t>(1 << bit);
        ASSERT_EQ(plant.heard.size(), request.size()) << text;
        for (std::size_t i = 0; i < request.size(); ++i) EXPECT_EQ(plant.heard[i].byte, request[i]) << text;
        EXPECT_EQ(exchange.response_bytes(), answer) << text;
        for (std::size_t i = 0; i < disturbed.size(); ++i) {
          EXPECT_EQ(disturbed[i].parity_error, i == character) << text;
          EXPECT_FALSE(disturbed[i].framing_error) << text;
        }
        EXPECT_EQ(plant.count(), 1U);
      }
}

TEST(Faults, TwoFlipsOfACharacterEscapeItsParity) {
  Plant plant({"flip:character=1,bit=1", "flip:character=1,bit=2"});
  EXPECT_EQ(plant.request_heard(), "07 03 00 ff 55 aa 80 7f");
}

TEST(Faults, FlippedStartBitHidesACharacterAndWhatFollowsIsFoundAgain) {
  Plant plant({"flip:character=4,bit=start"}, k8O1);
  EXPECT_EQ(plant.request_heard(), "01 03 00 55 aa 80 7f") << "16#FF and its odd parity are all mark after the start bit";
}

TEST(Faults, ParityAndFramingErrorsLeaveTheData) {
  EXPECT_EQ(Plant({"parity:character=3"}).request_heard(), "01 03 00p ff 55 aa 80 7f");
  EXPECT_EQ(Plant({"parity:character=each,of=answer"}).answer_heard(), "fep 00p 5ap c3p");
  Plant framing({"framing:character=8"});
  EXPECT_EQ(framing.request_heard(), "01 03 00 ff 55 aa 80 7ff");
  EXPECT_EQ(Plant({"framing:character=4,of=answer"}).answer_heard(), "fe 00 5a c3f");
}

TEST(Faults, BitsTheFormatDoesNotHaveAreCountedAsImpossible) {
  Plant no_parity({"parity:character=3", "flip:bit=parity", "flip:bit=7"}, k8N1);
  no_parity.exchange();
  EXPECT_EQ(no_parity.count(0), 0U);
  EXPECT_EQ(no_parity.impossible(0), 1U);
  EXPECT_EQ(no_parity.impossible(1), 1U);
  EXPECT_EQ(no_parity.impossible(2), 0U);
  Plant seven_bits({"flip:bit=7", "flip:bit=6", "parity"}, k7O1);
  seven_bits.exchange();
  EXPECT_EQ(seven_bits.impossible(0), 1U);
  EXPECT_EQ(seven_bits.count(1), 1U);
  EXPECT_EQ(seven_bits.count(2), 1U);
  EXPECT_EQ(seven_bits.heard.at(0).byte, 0x41);
  EXPECT_FALSE(seven_bits.heard.at(0).parity_error) << "the data bit and the parity bit are both wrong";
}

/// Writes down what it is told.
struct Watcher final : FaultWatcher {
  void fault_happens(const Faults::Injected& fault, const FaultHappening& what) override {
    faults.push_back(to_text(fault.fault));
    all.push_back(what);
  }
  void faults_cleared(Time at) override { cleared.push_back(at); }
  std::vector<std::string> faults;
  std::vector<FaultHappening> all;
  std::vector<Time> cleared;
};

TEST(Faults, AWatcherIsToldWhichCharacterIsStruckAndFromWhenToWhen) {
  Plant plant({"flip:character=3,bit=2", "missing:of=answer,character=2,count=2", "gap:length=1ms,exchange=2"});
  Watcher watcher;
  plant.faults.set_watcher(&watcher);
  plant.exchange();
  const std::string missing = "missing:character=2,count=2,of=answer";
  EXPECT_EQ(watcher.faults, (std::vector<std::string>{"flip:character=3,bit=2", missing, missing}));
  ASSERT_EQ(watcher.all.size(), 3u);
  EXPECT_EQ(watcher.all[0].character, 3u);
  EXPECT_EQ(watcher.all[0].from, 2 * kCharacter + k8E1.bit_times(3));
  EXPECT_EQ(watcher.all[0].to, 2 * kCharacter + k8E1.bit_times(4));
  EXPECT_EQ(watcher.all[1].character, 2u);
  EXPECT_EQ(watcher.all[2].character, 3u);
  EXPECT_EQ(watcher.all[2].to - watcher.all[1].from, 2 * kCharacter);
  plant.faults.clear(plant.now);
  EXPECT_EQ(watcher.cleared, std::vector<Time>{plant.now});
}

TEST(Faults, WhatAFaultDoesToTheWireForLongIsKnownAfterwards) {
  Plant plant({"break:from=2ms,length=100ms", "cut:from=5ms"});
  plant.run_until(10 * ms);
  const std::vector<Faults::Injected>& injected = plant.faults.state().injected;
  EXPECT_EQ(injected[0].last_begin, 2 * ms);
  EXPECT_EQ(injected[0].last_end, 102 * ms);
  EXPECT_EQ(injected[1].last_begin, 5 * ms);
  EXPECT_EQ(injected[1].last_end, kNever);
}

TEST(Faults, BreakIsOneCharacterOfZerosWithAFramingError) {
  Plant plant({"break:from=20ms,length=30bit"});
  plant.run_until(40 * ms);
  EXPECT_EQ(shown(plant.heard), "00f");
  EXPECT_EQ(plant.count(), 1U);
  EXPECT_EQ(Plant({"break:character=8,length=11bit"}).request_heard(), "01 03 00 ff 55 aa 80 00f");
}

TEST(Faults, GlitchShorterThanHalfABitOnTheIdleLineIsIgnored) {
  for (const char* const glitch :
       {"glitch:from=20ms,length=0.49bit", "glitch:from=20ms,length=1us", "glitch:from=20ms,length=1ns"}) {
    Plant plant({glitch});
    plant.run_until(60 * ms);
    EXPECT_TRUE(plant.heard.empty()) << glitch;
    EXPECT_EQ(plant.count(), 1U);
    EXPECT_EQ(plant.request_heard(), kWholeRequest);
  }
}

TEST(Faults, GlitchLongerThanHalfABitOnTheIdleLineIsTakenForAStartBit) {
  Plant plant({"glitch:from=20ms,length=0.51bit"});
  plant.run_until(60 * ms);
  EXPECT_EQ(shown(plant.heard), "ffp");
}

TEST(Faults, GlitchInACharacterMattersOnlyInTheMiddleOfABit) {
  EXPECT_EQ(Plant({"glitch:character=3,at=4.05bit,length=0.4bit"}).request_heard(), kWholeRequest);
  EXPECT_EQ(Plant({"glitch:character=3,at=4.45bit,length=0.1bit"}).request_heard(), "01 03 08p ff 55 aa 80 7f");
  EXPECT_EQ(Plant({"glitch:character=3,at=4bit,length=2bit"}).request_heard(), "01 03 18 ff 55 aa 80 7f");
  EXPECT_EQ(Plant({"glitch:character=2,at=4.45bit,length=10us,of=answer"}).answer_heard(), "fe 08p 5a c3");
}

TEST(Faults, MissingCharactersLeaveTheirTime) {
  Plant plant({"missing:character=3,count=2"});
  EXPECT_EQ(plant.request_heard(), "01 03 55 aa 80 7f");
  EXPECT_EQ(plant.heard[2].start - plant.heard[1].start, 3 * kCharacter);
  EXPECT_EQ(plant.count(), 2U);
  EXPECT_EQ(Plant({"missing:of=answer"}).answer_heard(), "00 5a c3");
  Plant all({"missing:character=each"});
  EXPECT_EQ(all.request_heard(), "");
  EXPECT_EQ(all.count(), kRequest.size());
}

TEST(Faults, ExtraCharactersTakeTheirTimeOnTheWire) {
  Plant plant({"extra:behind=8,bytes=0102,count=2"});
  EXPECT_EQ(plant.request_heard(), kWholeRequest + " 01 02 01 02");
  EXPECT_EQ(plant.master.exchange().request_end - plant.master.exchange().request_start, 12 * kCharacter);
  EXPECT_EQ(plant.count(), 4U);
  EXPECT_EQ(Plant({"extra:behind=0,bytes=99"}).request_heard(), "99 " + kWholeRequest);
  EXPECT_EQ(Plant({"extra:behind=2,bytes=99,of=answer"}).answer_heard(), "fe 00 99 5a c3");
  Plant random({"extra:behind=1,count=3"});
  random.exchange();
  EXPECT_EQ(random.heard.size(), kRequest.size() + 3);
}

TEST(Faults, GapDelaysACharacterAndAllBehindIt) {
  Plant plant({"gap:character=4,length=10ms"});
  EXPECT_EQ(plant.request_heard(), kWholeRequest);
  EXPECT_EQ(plant.heard[3].start - plant.heard[2].start, kCharacter + 10 * ms);
  EXPECT_EQ(plant.heard[4].start - plant.heard[3].start, kCharacter);
  Plant each({"gap:character=each,length=2bit"});
  EXPECT_EQ(each.request_heard(), kWholeRequest);
  EXPECT_EQ(each.heard[7].start - each.heard[6].start, kCharacter + k8E1.bit_times(2));
}

TEST(Faults, EchoIsHeardBeforeTheAnswer) {
  Plant plant({"echo"});
  const Exchange& exchange = plant.exchange();
  EXPECT_EQ(shown(exchange.echo), kWholeRequest);
  EXPECT_EQ(shown(exchange.response), kWholeAnswer);
  EXPECT_GT(*exchange.latency(), 0);
  EXPECT_EQ(shown(plant.heard), kWholeRequest);
  Plant silent({"echo", "flip:character=3,bit=0"});
  silent.answers = false;
  EXPECT_TRUE(silent.exchange().timed_out);
  EXPECT_EQ(shown(silent.master.exchange().echo), "01 03 01p ff 55 aa 80 7f")
      << "it shows the master what the line has become";
}

TEST(Faults, CollisionIsSpaceWhereEitherStationIs) {
  EXPECT_EQ(Plant({"collision:character=4,bytes=0f"}).request_heard(), "01 03 00 0f 55 aa 80 7f");
  EXPECT_EQ(Plant({"collision:character=5,bytes=55aa"}).request_heard(), kWholeRequest) << "the same at the same time";
  EXPECT_EQ(Plant({"collision:character=1,bytes=f1,of=answer"}).answer_heard(), "f0p 00 5a c3");
  Plant idle({"collision:from=20ms,bytes=0183"});
  idle.run_until(40 * ms);
  EXPECT_EQ(shown(idle.heard), "01 83");
  EXPECT_EQ(idle.count(), 2U);
  Plant off_beat({"collision:character=3,at=4.3bit"});
  off_beat.exchange();
  EXPECT_NE(shown(off_beat.heard), kWholeRequest);
}

TEST(Faults, BaudErrorIsHarmlessUpToFourPercentAndFatalFromSeven) {
  for (const char* const station : {"master", "plc"})
    for (const char* const error : {"-4%", "-1.5%", "0.0001%", "4%"}) {
      Plant plant({("baud:error=" + std::string(error) + ",station=" + station).c_str()});
      EXPECT_EQ(plant.request_heard(), kWholeRequest) << error << station;
      EXPECT_EQ(shown(plant.master.exchange().response), kWholeAnswer) << error << station;
      EXPECT_EQ(plant.count(), 1U);
    }
  for (const char* const station : {"master", "plc"})
    for (const char* const error : {"-8%", "8%"}) {
      Plant plant({("baud:error=" + std::string(error) + ",station=" + station).c_str()});
      EXPECT_NE(plant.request_heard(), kWholeRequest) << error << station;
      EXPECT_NE(shown(plant.master.exchange().response), kWholeAnswer) << error << station;
    }
}

TEST(Faults, TwoClocksOffInTheSameDirectionUnderstandEachOther) {
  Plant plant({"baud:error=20%,station=plc", "baud:error=20%,station=master", "flip:character=8,bit=7"});
  EXPECT_EQ(plant.request_heard(), "01 03 00 ff 55 aa 80 ffp") << "a bit is a bit of the sender";
}

TEST(Faults, BaudErrorStretchesABitExactly) {
  Plant plant({"baud:error=-1%"});
  plant.exchange();
  const Exchange& exchange = plant.master.exchange();
  EXPECT_NEAR(static_cast<double>(exchange.request_end - exchange.request_start), 88e9 / 9600 / 0.99, 8);
}

TEST(Faults, CutLineIsSilentAndIsHealedByItself) {
  Plant for_ever({"cut:character=3"});
  EXPECT_EQ(for_ever.request_heard(), "01 03");
  EXPECT_TRUE(for_ever.master.exchange().timed_out);
  EXPECT_EQ(for_ever.request_heard(), "");
  for_ever.faults.clear(for_ever.now);
  EXPECT_EQ(for_ever.request_heard(), kWholeRequest);
  Plant for_a_while({"cut:from=0s,for=20ms"});
  EXPECT_EQ(for_a_while.request_heard(), "");
  EXPECT_EQ(for_a_while.request_heard(), kWholeRequest);
  Plant answer({"cut:character=2,for=1ms,of=answer"});
  EXPECT_EQ(answer.answer_heard().substr(0, 3), "fe ");
  EXPECT_NE(shown(answer.master.exchange().response), kWholeAnswer);
}

TEST(Faults, NoiseInvertsAboutItsShareOfTheBits) {
  for (const double rate : {0.001, 0.01, 0.1}) {
    Plant plant({("noise:seed=5,ber=" + std::to_string(rate)).c_str()});
    constexpr int kBits = 400'000;
    plant.run_until(kBits * kBit);
    const double expected = rate * kBits;
    EXPECT_NEAR(static_cast<double>(plant.count()), expected, 4 * std::sqrt(expected)) << rate;
  }
}

TEST(Faults, ReceiverFindsAboutTheShareOfBitsInvertedThatNoiseInverts) {
  Plant plant({"noise:ber=0.002,of=request"});
  plant.answers = false;
  std::uint64_t bits = 0, wrong = 0;
  for (int round = 0; round < 4000; ++round) {
    plant.exchange();
    if (plant.heard.size() != kRequest.size()) continue;  // a start bit was hit, or a stop bit
    for (std::size_t i = 0; i < kRequest.size(); ++i)
      wrong += static_cast<std::uint64_t>(__builtin_popcount(plant.heard[i].byte ^ kRequest[i]));
    bits += 8 * kRequest.size();
  }
  const double expected = 0.002 * static_cast<double>(bits);
  EXPECT_GT(bits, 200'000U);
  EXPECT_NEAR(static_cast<double>(wrong), expected, 0.2 * expected);
}

TEST(Faults, NoiseIsTheSameWithTheSameSeedAndAnotherWithAnother) {
  const auto heard = [](const char* spec) {
    Plant plant({spec});
    std::string all;
    for (int i = 0; i < 20; ++i) all += plant.request_heard() + "\n";
    return all;
  };
  EXPECT_EQ(heard("noise:ber=0.01,seed=3"), heard("noise:ber=0.01,seed=3"));
  EXPECT_NE(heard("noise:ber=0.01,seed=3"), heard("noise:ber=0.01,seed=4"));
}

TEST(Faults, NoiseKeepsToItsTimeAndItsHalf) {
  Plant window({"noise:ber=1,from=10ms,for=5ms"});
  window.run_until(100 * ms);
  EXPECT_EQ(window.count(), 48U) << "each bit that begins in 5 ms";
  Plant answer({"noise:ber=0.5,of=answer"});
  EXPECT_EQ(answer.request_heard(), kWholeRequest);
  EXPECT_NE(shown(answer.master.exchange().response), kWholeAnswer);
  Plant third({"noise:ber=0.5,of=request,exchange=3"});
  EXPECT_EQ(third.request_heard(), kWholeRequest);
  EXPECT_EQ(third.request_heard(), kWholeRequest);
  EXPECT_NE(third.request_heard(), kWholeRequest);
  third.run_until(third.now + 100 * ms);
  EXPECT_EQ(third.request_heard(), kWholeRequest);
}

TEST(Faults, ChanceDrawsWhatItsSourceSays) {
  Faults::Chance chance(1234567);  // first values of SplitMix64 from this seed, as published for it
  EXPECT_EQ(chance.draw(), 6457827717110365317U);
  EXPECT_EQ(chance.draw(), 3203168211198807973U);
  EXPECT_EQ(chance.draw(), 9817491932198370423U);
}

TEST(Faults, HappenInTheExchangesTheyAreMeantFor) {
  const auto pattern = [](const char* spec) {
    Plant plant({spec});
    std::string happened;
    for (int i = 0; i < 9; ++i) happened += plant.request_heard() == kWholeRequest ? '-' : 'x';
    EXPECT_EQ(plant.count(), static_cast<std::uint64_t>(std::count(happened.begin(), happened.end(), 'x')));
    return happened;
  };
  EXPECT_EQ(pattern("flip"), "xxxxxxxxx");
  EXPECT_EQ(pattern("flip:every=3"), "--x--x--x");
  EXPECT_EQ(pattern("flip:exchange=4"), "---x-----");
  EXPECT_EQ(pattern("flip:exchange=4,every=3"), "---------");
}

TEST(Faults, HappenWithTheirProbability) {
  Plant plant({"missing:character=1,probability=0.3,seed=9"});
  plant.answers = false;
  for (int i = 0; i < 1000; ++i) plant.exchange();
  EXPECT_NEAR(static_cast<double>(plant.count()), 300, 60);
}

TEST(Faults, ExchangesAreCountedFromTheInjection) {
  Plant plant;
  plant.exchange();
  plant.faults.inject(fault_of("flip:exchange=2"), plant.now);
  EXPECT_EQ(plant.request_heard(), kWholeRequest);
  EXPECT_NE(plant.request_heard(), kWholeRequest);
}

TEST(Faults, SeveralWorkTogether) {
  Plant plant({"extra:behind=0,bytes=77", "gap:character=3,length=2ms", "flip:character=3,bit=0", "parity:character=5",
               "missing:character=7", "echo"});
  EXPECT_EQ(plant.request_heard(), "77 01 03 01p ff 55p aa 7f");
  EXPECT_EQ(shown(plant.master.exchange().echo), "77 01 03 01p ff 55p aa 7f");
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(plant.count(i), 1U) << i;
}

TEST(Faults, PeerThatAnnouncesNothingBeginsAnExchangeBehindAnAnswerOrASilence) {
  Plant plant({"flip:every=2"});
  Uart peer(plant.line, plant.queue, kPeerUart, 2);
  peer.configure(k8E1, plant.now);
  peer.enable_receiver(false, 0);
  const auto send = [&](std::uint8_t byte) {
    plant.heard.clear();
    peer.send(byte, plant.now);
    while (plant.heard.empty()) {
      if (plant.queue.next() == kNever) break;
      const Event event = plant.queue.pop();
      plant.now = event.at;
      if (event.owner == kPeerUart) peer.handle(event);
      if (event.owner == kPlcUart) plant.plc_reports(plant.plc.handle(event));
      if (event.owner == kMasterUart) plant.master_uart.handle(event);
    }
    while (peer.state().sending) {
      const Event event = plant.queue.pop();
      plant.now = event.at;
      if (event.owner == kPeerUart) peer.handle(event);
    }
    return plant.heard.empty() ? -1 : int{plant.heard[0].byte};
  };
  EXPECT_EQ(send(0x10), 0x10);
  EXPECT_EQ(send(0x10), 0x10) << "second character of the same request";
  plant.now += 4 * kCharacter;
  EXPECT_EQ(send(0x10), 0x11) << "first character of the second request";
  EXPECT_EQ(send(0x10), 0x10);
  plant.plc.enable_receiver(false, plant.now);
  plant.plc.send(0x20, plant.now);
  plant.run_until(plant.now + kCharacter);
  plant.plc.enable_receiver(true, plant.now);
  EXPECT_EQ(send(0x10), 0x10) << "third request";
}

TEST(Faults, OfAStationCountOnlyWhatItSendsHoweverSoonItAnswersAnotherPlc) {
  constexpr EventOwner kOther = kPeerUart;
  Line line;
  EventQueue queue;
  Uart master(line, queue, kPlcUart, 0), slave(line, queue, kOther, 1);
  Faults faults(line, queue, kFaults);
  for (Uart* uart : {&master, &slave}) {
    uart->configure(k8E1, 0);
    faults.add_plc(*uart);
  }
  slave.enable_receiver(false, 0);
  faults.inject(fault_of("flip:character=2"), 0, slave.driver());
  std::vector<ReceivedCharacter> heard;
  Time now = 0;
  const auto send = [&](Uart& from, std::uint8_t byte) {
    from.send(byte, now);
    while (from.state().sending) {
      const Event event = queue.pop();
      now = event.at;
      const auto report = (event.owner == kPlcUart ? master : slave).handle(event);
      if (report.received) heard.push_back(*report.received);
    }
  };
  for (const int exchange : {1, 2}) {
    heard.clear();
    master.enable_receiver(false, now);
    for (const std::uint8_t byte : Bytes{0x10, 0x20, 0x30}) send(master, byte);
    master.enable_receiver(true, now);
    for (const std::uint8_t byte : Bytes{0x40, 0x50, 0x60}) send(slave, byte);
    EXPECT_EQ(shown(heard), "40 51p 60") << exchange;
    now += 4 * kCharacter;
  }
}

/// Two PLCs alone on a line: a program asks, the other one answers.
struct ProgramThatAsks {
  static constexpr EventOwner kMasterPlc = kPlcUart, kSlavePlc = kPeerUart;
  Line line;
  EventQueue queue;
  Faults faults{line, queue, kFaults};
  Uart master{line, queue, kMasterPlc, 0}, slave{line, queue, kSlavePlc, 1};
  Time now = 0;

  ProgramThatAsks() {
    for (Uart* uart : {&slave, &master}) {
      uart->configure(k8E1, 0);
      faults.add_plc(*uart);
    }
  }

  /// Back with what the other one hears.
  std::string send(Uart& from, const Bytes& frame) {
    std::vector<ReceivedCharacter> heard;
    from.enable_receiver(false, now);
    for (const std::uint8_t byte : frame) {
      from.send(byte, now);
      while (from.state().sending) {
        const Event event = queue.pop();
        now = event.at;
        const auto report = (event.owner == kMasterPlc ? master : slave).handle(event);
        if (report.received) heard.push_back(*report.received);
      }
    }
    from.enable_receiver(true, now);
    now += 4 * kCharacter;
    return shown(heard);
  }
  std::string ask() { return send(master, kRequest); }
  std::string answer() { return send(slave, kAnswer); }
};

TEST(Faults, WhatAPlcAsksAnotherIsTheRequestAndWhatThatSaysTheAnswer) {
  const std::string request = "01 03 00p ff 55 aa 80 7f", answer = "fe 00 5ap c3";
  for (const auto& [of, in_request, in_answer] :
       {std::tuple{"request", true, false}, std::tuple{"answer", false, true}, std::tuple{"both", true, true}}) {
    ProgramThatAsks plant;
    plant.faults.inject(fault_of(std::string("parity:character=3,of=") + of), 0);
    for (const int exchange : {1, 2, 3}) {
      EXPECT_EQ(plant.ask(), in_request ? request : kWholeRequest) << of << exchange;
      EXPECT_EQ(plant.answer(), in_answer ? answer : kWholeAnswer) << of << exchange;
    }
  }
}

TEST(Faults, OfAPlcThatAsksBeginWithARequestWheneverTheyAreInjected) {
  ProgramThatAsks plant;
  plant.ask();
  plant.faults.inject(fault_of("parity:character=3,every=2"), plant.now);
  EXPECT_EQ(plant.answer(), kWholeAnswer);
  EXPECT_EQ(plant.ask(), kWholeRequest) << "first exchange";
  EXPECT_EQ(plant.ask(), "01 03 00p ff 55 aa 80 7f") << "second one, for nobody has answered";
  EXPECT_EQ(plant.answer(), kWholeAnswer);
  EXPECT_EQ(plant.ask(), kWholeRequest);
}

TEST(Faults, TheClockOfThePlcThatAsksIsTheMasters) {
  for (const auto& [error, bits] : {std::pair{"-10%", 8 * 11 / 0.9}, std::pair{"10%", 8 * 11 / 1.1}}) {
    ProgramThatAsks plant;
    plant.ask();
    plant.faults.inject(fault_of(std::string("baud:station=master,error=") + error), plant.now);
    const Time begin = plant.now;
    plant.ask();
    EXPECT_NEAR(static_cast<double>(plant.now - 4 * kCharacter - begin), bits * 1e9 / 9600, 20) << error;
  }
}

TEST(Faults, PortOfTheHostHearsItselfOnALineWithEcho) {
  const auto heard = [](const char* spec) {
    Line line;
    EventQueue queue;
    Uart plc(line, queue, kPlcUart, 0), uart(line, queue, kPeerUart, 2);
    HostPort port(uart);
    Faults faults(line, queue, kFaults);
    faults.add_plc(plc);
    faults.inject(fault_of(spec), 0);
    port.attach(k8E1, 0);
    Time at = 0;
    for (int request = 0; request < 2; ++request) {
      const std::vector<HostCharacter> characters{{.byte = 0x5A, .format = k8E1}, {.byte = 0xA5, .format = k8E1}};
      port.send(characters, at);
      while (queue.next() != kNever) {
        const Event event = queue.pop();
        if (event.owner == kPeerUart) port.on(uart.handle(event));
        if (event.owner == kPlcUart) plc.handle(event);
        at = event.at;
      }
      at += 10 * kCharacter;
    }
    return shown(port.take_received());
  };
  EXPECT_EQ(heard("echo"), "5a a5 5a a5");
  EXPECT_EQ(heard("echo:every=2"), "5a a5");
  EXPECT_EQ(heard("flip:of=answer"), "");
}

TEST(Faults, RestoredOneGoesOnAsItDid) {
  const std::initializer_list<const char*> kAll{"noise:ber=0.004", "extra:probability=0.5", "collision:every=3",
                                                "cut:character=5,for=3ms,every=4"};
  Plant plant(kAll);
  for (int i = 0; i < 10; ++i) plant.exchange();
  const Line line = plant.line;
  const EventQueue queue = plant.queue;
  const Uart::State plc = plant.plc.state(), master_uart = plant.master_uart.state();
  const Requester::State master = plant.master.state();
  const Faults::State faults = plant.faults.state();
  const Time now = plant.now;
  const auto go_on = [](Plant& on) {
    std::string all;
    for (int i = 0; i < 10; ++i) all += on.request_heard() + " / " + shown(on.master.exchange().response) + "\n";
    return all;
  };
  const std::string first = go_on(plant);
  Plant other;
  other.line = line;
  other.queue = queue;
  other.plc.restore(plc);
  other.master_uart.restore(master_uart);
  other.master.restore(master);
  other.faults.restore(faults);
  other.now = now;
  EXPECT_EQ(go_on(other), first);
  EXPECT_EQ(other.faults.state(), plant.faults.state());
}

TEST(Faults, ClearedOnesLeaveNothing) {
  Plant plant({"noise:ber=0.5", "baud:error=30%", "echo", "cut:from=1s"});
  plant.run_until(20 * ms);
  plant.faults.clear(plant.now);
  plant.run_until(40 * ms);
  plant.heard.clear();
  EXPECT_EQ(plant.request_heard(), kWholeRequest);
  EXPECT_EQ(shown(plant.master.exchange().response), kWholeAnswer);
  EXPECT_TRUE(plant.master.exchange().echo.empty());
  EXPECT_EQ(plant.line.interference(), nullptr);
}

}  // namespace
}  // namespace s7200::serial::faults_test
