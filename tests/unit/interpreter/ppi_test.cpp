// PPI on a port that is not in Freeport mode (facts 10.9). The master is that of tests/support/ppi_master.hpp.
#include "interpreter/cpu/ports/ppi.hpp"

#include <random>

#include "interpreter/cpu/ports/s7_services.hpp"
#include "interpreter/model/s7_pdu.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tests/support/ppi_master.hpp"

namespace s7200::test::ppi_test {
namespace {

using namespace ppi;

constexpr std::string_view kQuiet = "LD SM0.0\nINCW VW1000\nMEND\n";
constexpr std::uint8_t kV = 0x84;

const Bytes kReadVb100 = reading({variable(0x02, 4, kV, 100 * 8, 1)});

TEST(Ppi, ARequestIsAcceptedAndItsAnswerFetchedByAPoll) {
  Plc plc(kQuiet);
  plc.set("VD100", 0x12345678);
  Master master(plc);
  // The request in full: 4 bytes of DB 1 from bit address 16#000320.
  EXPECT_EQ(master.say({0x68, 0x1B, 0x1B, 0x68, 0x02, 0x00, 0x6C, 0x32, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00, 0x0E, 0x00, 0x00,
                        0x04, 0x01, 0x12, 0x0A, 0x10, 0x02, 0x00, 0x04, 0x00, 0x01, 0x84, 0x00, 0x03, 0x20, 0x8F, 0x16}),
            Bytes{0xE5});
  EXPECT_EQ(master.say({0x10, 0x02, 0x00, 0x5C, 0x5E, 0x16}),
            (Bytes{0x68, 0x19, 0x19, 0x68, 0x00, 0x02, 0x08, 0x32, 0x03, 0x00, 0x00, 0x00, 0x01, 0x00, 0x02, 0x00,
                   0x08, 0x00, 0x00, 0x04, 0x01, 0xFF, 0x04, 0x00, 0x20, 0x12, 0x34, 0x56, 0x78, 0x86, 0x16}));
}

// Published with the driver for the S7-200 in the project iottree.
TEST(Ppi, ExchangesRecordedWithAnS7200AreReproduced) {
  Plc plc("LD SM0.0\nTON T32, 1\nMEND\n");
  plc.run_until(50 * ms);
  plc.set("T32", 32760);
  plc.set("T40", 21);
  plc.run_until(100 * ms);
  Master master(plc);
  const auto ask = [&](const Bytes& request) {
    EXPECT_EQ(master.say(request), Bytes{0xE5});
    return master.say({0x10, 0x02, 0x00, 0x5C, 0x5E, 0x16});
  };
  // T32 to T34, of which the first is at its end; T40 to T43, of which the first runs.
  EXPECT_EQ(ask({0x68, 0x1B, 0x1B, 0x68, 0x02, 0x00, 0x6C, 0x32, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x0E, 0x00, 0x00,
                 0x04, 0x01, 0x12, 0x0A, 0x10, 0x1F, 0x00, 0x03, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x20, 0x41, 0x16}),
            (Bytes{0x68, 0x24, 0x24, 0x68, 0x00, 0x02, 0x08, 0x32, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00,
                   0x02, 0x00, 0x13, 0x00, 0x00, 0x04, 0x01, 0xFF, 0x09, 0x00, 0x0F, 0x02, 0x00, 0x00,
                   0x7F, 0xFF, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x16}));
  EXPECT_EQ(ask({0x68, 0x1B, 0x1B, 0x68, 0x02, 0x00, 0x6C, 0x32, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x0E, 0x00, 0x00,
                 0x04, 0x01, 0x12, 0x0A, 0x10, 0x1F, 0x00, 0x04, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x28, 0x4A, 0x16}),
            (Bytes{0x68, 0x29, 0x29, 0x68, 0x00, 0x02, 0x08, 0x32, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x00,
                   0x18, 0x00, 0x00, 0x04, 0x01, 0xFF, 0x09, 0x00, 0x14, 0x00, 0x00, 0x00, 0x00, 0x15, 0x00, 0x00,
                   0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x8F, 0x16}));
  // STOP.
  EXPECT_EQ(ask({0x68, 0x1D, 0x1D, 0x68, 0x02, 0x00, 0x6C, 0x32, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x10, 0x00, 0x00, 0x29,
                 0x00, 0x00, 0x00, 0x00, 0x00, 0x09, 0x50, 0x5F, 0x50, 0x52, 0x4F, 0x47, 0x52, 0x41, 0x4D, 0xAA, 0x16}),
            (Bytes{0x68, 0x10, 0x10, 0x68, 0x00, 0x02, 0x08, 0x32, 0x03, 0x00, 0x00,
                   0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x29, 0x69, 0x16}));
  EXPECT_EQ(plc.cpu.state().mode, Mode::Stop);
}

TEST(Ppi, ARepliesBeginElevenBitTimesAfterTheRequest) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(master.say(sd1(2, 0, 0x49)), sd1(0, 2, 0x00));
  ASSERT_EQ(plc.port.sent.size(), 6U);
  EXPECT_NEAR(static_cast<double>(plc.port.sent[0].at - master.end_of_frame()), 11.0 * kBit, 200);
  EXPECT_EQ(plc.port.sent[1].at - plc.port.sent[0].at, kCharacter);
  EXPECT_TRUE(plc.port.receiver) << "it listens again";
}

TEST(Ppi, TheStatusIsThatOfASlave) {
  Plc plc(kQuiet);
  EXPECT_EQ(Master(plc, 1).say({0x10, 0x02, 0x01, 0x49, 0x4C, 0x16}), (Bytes{0x10, 0x01, 0x02, 0x00, 0x03, 0x16}));
}

TEST(Ppi, TheAnswerIsNotThereBeforeTheCommunicationPartOfTheScan) {
  // A scan of 200 ms: the polls meanwhile are accepted without an answer.
  std::string program = "LD SM0.0\n";
  for (int i = 0; i < 40; ++i) program += "SQRT VD8, VD12\n";
  Plc plc(program + "MEND\n");
  Master master(plc);
  plc.run_until(5 * ms);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kReadVb100), 15 * ms), Bytes{0xE5});
  EXPECT_EQ(master.say(sd1(2, 0, 0x5C), 15 * ms), Bytes{0xE5});
  EXPECT_EQ(master.say(sd1(2, 0, 0x7C), 200 * ms), Bytes{0xE5});
  EXPECT_GT(master.say(sd1(2, 0, 0x5C)).size(), 9U);
}

TEST(Ppi, ARepeatedPollGetsTheAnswerAgain) {
  Plc plc(kQuiet);
  Master master(plc);
  master.say(sd2(2, 0, 0x6C, kReadVb100));
  const Bytes answer = master.say(sd1(2, 0, 0x5C));
  EXPECT_GT(answer.size(), 9U);
  EXPECT_EQ(master.say(sd1(2, 0, 0x5C)), answer);
  EXPECT_EQ(master.say(sd1(2, 0, 0x7C)), Bytes{0xE5}) << "the other frame count bit: the answer has arrived";
  EXPECT_EQ(master.say(sd1(2, 0, 0x5C)), Bytes{0xE5});
}

TEST(Ppi, AnotherMasterIsToldThatThereIsNoResource) {
  Plc plc(kQuiet);
  Master first(plc, 0), second(plc, 1);
  EXPECT_EQ(first.say(sd2(2, 0, 0x6C, kReadVb100), 20 * ms), Bytes{0xE5});
  EXPECT_EQ(second.say(sd2(2, 1, 0x6C, kReadVb100), 20 * ms), sd1(1, 2, 0x02));
  EXPECT_EQ(second.say(sd1(2, 1, 0x5C), 20 * ms), sd1(1, 2, 0x02)) << "a poll is told the same";
  EXPECT_GT(first.say(sd1(2, 0, 0x5C), 60 * ms).size(), 9U);
  EXPECT_EQ(second.say(sd1(2, 1, 0x5C), 20 * ms), Bytes{0xE5}) << "it has asked nothing";
  EXPECT_EQ(second.say(sd2(2, 1, 0x6C, kReadVb100), 20 * ms), Bytes{0xE5});
}

TEST(Ppi, ASecondRequestTakesThePlaceOfTheFirst) {
  Plc plc(kQuiet);
  plc.set("VB200", 0x22);
  Master master(plc);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kReadVb100)), Bytes{0xE5});
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, reading({variable(2, 1, kV, 200 * 8, 1)}))), Bytes{0xE5});
  const Bytes answer = master.say(sd1(2, 0, 0x5C));
  ASSERT_GE(answer.size(), 9U);
  EXPECT_EQ(value_of({answer.begin() + 7, answer.end() - 2}), Bytes{0x22});
  EXPECT_EQ(master.say(sd1(2, 0, 0x7C)), Bytes{0xE5}) << "there is no other";
}

TEST(Ppi, ASecondRequestIsRefusedWhereThatIsChosen) {
  Plc plc(with_system_block(*program_of(kQuiet), {.second_request = SecondRequest::Refused}));
  plc.set("VB200", 0x22);
  const Bytes second = sd2(2, 0, 0x6C, reading({variable(2, 1, kV, 200 * 8, 1)}));
  Master master(plc);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kReadVb100)), Bytes{0xE5});
  EXPECT_EQ(master.say(second), (Bytes{0x10, 0x00, 0x02, 0x02, 0x04, 0x16}));
  EXPECT_EQ(value_of(master.fetch()).size(), 4U) << "the answer to the first";
  EXPECT_EQ(master.say(second), Bytes{0xE5}) << "now it is taken";
  plc.run_until(plc.cpu.state().ppi[0].asked + s7200::ppi::kPatienceOfMasters);
  EXPECT_EQ(master.say(second), Bytes{0xE5}) << "it has given up the one before";
  EXPECT_EQ(value_of(master.fetch()), Bytes{0x22});
}

