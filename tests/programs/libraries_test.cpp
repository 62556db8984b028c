// The stand-ins for Micro/WIN's Modbus library on a line: what its manual leaves open (interpreter/program/loading/stand_ins.hpp).
// What the manual says: libraries/*.yaml.
#include <gtest/gtest.h>

#include "serial_sim/modbus/crc.hpp"
#include "tests/support/plc.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::test::libraries_test {
namespace {

std::string program(const std::string& name) {
  return "// FOR THE CPU 224\n" + text_of(source_path("tests/programs/libraries/" + name));
}

class LibrarySlave : public ::testing::Test {
 protected:
  void SetUp() override {
    bench.start();
    forget();
  }
  void forget() { bench.cpu().poke(image::kM + 3, Bytes{0, 0xFF}); }
  int served() { return bench.state().image[image::kM + 3]; }
  int error() { return bench.state().image[image::kM + 4]; }

  SlaveBench bench{program("slave.awl")};
};

TEST_F(LibrarySlave, IsDoneWithError6AfterADisturbedCharacterFromAnyStation) {
  for (const char* frame : {"01 03p 00 00 00 01 84 0a", "07 03p 00 00 00 01 84 0a"}) {
    forget();
    EXPECT_EQ(bench.ask_raw(frame), "-");
    bench.run_for(50 * kMillisecond);
    EXPECT_EQ(served(), 1) << frame;
    EXPECT_EQ(error(), 6) << frame;
  }
}

TEST_F(LibrarySlave, IsDoneWithError7AfterAWrongCrcOfAFrameToItOrToAll) {
  for (const auto& [frame, how_often] :
       {std::pair{"01 03 00 00 00 01 00 00", 1}, {"00 06 00 00 00 01 00 00", 1}, {"07 03 00 00 00 01 00 00", 0}}) {
    forget();
    EXPECT_EQ(bench.ask_raw(frame), "-");
    bench.run_for(50 * kMillisecond);
    EXPECT_EQ(served(), how_often) << frame;
    EXPECT_EQ(error(), how_often == 0 ? 0xFF : 7) << frame;
  }
}

TEST_F(LibrarySlave, TellsExceptions1And2And3AsErrors8And9And4) {
  for (const auto& [request, answer, expected] :
       {std::tuple{"01 07", "01 87 01", 8}, {"01 03 03 e8 00 01", "01 83 02", 9}, {"01 03 00 00 00 00", "01 83 03", 4}}) {
    forget();
    EXPECT_EQ(bench.ask(request), answer);
    EXPECT_EQ(served(), 1) << request;
    EXPECT_EQ(error(), expected) << request;
  }
}

TEST_F(LibrarySlave, IsDoneAfterABroadcastThatWritesAndIgnoresOneThatReads) {
  EXPECT_EQ(bench.ask("00 06 00 00 12 34"), "-");
  EXPECT_EQ(served(), 1);
  EXPECT_EQ(bench.vw(1000), 0x1234);
  EXPECT_EQ(bench.ask("00 03 00 00 00 01"), "-");
  EXPECT_EQ(served(), 1);
}

TEST_F(LibrarySlave, Serves120RegistersAtMost) {
  EXPECT_EQ(bench.ask("01 03 00 00 00 78").size(), 3U * 243 - 1);
  EXPECT_EQ(bench.ask("01 03 00 00 00 79"), "01 83 03");
  EXPECT_EQ(bench.ask("01 04 00 00 00 79"), "01 84 03");
}

/// A master of which the test is the slave. It asks for one register of station 1 unless told otherwise.
class LibraryMaster : public ::testing::Test {
 protected:
  void ask(unsigned slave = 1, unsigned rw = 0) {
    plc.run_until(10 * ms);
    plc.set("VB2000", slave);
    plc.set("VB2001", rw);
    plc.set("VD2002", 40001);
    plc.set("VW2006", 1);
    plc.set("VD2008", 0x08000190);
    plc.set("M10.0", 1);
    plc.run_until(40 * ms);
    ASSERT_EQ(requests(), 1U);
  }
  std::size_t requests() const { return plc.port.sent.size() / 8; }
  Time end_of_request() const { return plc.port.sent.back().at + plc.port.format.character_time(); }

  /// A frame with its CRC; returns when its last character ends.
  Time answer(Bytes frame, Time from) {
    const std::uint16_t crc = modbus::crc16(frame);
    frame.push_back(static_cast<std::uint8_t>(crc));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
    for (const std::uint8_t byte : frame) plc.character_at(from += plc.port.format.character_time(), byte);
    return from;
  }
  bool done() { return plc.value("M10.2") != 0; }
  std::int64_t error() { return plc.value("MB11"); }

  Plc plc{program("master.awl"), cpu224()};
};

TEST_F(LibraryMaster, WaitsFromTheEndOfTheRequestForTheFirstCharacterOfTheAnswer) {
  ask();
  const Time end = end_of_request();
  plc.run_until(end + 190 * ms);
  const Time answered = answer({1, 3, 2, 0x12, 0x34}, end + 190 * ms);
  EXPECT_GT(answered, end + 195 * ms);
  plc.run_until(end + 250 * ms);
  EXPECT_TRUE(done());
  EXPECT_EQ(error(), 0);
  EXPECT_EQ(requests(), 1U);
  EXPECT_EQ(plc.value("VW400"), 0x1234);
}

TEST_F(LibraryMaster, AsksAgainTwiceWithoutAnAnswer) {
  ask();
  const Time end = end_of_request();
  plc.run_until(end + 195 * ms);
  EXPECT_EQ(requests(), 1U);
  plc.run_until(end + 230 * ms);
  EXPECT_EQ(requests(), 2U);
  plc.run_until(end + 1000 * ms);
  EXPECT_EQ(requests(), 3U);
  EXPECT_TRUE(done());
  EXPECT_EQ(error(), 3);
}

TEST_F(LibraryMaster, DoesNotAskAgainAfterAnException) {
  ask();
  answer({1, 0x83, 2}, end_of_request() + 5 * ms);
  plc.run_until(500 * ms);
  EXPECT_TRUE(done());
  EXPECT_EQ(error(), 102);
  EXPECT_EQ(requests(), 1U);
}

TEST_F(LibraryMaster, IsDone100MillisecondsAfterABroadcast) {
  ask(0, 1);
  const Time end = end_of_request();
  plc.run_until(end + 95 * ms);
  EXPECT_FALSE(done());
  plc.run_until(end + 110 * ms);
  EXPECT_TRUE(done());
  EXPECT_EQ(error(), 0);
}

TEST(LibraryMasterPort, IsSetUpInTheFirstScanAndWhenParametersChange) {
  Plc plc("NETWORK 1\nLD SM0.1\nMOVD 9600, VD50\nNETWORK 2\nLD SM0.0\nCALL MBUS_CTRL, 1, VD50, 2, 200, M0.1, MB1\nMEND\n",
          cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.port.format, (SerialFormat{9600, 8, Parity::Even, 1}));
  plc.set("VD50", 19200);
  plc.run_scans(2);
  EXPECT_EQ(plc.port.format, (SerialFormat{19200, 8, Parity::Even, 1}));
}

}  // namespace
}  // namespace s7200::test::libraries_test
