#include <gtest/gtest.h>

#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/westnet_plc.hpp"
#include "tests/unit/serial_sim/westinghouse_bench.hpp"

namespace s7200::westinghouse::westinghouse_westnet_test {
namespace {

const std::string kReference = "../shared/reference/westinghouse_vectors.txt";

TEST(Westnet, EveryExchangeOfTheReferenceHolds) {
  const std::string text = text_of(kReference);
  if (text.empty()) GTEST_SKIP() << "there is no " << kReference;
  EXPECT_EQ(play_file(text, "westnet"), 12);
}

TEST(Westnet, OurOwnExchangesHold) { EXPECT_GT(play_file(text_of("tests/exchanges/westinghouse.txt"), "westnet"), 0); }

using enum HighwayCommand;

std::string asked(Bench& bench, const Bytes& message) { return bench.ask(serial::to_hex(message)); }

/// The PLC at 00.11.00 is addressed.
struct Addressed {
  Bench bench;
  explicit Addressed(const std::string& settings = {}) : bench("westnet", "remote=00.11.00 " + settings) {}
  std::string operator()(const Bytes& message) { return asked(bench, message); }
};

TEST(Westnet, W1TheLineIs9600Baud8N1WithoutASyncSignal) {
  Bench bench("westnet");
  EXPECT_EQ(bench.plc().format(), (SerialFormat{9600, 8, Parity::None, 1}));
  EXPECT_EQ(asked(bench, highway(ReadLocalAddress)), "09 06 00 01 00 10");
  EXPECT_EQ(*bench.master().requester().exchange().latency(), bench.plc().format().character_time());
  const auto with_gap = [&](Time gap) {
    bench.master().requester().start(
        {.frame = serial::to_frame(highway(ReadLocalAddress)), .timeout = 200 * kMillisecond, .gap = gap},
        bench.system().time());
    return bench.system().finish_exchange(bench.master()).response.size();
  };
  EXPECT_EQ(with_gap(95 * kMillisecond), 6U);
  EXPECT_EQ(with_gap(101 * kMillisecond), 0U);
}

TEST(Westnet, W2TheSessionStatusOfAFreePlcHasNoDrop) {
  EXPECT_EQ(Addressed()(highway(ReadSessionStatus)), "09 05 80 00 00 8e");
  EXPECT_EQ(Addressed("free_status=addressed")(highway(ReadSessionStatus)), "09 05 80 11 00 9f");
}

TEST(Westnet, W3Error12IsMeantInHex) {
  EXPECT_EQ(Addressed("session=00.22.00")(read_block(0, 2)), "ff 12");
  EXPECT_EQ(Addressed("session=00.22.00 busy_code=decimal")(read_block(0, 2)), "ff 0c");
}

TEST(Westnet, W4ASessionIsClosedExplicitlyOnly) {
  Addressed plc;
  EXPECT_EQ(plc(highway(OpenSession)), "09 03 00 00 00 0c");
  EXPECT_EQ(plc(highway(OpenSession)), "09 03 00 00 00 0c");
  plc(highway(SetAddress, 0, 0x33));
  plc(highway(SetAddress, 0, 0x11));
  EXPECT_EQ(plc(highway(ReadSessionStatus)), "09 05 00 01 00 0f");
  EXPECT_EQ(plc(highway(CloseSession)), "09 04 00 00 00 0d");
  EXPECT_EQ(plc(highway(CloseSession)), "09 04 00 00 00 0d");
  EXPECT_EQ(plc(highway(ReadSessionStatus)), "09 05 80 00 00 8e");
  Addressed closes("new_address=closes_session");
  closes(highway(OpenSession));
  closes(highway(SetAddress, 0, 0x33));
  closes(highway(SetAddress, 0, 0x11));
  EXPECT_EQ(closes(highway(ReadSessionStatus)), "09 05 80 00 00 8e");
}

TEST(Westnet, AfterPowerHasBeenOffNoDropIsAddressedAndNoSessionIsOpen) {
  Addressed plc;
  plc(highway(OpenSession));
  plc.bench.lose_power();
  EXPECT_EQ(plc(read_block(0, 2)), "ff 02") << "no drop is addressed";
  plc(highway(SetAddress, 0, 0x11));
  EXPECT_EQ(plc(highway(ReadSessionStatus)), "09 05 80 00 00 8e");
}

TEST(Westnet, W4TheSessionOfAnotherIsInTheWayOfThePlcButNotOfThePci) {
  Addressed plc("session=00.22.00");
  for (const Bytes& message :
       {highway(OpenSession), highway(CloseSession), read_block(0, 2), write_block(0, Bytes{1, 2}), write_bit(0, 1, true)})
    EXPECT_EQ(plc(message), "ff 12");
  EXPECT_EQ(plc(highway(ReadSessionStatus)), "09 05 00 22 00 30");
  EXPECT_EQ(plc(highway(SetAddress, 0, 0x11)), "09 00 00 11 00 1a");
  EXPECT_EQ(plc(highway(ReadRemoteAddress)), "09 01 00 11 00 1b");
  EXPECT_EQ(plc(highway(ReadLocalAddress)), "09 06 00 01 00 10");
  EXPECT_EQ(plc(highway(ReadHighwayStatus)), "09 02 00 00 00 0b");
}

TEST(Westnet, W5AnErrorIsFFAndItsCodeWhichTheHighwayStatusShowsUntilACommandSucceeds) {
  Bench bench("westnet");
  EXPECT_EQ(asked(bench, read_block(0, 2)), "ff 02");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(asked(bench, highway(ReadHighwayStatus)), "09 02 02 00 00 0d");
  asked(bench, highway(ReadLocalAddress));
  EXPECT_EQ(asked(bench, highway(ReadHighwayStatus)), "09 02 00 00 00 0b");
  Bench other("westnet", "error_byte=fe status=once");
  EXPECT_EQ(asked(other, read_block(0, 2)), "fe 02");
  EXPECT_EQ(asked(other, highway(ReadHighwayStatus)), "09 02 02 00 00 0d");
  EXPECT_EQ(asked(other, highway(ReadHighwayStatus)), "09 02 00 00 00 0b");
}

TEST(Westnet, W5WhatThePlcRefusesWithACodeIsAnErrorOfTheHighwayToo) {
  Addressed plc("error=05 key=protect write=unprotected error_byte=fe");
  EXPECT_EQ(plc(write_block(0, Bytes{1, 2})), "fe 05");
  EXPECT_EQ(plc(highway(ReadHighwayStatus)), "09 02 05 00 00 10");
  Addressed silent("key=protect write=unprotected");
  EXPECT_EQ(silent(write_block(0, Bytes{1, 2})), "");
  EXPECT_EQ(silent(highway(ReadHighwayStatus)), "09 02 00 00 00 0b");
}

TEST(Westnet, W6ADropThatCannotBeIsRefusedAndAMissingPlcWhenItIsAsked) {
  Addressed plc;
  for (const Bytes& message : {highway(SetAddress, 1, 0x11), highway(SetAddress, 0, 0), highway(SetAddress, 0, 0xFF),
                               highway(SetAddress, 0, 0x11, 2)})
    EXPECT_EQ(plc(message), "ff 02");
  EXPECT_EQ(plc(highway(ReadRemoteAddress)), "09 01 00 11 00 1b");
  EXPECT_EQ(plc(highway(SetAddress, 0, 0xFE, 1)), "09 00 00 fe 01 08");
  for (const Bytes& message : {highway(OpenSession), highway(CloseSession), highway(ReadSessionStatus), read_block(0, 2)})
    EXPECT_EQ(plc(message), "ff 02");
  EXPECT_EQ(Addressed("missing_plc=refused")(highway(SetAddress, 0, 0x12)), "ff 02");
  Bench bench("westnet");
  EXPECT_EQ(asked(bench, highway(ReadRemoteAddress)), "09 01 00 00 00 0a");
  EXPECT_EQ(asked(bench, highway(OpenSession)), "ff 02");
}

TEST(Westnet, APlcThatIsNowhereIsMissingWhetherOrNotADropIsAddressed) {
  Bench nowhere("westnet", "plc_at=");
  for (const Bytes& message : {highway(OpenSession), read_block(0, 2)}) EXPECT_EQ(asked(nowhere, message), "ff 02");
  EXPECT_EQ(asked(nowhere, highway(SetAddress, 0, 0x11)), "09 00 00 11 00 1a");
  EXPECT_EQ(asked(nowhere, read_block(0, 2)), "ff 02");
}

TEST(Westnet, TheComputerHasADrop) {
  Bench bench("westnet");
  std::string why = bench.plc().set("local=").why();
  EXPECT_EQ(why, "local: '' is not a drop; write highway, drop and subdrop in hex: 00.11.00");
  EXPECT_EQ(asked(bench, highway(ReadLocalAddress)), "09 06 00 01 00 10");
}

TEST(Westnet, W7WhatIsNotUnderstoodIsNotAnswered) {
  Addressed plc("W[0000]=0");
  const auto silent = [&](const Bytes& message) {
    const std::string answer = plc(message);
    plc.bench.wait(200 * kMillisecond);
    return answer.empty();
  };
  Bytes wrong = highway(ReadLocalAddress);
  wrong[5] ^= 1;
  EXPECT_TRUE(silent(wrong));
  EXPECT_TRUE(silent(message(Opcode::Highway, 7)));
  EXPECT_TRUE(silent(message(Opcode::Highway, 6, 1)));
  EXPECT_TRUE(silent(message(Opcode{0x04})));
  EXPECT_TRUE(silent(set_unit_address(5)));
  EXPECT_TRUE(silent(erase()));
  Bytes wrong_data = write_block(0, Bytes{1, 2});
  wrong_data.back() ^= 1;
  EXPECT_TRUE(silent(wrong_data));
  EXPECT_EQ(plc.bench.fault_of("W[0000]=0"), "");
  EXPECT_EQ(plc(highway(ReadHighwayStatus)), "09 02 00 00 00 0b");
  Addressed loud("malformed=04");
  EXPECT_EQ(loud(wrong), "ff 04");
  loud.bench.wait(200 * kMillisecond);
  EXPECT_EQ(loud(highway(ReadHighwayStatus)), "09 02 04 00 00 0f");
}

TEST(Westnet, ABlockOfMoreThan64BytesIsTooLarge) {
  EXPECT_EQ(Addressed()(read_block(0, 64)).substr(0, 17), "05 00 00 3f 00 44");
  EXPECT_EQ(Addressed()(read_block(0, 65)), "ff 04");
  EXPECT_EQ(Addressed()(write_block(0, Bytes(64))), "07 00 00 3f 00 46");
  EXPECT_EQ(Addressed()(write_block(0, Bytes(65))), "ff 04");
}

TEST(Westnet, FaultsOfTheLineAreMet) {
  Addressed plc;
  plc.bench.line().faults().inject(serial::parse_fault("flip:character=6,bit=0,exchange=1").fault,
                                   plc.bench.system().time());
  EXPECT_EQ(plc(highway(ReadLocalAddress)), "");
  plc.bench.wait(200 * kMillisecond);
  EXPECT_EQ(plc(highway(ReadLocalAddress)), "09 06 00 01 00 10");
}

TEST(Westnet, ASnapshotGoesOnAsItWouldHave) {
  Addressed plc;
  serial::System& system = plc.bench.system();
  plc.bench.master().requester().start({.frame = serial::to_frame(highway(OpenSession))}, system.time());
  system.run_until(system.time() + 4 * kMillisecond);
  const auto snapshot = system.snapshot();
  const Bytes answer = system.finish_exchange(plc.bench.master()).response_bytes();
  const auto end = system.snapshot();
  system.restore(snapshot);
  EXPECT_EQ(system.finish_exchange(plc.bench.master()).response_bytes(), answer);
  EXPECT_EQ(system.snapshot(), end);
  EXPECT_EQ(answer, highway(OpenSession));
}

}  // namespace
}  // namespace s7200::westinghouse::westinghouse_westnet_test