TEST(Ppi, WhatIsDoneWithASecondRequestIsOneOfTwoWords) {
  EXPECT_EQ(parse_second_request("replaces"), SecondRequest::Replaces);
  EXPECT_EQ(parse_second_request("refused"), SecondRequest::Refused);
  EXPECT_EQ(parse_second_request("queued").why(),
            "'queued' is not what a port does with a second request; write replaces or refused");
}

TEST(Ppi, AMasterThatHasGivenUpIsNoLongerWaitedFor) {
  Plc plc(kQuiet);
  Master first(plc, 0), second(plc, 1);
  first.say(sd2(2, 0, 0x6C, kReadVb100));
  const Time asked = plc.cpu.state().ppi[0].asked;
  plc.run_until(asked + s7200::ppi::kPatienceOfMasters - 50 * ms);
  EXPECT_EQ(second.say(sd2(2, 1, 0x6C, kReadVb100)), sd1(1, 2, 0x02));
  plc.run_until(asked + s7200::ppi::kPatienceOfMasters);
  EXPECT_EQ(second.say(sd2(2, 1, 0x6C, kReadVb100)), Bytes{0xE5});
  EXPECT_GT(second.say(sd1(2, 1, 0x5C)).size(), 9U);
  EXPECT_EQ(first.say(sd1(2, 0, 0x5C)), Bytes{0xE5}) << "its answer is gone";
}

TEST(Ppi, WhatIsNoFrameOrForAnotherStationIsIgnored) {
  Plc plc(kQuiet);
  Master master(plc);
  const Bytes good = sd2(2, 0, 0x6C, kReadVb100);
  const auto with = [&](std::size_t at, std::uint8_t byte) {
    Bytes changed = good;
    changed[at] = byte;
    return changed;
  };
  EXPECT_EQ(master.say(sd2(3, 0, 0x6C, kReadVb100)), Bytes{}) << "another station";
  EXPECT_EQ(master.say(with(good.size() - 2, 0x00)), Bytes{}) << "check sum";
  EXPECT_EQ(master.say(with(good.size() - 1, 0x17)), Bytes{}) << "end";
  EXPECT_EQ(master.say(with(2, 0x1C)), Bytes{}) << "the two lengths differ";
  EXPECT_EQ(master.say(with(3, 0x69)), Bytes{});
  EXPECT_EQ(master.say({0x68, 2, 2, 0x68, 2, 0, 2, 0x16}), Bytes{}) << "too short";
  EXPECT_EQ(master.say({good.begin(), good.end() - 3}), Bytes{}) << "cut off";
  EXPECT_EQ(master.say({0x02, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x39}), Bytes{}) << "Modbus";
  EXPECT_EQ(master.say({0xE5}), Bytes{});
  EXPECT_EQ(master.say({0xDC, 0x02, 0x00}), Bytes{}) << "a token";
  EXPECT_EQ(master.say(sd2(2, 0, 0x08, kReadVb100)), Bytes{}) << "a reply of another slave";
  EXPECT_EQ(master.say(good), Bytes{0xE5});
  EXPECT_EQ(plc.records.of(TraceKind::PpiIgnored).size(), 2U);
}

TEST(Ppi, TheTraceHasOneLineForADamagedFrame) {
  Plc plc(kQuiet);
  std::ostringstream text;
  TextTrace trace(text, program_of(kQuiet), TraceDetail::Events);
  Master master(plc);
  master.say(joined({{0x68, 0x1B, 0x1C, 0x68}, Bytes(20, 0x55)}));
  master.say(sd1(2, 0, 0x49));
  master.say({0x02, 0x03, 0x00});
  for (const TraceRecord& record : plc.records.of(TraceKind::CharacterIgnored)) trace.record(record);
  const std::string lines = text.str();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1 + 2) << lines;
  EXPECT_NE(
      lines.find("ignored  68 and the rest up to the next pause: the port is in PPI mode, and this is not a PPI frame\n"),
      std::string::npos)
      << lines;
}

TEST(Ppi, AfterABadCharacterNothingIsUnderstoodUntilThereIsSilence) {
  Plc plc(kQuiet);
  const Bytes frame = sd1(2, 0, 0x49);
  const auto send = [&](Time begin, std::size_t bad) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const Time start = begin + static_cast<Time>(i) * kCharacter;
      plc.received_at({.byte = frame[i], .parity_error = i == bad, .start = start, .end = start + 10 * kBit + kBit / 2});
    }
    return begin + 6 * kCharacter;
  };
  const Time first = send(10 * ms, 1), second = send(first, 99);
  plc.run_until(second + 10 * ms);
  EXPECT_TRUE(plc.port.sent.empty()) << "the second frame follows at once";
  send(second + 10 * ms, 99);
  plc.run_until(second + 40 * ms);
  EXPECT_EQ(plc.port.sent.size(), 6U);
}

TEST(Ppi, ThePortIsAtTheRateOfTheSystemBlock) {
  for (const auto& [baud, model] : {std::pair{9600U, &cpu214()}, {19200U, &cpu214()}, {187500U, &cpu224()}}) {
    Plc plc(at_rate(kQuiet, baud, *model));
    EXPECT_EQ(plc.port.format, (SerialFormat{baud, 8, Parity::Even, 1}));
    Master master(plc, 0, baud);
    EXPECT_EQ(master.say(sd1(2, 0, 0x49)), sd1(0, 2, 0x00)) << baud;
    ASSERT_EQ(plc.port.sent.size(), 6U);
    EXPECT_NEAR(static_cast<double>(plc.port.sent[0].at - master.end_of_frame()), 11e9 / baud, 200);
    EXPECT_EQ(code_of(master.ask(kReadVb100)), 0xFF) << baud;
  }
}

TEST(Ppi, SilenceIsOfTheRateOfThePort) {
  Plc plc(at_rate(kQuiet, 187500, cpu224()));
  Master master(plc, 0, 187500);
  plc.received_at({.byte = 0x68, .start = 10 * ms, .end = 10 * ms + 56 * us});  // the begin of a frame that is cut off
  plc.run_until(10 * ms + 100 * us);
  EXPECT_EQ(master.say(sd1(2, 0, 0x49)), sd1(0, 2, 0x00)) << "213 us later, which is 40 bits";
}

TEST(Ppi, EachPortHasARateOfItsOwnAndComesBackToItFromFreeport) {
  const auto program =
      with_system_block(*program_of("LD SM0.7\nMOVB 16#89, SMB30\nLDN SM0.7\nMOVB 0, SMB30\nMEND\n", cpu226()),
                        {.ppi_rates = {19200, 187500}});
  Plc plc(program);
  EXPECT_EQ(plc.port.format.baud, 19200U);
  EXPECT_EQ(plc.port1.format.baud, 187500U);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.port.format.baud, 9600U) << "as SMB30 says in Freeport mode";
  plc.set("SMB0", plc.value("SMB0") & 0x7F);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.port.format.baud, 19200U);
}

TEST(PpiRates, AreThoseOfTheCpu) {
  std::string why;
  const auto rates = [&](std::string_view text, const CpuModel& model) {
    const auto read = parse_ppi_rates(text, model);
    why = read.why();
    return read.value_or(PpiRates{});
  };
  EXPECT_EQ(rates("19200", cpu214()), (PpiRates{19200, 19200}));
  EXPECT_EQ(rates("187500", cpu221()), (PpiRates{187500, 187500}));
  EXPECT_EQ(rates("9600, 187500", cpu226()), (PpiRates{9600, 187500}));
  EXPECT_EQ(rates("187500", cpu214()), PpiRates{});
  EXPECT_EQ(why, "PPI at 187500 baud needs CPU 22x; choose one, such as CPU 224");
  EXPECT_EQ(rates("38400", cpu224()), PpiRates{});
  EXPECT_EQ(why, "'38400' is not a rate of PPI; write 9600, 19200 or, on CPU 22x, 187500");
  EXPECT_EQ(rates("9600,19200", cpu214()), PpiRates{});
  EXPECT_EQ(why, "CPU 214 has no port 1 for the second rate; a second port needs CPU 216, 224XP, 226, 226r1 or 226XM");
  EXPECT_EQ(rates("9600,19200,9600", cpu226()), PpiRates{});
  EXPECT_EQ(why, "CPU 226 has no port 2 for the third rate");
  EXPECT_EQ(rates("9600,", cpu226()), PpiRates{});
  EXPECT_EQ(to_text(PpiRates{9600, 19200}), "9600,19200");
  EXPECT_EQ(to_text(PpiRates{19200, 19200}), "19200");
}

TEST(Ppi, WhatIsNotModelledIsIgnoredAndNamedInTheTrace) {
  Plc plc(kQuiet);
  Master master(plc, 1);
  const auto named = [&](const Bytes& frame) {
    plc.records.all.clear();
    EXPECT_EQ(master.say(frame, 20 * ms), Bytes{});
    const auto records = plc.records.of(TraceKind::PpiNotModelled);
    return records.size() == 1 ? describe(records[0], plc.cpu.program()) : std::to_string(records.size()) + " records";
  };
  EXPECT_EQ(named({0xDC, 2, 1}), "PPI token from station 1 ignored: passing the token on is not modelled");
  EXPECT_EQ(named({0xDC, 3, 1}), "0 records") << "for another master";
  EXPECT_EQ(named(sd2(127, 1, 0x6C, kReadVb100)), "PPI broadcast from station 1 ignored: broadcasts are not modelled");
  EXPECT_EQ(named(sd2(0x82, 1, 0x6C, kReadVb100)),
            "PPI frame from 16#01 to 16#82 ignored: addresses above 127 are not modelled");
  EXPECT_EQ(named(sd2(2, 0x81, 0x6C, kReadVb100)),
            "PPI frame from 16#81 to 16#02 ignored: addresses above 127 are not modelled");
  EXPECT_EQ(named(sd2(0x83, 1, 0x6C, kReadVb100)), "0 records") << "for another station";
  EXPECT_EQ(named(sd2(3, 1, 0x6C, kReadVb100)), "0 records") << "a slave hears a master and another slave";
}

