// Timers of 1, 10 and 100 ms and counters over scans of any length. Times: plc.hpp.
#include <cstdlib>

#include "interpreter/cpu/scan.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::timer_test {
namespace {

bool timer_bit(const Plc& plc, std::uint32_t number) {
  return plc.cpu.state().image[image::kTBits + number / 8] >> (number % 8) & 1;
}
bool counter_bit(const Plc& plc, std::uint32_t number) {
  return plc.cpu.state().image[image::kCBits + number / 8] >> (number % 8) & 1;
}

// TON ends at 220 us, SQRT at 5230 us: five ticks of the millisecond in between.
TEST(Timer, OneMillisecondTimersCountInsideAScan) {
  Plc plc("LD SM0.0\nTON T32, 4\nMOVW T32, VW0\nSQRT VD100, VD104\nMOVW T32, VW2\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.value("VW2"), 5);
  EXPECT_TRUE(timer_bit(plc, 32));
}

// T96 makes the CPU look at the tick at 1000 us, when the TON of T32 ends, too.
TEST(Timer, ATickAtTheEndOfTheExecutionThatEnablesATimerIsNotOneOfIts) {
  std::string text = "LD SM0.0\nTON T96, 4\n";
  for (int i = 0; i < 77; ++i) text += "= M0.0\n";
  Plc plc(text + "TON T32, 4\nMOVW T32, VW0\nMOVW T96, VW2\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.value("VW2"), 1);
}

TEST(Timer, TheEventsOfT32AndT96AreOfTheTickThatBringsThemToTheirPresets) {
  Plc plc(
      "LD SM0.1\nATCH 0, 21\nATCH 1, 22\nENI\nLD SM0.0\nTON T32, 5\nTON T96, 50\nMEND\n"
      "INT 0\nINCW VW0\nMOVW T32, VW2\nRETI\nINT 1\nINCW VW4\nMOVW T96, VW6\nRETI\n",
      cpu215());
  plc.run_until(30 * ms);
  EXPECT_EQ(plc.value("VW0"), 1);
  EXPECT_EQ(plc.value("VW2"), 5);
  EXPECT_EQ(plc.value("VW4"), 0);
  plc.run_until(100 * ms);
  EXPECT_EQ(plc.value("VW0"), 1);
  EXPECT_EQ(plc.value("VW4"), 1);
  EXPECT_EQ(plc.value("VW6"), 50);
}

TEST(Timer, AOneMillisecondTimerCountsWholeMillisecondsFromItsStart) {
  Plc plc("LD I0.0\nTON T32, 1000\nMEND\n");
  plc.input_at(1900 * us, "I0.0", true);  // executed from 2700 us on, in the scan begun at 2490 us
  plc.run_until(2990 * us);
  EXPECT_EQ(plc.value("T32"), 0);
  plc.run_until(10'500 * us);
  EXPECT_EQ(plc.value("T32"), 8) << "the ticks of 3 ms to 10 ms";
}

// Scans of 850 us + 20 ms; scan k reads its inputs until 200 us + (k - 1) * 20.85 ms: 0, 21.05, 41.9, 62.75, 83.6, 104.45
// ms.
TEST(Timer, TenMillisecondTimersDoNotChangeDuringAScan) {
  Plc plc(
      "LD SM0.0\nTON T33, 10\nMOVW T33, VW0\nSQRT VD100, VD104\nSQRT VD100, VD104\nSQRT VD100, VD104\nSQRT VD100, VD104\n"
      "MOVW T33, VW2\nMEND\n");
  const int expected[] = {0, 2, 4, 6, 8, 10};
  for (std::size_t scan = 0; scan < 6; ++scan) {
    plc.run_scans(scan + 1);
    EXPECT_EQ(plc.value("VW0"), expected[scan]) << scan;
    EXPECT_EQ(plc.value("VW2"), expected[scan]) << scan;
    EXPECT_EQ(timer_bit(plc, 33), expected[scan] >= 10);
  }
}

// Scans of 840 us + 100 ms, begun at 0.2, 101.04, 201.88, 302.72 ms.
TEST(Timer, HundredMillisecondTimersCountWhenTheyAreExecuted) {
  Plc plc("LD SM0.0\nDIV VW100, VD104\nTON T37, 3\nMOVW T37, VW0\nMEND\n");
  plc.set("VW100", 1);
  const int expected[] = {0, 1, 2, 3};
  for (std::size_t scan = 0; scan < 4; ++scan) {
    plc.run_scans(scan + 1);
    EXPECT_EQ(plc.value("VW0"), expected[scan]) << scan;
    EXPECT_EQ(timer_bit(plc, 37), expected[scan] >= 3);
  }
}

TEST(Timer, AHundredMillisecondTimerThatIsJumpedOverLosesTheTicksOfThatScan) {
  Plc plc("LD I0.0\nJMP 1\nLD SM0.0\nTON T37, 100\nLBL 1\nLD SM0.0\nDIV VW100, VD104\nMEND\n");
  plc.set("VW100", 1);
  plc.run_scans(3);
  EXPECT_EQ(plc.value("T37"), 2);
  plc.input("I0.0", true);
  plc.run_scans(6);
  plc.input("I0.0", false);
  plc.run_scans(7);
  EXPECT_EQ(plc.value("T37"), 3);
}

// The first scan takes 300 * (100 ms + 20 us) and a bit: 30 s.
TEST(Timer, AScanLongerThan25SecondsLosesTicks) {
  Plc plc("LD SM0.0\nTON T33, 32000\nTON T37, 32000\nLD SM0.1\nFOR VW10, 1, 300\nDIV VW100, VD104\nWDR\nNEXT\nMEND\n");
  plc.set("VW100", 1);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("T33"), 2500);
  EXPECT_EQ(plc.value("T37"), 250);
}

TEST(Timer, OnDelayTimersAreClearedByTheirInputAndRetentiveOnesByR) {
  Plc plc("LD I0.0\nTON T32, 2\nTONR T0, 2\nLD I0.1\nR T0, 1\nMEND\n");
  plc.input("I0.0", true);
  plc.run_until(5 * ms);
  EXPECT_TRUE(timer_bit(plc, 32));
  EXPECT_TRUE(timer_bit(plc, 0));
  plc.input("I0.0", false);
  plc.run_until(7 * ms);
  const std::int64_t kept = plc.value("T0");
  EXPECT_EQ(plc.value("T32"), 0);
  EXPECT_FALSE(timer_bit(plc, 32));
  EXPECT_GE(kept, 4);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.value("T0"), kept);
  EXPECT_TRUE(timer_bit(plc, 0));
  plc.input("I0.1", true);
  plc.run_until(12 * ms);
  EXPECT_EQ(plc.value("T0"), 0);
  EXPECT_FALSE(timer_bit(plc, 0));
}

// I0.1 resets the timers after their instructions; I0.2 jumps over the instructions.
constexpr std::string_view kResetWhileCounting =
    "LD I0.2\nJMP 1\nLD SM0.0\nTON T32, 1000\nTONR T0, 1000\nTON T33, 1000\nTONR T1, 1000\nLBL 1\nLD I0.1\nR T32, 2\nR T0, "
    "2\n"
    "MEND\n";

TEST(Timer, AResetStopsATimerOf1Or10MillisecondsUntilItsInstructionIsExecutedAgain) {
  Plc plc(kResetWhileCounting);
  plc.run_until(45 * ms);
  for (const char* timer : {"T32", "T0"}) EXPECT_GE(plc.value(timer), 40) << timer;
  for (const char* timer : {"T33", "T1"}) EXPECT_EQ(plc.value(timer), 4) << timer;
  plc.input("I0.2", true);
  plc.run_until(48 * ms);
  plc.input("I0.1", true);
  plc.run_until(50 * ms);
  plc.input("I0.1", false);
  plc.run_until(100 * ms);
  for (const char* timer : {"T32", "T0", "T33", "T1"}) EXPECT_EQ(plc.value(timer), 0) << timer << " stands still";
  plc.input("I0.2", false);
  plc.run_until(145 * ms);
  for (const char* timer : {"T32", "T0"}) EXPECT_GE(plc.value(timer), 40) << timer << " is enabled again";
  for (const char* timer : {"T33", "T1"}) EXPECT_EQ(plc.value(timer), 4) << timer << " is enabled again";
}

TEST(Timer, WithoutAResetATimerThatIsJumpedOverCountsOn) {
  Plc plc(kResetWhileCounting);
  plc.run_until(5 * ms);
  plc.input("I0.2", true);
  plc.run_until(100 * ms);
  for (const char* timer : {"T32", "T0"}) EXPECT_GE(plc.value(timer), 95) << timer;
  for (const char* timer : {"T33", "T1"}) EXPECT_EQ(plc.value(timer), 9) << timer;
}

TEST(Timer, AResetOfAOneMillisecondTimerAlsoPreventsItsInterrupt) {
  Plc plc("LD SM0.1\nTON T32, 20\nATCH 0, 21\nENI\nLD I0.1\nR T32, 1\nMEND\nINT 0\nINCW VW0\nRETI\n", cpu215());
  plc.input_at(10 * ms, "I0.1", true);
  plc.run_until(60 * ms);
  EXPECT_EQ(plc.value("VW0"), 0);
}

// Scans of 860 us + 100 ms: one tick a scan.
TEST(Timer, AResetOfAHundredMillisecondTimerClearsValueAndBitAndTheTimerGoesOn) {
  for (const std::uint32_t number : {37u, 5u}) {
    const std::string timer = fmt::format("T{}", number);
    Plc plc(fmt::format("LD SM0.0\nDIV VW100, VD104\n{} {}, 2\nLD I0.1\nR {}, 1\nMEND\n", number == 37 ? "TON" : "TONR",
                        timer, timer));
    plc.set("VW100", 1);
    plc.run_scans(4);
    EXPECT_EQ(plc.value(timer), 3);
    EXPECT_TRUE(timer_bit(plc, number));
    plc.input("I0.1", true);
    plc.run_scans(5);
    EXPECT_EQ(plc.value(timer), 0);
    EXPECT_FALSE(timer_bit(plc, number));
    plc.input("I0.1", false);
    plc.run_scans(6);
    EXPECT_EQ(plc.value(timer), 1) << "the tick of the scan in which it was reset";
    plc.run_scans(7);
    EXPECT_TRUE(timer_bit(plc, number));
  }
}

TEST(Timer, TheExecutionThatEnablesATonWritesZeroToItsValue) {
  for (const char* timer : {"T32", "T33", "T37"}) {
    Plc plc(fmt::format("LD I0.0\nJMP 1\nLD SM0.0\nTON {0}, 100\nMOVW {0}, VW0\nLBL 1\nMEND\n", timer));
    plc.input("I0.0", true);
    plc.run_scans(1);
    plc.set(timer, 50);
    plc.set("VW0", 1);
    plc.input("I0.0", false);
    plc.run_scans(2);
    EXPECT_EQ(plc.value("VW0"), 0) << timer;
  }
  Plc retentive("LD SM0.0\nTONR T5, 100\nMOVW T5, VW0\nMEND\n");
  retentive.set("T5", 50);
  retentive.run_scans(1);
  EXPECT_EQ(retentive.value("VW0"), 50) << "a TONR keeps what it has";
}

TEST(Timer, TimersCountBeyondTheirPresetUpTo32767) {
  Plc plc("LD SM0.0\nTON T32, 5\nMEND\n");
  plc.run_until(1 * ms);
  plc.set("T32", 32'765);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.value("T32"), 32'767);
}

TEST(Timer, ATimerThatStaysAtItsPresetOf32767HasReachedItOnce) {
  Plc plc("LD SM0.0\nTON T32, 32767\nLD SM0.1\nATCH 0, 21\nENI\nMEND\nINT 0\nINCW VW0\nRETI\n", cpu215());
  plc.run_until(1 * ms);
  plc.set("T32", 32'765);
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Timer, InStopTimersDoNotCount) {
  Plc plc("LD SM0.0\nTON T32, 5\nTON T33, 5\nLD I0.0\nSTOP\nMEND\n");
  plc.input_at(50 * ms, "I0.0", true);
  plc.run_until(60 * ms);
  ASSERT_TRUE(plc.stopped());
  const std::int64_t fast = plc.value("T32"), slow = plc.value("T33");
  plc.run_until(200 * ms);
  EXPECT_EQ(plc.value("T32"), fast);
  EXPECT_EQ(plc.value("T33"), slow);
}

TEST(Timer, AfterAStopTimersGoOnFromTheirValue) {
  Plc plc("LD SM0.0\nTON T32, 30000\nTON T33, 30000\nTON T37, 30000\nTONR T5, 30000\nMEND\n");
  plc.run_until(2 * kSecond);
  scan::change_mode(plc.cpu.core(), Mode::Stop);
  plc.run_until(12 * kSecond);
  scan::change_mode(plc.cpu.core(), Mode::Run);
  plc.run_until(13 * kSecond);
  EXPECT_LE(std::abs(plc.value("T32") - 3000), 3);
  EXPECT_LE(std::abs(plc.value("T33") - 300), 2);
  EXPECT_LE(std::abs(plc.value("T37") - 30), 2);
  EXPECT_LE(std::abs(plc.value("T5") - 30), 2);
}

TEST(Timer, OneMillisecondTimersCountAgainAfterAStop) {
  Plc plc("LD SM0.0\nTON T32, 5\nMEND\n");
  plc.run_until(20 * ms);
  scan::change_mode(plc.cpu.core(), Mode::Stop);
  plc.run_until(40 * ms);
  const std::int64_t before = plc.value("T32");
  scan::change_mode(plc.cpu.core(), Mode::Run);
  plc.run_until(80 * ms);
  EXPECT_GT(plc.value("T32"), before + 30);
}

TEST(Timer, AResetOfOneLeavesTheOthersAlone) {
  Plc plc("LD SM0.0\nTON T37, 500\nTON T33, 500\nTON T34, 500\nLD I0.0\nEU\nR C0, 1\nR C33, 1\nR T32, 1\nMEND\n");
  plc.input_at(10'005 * ms, "I0.0", true);
  plc.run_until(10'055 * ms);
  EXPECT_EQ(plc.value("T37"), 100);
  EXPECT_EQ(plc.value("T33"), 1005);
  EXPECT_EQ(plc.value("T34"), 1005);
}

void scan_with(Plc& plc, std::string_view point, bool level) {
  plc.input(point, level);
  plc.run_scans(plc.cpu.state().scans + 1);
}

TEST(Counter, CtuCountsRisingEdgesUpTo32767AndItsResetHolds) {
  Plc plc("LD I0.0\nLD I0.1\nCTU C1, 2\nMEND\n");
  plc.input("I0.0", true);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("C1"), 0) << "1 from the beginning is not an edge";
  for (int i = 0; i < 2; ++i) {
    scan_with(plc, "I0.0", false);
    scan_with(plc, "I0.0", true);
  }
  EXPECT_EQ(plc.value("C1"), 2);
  EXPECT_TRUE(counter_bit(plc, 1));
  plc.set("C1", 32'767);
  scan_with(plc, "I0.0", false);
  scan_with(plc, "I0.0", true);
  EXPECT_EQ(plc.value("C1"), 32'767);
  scan_with(plc, "I0.1", true);
  EXPECT_EQ(plc.value("C1"), 0);
  EXPECT_FALSE(counter_bit(plc, 1));
  scan_with(plc, "I0.0", false);
  scan_with(plc, "I0.0", true);
  EXPECT_EQ(plc.value("C1"), 0);
}

TEST(Counter, CtudCountsBothWaysAndWraps) {
  Plc plc("LD I0.0\nLD I0.1\nLD I0.2\nCTUD C2, 1\nMEND\n");
  plc.run_scans(1);
  scan_with(plc, "I0.1", true);
  EXPECT_EQ(plc.value("C2"), -1);
  EXPECT_FALSE(counter_bit(plc, 2));
  plc.set("C2", 32'767);
  scan_with(plc, "I0.0", true);
  EXPECT_EQ(plc.value("C2"), -32'768);
  scan_with(plc, "I0.1", false);
  scan_with(plc, "I0.1", true);
  EXPECT_EQ(plc.value("C2"), 32'767);
  EXPECT_TRUE(counter_bit(plc, 2));
  scan_with(plc, "I0.2", true);
  EXPECT_EQ(plc.value("C2"), 0);
}

}  // namespace
}  // namespace s7200::test::timer_test
