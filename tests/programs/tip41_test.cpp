// Siemens' Application Tip 41, a Modbus RTU slave, as published: what it answers, its timing, and where it departs from the
// specification. The document is not part of this project; without it these tests are skipped.
#include "tests/support/tip41.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/system/system.hpp"
#include "tests/support/ppi_master.hpp"

namespace s7200::test::tip41_test {
namespace {

class Tip41Slave : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!tip41::available()) GTEST_SKIP() << tip41::path() << " is not there: the document is not part of this project";
    text = tip41::text();
  }

  std::string text;
};

/// It never reads SM0.7, so it is STOP that makes its port speak PPI, not the position of the switch. A programming device
/// at the other port of a CPU 216 turns the CPU.
TEST_F(Tip41Slave, InStopItsPortSpeaksPpiAndInRunModbusAgain) {
  using namespace serial;
  System system;
  SharedLine &office = system.add_line(), &device = system.add_line();
  SharedLine* const lines[] = {&office, &device};
  serial::Plc& plc = system.add_plc(lines, program_of(text, cpu216()));
  RequesterStation &master = system.add_requester(office), &programmer = system.add_requester(device);
  const auto ask = [&](RequesterStation& station, std::uint8_t port, const Bytes& bytes) {
    system.run_until(system.time() + 50 * kMillisecond);
    station.uart().configure(plc.port_format(port), system.time());
    station.requester().start({.frame = to_frame(bytes), .timeout = 200 * kMillisecond}, system.time());
    return to_hex(system.finish_exchange(station).response_bytes());
  };
  const auto turn = [&](std::uint8_t function, Bytes zeros) {
    const std::string_view service = "\tP_PROGRAM";
    zeros.insert(zeros.begin(), function);
    zeros.insert(zeros.end(), service.begin(), service.end());
    EXPECT_EQ(ask(programmer, 1, ppi::sd2(2, 0, 0x6C, ppi::request(zeros))), "e5");
    ask(programmer, 1, ppi::sd1(2, 0, 0x5C));
    system.run_until(system.time() + 2 * kSecond);
  };
  const Bytes status = ppi::sd1(2, 0, 0x49), read = modbus::rtu_frame(1, modbus::read_holding_registers(10, 1));
  system.power_up();
  system.run_until(2 * kSecond);
  EXPECT_EQ(ask(master, 0, read), "01 03 02 00 00 b8 44");
  turn(0x29, Bytes(5));
  EXPECT_EQ(plc.cpu().state().mode, Mode::Stop);
  EXPECT_EQ(ask(master, 0, status), "10 00 02 00 02 16");
  EXPECT_EQ(ask(master, 0, read), "");
  turn(0x28, {0, 0, 0, 0, 0, 0, 0xFD, 0, 0});
  EXPECT_EQ(plc.cpu().state().mode, Mode::Run);
  EXPECT_EQ(ask(master, 0, read), "01 03 02 00 00 b8 44");
}

TEST_F(Tip41Slave, AnswersItsEightFunctions) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask_raw("0106000a1234a4bf"), "01 06 00 0a 12 34 a4 bf");
  EXPECT_EQ(bench.ask_raw("0103000a0001a408"), "01 03 02 12 34 b5 33");
  EXPECT_EQ(bench.ask("010f0000000801ff"), "01 0f 00 00 00 08");
  EXPECT_EQ(bench.qb(0), 0xFF);
  EXPECT_EQ(bench.ask("010100000008"), "01 01 01 ff");
  EXPECT_EQ(bench.ask("01050009ff00"), "01 05 00 09 ff 00");
  EXPECT_EQ(bench.qb(1), 0x02);
  EXPECT_EQ(bench.ask("010500010000"), "01 05 00 01 00 00");
  EXPECT_EQ(bench.qb(0), 0xFD);
  bench.set_input(0, 0xA5);
  bench.run_for(10 * kMillisecond);
  EXPECT_EQ(bench.ask("010200000008"), "01 02 01 a5");
  EXPECT_EQ(bench.ask("01100014000204cafe0102"), "01 10 00 14 00 02");
  EXPECT_EQ(bench.vw(40), 0xCAFE);
  EXPECT_EQ(bench.vw(42), 0x0102);
  bench.set_vw(2002, 0x0BAD);
  EXPECT_EQ(bench.ask("010400010001"), "01 04 02 0b ad");
  EXPECT_EQ(bench.ask("01030000007d").size(), 3U * (3 + 250) - 1);
  EXPECT_EQ(bench.state().error_count, 0U);
}

TEST_F(Tip41Slave, RefusesWhatItDoesNotHave) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("0107"), "01 87 01");
  EXPECT_EQ(bench.ask("010f0000000901ff01"), "01 8f 02");
  EXPECT_EQ(bench.ask("010503e8ff00"), "01 85 02");
  EXPECT_EQ(bench.ask("010603e80000"), "01 86 02");
  EXPECT_EQ(bench.ask("010303e70002"), "01 83 02");
}