TEST(Ppi, WhatIsNoS7RequestGetsNoAnswerAndIsNamedInTheTrace) {
  Plc plc(kQuiet);
  Master master(plc, 1);
  const Bytes not_its_length{0x32, 1, 0, 0, 0, 0, 0, 9, 0, 0, 0x04}, of_another_kind{0x32, 3, 0, 0, 0, 0, 0, 0, 0, 0},
      of_another_protocol{0x72, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  for (const Bytes& nonsense : {not_its_length, of_another_kind, of_another_protocol}) {
    plc.records.all.clear();
    EXPECT_EQ(master.say(sd2(2, 1, 0x6C, nonsense), 20 * ms), Bytes{0xE5});
    const auto records = plc.records.of(TraceKind::PpiNotModelled);
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(describe(records[0], plc.cpu.program()),
              "PPI station 1 asks, but with no S7 request in it: it gets no answer");
    EXPECT_EQ(master.say(sd1(2, 1, 0x5C), 20 * ms), Bytes{0xE5});
  }
}

TEST(Ppi, WhatIsIgnoredIsInTheTraceWhenItsLastCharacterHasCome) {
  Plc plc(kQuiet);
  Master master(plc, 1);
  const auto last_come = [&] { return master.end_of_frame() - kCharacter + 10 * (kSecond / 9600) + kSecond / 9600 / 2; };
  Bytes damaged = sd2(2, 1, 0x6C, kReadVb100);
  damaged.back() = 0x17;
  master.say(damaged);
  EXPECT_EQ(plc.records.times(TraceKind::PpiIgnored), std::vector<Time>{last_come()});
  for (const Bytes& frame : {Bytes{0xDC, 2, 1}, sd2(127, 1, 0x6C, kReadVb100), sd2(0x82, 1, 0x6C, kReadVb100)}) {
    plc.records.all.clear();
    master.say(frame);
    EXPECT_EQ(plc.records.times(TraceKind::PpiNotModelled), std::vector<Time>{last_come()});
  }
}

TEST(Ppi, AServiceThatASlaveHasNotIsRefused) {
  Plc plc(kQuiet);
  EXPECT_EQ(Master(plc).say(sd2(2, 0, 0x73, {1, 2})), sd1(0, 2, 0x03));
}

TEST(Ppi, AnSd3IsARequestToo) {
  Plc plc(kQuiet);
  const Bytes body{2, 0, 0x6C, 0x32, 1, 0, 0, 0, 1, 0, 0};
  EXPECT_EQ(Master(plc).say(joined({{0xA2}, body, {sum(body), 0x16}})), Bytes{0xE5});
}

TEST(Ppi, ItsStationIsWhatTheProgramHasSet) {
  Plc plc("LD SM0.1\nMOVB 7, VB0\nSPA VB0, 0\nMEND\n", cpu224());
  plc.run_until(5 * ms);
  Master master(plc);
  EXPECT_EQ(master.ask(kReadVb100, 2), Bytes{});
  EXPECT_EQ(code_of(master.ask(kReadVb100, 7)), 0xFF);
}

TEST(Ppi, ItsStationIsThatOfTheSystemBlockUntilTheProgramSetsAnother) {
  Plc plc(with_system_block(*program_of("LD SM0.0\nMEND\n", cpu214()), {.ppi_stations = {9, 9}}));
  plc.run_until(5 * ms);
  Master master(plc);
  EXPECT_EQ(master.ask(kReadVb100, 2), Bytes{});
  EXPECT_EQ(code_of(master.ask(kReadVb100, 9)), 0xFF);
  Plc other(
      with_system_block(*program_of("LD SM0.1\nMOVB 7, VB0\nSPA VB0, 0\nMEND\n", cpu226()), {.ppi_stations = {9, 10}}));
  other.run_until(5 * ms);
  EXPECT_EQ(other.cpu.state().station[0], 7);
  EXPECT_EQ(other.cpu.state().station[1], 10);
}

TEST(PpiStations, AreFrom1To126) {
  std::string why;
  const auto stations = [&](std::string_view text, const CpuModel& model) {
    const auto read = parse_ppi_stations(text, model);
    why = read.why();
    return read.value_or(PpiStations{});
  };
  EXPECT_EQ(stations("1", cpu214()), (PpiStations{1, 1}));
  EXPECT_EQ(stations("3, 126", cpu226()), (PpiStations{3, 126}));
  for (const std::string_view wrong : {"0", "127", "256", "-1", "x", ""}) {
    EXPECT_EQ(stations(wrong, cpu226()), PpiStations{}) << wrong;
    EXPECT_EQ(why, fmt::format("'{}' is not a PPI station from 1 to 126", wrong));
  }
  EXPECT_EQ(stations("3,4", cpu214()), PpiStations{});
  EXPECT_EQ(why, "CPU 214 has no port 1 for the second station; a second port needs CPU 216, 224XP, 226, 226r1 or 226XM");
  EXPECT_EQ(to_text(PpiStations{3, 4}), "3,4");
  EXPECT_EQ(to_text(PpiStations{3, 3}), "3");
}

TEST(Ppi, TheModeSwitchTurnsFreeportOnAndOffWhereTheProgramCopiesIt) {
  Plc plc("LD SM0.7\nMOVB 9, SMB30\nLDN SM0.7\nMOVB 8, SMB30\nMEND\n");
  const auto turn_to = [&](bool run) {
    const auto status = static_cast<std::uint32_t>(plc.value("SMB0"));
    plc.set("SMB0", run ? status | 0x80 : status & 0x7F);
    plc.run_until(plc.cpu.time() + 5 * ms);
  };
  Master master(plc);
  plc.run_until(5 * ms);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kReadVb100)), Bytes{}) << "RUN: Freeport mode";
  turn_to(false);
  EXPECT_EQ(code_of(master.ask(kReadVb100)), 0xFF) << "TERM";
  EXPECT_EQ(plc.port.format, (SerialFormat{.baud = 9600, .data_bits = 8, .parity = Parity::Even, .stop_bits = 1}));
  turn_to(true);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kReadVb100)), Bytes{});
  EXPECT_EQ(plc.port.format.parity, Parity::None);
  turn_to(false);
  EXPECT_EQ(code_of(master.ask(kReadVb100)), 0xFF);
}

const Bytes kProgram{9, 'P', '_', 'P', 'R', 'O', 'G', 'R', 'A', 'M'};
const Bytes kToRun = request(joined({{0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0}, kProgram}));
const Bytes kToStop = request(joined({{0x29, 0, 0, 0, 0, 0}, kProgram}));

constexpr std::string_view kEcho =
    "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMEND\n"
    "INT 0\nLD SM0.0\nMOVB 1, VB100\nMOVB SMB2, VB101\nXMT VB100, 0\nRETI\n";

TEST(Ppi, AnAcceptanceThatIsDueLeavesBeforeFreeportBegins) {
  // SM0.7 turns Freeport on after each time in the eleven bits before E5, and in E5.
  for (const Time after : {100 * us, 800 * us, 1200 * us, 2 * ms}) {
    Plc plc(
        "LD SM0.7\nEU\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM0.0\nMOVB 1, VB100\nMOVB SMB2, VB101\n"
        "XMT VB100, 0\nRETI\n");
    Master master(plc);
    plc.set("SMB0", plc.cpu.state().image[sm::kScanStatus] & 0x7F);
    plc.run_until(10 * ms);
    master.say(sd2(2, 0, 0x6C, kReadVb100), after);
    plc.set("SMB0", plc.cpu.state().image[sm::kScanStatus] | 0x80);
    plc.run_until(plc.cpu.time() + 20 * ms);
    ASSERT_EQ(plc.port.sent.size(), 1U) << after;
    EXPECT_EQ(plc.port.sent[0].byte, 0xE5);
    EXPECT_EQ(plc.port.format.parity, Parity::None) << "Freeport";
    EXPECT_TRUE(plc.port.receiver) << after;
    EXPECT_GE(plc.port.configured_at, plc.port.sent[0].at + kCharacter) << after << ": E5 leaves as PPI sends it";
    EXPECT_EQ(master.say({0x42}), Bytes{0x42}) << after;
  }
}

TEST(Ppi, RunAndStopTakeEffectWhenTheirAnswerHasLeft) {
  Plc plc(kEcho);
  plc.cpu.power_up(false, nullptr);
  Master master(plc);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kToRun)), Bytes{0xE5});
  EXPECT_TRUE(plc.stopped());
  EXPECT_EQ(master.say(sd1(2, 0, 0x5C)).size(), 22U) << "the whole answer";
  EXPECT_FALSE(plc.stopped());
  EXPECT_EQ(plc.records.of(TraceKind::ModeChange).back().at / ms, (plc.port.sent.back().at + kCharacter) / ms);
  EXPECT_EQ(master.say({0x42}), Bytes{0x42}) << "Freeport";
}

TEST(Ppi, AMasterThatDoesNotFetchTheAnswerToStopDoesNotStopTheCpu) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kToStop)), Bytes{0xE5});
  EXPECT_FALSE(plc.stopped());
  EXPECT_EQ(code_of(master.ask(kReadVb100)), 0xFF);
  EXPECT_FALSE(plc.stopped()) << "it has asked for something else";
}

