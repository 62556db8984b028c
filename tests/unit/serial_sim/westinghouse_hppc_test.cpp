#include <gtest/gtest.h>

#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/hppc_plc.hpp"
#include "tests/unit/serial_sim/westinghouse_bench.hpp"

namespace s7200::westinghouse::westinghouse_hppc_test {
namespace {

const std::string kReference = "../shared/reference/westinghouse_vectors.txt";

TEST(Hppc, EveryExchangeOfTheReferenceHolds) {
  const std::string text = text_of(kReference);
  if (text.empty()) GTEST_SKIP() << "there is no " << kReference;
  EXPECT_EQ(play_file(text, "hppc"), 14);
}

TEST(Hppc, OurOwnExchangesHold) { EXPECT_GT(play_file(text_of("tests/exchanges/westinghouse.txt"), "hppc"), 0); }

Bytes request(HppcOpcode opcode, const Bytes& operands, std::uint8_t destination = kIop) {
  return hppc_message(destination, kApl, opcode, operands, FcsTable::Document);
}

/// Opcode and operands of the answer, which has a right length, frame check and address.
std::string asked(Bench& bench, const Bytes& message, FcsTable table = FcsTable::Document) {
  const std::string hex = bench.ask(serial::to_hex(message));
  if (hex.empty()) return {};
  const Bytes answer = serial::bytes_of(serial::parse_hex_frame(hex).frame);
  EXPECT_TRUE(is_whole_hppc(answer)) << hex;
  EXPECT_EQ(hppc_fcs(answer, table), 0) << hex;
  EXPECT_EQ(answer[2], kApl);
  return serial::to_hex(std::span(answer).subspan(5, answer.size() - 7));
}

std::string asked(const std::string& settings, const Bytes& message) {
  Bench bench("hppc", settings);
  return asked(bench, message);
}

TEST(HppcMessage, TheFrameCheckHasTheOddEntryOfTheDocumentUnlessThePolynomialIsAskedFor) {
  const Bytes printed{0x09, 0x00, 0x20, 0x40, 0x00, 0x0D, 0xFF};
  EXPECT_EQ(hppc_fcs(printed, FcsTable::Document), 0xD486);
  EXPECT_EQ(hppc_fcs(printed, FcsTable::Polynomial), 0xD486);
  const Bytes meets_the_entry{0x0C, 0x00, 0x20, 0x40, 0x00, 0x0C, 0x02, 0x00, 0x08, 0x02};
  EXPECT_EQ(hppc_fcs(meets_the_entry, FcsTable::Document), 0x6F2F);
  EXPECT_EQ(hppc_fcs(meets_the_entry, FcsTable::Polynomial), 0x6F6B);
}

TEST(Hppc, ThePolynomialIsASetting) {
  Bench bench("hppc", "fcs=polynomial");
  const Bytes message = hppc_message(kIop, kApl, HppcOpcode::Read, hppc_read(0x80002, 2), FcsTable::Polynomial);
  EXPECT_EQ(asked(bench, message, FcsTable::Polynomial), "0c 02 56 04");
}

TEST(Hppc, H1TheLineIs9600Baud8N1) {
  EXPECT_EQ(Bench("hppc").plc().format(), (SerialFormat{9600, 8, Parity::None, 1}));
  EXPECT_EQ(Bench("hppc", "baud=1200").plc().format().baud, 1200U);
}

TEST(Hppc, H2ItIsAsynchronousFromPowerUpUnlessItSearchesForItsLine) {
  EXPECT_EQ(asked("", request(HppcOpcode::Read, hppc_read(0, 0))), "0c 00");
  Bench bench("hppc", "search_ms=1000");
  EXPECT_EQ(asked(bench, request(HppcOpcode::Read, hppc_read(0, 0))), "");
  bench.wait(kSecond);
  EXPECT_EQ(asked(bench, request(HppcOpcode::Read, hppc_read(0, 0))), "0c 00");
}

TEST(Hppc, AfterPowerHasBeenOffItSearchesForItsLineAgainAndHasItsMemory) {
  Bench bench("hppc", "search_ms=1000 M[90000]=12");
  bench.wait(2 * kSecond);
  EXPECT_EQ(asked(bench, request(HppcOpcode::Read, hppc_read(0x90000, 1))), "0c 01 12");
  bench.lose_power();
  EXPECT_EQ(asked(bench, request(HppcOpcode::Read, hppc_read(0x90000, 1))), "");
  bench.wait(kSecond);
  EXPECT_EQ(asked(bench, request(HppcOpcode::Read, hppc_read(0x90000, 1))), "0c 01 12");
}

TEST(Hppc, H3TheFifthByteIsNotChecked) {
  Bytes message{0x0C, 0x00, kIop, kApl, 0x55, 0x0C, 0, 0, 0, 0};
  const std::uint16_t fcs = hppc_fcs(message, FcsTable::Document);
  message.push_back(static_cast<std::uint8_t>(fcs >> 8));
  message.push_back(static_cast<std::uint8_t>(fcs & 0xFF));
  EXPECT_EQ(asked("", message), "0c 00");
  EXPECT_EQ(asked("zero_byte=checked", message), "");
}

TEST(Hppc, H4AReadHasAnAddressAndANumber) {
  EXPECT_EQ(asked("M[90000]=12,34", request(HppcOpcode::Read, hppc_read(0x90000, 2))), "0c 02 12 34");
  EXPECT_EQ(asked("M[00000]=12,34 read_request=number", request(HppcOpcode::Read, {2})), "0c 02 12 34");
  EXPECT_EQ(asked("", request(HppcOpcode::Read, {2})), "10 12 00 00");
  EXPECT_EQ(asked("read_request=number", request(HppcOpcode::Read, hppc_read(0, 2))), "10 12 00 00");
}

TEST(Hppc, H5ABitWriteHasThePatternBeforeTheMask) {
  const Bytes message = request(HppcOpcode::BitWrite, hppc_bit_write(0x90000, 0x8001, 0x800F));
  Bench bench("hppc", "M[90000]=F2,00");
  EXPECT_EQ(asked(bench, message), "0a");
  EXPECT_EQ(bench.fault_of("M[90000]=F1,80"), "");
  Bench other("hppc", "M[90000]=F2,00 bit_write=mask_first");
  EXPECT_EQ(asked(other, message), "0a");
  EXPECT_EQ(other.fault_of("M[90000]=F3,80"), "");
}

TEST(Hppc, H6AMonitorHasAddressesOfThreeBytes) {
  const Bytes three{0, 0, 0, 1, 0, 0, 0x00, 0x00, 0x09}, four{0, 0, 0, 1, 0, 0, 0x00, 0x00, 0x09, 0x00};
  EXPECT_EQ(asked("M[90000]=12", request(HppcOpcode::Monitor, three)), "09 00 12");
  EXPECT_EQ(asked("M[90000]=12", request(HppcOpcode::Monitor, four)), "10 12 00 00");
  EXPECT_EQ(asked("M[90000]=12 monitor_address_bytes=4", request(HppcOpcode::Monitor, four)), "09 00 12");
}

TEST(Hppc, H7TheStatusOfAMonitorSaysStoppedBeforeNetworkNotFound) {
  const auto monitor = [](std::uint32_t network) {
    const std::vector<std::uint32_t> bytes{0x90000};
    return request(HppcOpcode::Monitor, hppc_monitor(network, bytes, {}, {}));
  };
  EXPECT_EQ(asked("", monitor(0)), "09 00 00");
  EXPECT_EQ(asked("", monitor(0x110)), "09 00 00");
  EXPECT_EQ(asked("", monitor(0x111)), "09 02 00");
  EXPECT_EQ(asked("table=example", monitor(0x111)), "09 02 00");
  EXPECT_EQ(asked("table=example", monitor(0x110)), "09 00 00");
  EXPECT_EQ(asked("run=stopped", monitor(0x111)), "09 10 00");
  EXPECT_EQ(asked("status=08", monitor(0x111)), "09 08 00");
}

TEST(Hppc, H8WhatIsWrongIsAnsweredWithItsError) {
  const std::map<std::string, Bytes> errors{
      {"10 10 00 00", request(HppcOpcode{0x11}, {})},
      {"10 10 00 00 ", request(HppcOpcode{0x1F}, {})},
      {"10 10 00 00  ", request(HppcOpcode{0x24}, {})},
      {"10 26 00 00", request(HppcOpcode{0x00}, {})},
      {"10 26 00 00 ", request(HppcOpcode{0x0F}, {})},
      {"10 26 00 00  ", request(HppcOpcode{0x23}, {1, 2, 3})},
      {"10 11 00 00", request(HppcOpcode::Read, hppc_read(0xFFFFF, 2))},
      {"10 11 00 00 ", request(HppcOpcode::Write, hppc_write(0xFFFFF, Bytes{1, 2}))},
      {"10 11 00 00  ", request(HppcOpcode::BitWrite, hppc_bit_write(0xFFFFF, 0, 0))},
      {"10 12 00 00", request(HppcOpcode::Parameters, {})},
      {"10 12 00 00 ", request(HppcOpcode::Write, {0, 0, 8, 2, 1})},
      {"10 12 00 00  ", request(HppcOpcode::Monitor, {0, 0, 0, 1, 0, 0})},
  };
  for (const auto& [answer, message] : errors)
    EXPECT_EQ(asked("", message), answer.substr(0, 11)) << serial::to_hex(message);
  EXPECT_EQ(asked("edit_lo=1234", request(HppcOpcode{0x30}, {})), "10 10 34 12");
  EXPECT_EQ(asked("errors=ignored", request(HppcOpcode{0x30}, {})), "");
}

TEST(Hppc, H8AMonitorOfMoreThan256BytesIsAnInvalidOperand) {
  const auto monitor = [](std::size_t count) {
    const std::vector<std::uint32_t> addresses(count, 0x90000);
    return request(HppcOpcode::Monitor, hppc_monitor(0, {}, {}, addresses));
  };
  EXPECT_EQ(asked("", monitor(64)).substr(0, 5), "09 00");
  EXPECT_EQ(asked("", monitor(65)), "10 11 00 00");
}

TEST(Hppc, H8WhatIsNotForItOrNoMessageIsNotAnswered) {
  const Bytes resync = hppc_read(0, 0);
  EXPECT_EQ(asked("", request(HppcOpcode::Read, resync, 0x11)), "");
  EXPECT_EQ(asked("", request(HppcOpcode::Error, {1, 0, 0})), "");
  EXPECT_EQ(Bench("hppc").ask("07 00 20 40 00 0d 00"), "");
  EXPECT_EQ(Bench("hppc").ask("01 04 20 40 00 0d 00"), "");
  Bench bench("hppc");
  EXPECT_EQ(asked(bench, request(HppcOpcode::Write, hppc_write(0x90000, Bytes{7}), kAll)), "");
  EXPECT_EQ(bench.fault_of("M[90000]=07"), "");
}

TEST(Hppc, ItAnswersWhoeverAsked) {
  Bench bench("hppc");
  const Bytes message = hppc_message(kIop, 0x77, HppcOpcode::Read, hppc_read(0, 0), FcsTable::Document);
  EXPECT_EQ(bench.ask(serial::to_hex(message)).substr(6, 2), "77");
}

TEST(Hppc, AnAnswerBeginsOneCharacterAfterTheRequest) {
  Bench bench("hppc");
  bench.master().requester().start({.frame = serial::to_frame(request(HppcOpcode::Read, hppc_read(0, 0)))},
                                   bench.system().time());
  EXPECT_EQ(*bench.system().finish_exchange(bench.master()).latency(), bench.plc().format().character_time());
}

TEST(Hppc, H8AMessageEndsWithAGapOf500MillisecondsOrAfter10Seconds) {
  Bench bench("hppc");
  const Bytes resync = request(HppcOpcode::Read, hppc_read(0, 0));
  const auto answered = [&](const Bytes& message, Time gap) {
    bench.master().requester().start({.frame = serial::to_frame(message), .timeout = 100 * kMillisecond, .gap = gap},
                                     bench.system().time());
    const bool any = !bench.system().finish_exchange(bench.master()).response.empty();
    bench.wait(kSecond);
    return any;
  };
  EXPECT_TRUE(answered(resync, 490 * kMillisecond));
  EXPECT_FALSE(answered(resync, 510 * kMillisecond));
  const Bytes longer = request(HppcOpcode::Write, hppc_write(0x90000, Bytes(20)));
  EXPECT_TRUE(answered(longer, 300 * kMillisecond));
  EXPECT_FALSE(answered(longer, 350 * kMillisecond));
  EXPECT_TRUE(answered(resync, 0));
}

TEST(Hppc, ACharacterReceivedWhileItSendsAbortsTheAnswer) {
  Bench bench("hppc");
  const Bytes table = request(HppcOpcode::Parameters, {0xFF});
  bench.master().requester().start({.frame = serial::to_frame(table)}, bench.system().time());
  bench.system().run_until(bench.system().time() + 60 * kMillisecond);
  const Time now = bench.system().time();
  const auto copy = bench.plc().clone();
  copy->hear({.byte = 0x55, .start = now, .end = now + kMillisecond});
  EXPECT_TRUE(copy->take_abort());
  auto& other = bench.system().add_requester(bench.line());
  other.uart().configure(bench.plc().format(), 0);
  other.requester().start({.frame = serial::to_frame(Bytes{0x55}), .timeout = kMillisecond}, now);
  bench.system().finish_exchange(bench.master());
  const std::size_t length = bench.master().requester().exchange().response.size();
  EXPECT_GT(length, 20U);
  EXPECT_LT(length, 266U);
  bench.wait(kSecond);  // on the one line of both what collided is heard too
  EXPECT_EQ(asked(bench, request(HppcOpcode::Read, hppc_read(0, 0))), "0c 00");
}

TEST(Hppc, H10TheParameterTableIsThatOfSection66OrOfTheExample) {
  const Bytes message = request(HppcOpcode::Parameters, {0x34});
  const auto base = [&](const std::string& settings) {
    const std::string hex = asked(settings, message);
    const Bytes bytes = serial::bytes_of(serial::parse_hex_frame(hex).frame);
    return std::pair{holding_registers(std::span(bytes).subspan(4)), bytes};
  };
  const auto [base66, bytes66] = base("");
  ASSERT_TRUE(base66);
  EXPECT_EQ(base66->base, 0xABFFEU);
  EXPECT_EQ(base66->number, 0x0800);
  EXPECT_EQ(bytes66[4 + 0x2E], 0xFE);
  const auto [base_of_example, example] = base("table=example");
  ASSERT_TRUE(base_of_example);
  EXPECT_EQ(base_of_example->base, 0xABFFEU);
  EXPECT_EQ(example[4 + 0x2C], 0xFE);
  EXPECT_FALSE(holding_registers(Bytes(0x34)));
}

TEST(Hppc, FaultsOfTheLineAreMet) {
  Bench bench("hppc");
  const Bytes resync = request(HppcOpcode::Read, hppc_read(0, 0));
  bench.line().faults().inject(serial::parse_fault("flip:character=8,bit=3,exchange=1").fault, bench.system().time());
  EXPECT_EQ(asked(bench, resync), "10 01 00 00");
  EXPECT_EQ(asked(bench, resync), "0c 00");
}

TEST(Hppc, ASnapshotGoesOnAsItWouldHave) {
  Bench bench("hppc");
  serial::System& system = bench.system();
  bench.master().requester().start({.frame = serial::to_frame(request(HppcOpcode::Parameters, {0x34}))}, system.time());
  for (int i = 0; i < 2; ++i) system.run_until(system.time() + 15 * kMillisecond);
  const auto snapshot = system.snapshot();
  const Bytes answer = system.finish_exchange(bench.master()).response_bytes();
  const auto end = system.snapshot();
  system.restore(snapshot);
  EXPECT_EQ(system.finish_exchange(bench.master()).response_bytes(), answer);
  EXPECT_EQ(system.snapshot(), end);
  EXPECT_EQ(answer.size(), 0x3FU);
}

TEST(HppcMessage, EachBitOfAStatusHasItsWords) {
  EXPECT_EQ(hppc_status_text(0), "status 16#00");
  EXPECT_EQ(hppc_status_text(0x12), "status 16#12: network not found, processor not running");
  EXPECT_EQ(hppc_status_text(0x1F),
            "status 16#1F: special function data valid, network not found, controlled by an MCR, controlled by a skip, "
            "processor not running");
}

TEST(HppcMessage, AParameterTableIsSaidWithItsPlaceAndWhatIsKnownOfIt) {
  EXPECT_EQ(hppc_parameters_text(Bytes{0, 0, 8}), "parameter table at 16#80000");
  EXPECT_EQ(hppc_parameters_text(Bytes{0, 0, 8, 0x8A, 0}), "parameter table at 16#80000: 8a 00");
  Bytes whole{0, 0, 8};
  whole.resize(3 + 0x34);
  whole[3 + 0x2E] = 0xFE, whole[3 + 0x2F] = 0xBF, whole[3 + 0x30] = 0x0A;
  EXPECT_TRUE(hppc_parameters_text(whole).starts_with("parameter table at 16#80000, holding register 1 at 16#ABFFE: 00"));
}

TEST(HppcMessage, AnAnswerIsJudgedByLengthCheckAddressAndOpcode) {
  const Bytes asked_for = request(HppcOpcode::Read, hppc_read(0, 0));
  const auto fault = [&](const Bytes& answer) { return check_hppc_answer(asked_for, answer, FcsTable::Document).fault; };
  const auto answer = [](std::uint8_t destination, HppcOpcode opcode, const Bytes& operands) {
    return hppc_message(destination, 0, opcode, operands, FcsTable::Document);
  };
  EXPECT_EQ(fault(answer(kApl, HppcOpcode::Read, {0})), "");
  EXPECT_EQ(fault(answer(0x41, HppcOpcode::Read, {0})), "for 16#41, not for 16#40");
  EXPECT_EQ(fault(answer(kApl, HppcOpcode::Write, {0})), "answer to opcode 0B, not 0C");
  EXPECT_EQ(fault(answer(kApl, HppcOpcode::Error, {})), "an error response without a code");
  EXPECT_EQ(fault({1, 2, 3}), "too short for an answer: 01 02 03");
  Bytes damaged = answer(kApl, HppcOpcode::Read, {0});
  damaged[6] ^= 1;
  EXPECT_EQ(fault(damaged), "wrong frame check");
  damaged[0] ^= 1;
  EXPECT_EQ(fault(damaged), "wrong length: 9 bytes, it says 8");
  EXPECT_EQ(check_hppc_answer(asked_for, answer(kApl, HppcOpcode::Error, {0x11, 0, 0}), FcsTable::Document).exception, 0x11);
}

}  // namespace
}  // namespace s7200::westinghouse::westinghouse_hppc_test