TEST_F(Tip41Slave, IsSilentAboutOtherStationsAndDisturbedFramesAndAnswersTheNextOne) {
  SlaveBench bench(text);
  bench.start();
  for (const char* frame :
       {"0203000a0001a43b", "0103000a0001a409", "0103p000a0001a408", "0103000a0001a408p", "01p03000a0001a408"}) {
    EXPECT_EQ(bench.ask_raw(frame), "-") << frame;
    EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 00 00") << "after " << frame;
  }
}

TEST_F(Tip41Slave, FirstScanTakesTheTimeTheDocumentGives) {
  SlaveBench bench(text);
  bench.start();
  const double first_scan_ms = static_cast<double>(bench.state().longest_scan) / kMillisecond;
  EXPECT_NEAR(first_scan_ms, 690.0, 6.9);
}

TEST_F(Tip41Slave, TakesACharacterWhoseStopBitIsAtSpaceBecauseTheCpuShowsItParityOnly) {
  SlaveBench bench(text);
  bench.start();
  bench.simulation().inject(serial::parse_fault("framing:character=8").fault);
  EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 00 00");
  EXPECT_EQ(bench.simulation().faults().state().injected.at(0).count, 1U);
}

/// When the characters of a request came and when INT 124 was called for.
struct QuietWatch : TraceSink {
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::CharacterReceived) last_character = record.at;
    if (record.kind == TraceKind::Attach && record.routine == 124) timer_started = record.at;
    if (record.kind == TraceKind::ServiceBegin && record.routine == 124) request_ended = record.since;
  }
  Time last_character = 0, timer_started = 0, request_ended = 0;
};

TEST_F(Tip41Slave, QuietTimerEndsARequestSixMillisecondsAfterItsLastCharacter) {
  SlaveBench bench(text);
  QuietWatch watch;
  bench.cpu().set_sink(&watch);
  bench.start();
  bench.ask("0103000a0001");
  EXPECT_EQ(watch.request_ended, watch.timer_started + 6 * kMillisecond);
  EXPECT_GT(watch.timer_started, watch.last_character);
  EXPECT_LT(watch.timer_started, watch.last_character + kMillisecond / 5) << "the receive routine's way to its ATCH";
}

TEST_F(Tip41Slave, WorksAtEveryRateOfItsTable) {
  for (const RateSetting& rate : kRateSettings) {
    SlaveBench bench(at_rate(text, rate));
    bench.start();
    EXPECT_EQ(bench.format().baud, rate.baud);
    EXPECT_EQ(bench.ask("0106000a1234"), "01 06 00 0a 12 34") << rate.baud;
    EXPECT_EQ(bench.ask("0103000a0001"), "01 03 02 12 34") << rate.baud;
    EXPECT_EQ(bench.state().error_count, 0U);
  }
}

/// A request of 129 characters.
Bytes sixty_registers() {
  const std::vector<std::uint16_t> values(60, 0x5AA5);
  return modbus::write_registers(0, values);
}

TEST_F(Tip41Slave, ServesLongRequestsAt19200Baud) {
  SlaveBench bench(at_rate(text, kRateSettings[6]));
  CountingSink sink;
  bench.cpu().set_sink(&sink);
  bench.start();
  EXPECT_EQ(serial::to_hex(bench.ask(sixty_registers())), "01 10 00 00 00 3c");
  EXPECT_EQ(sink.of(TraceKind::EventLost), 0U);
}

TEST_F(Tip41Slave, OverrunsItsQueueAt38400Baud) {
  SlaveBench bench(at_rate(text, k38400));
  CountingSink sink;
  bench.cpu().set_sink(&sink);
  bench.start();
  EXPECT_TRUE(bench.ask(sixty_registers()).empty());
  EXPECT_GT(sink.of(TraceKind::EventLost), 0U);
  EXPECT_EQ(sink.last_of(TraceKind::EventLost).event, 8);
  EXPECT_EQ(bench.vw(0), 0);
}

TEST_F(Tip41Slave, SetsTheOverflowBitWhenItsQueueOverruns) {
  const std::string watching = changed(text, "INT     123\nLD      SM0.0", "INT 123\nLD SM4.0\nS M0.0, 1\nLD SM0.0");
  SlaveBench bench(at_rate(watching, k38400));
  bench.start();
  bench.ask(sixty_registers());
  EXPECT_EQ(bench.state().image[image::kM] & 1, 1);
}