TEST(Ppi, ARequestThatFollowsTheAnswerToStopInALongScanDoesNotCancelIt) {
  std::string program = "LD SM0.0\n";
  for (int i = 0; i < 40; ++i) program += "SQRT VD8, VD12\n";
  Plc plc(program + "MEND\n");
  Master master(plc);
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kToStop), 300 * ms), Bytes{0xE5});
  EXPECT_GT(master.say(sd1(2, 0, 0x5C), 27 * ms).size(), 9U);
  EXPECT_FALSE(plc.stopped()) << "the scan is not over";
  EXPECT_EQ(master.say(sd2(2, 0, 0x6C, kReadVb100)), Bytes{0xE5});
  EXPECT_TRUE(plc.stopped());
}

TEST(Ppi, XmtWaitsForTheCharacterThatIsLeaving) {
  // I0.0 switches to Freeport mode and sends, in the middle of an answer.
  Plc plc("LD I0.0\nEU\nMOVB 9, SMB30\nMOVB 1, VB100\nMOVB 16#41, VB101\nXMT VB100, 0\nMEND\n");
  Master master(plc);
  master.say(sd2(2, 0, 0x6C, kReadVb100));
  plc.port.sent.clear();
  const Time begin = plc.cpu.time() + 10 * ms;
  const Bytes poll = sd1(2, 0, 0x5C);
  for (std::size_t i = 0; i < poll.size(); ++i) {
    const Time start = begin + static_cast<Time>(i) * kCharacter;
    plc.received_at({.byte = poll[i], .start = start, .end = start + 10 * kBit + kBit / 2});
  }
  plc.input_at(begin + 12 * kCharacter, "I0.0", true);
  plc.run_until(begin + 100 * ms);
  ASSERT_GE(plc.port.sent.size(), 3U);
  EXPECT_LT(plc.port.sent.size(), 10U) << "the answer was cut off";
  EXPECT_EQ(plc.port.sent.back().byte, 0x41);
  EXPECT_EQ(plc.port.sent.back().at, (plc.port.sent.end() - 2)->at + kCharacter);
}

TEST(Ppi, EachPortOfACpuWithTwoIsAStation) {
  Plc plc(kQuiet, cpu226());
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(kReadVb100)), 0xFF);
  const Bytes frame = sd1(2, 0, 0x49);
  const Time begin = plc.cpu.time() + 10 * ms;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Time start = begin + static_cast<Time>(i) * kCharacter;
    plc.received_at({.byte = frame[i], .start = start, .end = start + 10 * kBit + kBit / 2}, 1);
  }
  plc.run_until(begin + 30 * ms);
  EXPECT_EQ(plc.port1.sent.size(), 6U);
}

TEST(Ppi, RandomCharactersNeverGetMoreThanAnAcceptance) {
  Plc plc(kQuiet);
  std::mt19937 random(20261122);
  Time at = 5 * ms;
  for (int i = 0; i < 20'000; ++i) {
    // Delimiters and short numbers, so that there are whole frames among them.
    static constexpr std::uint8_t kLikely[] = {0x10, 0x68, 0xA2, 0xE5, 0x16, 0x02, 0x00, 0x6C, 0x5C, 0x03, 0x04, 0x05};
    const auto draw = static_cast<std::uint32_t>(random());
    const auto byte = draw % 3 == 0 ? static_cast<std::uint8_t>(draw >> 8) : kLikely[(draw >> 8) % std::size(kLikely)];
    at += kCharacter + (draw >> 20) % 40 * (draw >> 28 == 0 ? 10 * kBit : 0);
    plc.received_at({.byte = byte, .parity_error = draw % 97 == 0, .start = at, .end = at + 10 * kBit + kBit / 2});
  }
  const auto memory = plc.cpu.state().image;
  plc.run_until(at + 50 * ms);
  EXPECT_TRUE(std::equal(memory.begin() + image::kV + 1002, memory.begin() + image::kL,
                         plc.cpu.state().image.begin() + image::kV + 1002));
}

// --- services ---

TEST(S7Services, EachAreaIsReadAtItsPlace) {
  Plc plc(kQuiet, cpu224());
  plc.set("VB200", 0x84);
  plc.set("MB3", 0x83);
  plc.set("QB0", 0x82);
  plc.set("SMB34", 0x55);
  plc.set("SB2", 0x33);
  plc.set("AQW2", 0x0707);
  plc.set("AIW4", 0x0606);
  plc.input("I0.2", true);
  plc.run_until(10 * ms);
  Master master(plc);
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x84, 200 * 8, 1)}))), Bytes{0x84});
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x83, 3 * 8)}))), Bytes{0x83});
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x82, 0)}))), Bytes{0x82});
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x81, 0)}))), Bytes{0x04});
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x05, 34 * 8)}))), Bytes{0x55});
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x04, 2 * 8)}))), Bytes{0x33});
  EXPECT_EQ(value_of(master.ask(reading({variable(4, 1, 0x07, 2 * 8)}))), (Bytes{0x07, 0x07}));
  EXPECT_EQ(value_of(master.ask(reading({variable(4, 1, 0x06, 4 * 8)}))), (Bytes{0x06, 0x06}));
  EXPECT_EQ(value_of(master.ask(reading({variable(1, 1, 0x81, 2)}))), Bytes{1}) << "I0.2";
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, 0x05, 6 * 8)}))), Bytes{cpu224().identification})
      << "SMB6: which CPU";
}

TEST(S7Services, TimersAndCountersHaveAStatusAndTheirCurrentValue) {
  Plc plc("LD SM0.0\nTON T37, 1000\nTON T38, 1\nMEND\n");
  plc.run_until(50 * ms);
  plc.set("T38", 32766);
  plc.set("C5", 0x0102);
  plc.set("C6", 0x0304);
  plc.run_until(550 * ms);
  Master master(plc);
  EXPECT_EQ(value_of(master.ask(reading({variable(0x1E, 2, 0x1E, 5)}))), (Bytes{0, 0x01, 0x02, 0, 0x03, 0x04}));
  const Bytes timers = value_of(master.ask(reading({variable(0x1F, 2, 0x1F, 37)})));
  ASSERT_EQ(timers.size(), 10U);
  EXPECT_EQ(Bytes(timers.begin(), timers.begin() + 4), (Bytes{0, 0, 0, 0})) << "it runs";
  EXPECT_GE(timers[4], 5);
  EXPECT_EQ(Bytes(timers.begin() + 5, timers.end()), (Bytes{2, 0, 0, 0x7F, 0xFF})) << "at its end";
  EXPECT_EQ(code_of(master.ask(writing(variable(0x1E, 1, 0x1E, 5), 0x09, 3, {0, 0x00, 0x63}))), 0xFF);
  EXPECT_EQ(code_of(master.ask(writing(variable(0x1E, 1, 0x1E, 5), 0x09, 2, {0x00, 0x63}))), 0x06) << "without its status";
  EXPECT_EQ(plc.value("C5"), 99);
  EXPECT_EQ(code_of(master.ask(reading({variable(2, 2, 0x1E, 5)}))), 0x06) << "bytes of a counter";
}

TEST(S7Services, ANegativeCurrentValueOfATimerIsWritten) {
  Plc plc("LD SM0.0\nTON T37, 1000\nMEND\n");
  plc.run_until(50 * ms);
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(writing(variable(0x1F, 1, 0x1F, 37), 0x09, 5, {0, 0, 0, 0xFF, 0x00}))), 0xFF);
  const auto after = static_cast<std::int16_t>(plc.value("T37"));
  EXPECT_LT(after, -200);
  plc.run_until(plc.cpu.time() + 500 * ms);
  EXPECT_NEAR(static_cast<std::int16_t>(plc.value("T37")), after + 5, 1);
}

TEST(S7Services, HighSpeedCountersAreReadAsDoubleWords) {
  Plc plc("LD SM0.1\nHDEF 0, 0\nMOVB 16#F8, SMB37\nMOVD +5, SMD38\nHSC 0\nMEND\n");
  plc.run_until(5 * ms);
  Master master(plc);
  EXPECT_EQ(value_of(master.ask(reading({variable(0x20, 1, 0x20, 0)}))), (Bytes{0, 0, 0, 5}));
}

TEST(S7Services, TheIdentificationIsNameAndRelease) {
  const auto text = [](const CpuModel& model) {
    Plc plc(kQuiet, model);
    const Bytes value = value_of(Master(plc).ask(reading({variable(2, 20, 0x03, 0)})));
    return std::string(value.begin(), value.end());
  };
  EXPECT_EQ(text(cpu226()), "CPU 226         0200");
  EXPECT_EQ(text(cpu224xp()), "CPU 224XP       0200");
  EXPECT_EQ(text(cpu226r1()), "CPU 226         0100");
  EXPECT_EQ(text(cpu226xm()), "CPU 226XM       0100");
  EXPECT_EQ(text(cpu214()), "CPU 214         0100");

  Plc plc(kQuiet, cpu226());
  Master master(plc);
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 2, 0x03, 16 * 8)}))), (Bytes{'0', '2'})) << "part of it";
  EXPECT_EQ(code_of(master.ask(reading({variable(2, 21, 0x03, 0)}))), 0x05) << "there are 20 bytes";
  EXPECT_EQ(code_of(master.ask(reading({variable(1, 1, 0x03, 0)}))), 0x06) << "it has no bits";
  EXPECT_EQ(code_of(master.ask(writing(variable(2, 1, 0x03, 0), 0x04, 8, {'X'}))), 0x03) << "it cannot be written";
  EXPECT_EQ(text(cpu226()), "CPU 226         0200");
}

