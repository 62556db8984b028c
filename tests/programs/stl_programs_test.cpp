// Every program for users, and what the small ones are for.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/slave_bench.hpp"

namespace s7200::test::stl_programs_test {
namespace {

std::vector<std::string> all_programs() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(source_path("stl_programs")))
    if (entry.path().extension() == ".stl") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

class StlPrograms : public ::testing::TestWithParam<std::string> {};

TEST_P(StlPrograms, HaveAHeaderNoDiagnosticsAndRunWithoutErrors) {
  const std::string text = text_of(GetParam());
  EXPECT_EQ(text.substr(0, 3), "// ");
  SlaveBench bench(text);  // reports diagnostics
  bench.simulation().power_up();
  EXPECT_EQ(bench.simulation().run_until(2 * kSecond), serial::Halt::Time);
  EXPECT_EQ(bench.state().error_count, 0U);
  EXPECT_GT(bench.state().scans, 100U);
}

INSTANTIATE_TEST_SUITE_P(All, StlPrograms, ::testing::ValuesIn(all_programs()),
                         [](const auto& program) { return std::filesystem::path(program.param).stem().string(); });

TEST(CharacterEcho, SendsBackEveryCharacter) {
  SlaveBench bench(text_of(source_path("stl_programs/character_echo.stl")));
  bench.start();
  EXPECT_EQ(bench.format(), (SerialFormat{9600, 8, Parity::None, 1}));
  for (const char* character : {"41", "00", "ff"}) EXPECT_EQ(bench.ask_raw(character), character);
  EXPECT_EQ(bench.vw(102), 3);
  EXPECT_EQ(bench.qb(0), 0xFF);
}

TEST(EdgeCounter, CountsPulsesThatTheScanDoesNotSee) {
  SlaveBench bench(text_of(source_path("stl_programs/edge_counter.stl")));
  bench.simulation().power_up();
  bench.run_for(10 * kMillisecond);
  for (int i = 0; i < 100; ++i) {
    bench.set_input(0, 1);
    bench.run_for(200 * kMicrosecond);
    bench.set_input(0, 0);
    bench.run_for(kMillisecond);
  }
  EXPECT_EQ(bench.vw(0), 100);
  EXPECT_EQ(bench.vw(2), 100);
  EXPECT_LT(bench.vw(4), 100);
  bench.set_input(0, 2);
  bench.run_for(10 * kMillisecond);
  EXPECT_EQ(bench.vw(0), 0);
}

// Programs of the tests.

std::string test_program(const std::string& name) { return text_of(source_path("tests/programs/" + name)); }

/// 30 characters without a gap, at 38400 or 9600 baud, for a receive routine that takes 1.1 ms; how many it served.
struct Served {
  std::uint16_t characters;
  bool overflow_seen;
  std::uint64_t lost;
};
Served send_thirty_characters(std::uint8_t port_control) {
  SlaveBench bench(test_program("slow_receiver.stl"));
  CountingSink sink;
  bench.simulation().power_up();
  bench.set_vb(10, port_control);
  bench.cpu().set_sink(&sink);
  bench.run_for(10 * kMillisecond);
  bench.simulation().configure_master(bench.format());
  bench.send({.frame = serial::to_frame(Bytes(30, 0x55)), .timeout = 100 * kMillisecond});
  return {bench.vw(0), (bench.state().image[image::kM] & 1) != 0, sink.of(TraceKind::EventLost)};
}

TEST(ReceiveQueue, LosesCharactersOfAReceiveRoutineThatTakesLongerThanOne) {
  const Served fast = send_thirty_characters(0x01);
  EXPECT_LT(fast.characters, 30);
  EXPECT_EQ(fast.characters + fast.lost, 30U);
  EXPECT_TRUE(fast.overflow_seen);
  const Served slow = send_thirty_characters(0x0D);
  EXPECT_EQ(slow.characters, 30);
  EXPECT_EQ(slow.lost, 0U);
  EXPECT_FALSE(slow.overflow_seen);
}

TEST(Watchdog, StopsAScanOfMoreThan300MillisecondsUnlessItIsReset) {
  SlaveBench with(test_program("long_scan.stl"));
  with.simulation().power_up();
  EXPECT_EQ(with.simulation().run_until(2 * kSecond), serial::Halt::Time);
  SlaveBench without(changed(test_program("long_scan.stl"), "WDR", ""));
  without.simulation().power_up();
  EXPECT_EQ(without.simulation().run_until(2 * kSecond), serial::Halt::Stopped);
  EXPECT_EQ(without.state().fatal_code, static_cast<std::uint16_t>(FatalError::Watchdog));
  EXPECT_NEAR(static_cast<double>(without.state().time) / kMillisecond, 300.0, 1.0) << "stops when it expires";
}

}  // namespace
}  // namespace s7200::test::stl_programs_test
