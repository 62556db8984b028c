// A CPU whose crystal is off: all that it counts by its clock comes sooner or later. Times: plc.hpp.
#include "tests/support/plc.hpp"

namespace s7200::test::clock_error_test {
namespace {

/// Timers of each time base, a timed interrupt of 10 ms, SM0.5 and the time of day, which begins at 10:00:00.
struct Counts {
  std::int64_t of_1ms = 0, of_10ms = 0, of_100ms = 0, interrupts = 0, clock_pulses = 0, seconds = 0;
};

Counts counts_at(Time end, std::int32_t clock_error) {
  Plc plc(
      "LD SM0.1\nMOVB 10, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nTONR T0, 32767\nTONR T1, 32767\nTONR T5, 32767\nTODR VB20\n"
      "LD SM0.5\nEU\nINCW VW12\nMEND\nINT 0\nINCW VW10\nRETI\n");
  plc.cpu.set_clock_error(clock_error);
  plc.cpu.power_up();
  plc.cpu.set_clock({.year = 26, .month = 11, .day = 21, .hour = 10});
  plc.run_until(end);
  return {plc.value("T0"), plc.value("T1"), plc.value("T5"), plc.value("VW10"), plc.value("VW12"), plc.cpu.clock().second};
}

TEST(ClockError, AllThatCountsMillisecondsIsOff) {
  const Time end = 29'980 * ms;
  const Counts exact = counts_at(end, 0), fast = counts_at(end, 1000), slow = counts_at(end, -1000);
  EXPECT_EQ(fast.of_1ms - exact.of_1ms, 30);
  EXPECT_EQ(exact.of_1ms - slow.of_1ms, 30);
  EXPECT_EQ(fast.of_10ms - exact.of_10ms, 3);
  EXPECT_EQ(fast.of_100ms - exact.of_100ms, 1);
  EXPECT_EQ(fast.interrupts - exact.interrupts, 3);
  EXPECT_EQ(exact.interrupts - slow.interrupts, 3);
  EXPECT_EQ(fast.clock_pulses - exact.clock_pulses, 1);
  EXPECT_EQ(exact.seconds, 29);
  EXPECT_EQ(fast.seconds, 30);
}

// The character at 20 ms starts the message, and nothing follows for a minute.
TEST(ClockError, RcvWaitsByTheClockOfItsCpu) {
  for (const std::int32_t clock_error : {0, 1000, -1000}) {
    Plc plc(
        "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#94, SMB87\nMOVW 0, SMW90\nMOVW 60000, SMW92\nMOVB 20, SMB94\nRCV VB100, 0\n"
        "MEND\n",
        cpu224());
    plc.cpu.set_clock_error(clock_error);
    plc.cpu.power_up();
    plc.character_at(20 * ms, 'a');
    plc.run_until(61 * kSecond);
    const Times ends = plc.records.times(TraceKind::ReceiveEnd);
    ASSERT_EQ(ends.size(), 1U);
    EXPECT_NEAR(static_cast<double>(ends[0]), static_cast<double>(60'020 * ms - 60 * clock_error * us), 1e6);
  }
}

// MEND alone: scans of 810 us, right to the nanosecond; the first one makes up for nothing.
TEST(ClockError, ScansAreOffAsAWhole) {
  for (const std::int32_t clock_error : {0, 50, -50, 1000, -1000}) {
    Plc plc("MEND\n");
    plc.cpu.set_clock_error(clock_error);
    plc.cpu.power_up();
    plc.run_scans(1000);
    const double nominal = 1000.0 * 810 * us;
    EXPECT_NEAR(static_cast<double>(plc.cpu.time()), nominal - nominal * clock_error / 1e6, 2000) << clock_error;
  }
}

// 400 ms of divisions; the inputs are read in 200 us.
TEST(ClockError, AScanIsShorterByItsFirstPartAtMost) {
  const std::string divisions = "DIV VW100, VD104\nDIV VW100, VD104\nWDR\n";
  Plc plc("LD SM0.0\nMOVW 1, VW100\n" + divisions + divisions + "MEND\n");
  plc.cpu.set_clock_error(1000);
  plc.cpu.power_up();
  plc.run_scans(2);
  EXPECT_EQ(plc.cpu.time(), 2 * (400 * ms + 850 * us) - 200 * us);
}

}  // namespace
}  // namespace s7200::test::clock_error_test