TEST(S7Services, BitsBytesAndWordsAreWritten) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(writing(variable(2, 3, kV, 500 * 8, 1), 0x04, 24, {1, 2, 3}))), 0xFF);
  EXPECT_EQ(plc.value("VW500"), 0x0102);
  EXPECT_EQ(plc.value("VB502"), 3);
  EXPECT_EQ(plc.value("VB503"), 0);
  EXPECT_EQ(code_of(master.ask(writing(variable(1, 1, 0x83, 31 * 8 + 7), 0x03, 1, {1}))), 0xFF);
  EXPECT_EQ(plc.value("M31.7"), 1);
  EXPECT_EQ(plc.value("MB31"), 0x80);
  EXPECT_EQ(code_of(master.ask(writing(variable(4, 1, kV, 510 * 8, 1), 0x04, 16, {0xFF, 0xFE}))), 0xFF);
  EXPECT_EQ(plc.value("VW510"), -2);
}

TEST(S7Services, ALengthInBitsIsRoundedUpToBytes) {
  for (const s7::DataType in_bits : {s7::kInBits, s7::kInBitsOfBytes}) {
    EXPECT_EQ(s7::data_bytes(in_bits, 1), 1U);
    EXPECT_EQ(s7::data_bytes(in_bits, 9), 2U);
  }
  EXPECT_EQ(s7::data_bytes(s7::kInBytes, 9), 9U);
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(writing(variable(2, 2, kV, 500 * 8, 1), 0x04, 15, {1, 2}))), 0xFF);
  EXPECT_EQ(plc.value("VW500"), 0x0102);
}

TEST(S7Services, AWriteWithFewerValuesThanVariablesWritesNone) {
  Plc plc(kQuiet);
  Master master(plc);
  const Bytes variables = joined({{0x05, 2}, variable(2, 1, kV, 500 * 8, 1), variable(2, 1, kV, 502 * 8, 1)});
  EXPECT_EQ(error_of(master.ask(request(variables, {0, 4, 0, 8, 0x11}))), 0x8704);
  EXPECT_EQ(plc.value("VB500"), 0);
  EXPECT_TRUE(plc.records.of(TraceKind::PpiAccess).empty());
  const Bytes done = master.ask(request(variables, {0, 4, 0, 8, 0x11, 0, 0, 4, 0, 8, 0x22}));
  EXPECT_EQ((Bytes{done.end() - 2, done.end()}), (Bytes{0xFF, 0xFF}));
  EXPECT_EQ(plc.value("VB500"), 0x11);
  EXPECT_EQ(plc.value("VB502"), 0x22);
}

TEST(S7Services, WhatIsReadOnlyIsNotWritten) {
  Plc plc(kQuiet, cpu224());
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(writing(variable(2, 1, 0x05, 29 * 8), 0x04, 8, {1}))), 0x03) << "SMB29";
  EXPECT_EQ(code_of(master.ask(writing(variable(2, 1, 0x05, 34 * 8), 0x04, 8, {9}))), 0xFF) << "SMB34";
  EXPECT_EQ(plc.value("SMB34"), 9);
  EXPECT_EQ(code_of(master.ask(writing(variable(4, 1, 0x06, 0), 0x04, 16, {1, 1}))), 0x03) << "AIW0";
  EXPECT_EQ(code_of(master.ask(writing(variable(0x20, 1, 0x20, 0), 0x09, 4, {0, 0, 0, 1}))), 0x03) << "HC0";
}

TEST(S7Services, EachVariableHasItsReturnCodeAndBeginsAtAnEvenPlace) {
  Plc plc(kQuiet);
  plc.set("VB10", 0xAA);
  plc.set("VB4095", 0xBB);
  const Bytes answer =
      Master(plc).ask(reading({variable(2, 1, kV, 10 * 8, 1), variable(2, 2, kV, 4095 * 8, 1), variable(2, 1, 0x99, 0),
                               variable(9, 1, kV, 0, 1), variable(2, 1, kV, 4095 * 8, 1)}));
  EXPECT_EQ((Bytes{answer.begin() + 14, answer.end()}), (Bytes{0xFF, 4, 0, 8, 0xAA, 0,  // VB10, and a byte to fill up
                                                               0x05, 0, 0, 0,           // beyond V memory
                                                               0x0A, 0, 0, 0,           // no such area
                                                               0x06, 0, 0, 0,           // no such type
                                                               0xFF, 4, 0, 8, 0xBB}));
}

TEST(S7Services, AnAnswerThatIsTooLongIsRefused) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 222, kV, 0, 1)}))).size(), 222U) << "18 bytes and 222 are 240";
  EXPECT_EQ(error_of(master.ask(reading({variable(2, 223, kV, 0, 1)}))), 0x8500);
  EXPECT_EQ(error_of(master.ask(reading({variable(2, 60'000, kV, 0, 1)}))), 0) << "beyond V memory: its return code says so";
}

TEST(S7Services, TheLengthThatWasAgreedOnIsNotKept) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(master.ask(request({0xF0, 0, 0, 1, 0, 1, 0, 0x40})).back(), 0x40);
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 222, kV, 0, 1)}))).size(), 222U);
}

TEST(S7Services, TheCommunicationIsSetUpFor240Bytes) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(master.ask(request({0xF0, 0, 0, 1, 0, 1, 0x03, 0xC0}, {}, 0x1234)),
            (Bytes{0x32, 3, 0, 0, 0x12, 0x34, 0, 8, 0, 0, 0, 0, 0xF0, 0, 0, 1, 0, 1, 0, 0xF0}));
  EXPECT_EQ(master.ask(request({0xF0, 0, 0, 1, 0, 1, 0, 0x64})).back(), 0x64);
}

TEST(S7Services, StopAndRunChangeTheMode) {
  Plc plc("LD SM0.1\nINCW VW0\nLD SM0.0\n= Q0.0\nMEND\n");
  Master master(plc);
  const Bytes program{9, 'P', '_', 'P', 'R', 'O', 'G', 'R', 'A', 'M'};
  EXPECT_EQ(master.ask(request(joined({{0x29, 0, 0, 0, 0, 0}, program}))),
            (Bytes{0x32, 3, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0x29}));
  EXPECT_TRUE(plc.stopped());
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0);
  EXPECT_EQ(code_of(master.ask(kReadVb100)), 0xFF) << "in STOP it answers too";
  EXPECT_EQ(master.ask(request(joined({{0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0}, program}))).back(), 0x28);
  EXPECT_FALSE(plc.stopped());
  plc.run_until(plc.cpu.time() + 10 * ms);
  EXPECT_EQ(plc.value("VW0"), 2) << "two first scans";
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 1);
  EXPECT_EQ(error_of(master.ask(request({0x28, 0, 0, 0, 0, 0, 0, 0xFD, 0, 0, 5, '_', 'G', 'A', 'R', 'B'}))), 0x8104);
}

Bytes user_data(std::uint8_t group, std::uint8_t service, const Bytes& data) {
  return joined({{0x32, 7, 0, 0, 0, 1, 0, 8},
                 word(static_cast<unsigned>(data.size())),
                 {0, 1, 0x12, 4, 0x11, static_cast<std::uint8_t>(0x40 | group), service, 0},
                 data});
}

TEST(S7Services, TheClockIsReadAndSet) {
  Plc plc(kQuiet);
  Master master(plc);
  const Bytes set = master.ask(user_data(7, 2, {0xFF, 9, 0, 10, 0, 0x20, 0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0x00, 0x01}));
  ASSERT_GE(set.size(), 22U);
  EXPECT_EQ((Bytes{set.begin(), set.begin() + 22}),
            (Bytes{0x32, 7, 0, 0, 0, 1, 0, 12, 0, 4, 0, 1, 0x12, 8, 0x12, 0x87, 2, 0, 0, 0, 0, 0}));
  EXPECT_EQ(plc.cpu.clock().year, 26);
  EXPECT_EQ(plc.cpu.clock().minute, 45);
  const Bytes now = master.ask(user_data(7, 1, {0x0A, 0, 0, 0}));
  ASSERT_EQ(now.size(), 10U + 12U + 14U);
  EXPECT_EQ((Bytes{now.begin() + 22, now.begin() + 33}), (Bytes{0xFF, 9, 0, 10, 0, 0x20, 0x26, 0x11, 0x22, 0x15, 0x45}));
  const Bytes bad = master.ask(user_data(7, 2, {0xFF, 9, 0, 10, 0, 0x20, 0x2A, 0x11, 0x22, 0x15, 0x45, 0x30, 0x00, 0x01}));
  EXPECT_EQ(load16(&bad[20]), 0x8704) << "not BCD";
}

TEST(S7Services, ACpu212HasNoClock) {
  Plc plc(kQuiet, cpu212());
  Master master(plc);
  for (const Bytes& asked : {user_data(7, 1, {0x0A, 0, 0, 0}),
                             user_data(7, 2, {0xFF, 9, 0, 10, 0, 0x20, 0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0x00, 0x01})})
    EXPECT_EQ(load16(&master.ask(asked).at(20)), 0x8104);
}

// --- forced values ---

Bytes list(const Bytes& bytes) { return joined({{0xFF, 9}, word(static_cast<unsigned>(bytes.size())), bytes}); }

/// A variable of a list to force: without `12 0A`.
Bytes forced(std::uint8_t type, std::uint8_t area, unsigned address, unsigned block = 0, unsigned count = 1) {
  const Bytes bytes = variable(type, count, area, address, block);
  return {bytes.begin() + 2, bytes.end()};
}