TEST_F(Tip41Slave, NeedsItsWatchdogResets) {
  std::string without = text;
  for (std::size_t at; (at = without.find("WDR")) != std::string::npos;) without.erase(at, without.find('\n', at) - at);
  SlaveBench bench(without);
  bench.simulation().power_up();
  EXPECT_EQ(bench.simulation().run_until(kSecond), serial::Halt::Stopped);
  EXPECT_EQ(bench.state().fatal_code, static_cast<std::uint16_t>(FatalError::Watchdog));
  EXPECT_NEAR(static_cast<double>(bench.state().time) / kMillisecond, 300.0, 1.0);
}

TEST_F(Tip41Slave, PrintedAndReadAgainIsTheSameProgram) {
  const stl::ParseResult read_again = stl::parse(text, "again");
  EXPECT_EQ(stl::to_text(read_again.source), text);
  const auto first = compile(text);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->ops.size(), 340U);
}

// Where the tip departs from the specification. Our own slave does not: modbus_slave_test.cpp.

class Tip41Departs : public Tip41Slave {};

TEST_F(Tip41Departs, IgnoresTheBroadcast) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("0006000a1234"), "-");
  EXPECT_EQ(bench.vw(20), 0);
}

TEST_F(Tip41Departs, AnswersExceptionTwoWhereThreeIsDue) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("01030000007e"), "01 83 02") << "126 registers";
  EXPECT_EQ(bench.ask("0101000007d1"), "01 81 02") << "2001 coils";
  EXPECT_EQ(bench.ask("01100000000103cafe"), "01 90 02") << "byte count";
}

TEST_F(Tip41Departs, AcceptsAQuantityOfZero) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("010100000000"), "01 01 00");
  EXPECT_EQ(bench.state().error_count, 0U);
  EXPECT_EQ(bench.ask("010300000000"), "01 03 00");
  EXPECT_EQ(bench.ask("010f0000000000"), "01 0f 00 00 00 00");
  EXPECT_EQ(bench.ask("01100000000000"), "01 10 00 00 00 00");
  EXPECT_EQ(bench.state().error_count, 3U);
  EXPECT_EQ(bench.state().errors[0].code, static_cast<std::uint16_t>(RunError::Count));
}

TEST_F(Tip41Departs, AnswersFunctionFiveWithAnyValueAsIfItHadActed) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("010500001234"), "01 05 00 00 12 34");
  EXPECT_EQ(bench.qb(0), 0);
}

TEST_F(Tip41Departs, TakesCoil32767ForOneThatExists) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("01057fffff00"), "01 05 7f ff ff 00");
  EXPECT_EQ(bench.state().errors[0].code, static_cast<std::uint16_t>(RunError::IndirectAddress));
}

TEST_F(Tip41Departs, WritesWholeBytesOfCoilsOnlyAndDoesNotLookAtTheByteCount) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("010f0001000801ff"), "01 8f 02");
  EXPECT_EQ(bench.ask("010f0000000501ff"), "01 8f 02");
  EXPECT_EQ(bench.ask("010f0000000877a5"), "01 0f 00 00 00 08");
  EXPECT_EQ(bench.qb(0), 0xA5);
}

TEST_F(Tip41Departs, WritesSixtyRegistersAtMost) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(serial::to_hex(bench.ask(sixty_registers())), "01 10 00 00 00 3c");
  const std::vector<std::uint16_t> values(61, 1);
  EXPECT_EQ(serial::to_hex(bench.ask(modbus::write_registers(0, values))), "01 90 02");
}

TEST_F(Tip41Departs, FillsTheLastByteWithTheStatesOfFurtherPoints) {
  SlaveBench bench(text);
  bench.start();
  bench.set_qb(0, 0xFF);
  EXPECT_EQ(bench.ask("010100000003"), "01 01 01 ff");
}

TEST_F(Tip41Departs, DoesNotLookAtTheLengthOfAReadRequest) {
  SlaveBench bench(text);
  bench.start();
  EXPECT_EQ(bench.ask("0103000a0001ffff"), "01 03 02 00 00");
  EXPECT_EQ(bench.ask_raw("017e80"), "01 fe 01 a1 a0") << "a station and its CRC";
}

TEST_F(Tip41Departs, DropsAFrameOf256Characters) {
  SlaveBench bench(text);
  bench.start();
  Bytes pdu(253, 0);
  pdu[0] = 0x65;
  EXPECT_TRUE(bench.ask(pdu).empty());
  pdu.pop_back();
  EXPECT_EQ(serial::to_hex(bench.ask(pdu)), "01 e5 01");
}

TEST_F(Tip41Departs, MissesARequestThatFollowsItsAnswerAfterNoMoreThanTheSilenceOfTheStandard) {
  SlaveBench bench(text);
  bench.start();
  const serial::Frame request = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 1)));
  EXPECT_FALSE(bench.send({.frame = request}).timed_out);
  EXPECT_TRUE(bench.send({.frame = request}).timed_out) << "sent when the exchange before is over, 3.5 characters later";
}

}  // namespace
}  // namespace s7200::test::tip41_test
