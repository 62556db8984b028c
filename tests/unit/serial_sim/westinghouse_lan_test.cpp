#include <gtest/gtest.h>

#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "tests/unit/serial_sim/westinghouse_bench.hpp"

namespace s7200::westinghouse::westinghouse_lan_test {
namespace {

const std::string kReference = "../shared/reference/westinghouse_vectors.txt";

TEST(Pc1000Lan, EveryExchangeOfTheReferenceHolds) {
  const std::string text = text_of(kReference);
  if (text.empty()) GTEST_SKIP() << "there is no " << kReference;
  EXPECT_EQ(play_file(text, "pc1000-lan"), 13);
}

TEST(Pc1000Lan, OurOwnExchangesHold) { EXPECT_GT(play_file(text_of("tests/exchanges/westinghouse.txt"), "pc1000-lan"), 0); }

std::string asked(Bench& bench, const Bytes& message) { return bench.ask(serial::to_hex(message), true); }

/// A PLC that is on-line.
struct OnLine {
  Bench bench;
  explicit OnLine(const std::string& settings = {}) : bench("pc1000-lan", settings) { asked(bench, set_unit_address(5)); }
  std::string operator()(const Bytes& message) { return asked(bench, message); }
};

TEST(Pc1000Lan, L1TheLineIs9600Baud8N1) {
  EXPECT_EQ(Bench("pc1000-lan").plc().format(), (SerialFormat{9600, 8, Parity::None, 1}));
  EXPECT_EQ(Bench("pc1000-lan", "baud=19200 parity=odd").plc().format(), (SerialFormat{19200, 8, Parity::Odd, 1}));
}

TEST(Pc1000Lan, L2CharactersCountOnlyWhileSyncIsHighAtTheirStart) {
  Bench bench("pc1000-lan");
  const std::string unit = serial::to_hex(set_unit_address(5));
  EXPECT_EQ(bench.ask(unit, false), "");
  EXPECT_NE(bench.ask(unit, true), "");
  Bench ignored("pc1000-lan", "sync=ignored");
  EXPECT_NE(ignored.ask(unit, false), "");
}

TEST(Pc1000Lan, L2ASyncEdgeThrowsAwayWhatIsNotComplete) {
  Bench bench("pc1000-lan");
  const Bytes unit = set_unit_address(5);
  const auto part = [&](std::size_t from, std::size_t to) {
    return serial::to_hex(
        Bytes(unit.begin() + static_cast<std::ptrdiff_t>(from), unit.begin() + static_cast<std::ptrdiff_t>(to)));
  };
  EXPECT_EQ(bench.ask(part(0, 3), true, 5 * kMillisecond), "");
  EXPECT_EQ(bench.ask(part(3, 6), true), "");
  EXPECT_NE(asked(bench, unit), "");
  bench.station().responder().sync(true, bench.system().time());  // and stays high
  EXPECT_EQ(bench.ask(part(0, 3), false, 5 * kMillisecond), "");
  EXPECT_NE(bench.ask(part(3, 6), false), "");
}

TEST(Pc1000Lan, AfterPowerHasBeenOffMemoryIsKeptAndNoUnitIsAddressed) {
  OnLine plc("W[0000]=1234");
  EXPECT_NE(plc(read_block(0, 2)), "");
  plc.bench.lose_power();
  EXPECT_EQ(plc(read_block(0, 2)), "");
  EXPECT_NE(plc(set_unit_address(5)), "");
  EXPECT_EQ(plc(read_block(0, 2)), "05 00 00 01 00 06 34 12 46");
}

TEST(Pc1000Lan, WithoutPowerItIsSilentAndHalfAMessageFromBeforeIsForgotten) {
  Bench bench("pc1000-lan", "sync=ignored");
  const Bytes unit = set_unit_address(5);
  EXPECT_EQ(bench.ask(serial::to_hex(Bytes(unit.begin(), unit.begin() + 3)), false, 5 * kMillisecond), "");
  bench.station().power_off(bench.system().time());
  EXPECT_EQ(bench.ask(serial::to_hex(unit)), "");
  bench.station().power_on(bench.system().time());
  EXPECT_NE(bench.ask(serial::to_hex(unit)), "");
}

TEST(Pc1000Lan, L3AGapOf100MillisecondsThrowsAMessageAwayAndTheAnswerComesOneCharacterAfterIt) {
  Bench bench("pc1000-lan", "sync=ignored");
  const auto with_gap = [&](Time gap) {
    bench.master().requester().start(
        {.frame = serial::to_frame(set_unit_address(5)), .timeout = 200 * kMillisecond, .gap = gap}, bench.system().time());
    return bench.system().finish_exchange(bench.master());
  };
  EXPECT_FALSE(with_gap(95 * kMillisecond).response.empty());
  EXPECT_TRUE(with_gap(101 * kMillisecond).response.empty());
  EXPECT_EQ(*with_gap(0).latency(), bench.plc().format().character_time());
  bench.set("gap_ms=200 answer_after=3");
  EXPECT_EQ(*with_gap(150 * kMillisecond).latency(), 3 * bench.plc().format().character_time());
}

TEST(Pc1000Lan, L4TheDataCheckIsTheSumOfTheData) {
  EXPECT_EQ(OnLine("W[0000]=1234")(read_block(0, 2)), "05 00 00 01 00 06 34 12 46");
  EXPECT_EQ(OnLine("W[0000]=1234 data_check=xor")(read_block(0, 2)), "05 00 00 01 00 06 34 12 26");
  const Bytes by_xor{0x05, 0, 0, 1, 0, 6, 0x34, 0x12, 0x26};
  EXPECT_EQ(check_block_answer(read_block(0, 2), by_xor, DataCheck::Xor).verdict, serial::Verdict::Right);
  EXPECT_EQ(check_block_answer(read_block(0, 2), by_xor).fault, "wrong data check: it is the XOR of the data, not the sum");
  EXPECT_EQ(write_block(0, Bytes{0x34, 0x12}, DataCheck::Xor).back(), 0x26);
}

TEST(Pc1000Lan, L5TheKeyswitchByteHasOneBitAPositionAndTheFaultMode) {
  const Bytes unit = set_unit_address(5);
  EXPECT_EQ(OnLine("key=stop")(unit), "0a 05 01 00 00 10");
  EXPECT_EQ(OnLine("key=protect")(unit), "0a 05 02 00 00 11");
  EXPECT_EQ(OnLine("key=modify fault=0201")(unit), "0a 05 0c 01 02 1e");
  EXPECT_EQ(OnLine("key_upper_bits=f")(unit), "0a 05 f1 00 00 00");
}

TEST(Pc1000Lan, L6ABitWriteSetsWithTheHighNibble1AndResetsWith0) {
  OnLine plc("W[0100]=00F0");
  EXPECT_EQ(plc(message(Opcode::BitWrite, 0, 1, 0x10)), "03 00 01 10 00 14");
  EXPECT_EQ(plc(message(Opcode::BitWrite, 0, 1, 0x04)), "03 00 01 04 00 08");
  EXPECT_EQ(plc(message(Opcode::BitWrite, 0, 1, 0x20)), "");
  EXPECT_EQ(plc.bench.fault_of("W[0100]=00E1"), "");
  EXPECT_EQ(OnLine("set_nibble=8")(message(Opcode::BitWrite, 0, 1, 0x80)), "03 00 01 80 00 84");
}

TEST(Pc1000Lan, L7AddressesCountWordsAndAnOddBlockEndsWithALowByte) {
  EXPECT_EQ(OnLine("W[0001]=1234,5678")(read_block(1, 3)), "05 01 00 02 00 08 34 12 78 be");
  EXPECT_EQ(OnLine("W[0001]=1234,5678 addresses=bytes")(read_block(2, 3)), "05 02 00 02 00 09 34 12 78 be");
  OnLine plc("W[0002]=1111");
  plc(write_block(1, Bytes{0x34, 0x12, 0x78}));
  EXPECT_EQ(plc.bench.fault_of("W[0001]=1234,1178"), "");
  EXPECT_EQ(plc(read_block(0xFFFF, 2)), "05 ff ff 01 00 04 00 00 00");
}

TEST(Pc1000Lan, L7AddressesOfBitsAreWordsEvenWhereThoseOfBlocksCountBytes) {
  OnLine plc("addresses=bytes");
  EXPECT_EQ(plc(write_bit(0x4000, 1, true)), "03 00 40 11 00 54");
  EXPECT_EQ(plc(read_block(0x8000, 2)), "05 00 80 01 00 86 02 00 02");
  plc.bench.set("fault=0204");
  plc(write_bit(kRetestWord, kRetestBit, true));
  EXPECT_EQ(plc.bench.fault_of("fault=0000"), "");
}

TEST(Pc1000Lan, L8WhatIsWrongOrRefusedIsNotAnswered) {
  OnLine plc("W[0000]=0");
  EXPECT_EQ(plc(read_block(0xFFFF, 3)), "");
  EXPECT_EQ(plc(message(Opcode{0x04})), "");
  EXPECT_EQ(plc(message(Opcode::ReadBlock, 0, 0, 1, 1)), "");
  Bytes wrong_data = write_block(0, Bytes{1, 2});
  wrong_data.back() ^= 1;
  EXPECT_EQ(plc(wrong_data), "");
  Bytes wrong_check = write_block(0, Bytes{1, 2});
  wrong_check[5] ^= 1;
  EXPECT_EQ(plc(wrong_check), "");
  EXPECT_EQ(plc.bench.fault_of("W[0000]=0"), "");
  EXPECT_EQ(plc(write_block(0, Bytes{1, 2})), "07 00 00 01 00 08");
  OnLine loud("error=04");
  EXPECT_EQ(loud(read_block(0xFFFF, 3)), "ff 04");
  EXPECT_EQ(loud(message(Opcode{0x04})), "ff 04");
  Bytes wrong_read = read_block(0, 2);
  wrong_read[5] ^= 1;
  EXPECT_EQ(loud(wrong_read), "ff 04");
}

TEST(Pc1000Lan, L8TheDataOfAWriteWithAWrongCheckIsNotTakenForCommands) {
  OnLine plc("sync=ignored");
  Bytes message = write_block(0, set_unit_address(5));
  message[5] ^= 1;
  EXPECT_EQ(plc(message), "");
  plc.bench.wait(200 * kMillisecond);
  EXPECT_NE(plc(set_unit_address(5)), "");
}

TEST(Pc1000Lan, L8AUnitAddressWithAWrongCheckChangesNothing) {
  OnLine plc;
  Bytes other = set_unit_address(6);
  other[5] ^= 1;
  EXPECT_EQ(plc(other), "");
  EXPECT_NE(plc(read_block(0, 2)), "");
  EXPECT_EQ(plc(set_unit_address(6)), "");
  EXPECT_EQ(plc(read_block(0, 2)), "");
}

TEST(Pc1000Lan, L9ARetestClearsTheFaultRegisterInStopOnlyAndALastingFaultComesBack) {
  const Bytes retest = write_bit(kRetestWord, kRetestBit, true);
  OnLine stopped("fault=0204");
  EXPECT_EQ(stopped(retest), "03 05 82 11 00 9b");
  EXPECT_EQ(stopped.bench.fault_of("fault=0000"), "");
  OnLine running("fault=0204 key=modify");
  EXPECT_EQ(running(retest), "03 05 82 11 00 9b");
  EXPECT_EQ(running.bench.fault_of("fault=0204"), "");
  OnLine lasting("fault=0204 lasting_fault=0200");
  lasting(retest);
  EXPECT_EQ(lasting.bench.fault_of("fault=0200"), "");
  OnLine always("fault=0204 key=modify retest=always");
  always(retest);
  EXPECT_EQ(always.bench.fault_of("fault=0000"), "");
}

TEST(Pc1000Lan, L9BlocksAreWrittenInEveryPositionOfTheKeyswitch) {
  for (const char* const key : {"key=stop", "key=protect", "key=modify"})
    EXPECT_EQ(OnLine(key)(write_block(0, Bytes{1, 2})), "07 00 00 01 00 08");
  EXPECT_EQ(OnLine("key=protect write=unprotected")(write_block(0, Bytes{1, 2})), "");
  EXPECT_EQ(OnLine("key=protect write=unprotected")(write_bit(0, 1, true)), "");
  EXPECT_EQ(OnLine("key=modify write=unprotected")(write_bit(0, 1, true)), "03 00 00 11 00 14");
}

TEST(Pc1000Lan, L9EraseClearsAllMemoryInStopOnlyAndNotTheFaultRegister) {
  OnLine plc("W[0000]=1 W[FFFF]=2 fault=0001");
  EXPECT_EQ(plc(erase()), "0f 01 00 00 00 10");
  EXPECT_EQ(plc.bench.fault_of("W[0000]=0 W[FFFF]=0 fault=0001"), "");
  OnLine registers("W[07FF]=1 W[0800]=2 erases=registers");
  registers(erase());
  EXPECT_EQ(registers.bench.fault_of("W[07FF]=0 W[0800]=2"), "");
  for (const char* const refused : {"key=protect", "key=modify", "plc=pc1100"})
    EXPECT_EQ(OnLine(refused)(erase()), "") << refused;
  Bytes wrong_key = erase();
  wrong_key.back() ^= 1;
  EXPECT_EQ(OnLine()(wrong_key), "");
}

TEST(Pc1000Lan, OnlyTheAddressedUnitIsOnLine) {
  Bench bench("pc1000-lan", "unit=10");
  EXPECT_EQ(asked(bench, read_block(0, 2)), "");
  EXPECT_EQ(asked(bench, set_unit_address(5)), "");
  EXPECT_NE(asked(bench, set_unit_address(16)), "");
  EXPECT_NE(asked(bench, read_block(0, 2)), "");
}

TEST(Pc1000Lan, FaultsOfTheLineAreMet) {
  OnLine plc;
  plc.bench.line().faults().inject(serial::parse_fault("flip:character=2,bit=0,exchange=1").fault,
                                   plc.bench.system().time());
  EXPECT_EQ(plc(read_block(0, 2)), "");
  EXPECT_NE(plc(read_block(0, 2)), "");
}

TEST(Pc1000Lan, ASnapshotGoesOnAsItWouldHave) {
  OnLine plc("W[0000]=1234");
  serial::System& system = plc.bench.system();
  plc.bench.master().requester().start({.frame = serial::to_frame(read_block(0, 2)), .sync = true}, system.time());
  system.run_until(system.time() + 4 * kMillisecond);
  const auto snapshot = system.snapshot();
  const Bytes answer = system.finish_exchange(plc.bench.master()).response_bytes();
  const auto end = system.snapshot();
  system.restore(snapshot);
  EXPECT_EQ(system.finish_exchange(plc.bench.master()).response_bytes(), answer);
  EXPECT_EQ(system.snapshot(), end);
  EXPECT_FALSE(answer.empty());
}

TEST(Pc1000Lan, EachTextIsJudgedByItselfWhateverWasSaidOfTheOneBefore) {
  Bench bench("pc1000-lan");
  EXPECT_FALSE(bench.plc().set("parity=nonsense"));
  std::string why = bench.plc().set("ZZ1=5").why();
  EXPECT_NE(why.find("'ZZ1=5' is not a setting of this PLC"), std::string::npos) << why;
  EXPECT_EQ(bench.plc().holds("W[10000]=5").why(), "W: addresses are from 0 to FFFF");
  EXPECT_EQ(bench.plc().set("W[0000]=12345").why(), "W: 12345 is more than FFFF");
  EXPECT_EQ(bench.plc().set("W[0000]=1234").why(), "");
  EXPECT_EQ(bench.plc().holds("W[0000]=1234").why(), "");
  EXPECT_EQ(bench.plc().holds("W[0000]=1235").why(), "W 0 holds 1234, not 1235; ");
}

// What a master makes of answers.
TEST(BlockMessage, AnAnswerIsJudgedByItsFormAndChecks) {
  const auto fault = [](const Bytes& request, const std::string& response) {
    const Bytes bytes = serial::bytes_of(serial::parse_hex_frame(response).frame);
    return check_block_answer(request, bytes).fault;
  };
  const Bytes read = read_block(0, 2);
  EXPECT_EQ(fault(read, "05 00 00 01 00 06 34 12 46"), "");
  EXPECT_EQ(fault(read, "05 00 00 01 00 06 34 12 47"), "wrong data check");
  EXPECT_EQ(fault(read, "05 00 00 01 00 07 34 12 46"), "wrong check");
  EXPECT_EQ(fault(read, "05 01 00 01 00 07 34 12 46"), "does not repeat the message: 05 01 00 01 00 07");
  EXPECT_EQ(fault(read, "05 00 00 01 00 06 34 12"), "wrong length: 8 bytes, expected 9");
  EXPECT_EQ(fault(read, "07 00 00 01 00 08"), "not the answer to this message: 07 00 00 01 00 08");
  EXPECT_EQ(check_block_answer(read, Bytes{0xFF, 0x12}).exception, 0x12);
  EXPECT_EQ(check_block_answer(read, {}).verdict, serial::Verdict::Silent);
}

TEST(BlockMessage, TheBeginningOfAnAnswerSaysHowLongItIs) {
  const Bytes read{0x05, 0, 0, 1, 0, 6, 0x34, 0x12, 0x46};
  EXPECT_TRUE(is_whole_answer(read));
  EXPECT_FALSE(is_whole_answer(std::span(read).first(6)));
  EXPECT_TRUE(is_whole_answer(Bytes{0xFF, 0x12}));
  EXPECT_FALSE(is_whole_answer({}));
}

}  // namespace
}  // namespace s7200::westinghouse::westinghouse_lan_test