Bytes forcing(std::uint8_t service, const Bytes& bytes) {
  const Bytes data = list(bytes);
  return joined({{0x32, 7, 0, 0, 0, 1, 0, 12},
                 word(static_cast<unsigned>(data.size())),
                 {0, 1, 0x12, 8, 0x12, 0x48, service, 0, 0, 0, 0, 0},
                 data});
}

/// What follows the parameters of the answer to user data.
Bytes data_of(const Bytes& answer) { return answer.size() < 22 ? Bytes{} : Bytes{answer.begin() + 22, answer.end()}; }
int user_error_of(const Bytes& answer) { return answer.size() < 22 ? -1 : answer[20] * 256 + answer[21]; }

Bytes codes(std::uint8_t released, const Bytes& codes) {
  return list(joined({{released, static_cast<std::uint8_t>(codes.size())}, codes}));
}

TEST(S7Services, ForcedValuesHold) {
  Plc plc("LD SM0.0\nR Q0.0, 1\nMOVB 5, VB500\nLD I0.3\n= Q0.1\nMEND\n", cpu224());
  Master master(plc);
  // Q0.0 = 1, byte by byte.
  EXPECT_EQ(master.ask({0x32, 7, 0,    0,    0,    1,    0, 0x0C, 0,    0x12, 0, 1, 0x12, 8, 0x12, 0x48, 0x0B, 0, 0, 0,
                        0,    0, 0xFF, 0x09, 0x00, 0x0E, 0, 1,    0x10, 1,    0, 1, 0,    0, 0x82, 0,    0,    0, 1, 0}),
            (Bytes{0x32, 7,    0, 0, 0, 1, 0, 0x0C, 0,    0x07, 0, 1, 0x12, 8,   0x12,
                   0x88, 0x0B, 0, 0, 0, 0, 0, 0xFF, 0x09, 0,    3, 0, 1,    0xFF}));
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{0, 1}, forced(2, kV, 500 * 8, 1), {9, 0}})))), codes(0, {0xFF}));
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{0, 1}, forced(1, 0x81, 3), {1, 0}})))), codes(0, {0xFF}));
  plc.run_until(plc.cpu.time() + 10 * ms);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 3) << "Q0.0, and Q0.1 from the forced input";
  EXPECT_EQ(value_of(master.ask(reading({variable(2, 1, kV, 500 * 8, 1)}))), Bytes{9});
  EXPECT_NE(plc.cpu.state().forcing, Forcing{}) << "as the debugger forces it";
  // Released with 01, and as a published description has it, without a value.
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{1, 1}, forced(2, kV, 500 * 8, 1)})))), codes(1, {0xFF}));
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{0, 1}, forced(1, 0x82, 0)})))), codes(1, {0xFF}));
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{1, 1}, forced(1, 0x81, 3)})))), codes(1, {0xFF}));
  plc.run_until(plc.cpu.time() + 10 * ms);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0);
  EXPECT_EQ(plc.value("VB500"), 5);
  EXPECT_EQ(plc.cpu.state().forcing, Forcing{});
}

TEST(S7Services, SeveralValuesAreForcedAndReleasedAtOnce) {
  Plc plc(kQuiet, cpu224());
  Master master(plc);
  const Bytes places = joined({forced(2, 0x83, 5 * 8), forced(4, 0x06, 4 * 8), forced(6, kV, 600 * 8, 1)});
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{0, 3}, places, {0x77, 0, 0x12, 0x34, 1, 2, 3, 4}})))),
            codes(0, {0xFF, 0xFF, 0xFF}));
  plc.run_until(plc.cpu.time() + 10 * ms);
  EXPECT_EQ(plc.value("MB5"), 0x77);
  EXPECT_EQ(plc.value("AIW4"), 0x1234);
  EXPECT_EQ(plc.value("VD600"), 0x01020304);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{1, 3}, places})))), codes(1, {0xFF, 0xFF, 0xFF})) << i;
  EXPECT_EQ(plc.cpu.state().forcing, Forcing{});
}

TEST(S7Services, WhatCannotBeForcedIsRefused) {
  Plc plc(kQuiet, cpu224());
  Master master(plc);
  const auto code = [&](const Bytes& place, const Bytes& value) {
    return data_of(master.ask(forcing(0x0B, joined({{0, 1}, place, value}))));
  };
  EXPECT_EQ(code(forced(1, kV, 8, 1), {1, 0}), codes(0, {0x03})) << "a bit of V";
  EXPECT_EQ(code(forced(2, 0x05, 30 * 8), {1, 0}), codes(0, {0x03})) << "SMB30";
  EXPECT_EQ(code(forced(0x1F, 0x1F, 37), {0, 0, 0, 0, 1, 0}), codes(0, {0x03})) << "T37";
  EXPECT_EQ(code(forced(2, 0x03, 0), {1, 0}), codes(0, {0x03})) << "the identification";
  EXPECT_EQ(code(forced(4, 0x06, 3 * 8), {1, 0}), codes(0, {0x03})) << "AIW3";
  EXPECT_EQ(code(forced(2, kV, 9000 * 8, 1), {1, 0}), codes(0, {0x05}));
  EXPECT_EQ(code(forced(2, kV, 0, 1, 2), {1, 2}), codes(0, {0x06})) << "two at once";
  EXPECT_EQ(code(forced(2, 0x99, 0), {1, 0}), codes(0, {0x0A}));
  for (unsigned i = 0; i < 16; ++i) EXPECT_EQ(code(forced(2, kV, i * 8, 1), {1, 0}), codes(0, {0xFF})) << i;
  EXPECT_EQ(code(forced(2, kV, 16 * 8, 1), {1, 0}), codes(0, {0x03})) << "the seventeenth";
  EXPECT_EQ(code(forced(2, 0x82, 0), {1, 0}), codes(0, {0xFF})) << "points are not counted";
}

TEST(S7Services, AForcingThatListsLessThanItSaysForcesNothing) {
  Plc plc(kQuiet, cpu224());
  Master master(plc);
  const Bytes q0 = forced(2, 0x82, 0);
  for (const Bytes& wrong : {Bytes{}, Bytes{0}, Bytes{0, 0}, joined({{0, 2}, q0}), joined({{0, 2}, q0, q0, {1, 0}}),
                             joined({{2, 1}, q0, {1, 0}}), joined({{0, 1}, {0x12, 0x0A}, q0, {1, 0}})})
    EXPECT_EQ(user_error_of(master.ask(forcing(0x0B, wrong))), 0x8704);
  EXPECT_EQ(user_error_of(master.ask(user_data(8, 0x0B, {0xFF, 9, 0, 99, 0, 1}))), 0x8704);
  EXPECT_EQ(user_error_of(master.ask(forcing(0x0E, joined({{0, 1}, q0, {1, 0}})))), 0x8704) << "its values have a head";
  EXPECT_EQ(plc.cpu.state().forcing, Forcing{});
}

TEST(S7Services, OutputsAreSetInStopUntilTheNextChangeOfTheMode) {
  Plc plc("LD SM0.0\n= Q0.7\nMEND\n", cpu224());
  Master master(plc);
  // QB0 = 5, byte by byte.
  const Bytes q0_is_5{0x32, 7,    0, 0,    0, 1, 0,    0x0C, 0, 0x16, 0, 1, 0x12, 8, 0x12, 0x48, 0x0E, 0, 0, 0, 0, 0,
                      0xFF, 0x09, 0, 0x12, 0, 1, 0x10, 2,    0, 1,    0, 0, 0x82, 0, 0,    0,    0,    4, 0, 8, 5, 0};
  const auto outputs = [&] { return plc.cpu.state().image[image::kOutputs]; };
  EXPECT_EQ(data_of(master.ask(q0_is_5)), codes(0, {0x03})) << "in RUN";
  EXPECT_EQ(outputs(), 0x80);
  master.ask(kToStop);
  EXPECT_EQ(outputs(), 0);
  EXPECT_EQ(data_of(master.ask(q0_is_5)), codes(0, {0xFF}));
  EXPECT_EQ(outputs(), 5);
  Bytes of_libnodave = q0_is_5;
  of_libnodave[25] = 0x0C;
  of_libnodave[42] = 0x06;
  EXPECT_EQ(data_of(master.ask(of_libnodave)), codes(0, {0xFF})) << "its list does not count the values";
  EXPECT_EQ(outputs(), 6);
  EXPECT_EQ(data_of(master.ask(q0_is_5)), codes(0, {0xFF}));
  EXPECT_EQ(data_of(master.ask(forcing(0x0E, joined({{0, 1}, forced(1, 0x82, 4), {0, 3, 0, 1, 1, 0}})))), codes(0, {0xFF}));
  EXPECT_EQ(outputs(), 0x15);
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{0, 1}, forced(1, 0x82, 5), {1, 0}})))), codes(0, {0xFF}));
  EXPECT_EQ(outputs(), 0x35) << "forcing leaves the others alone";
  EXPECT_EQ(data_of(master.ask(forcing(0x0B, joined({{1, 1}, forced(1, 0x82, 5)})))), codes(1, {0xFF}));
  EXPECT_EQ(outputs(), 0x15);
  EXPECT_EQ(data_of(master.ask(forcing(0x0E, joined({{0, 1}, forced(4, 0x07, 0), {0, 4, 0, 8, 0x12, 0x34}})))),
            codes(0, {0xFF}));
  EXPECT_EQ(plc.value("AQW0"), 0x1234);
  EXPECT_EQ(data_of(master.ask(forcing(0x0E, joined({{0, 1}, forced(2, kV, 0, 1), {0, 4, 0, 8, 1, 0}})))), codes(0, {0x03}));
  EXPECT_EQ(plc.value("QB0"), 0x80) << "the image is that of the last scan";
  master.ask(kToRun);
  plc.run_until(plc.cpu.time() + 10 * ms);
  EXPECT_EQ(outputs(), 0x80);
  master.ask(kToStop);
  EXPECT_EQ(outputs(), 0);
}

