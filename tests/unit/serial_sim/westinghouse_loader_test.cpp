#include <gtest/gtest.h>

#include "serial_sim/faults/fault.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/loader_plc.hpp"
#include "tests/unit/serial_sim/westinghouse_bench.hpp"

namespace s7200::westinghouse::westinghouse_loader_test {
namespace {

using serial::Verdict;

const std::string kReference = "../shared/reference/westinghouse_vectors.txt";

TEST(Loader, EveryExchangeOfTheReferenceHolds) {
  const std::string text = text_of(kReference);
  if (text.empty()) GTEST_SKIP() << "there is no " << kReference;
  EXPECT_EQ(play_file(text, "pc500-loader"), 13);
}

TEST(Loader, OurOwnExchangesHold) { EXPECT_GT(play_file(text_of("tests/exchanges/westinghouse.txt"), "pc500-loader"), 0); }

/// A whole session of a computer with the PLC.
serial::Answer session(Bench& bench, const LoaderOperation& operation, Dle dle = Dle::Doubled) {
  LoaderSteps steps(operation, dle);
  Bytes all;
  for (std::optional<Bytes> request = steps.first(); request;) {
    const std::string hex = bench.ask(serial::to_hex(*request));
    const Bytes answer = hex.empty() ? Bytes{} : serial::bytes_of(serial::parse_hex_frame(hex).frame);
    EXPECT_EQ(is_whole_step(answer), steps.answered());
    all.insert(all.end(), answer.begin(), answer.end());
    request = steps.next(answer);
  }
  return steps.judge(all);
}

serial::Answer session(const std::string& settings, const LoaderOperation& operation, Dle dle = Dle::Doubled) {
  Bench bench("pc500-loader", settings);
  return session(bench, operation, dle);
}

Bytes head_and(const Bytes& data) {
  Bytes bytes(kReadHead);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

TEST(Loader, TheLineIs9600Baud8E1) {
  EXPECT_EQ(Bench("pc500-loader").plc().format(), (SerialFormat{9600, 8, Parity::Even, 1}));
}

TEST(Loader, AnAnswerBegins400MicrosecondsAfterTheRequest) {
  Bench bench("pc500-loader");
  bench.master().requester().start({.frame = serial::to_frame(Bytes{kStx})}, bench.system().time());
  EXPECT_EQ(*bench.system().finish_exchange(bench.master()).latency(), 400 * kMicrosecond);
}

TEST(Loader, AReadOrAWriteIsOneSession) {
  Bench bench("pc500-loader");
  EXPECT_EQ(session(bench, loader_read(0xEF80, 4)).bytes, head_and({0x12, 0x34, 0x56, 0x78}));
  EXPECT_EQ(session(bench, loader_write(0xEF80, Bytes{0x7F, 0x10})).verdict, Verdict::Right);
  EXPECT_EQ(session(bench, loader_read(0xEF80, 2)).bytes, head_and({0x7F, 0x10}));
  EXPECT_EQ(session(bench, loader_read(0xFFFF, 1)).verdict, Verdict::Right);
  EXPECT_EQ(session(bench, loader_read(0xE000, 512)).bytes.size(), 517U);
}

TEST(Loader, WhatAPlcRefusesIsAnsweredWithANak) {
  Bench bench("pc500-loader");
  const auto refused = [&](const LoaderOperation& operation) {
    const serial::Answer answer = session(bench, operation);
    return answer.verdict == Verdict::Exception && answer.exception == kNak;
  };
  EXPECT_TRUE(refused(loader_block(2)));
  EXPECT_TRUE(refused(loader_block(0)));
  EXPECT_TRUE(refused({LoaderOpcode::Block, {2, 1}, 13}));
  EXPECT_TRUE(refused({LoaderOpcode::Directory, {2}, 513}));
  EXPECT_TRUE(refused({LoaderOpcode::Directory, {}, 513}));
  EXPECT_TRUE(refused({LoaderOpcode::Pointers, {1}, 21}));
  EXPECT_TRUE(refused({LoaderOpcode::Read, {0x90, 0x01, 0x90, 0x00}, 6}));
  EXPECT_TRUE(refused({LoaderOpcode::Read, {0x90, 0x00}, 6}));
  EXPECT_TRUE(refused(loader_read(0x8000, 513)));
  EXPECT_TRUE(refused(loader_write(0x8000, {})));
  EXPECT_TRUE(refused(loader_write(0x8000, Bytes(513))));
  EXPECT_TRUE(refused(loader_write(0xFFFF, Bytes(2))));
  EXPECT_TRUE(refused({static_cast<LoaderOpcode>(0x08), {}, 1}));
  EXPECT_EQ(session(bench, loader_read(0xEF80, 1)).verdict, Verdict::Right);
}

TEST(Loader, S1TheDirectoryBeginsWithDb000) {
  EXPECT_EQ(session("", loader_directory()).bytes[3], 0x80);
  EXPECT_EQ(session("", loader_directory()).bytes[1], 0x00);
  EXPECT_EQ(session("directory=db1", loader_directory()).bytes[1], 0x80);
}

TEST(Loader, S2FiveZeroesStandBeforeThePointersAndNothingAfterThem) {
  const Bytes pointers{0xEF, 0x00, 0xEF, 0x80, 0xEE, 0x00, 0xEC, 0x00, 0xED, 0x00, 0xEA, 0x00, 0x28, 0x04, 0xCF, 0xFF};
  EXPECT_EQ(session("", loader_pointers()).bytes, head_and(pointers));
  LoaderOperation longer = loader_pointers();
  longer.data = 1 + 16 + 2;
  const Bytes bytes = session("head_bytes=1 tail_bytes=2", longer).bytes;
  ASSERT_EQ(bytes.size(), 19U);
  EXPECT_EQ(bytes[1], 0xEF);
}

TEST(Loader, S3AByte10IsDoubledInBothDirectionsUnlessThePlcIsPlain) {
  EXPECT_EQ(session("M[9000]=10,03,10", loader_read(0x9000, 3)).bytes, head_and({0x10, 0x03, 0x10}));
  EXPECT_EQ(session("M[9000]=10,03,10 dle=plain", loader_read(0x9000, 3), Dle::Plain).bytes, head_and({0x10, 0x03, 0x10}));
  EXPECT_EQ(session("M[9000]=10,03,10 dle=plain", loader_read(0x9000, 3)).verdict, Verdict::Wrong);
  Bench bench("pc500-loader");
  EXPECT_EQ(session(bench, loader_write(0x9010, Bytes{0x10, 0x10})).verdict, Verdict::Right);
  EXPECT_EQ(bench.fault_of("M[9010]=10,10"), "");
}

TEST(Loader, S4ASessionEndsSilentlyAfter500MillisecondsWithoutAByte) {
  Bench bench("pc500-loader");
  EXPECT_EQ(bench.ask("02"), "10 06");
  bench.wait(400 * kMillisecond);
  EXPECT_EQ(bench.ask("04"), "02");
  bench.wait(600 * kMillisecond);
  EXPECT_EQ(bench.ask("10 06"), "");
  EXPECT_EQ(bench.ask("02"), "10 06");
  Bench patient("pc500-loader", "timeout_ms=1000");
  EXPECT_EQ(patient.ask("02"), "10 06");
  patient.wait(800 * kMillisecond);
  EXPECT_EQ(patient.ask("04"), "02");
}

TEST(Loader, AfterPowerHasBeenOffTheSessionIsOver) {
  Bench bench("pc500-loader");
  EXPECT_EQ(bench.ask("02"), "10 06");
  bench.lose_power();
  EXPECT_EQ(bench.ask("04"), "");
  EXPECT_EQ(bench.ask("02"), "10 06");
}

TEST(Loader, S4WhatDoesNotFitTheHandshakeIsAnsweredWithANak) {
  const std::string nak = "10 15";
  Bench bench("pc500-loader");
  const auto after = [&](const std::vector<std::string>& steps) {
    std::string last;
    for (const std::string& step : steps) last = bench.ask(step);
    return last;
  };
  EXPECT_EQ(after({"02", "00"}), nak);
  EXPECT_EQ(after({"02", "04", "11"}), nak);
  EXPECT_EQ(after({"02", "04", "10 15"}), nak);
  EXPECT_EQ(after({"02", "04", "10 06", "10 06 90 10 05"}), nak);
  EXPECT_EQ(after({"02", "04", "10 06", "10 06 90p"}), nak);
  EXPECT_EQ(after({"02", "04p"}), nak);
  EXPECT_EQ(after({"55"}), "");
  EXPECT_EQ(after({"02p"}), "");
  EXPECT_EQ(after({"10 06"}), "");
  EXPECT_EQ(after({"02"}), "10 06");
  Bench silent("pc500-loader", "nak=silent");
  silent.ask("02");
  EXPECT_EQ(silent.ask("00"), "");
  EXPECT_EQ(silent.ask("02"), "10 06");
}

TEST(Loader, S5EveryAddressCanBeReadAndWritten) {
  EXPECT_EQ(session("", loader_write(0x0000, Bytes{1})).verdict, Verdict::Right);
  EXPECT_EQ(session("writable=areas", loader_write(0x0000, Bytes{1})).verdict, Verdict::Exception);
  EXPECT_EQ(session("writable=areas", loader_write(0xEF80, Bytes{1})).verdict, Verdict::Right);
  EXPECT_EQ(session("writable=areas", loader_write(0xCFFF, Bytes{1, 2})).verdict, Verdict::Exception);
}

TEST(Loader, TheTimeOutBeginsAfterALongAnswer) {
  Bench bench("pc500-loader");  // 512 bytes take longer than the time-out
  EXPECT_EQ(session(bench, loader_read(0x8000, 512)).verdict, Verdict::Right);
}

TEST(Loader, FaultsOfTheLineAreMet) {
  Bench bench("pc500-loader");
  bench.line().faults().inject(serial::parse_fault("parity:character=1,exchange=2").fault, bench.system().time());
  EXPECT_EQ(session(bench, loader_read(0xEF80, 1)).verdict, Verdict::Exception);
  EXPECT_EQ(session(bench, loader_read(0xEF80, 1)).verdict, Verdict::Right);
}

TEST(Loader, ASnapshotGoesOnAsItWouldHave) {
  Bench bench("pc500-loader");
  serial::System& system = bench.system();
  EXPECT_EQ(bench.ask("02"), "10 06");
  bench.master().requester().start({.frame = serial::to_frame(Bytes{0x04})}, system.time());
  system.run_until(system.time() + 500 * kMicrosecond);
  const auto snapshot = system.snapshot();
  const Bytes answer = system.finish_exchange(bench.master()).response_bytes();
  const auto end = system.snapshot();
  system.restore(snapshot);
  EXPECT_EQ(system.finish_exchange(bench.master()).response_bytes(), answer);
  EXPECT_EQ(system.snapshot(), end);
  EXPECT_EQ(answer, Bytes{0x02});
}

TEST(LoaderSteps, AnAnswerThatStopsOrDoesNotFitIsNamedByItsStep) {
  const LoaderSteps steps(loader_write(0x9000, Bytes{1}), Dle::Doubled);
  EXPECT_EQ(steps.judge({}).verdict, Verdict::Silent);
  EXPECT_EQ(steps.judge(Bytes{0x10, 0x06, 0x02}).fault, "no answer at step 3 of 5");
  EXPECT_EQ(steps.judge(Bytes{0x10, 0x06, 0x55}).fault, "step 2 of 5 does not fit: 55");
  EXPECT_EQ(steps.judge(Bytes{0x10, 0x06, 0x02, 0x16, 0x10, 0x03, 0x10, 0x06, 0x02, 0x12, 0x10, 0x03, 0x55}).fault,
            "more after the end of the session: 55");
}

}  // namespace
}  // namespace s7200::westinghouse::westinghouse_loader_test