// --- blocks ---

Bytes block_of(const std::string& text) { return list(Bytes(text.begin(), text.end())); }

TEST(S7Blocks, ThereAreOneProgramOneDataBlockAndOneSystemBlock) {
  Plc plc("LD SM0.0\nMEND\nSBR 3\nRET\nINT 4\nRETI\n");
  EXPECT_EQ(Master(plc).ask(user_data(3, 1, {0x0A, 0, 0, 0})),
            joined({{0x32, 7, 0, 0, 0, 1, 0, 12, 0, 32, 0, 1, 0x12, 8, 0x12, 0x83, 1, 0, 0, 0, 0, 0, 0xFF, 9, 0, 28},
                    {'0', '8', 0, 1, '0', 'E', 0, 0, '0', 'C', 0, 0, '0', 'A', 0, 1},
                    {'0', 'B', 0, 1, '0', 'D', 0, 0, '0', 'F', 0, 0}}));
}

TEST(S7Blocks, TheBlocksOfATypeAreListed) {
  Plc plc(kQuiet);
  Master master(plc);
  const auto blocks = [&](const std::string& type) { return master.ask(user_data(3, 2, block_of(type))); };
  EXPECT_EQ(data_of(blocks("08")), list({0, 1, 0, 1}));
  EXPECT_EQ(data_of(blocks("0A")), list({0, 1, 0, 5}));
  EXPECT_EQ(data_of(blocks("0B")), list({0, 0, 0, 7}));
  EXPECT_EQ(user_error_of(blocks("0C")), 0xD20E) << "no functions";
  EXPECT_EQ(data_of(blocks("0C")), (Bytes{0x0A, 0, 0, 0}));
  EXPECT_EQ(user_error_of(blocks("0Z")), 0xD203);
  EXPECT_EQ(user_error_of(blocks("A")), 0x8704);
  EXPECT_EQ(user_error_of(master.ask(user_data(3, 2, {}))), 0x8704);
}

TEST(S7Blocks, TheInformationOfDb1HasTheLengthOfVMemory) {
  Plc plc(kQuiet, cpu221());
  const Bytes data = data_of(Master(plc).ask(user_data(3, 3, block_of("0A00001A"))));
  ASSERT_EQ(data.size(), 4U + 78U);
  EXPECT_EQ((Bytes{data.begin(), data.begin() + 4 + 20}),
            (Bytes{0xFF, 9, 0, 78, 1, 'A', 0, 0x4A, 0, 0x22, 'p', 'p', 1, 0, 5, 0x0A, 0, 1, 0, 0, 0x08, 0x48, 0, 0}))
      << "DB1 of 2120 bytes with its head and foot";
  EXPECT_EQ(load16(&data[4 + 40]), 2048) << "V memory of a CPU 221";
}

TEST(S7Blocks, TheProgramAndTheSystemBlockAreProtected) {
  Plc plc(kQuiet);
  Master master(plc);
  const auto error = [&](const std::string& name) {
    const int information = user_error_of(master.ask(user_data(3, 3, block_of(name))));
    const Bytes start = joined(
        {{0x1D, 0, 0, 0, 0, 0, 0, 0, static_cast<std::uint8_t>(name.size() + 1), '_'}, Bytes(name.begin(), name.end())});
    EXPECT_EQ(error_of(master.ask(request(start))), information) << name;
    return information;
  };
  EXPECT_EQ(error("0800001A"), 0xD241);
  EXPECT_EQ(error("0B00000P"), 0xD241);
  EXPECT_EQ(error("0A00001P"), 0);
  EXPECT_EQ(error("0A00002A"), 0xD209);
  EXPECT_EQ(error("0Z00001A"), 0xD203);
  EXPECT_EQ(error("0A0000xA"), 0xD201);
  EXPECT_EQ(error("0A"), 0xD201);
  EXPECT_EQ(error_of(master.ask(request({0x1D, 0, 0, 0, 0, 0, 0, 0}))), 0x8704);
  EXPECT_EQ(error_of(master.ask(request({0x1D, 0, 0, 0, 0, 0, 0, 0, 9, '_'}))), 0x8704);
}

const Bytes kStartDb1 = request({0x1D, 0, 0, 0, 0, 0, 0, 0, 9, '_', '0', 'A', '0', '0', '0', '0', '1', 'A'});

/// The next part of an upload.
Bytes part(std::uint8_t id = 1) { return request({0x1E, 0, 0, 0, 0, 0, 0, id}); }

TEST(S7Blocks, Db1IsUploadedInParts) {
  Plc plc(kQuiet, cpu221());
  plc.set("VB0", 0x11);
  plc.set("VB2047", 0x99);
  Master master(plc);
  EXPECT_EQ(master.ask(kStartDb1), (Bytes{0x32, 3, 0, 0, 0, 1, 0, 16,  0,   0,   0,   0,   0x1D, 0,
                                          1,    0, 0, 0, 0, 1, 7, '0', '0', '0', '2', '1', '2',  '0'}));
  Bytes block;
  bool more = true;
  while (more) {
    const Bytes answer = master.ask(part());
    ASSERT_GE(answer.size(), 18U);
    EXPECT_EQ(answer[12], 0x1E);
    more = answer[13] != 0;
    EXPECT_EQ(load16(&answer[14]), answer.size() - 18) << "its length";
    EXPECT_EQ((Bytes{answer.begin() + 16, answer.begin() + 18}), (Bytes{0, 0xFB}));
    block.insert(block.end(), answer.begin() + 18, answer.end());
    ASSERT_LE(block.size(), 2120U);
  }
  EXPECT_EQ(master.ask(request({0x1F, 0, 0, 0, 0, 0, 0, 1})), (Bytes{0x32, 3, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0x1F}));
  ASSERT_EQ(block.size(), 36U + 2048U + 36U);
  EXPECT_EQ((Bytes{block.begin(), block.begin() + 8}), (Bytes{'p', 'p', 1, 0, 5, 0x0A, 0, 1}));
  EXPECT_EQ(block[36], 0x11);
  EXPECT_EQ(block[36 + 2047], 0x99);
}

TEST(S7Blocks, AnUploadBeginsAnewWithEachStart) {
  Plc plc(kQuiet);
  Master master(plc);
  master.ask(kStartDb1);
  const Bytes first = master.ask(part());
  EXPECT_NE(master.ask(part()), first);
  master.ask(kStartDb1);
  EXPECT_EQ(master.ask(part()), first);
}

TEST(S7Blocks, PartsWithoutAStartAreRefused) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(error_of(master.ask(part())), 0xD240);
  EXPECT_EQ(error_of(master.ask(request({0x1F, 0, 0, 0, 0, 0, 0, 1}))), 0xD240);
  master.ask(kStartDb1);
  EXPECT_EQ(error_of(master.ask(part(2))), 0xD240) << "another upload";
  EXPECT_EQ(error_of(master.ask(request({0x1E}))), 0x8704);
  master.ask(request({0x1F, 0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(error_of(master.ask(part())), 0xD240) << "it has been ended";
}

TEST(S7Services, UserDataThatNameNoServiceGetTheirError) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(master.ask({0x32, 7, 0, 0, 0, 1, 0, 3, 0, 0, 0, 1, 0x12}),
            (Bytes{0x32, 7, 0, 0, 0, 1, 0, 12, 0, 4, 0, 1, 0x12, 8, 0x12, 0x80, 0, 0, 0, 0, 0x87, 0x04, 0x0A, 0, 0, 0}));
}

TEST(S7Services, ATimeThatDoesNotExistIsRefused) {
  Plc plc(kQuiet);
  Master master(plc);
  const auto error = [&](const Bytes& time) {
    const Bytes answer = master.ask(user_data(7, 2, joined({{0xFF, 9, 0, 10, 0, 0x20}, time})));
    return load16(&answer[20]);
  };
  EXPECT_EQ(error({0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0x00, 0x01}), 0);
  for (const Bytes& wrong : {Bytes{0x26, 0x13, 0x22, 0x15, 0x45, 0x30, 0, 1},
                             {0x26, 0x00, 0x22, 0x15, 0x45, 0x30, 0, 1},
                             {0x26, 0x11, 0x99, 0x15, 0x45, 0x30, 0, 1},
                             {0x26, 0x11, 0x00, 0x15, 0x45, 0x30, 0, 1},
                             {0x26, 0x11, 0x22, 0x24, 0x00, 0x00, 0, 1},
                             {0x26, 0x11, 0x22, 0x15, 0x61, 0x30, 0, 1},
                             {0x26, 0x11, 0x22, 0x15, 0x45, 0x61, 0, 1},
                             {0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0, 8}})
    EXPECT_EQ(error(wrong), 0x8704);
  EXPECT_EQ(plc.cpu.clock().month, 11);
}

TEST(S7Services, VMemoryIsDataBlockOneAndThereIsNoOther) {
  Plc plc(kQuiet);
  plc.set("VB200", 0x84);
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(reading({variable(2, 1, 0x84, 200 * 8, 1)}))), 0xFF);
  for (const unsigned block : {0U, 2U, 5U, 99U}) {
    EXPECT_EQ(code_of(master.ask(reading({variable(2, 1, 0x84, 200 * 8, block)}))), 0x0A) << block;
    EXPECT_EQ(code_of(master.ask(writing(variable(2, 1, 0x84, 200 * 8, block), 0x04, 8, {0x11}))), 0x0A) << block;
  }
  EXPECT_EQ(plc.value("VB200"), 0x84);
  EXPECT_EQ(code_of(master.ask(reading({variable(2, 1, 0x83, 0, 5)}))), 0xFF) << "M has none";
}

TEST(S7Services, TheTraceTellsTheServicesOfUserDataApart) {
  Plc plc(kQuiet);
  Master master(plc, 1);
  const auto traced = [&](const Bytes& pdu) {
    plc.records.all.clear();
    master.ask(pdu);
    const auto records = plc.records.of(TraceKind::PpiService);
    return records.size() == 1 ? describe(records[0], plc.cpu.program()) : std::to_string(records.size()) + " records";
  };
  EXPECT_EQ(traced(user_data(7, 1, {0x0A, 0, 0, 0})), "PPI station 1 reads the clock");
  EXPECT_EQ(traced(user_data(7, 2, {0xFF, 9, 0, 10, 0, 0x20, 0x26, 0x11, 0x22, 0x15, 0x45, 0x30, 0x00, 0x01})),
            "PPI station 1 sets the clock");
  EXPECT_EQ(traced(user_data(7, 2, {0xFF, 9, 0, 0})), "PPI station 1 sets the clock: refused, error 16#8704");
  EXPECT_EQ(traced(user_data(4, 1, {0xFF, 9, 0, 4, 0x01, 0x11, 0, 1})),
            "PPI station 1 asks for user data, group 4, service 1: refused, error 16#8104")
      << "a status list";
  EXPECT_EQ(traced({0x32, 7, 0, 0, 0, 1, 0, 3, 0, 0, 0, 1, 0x12}),
            "PPI station 1 sends user data that name no service: refused, error 16#8704");
  EXPECT_EQ(traced(request({})), "PPI station 1 asks for no function: refused, error 16#8704");
  EXPECT_EQ(traced(request({0x00})), "PPI station 1 asks for function 00: refused, error 16#8104");
}

TEST(S7Services, OtherFunctionsAreRefusedByNumber) {
  Plc plc(kQuiet);
  Master master(plc);
  EXPECT_EQ(error_of(master.ask(request({0x1A, 0, 0}))), 0x8104) << "download";
  EXPECT_EQ(error_of(master.ask(request({0x04, 2, 0x12}))), 0x8704) << "fewer variables than it says";
  EXPECT_EQ(error_of(master.ask(request({0x05, 1, 0x12, 0x0A, 0x10, 2, 0, 4, 0, 1, 0x84, 0, 0, 0}, {0, 4, 0, 0xFF, 1}))),
            0x8704)
      << "more data than there are";
  EXPECT_EQ(master.ask({0x33, 1, 0, 0, 0, 1, 0, 0, 0, 0}), Bytes{}) << "not S7: it stays without an answer";
}

TEST(S7Services, ForcedMemoryHoldsAgainstAMaster) {
  Plc plc(kQuiet);
  ASSERT_TRUE(plc.cpu.force(plc.place("VB500"), 7));
  Master master(plc);
  EXPECT_EQ(code_of(master.ask(writing(variable(2, 1, kV, 500 * 8, 1), 0x04, 8, {1}))), 0xFF);
  EXPECT_EQ(plc.value("VB500"), 7);
}

TEST(S7Services, TheTraceSaysWhatAMasterReadsAndWrites) {
  Plc plc(kQuiet);
  Master master(plc, 1);
  master.ask(reading({variable(2, 4, kV, 100 * 8, 1), variable(1, 1, 0x83, 31 * 8 + 7), variable(0x1F, 1, 0x1F, 37)}));
  master.ask(reading({variable(2, 4, 0x99, 100 * 8, 1)}));
  master.ask(reading({variable(2, 0, kV, 0, 1), variable(4, 2, kV, 9000 * 8, 1), variable(1, 1, kV, 9000 * 8 + 7, 1),
                      variable(0x1F, 1, 0x1F, 300)}));
  master.ask(reading({variable(2, 20, 0x03, 0)}));
  master.ask(writing(variable(2, 1, 0x03, 0), 0x04, 8, {'X'}));
  master.ask(reading({variable(4, 1, kV, 300 * 8, 1), variable(4, 3, kV, 300 * 8, 1), variable(6, 1, 0x82, 0),
                      variable(4, 1, 0x06, 0), variable(0x1E, 1, 0x1E, 5), variable(0x1F, 3, 0x1F, 37)}));
  master.ask(reading({variable(1, 1, kV, 9000 * 8, 1), variable(1, 3, 0x83, 8), variable(1, 1, 0x1F, 37),
                      variable(2, 2, 0x1E, 5), variable(9, 1, 0x1E, 5), variable(9, 1, 0x83, 0)}));
  master.ask(writing(variable(1, 1, 0x83, 3), 0x03, 1, {1}));
  master.ask(forcing(0x0B, joined({{0, 1}, forced(1, 0x82, 3), {1, 0}})));
  master.ask(forcing(0x0B, joined({{1, 1}, forced(1, 0x82, 3)})));
  master.ask(forcing(0x0E, joined({{0, 1}, forced(2, 0x82, 0), {0, 4, 0, 8, 1, 0}})));
  std::string text;
  for (const TraceRecord& record : plc.records.of(TraceKind::PpiAccess)) text += describe(record, plc.cpu.program()) + '\n';
  EXPECT_EQ(text,
            "PPI station 1 reads VB100, 4 bytes\nPPI station 1 reads M31.7\nPPI station 1 reads T37\n"
            "PPI station 1 reads area 16#99, address 100.0: refused, error 16#0A\n"
            "PPI station 1 reads VB0, 0 bytes: refused, error 16#05\n"
            "PPI station 1 reads VW9000, 2 words: refused, error 16#05\n"
            "PPI station 1 reads V9000.7: refused, error 16#05\n"
            "PPI station 1 reads T300: refused, error 16#05\n"
            "PPI station 1 reads the CPU's identification\n"
            "PPI station 1 writes the CPU's identification: refused, error 16#03\n"
            "PPI station 1 reads VW300\nPPI station 1 reads VW300, 3 words\nPPI station 1 reads QD0\n"
            "PPI station 1 reads AIW0\nPPI station 1 reads C5\nPPI station 1 reads T37, 3 in all\n"
            "PPI station 1 reads V9000.0: refused, error 16#05\n"
            "PPI station 1 reads M1.0, 3 bits: refused, error 16#06\n"
            "PPI station 1 reads T37 as 1 bit: refused, error 16#06\n"
            "PPI station 1 reads C5 as 2 bytes: refused, error 16#06\n"
            "PPI station 1 reads C5 as type 16#09: refused, error 16#06\n"
            "PPI station 1 reads MB0 as type 16#09: refused, error 16#06\n"
            "PPI station 1 writes M0.3\n"
            "PPI station 1 forces Q0.3\nPPI station 1 unforces Q0.3\n"
            "PPI station 1 sets in STOP QB0: refused, error 16#03\n");
}

TEST(S7Services, TheTraceNamesTheServicesOfBlocks) {
  Plc plc(kQuiet);
  Master master(plc, 1);
  for (const Bytes& asked : {user_data(3, 1, {0x0A, 0, 0, 0}), user_data(3, 2, block_of("0C")),
                             user_data(3, 3, block_of("0A00001A")), kStartDb1, part(), request({0x1F, 0, 0, 0, 0, 0, 0, 1})})
    master.ask(asked);
  std::string text;
  for (const TraceRecord& record : plc.records.of(TraceKind::PpiService)) text += describe(record, plc.cpu.program()) + '\n';
  EXPECT_EQ(text,
            "PPI station 1 asks how many blocks there are\n"
            "PPI station 1 asks for the blocks of a type: refused, error 16#D20E\n"
            "PPI station 1 asks about a block\nPPI station 1 starts the upload of a block\n"
            "PPI station 1 fetches a part of the block\nPPI station 1 ends the upload\n");
}

TEST(S7Services, RandomRequestsGetAWholeAnswerOrNone) {
  Plc plc(kQuiet, cpu224());
  std::mt19937 random(20261127);
  // PDUs of every service, cut off, with a byte of them changed and with one left out, past the port and its timing.
  const std::vector<Bytes> right{kReadVb100,
                                 kStartDb1,
                                 part(),
                                 request({0x1F, 0, 0, 0, 0, 0, 0, 1}),
                                 user_data(3, 1, {0x0A, 0, 0, 0}),
                                 user_data(3, 2, block_of("0A")),
                                 user_data(3, 3, block_of("0A00001A")),
                                 forcing(0x0B, joined({{0, 2}, forced(2, 0x83, 5 * 8), forced(1, 0x82, 1), {7, 0, 1, 0}})),
                                 forcing(0x0B, joined({{1, 1}, forced(2, 0x83, 5 * 8)})),
                                 forcing(0x0E, joined({{0, 1}, forced(2, 0x82, 0), {0, 4, 0, 8, 1, 0}}))};
  for (int i = 0; i < 20'000; ++i) {
    Bytes asked = right[random() % right.size()];
    const std::size_t at = random() % asked.size();
    switch (random() % 4) {
      case 0:
        asked.resize(at);
        break;
      case 1:
        asked.erase(asked.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      default:
        asked[at] = static_cast<std::uint8_t>(random());
    }
    const Bytes answer = s7_services::carry_out(plc.cpu.core(), 0, 1, asked);
    EXPECT_LE(answer.size(), s7::kLongestPdu);
    if (answer.empty()) continue;
    const std::size_t head = answer[1] == s7::kUserData ? s7::kRequestHead : s7::kAnswerHead;
    ASSERT_GE(answer.size(), head);
    EXPECT_EQ(answer.size(), head + load16(&answer[6]) + load16(&answer[8]));
  }
}

}  // namespace
}  // namespace s7200::test::ppi_test
