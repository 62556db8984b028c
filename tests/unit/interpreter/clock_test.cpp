// The time of day: TODR, TODW, roll-over.
#include "tests/support/plc.hpp"

namespace s7200 {

std::ostream& operator<<(std::ostream& out, const ClockTime& t) {
  return out << fmt::format("{:02}-{:02}-{:02} {:02}:{:02}:{:02} day {}", t.year, t.month, t.day, t.hour, t.minute, t.second,
                            t.weekday);
}

namespace test {
namespace {

/// A second later.
ClockTime after(const ClockTime& t) {
  Plc plc("LD SM0.0\nMEND\n");
  plc.cpu.set_clock(t);
  plc.run_until(1 * kSecond);
  return plc.cpu.clock();
}

TEST(Clock, RollsOverSecondsMinutesHoursDaysMonthsYears) {
  EXPECT_EQ(after({26, 11, 21, 10, 0, 58, 7}), (ClockTime{26, 11, 21, 10, 0, 59, 7}));
  EXPECT_EQ(after({26, 11, 21, 10, 0, 59, 7}), (ClockTime{26, 11, 21, 10, 1, 0, 7}));
  EXPECT_EQ(after({26, 11, 21, 10, 59, 59, 7}), (ClockTime{26, 11, 21, 11, 0, 0, 7}));
  EXPECT_EQ(after({26, 11, 21, 23, 59, 59, 7}), (ClockTime{26, 11, 22, 0, 0, 0, 1})) << "Saturday, Sunday";
  EXPECT_EQ(after({26, 11, 30, 23, 59, 59, 2}), (ClockTime{26, 12, 1, 0, 0, 0, 3}));
  EXPECT_EQ(after({26, 12, 31, 23, 59, 59, 5}), (ClockTime{27, 1, 1, 0, 0, 0, 6}));
}

TEST(Clock, APowerCycleKeepsTheFractionOfTheSecond) {
  Plc before("LD SM0.0\nMEND\n");
  before.cpu.set_clock({26, 11, 21, 10, 0, 0, 7});
  before.run_until(1700 * ms);
  RetentiveMemory memory = before.cpu.retentive_memory();
  EXPECT_EQ(memory.clock, (ClockTime{26, 11, 21, 10, 0, 1, 7}));
  EXPECT_EQ(memory.clock_fraction, before.cpu.time() - kSecond);
  memory.power_off = 2500 * ms;
  Plc after("LD SM0.0\nMEND\n", &memory);
  EXPECT_EQ(after.cpu.clock(), (ClockTime{26, 11, 21, 10, 0, 4, 7})) << "1.7 s + 2.5 s";
  const Time rest = 5 * kSecond - before.cpu.time() - 2500 * ms;
  after.run_until(rest - 2 * ms);
  EXPECT_EQ(after.cpu.clock().second, 4);
  after.run_until(rest + 2 * ms);
  EXPECT_EQ(after.cpu.clock().second, 5);
}

TEST(Clock, LeapYearsAndTheCentury) {
  EXPECT_EQ(after({24, 2, 28, 23, 59, 59, 4}), (ClockTime{24, 2, 29, 0, 0, 0, 5}));
  EXPECT_EQ(after({24, 2, 29, 23, 59, 59, 5}), (ClockTime{24, 3, 1, 0, 0, 0, 6}));
  EXPECT_EQ(after({25, 2, 28, 23, 59, 59, 6}), (ClockTime{25, 3, 1, 0, 0, 0, 7}));
  EXPECT_EQ(after({0, 2, 28, 23, 59, 59, 2}), (ClockTime{0, 2, 29, 0, 0, 0, 3})) << "2000 is a leap year";
  EXPECT_EQ(after({99, 12, 31, 23, 59, 59, 6}), (ClockTime{0, 1, 1, 0, 0, 0, 7}));
}

TEST(Clock, AWeekdaySwitchedOffStaysOffAndAnImpossibleDateIsAccepted) {
  EXPECT_EQ(after({26, 11, 21, 23, 59, 59, 0}), (ClockTime{26, 11, 22, 0, 0, 0, 0}));
  EXPECT_EQ(after({26, 2, 30, 23, 59, 59, 2}), (ClockTime{26, 3, 1, 0, 0, 0, 3}));
}

ClockTime days_after(Plc& plc, const ClockTime& t, Time days) {
  plc.cpu.set_clock(t);
  State later = plc.cpu.state();
  later.time = later.clock_set_at + days * 86'400 * kSecond;
  plc.cpu.restore(later);
  return plc.cpu.clock();
}

TEST(Clock, ThirtyDaysLater) {
  Plc plc("LD SM0.0\nMEND\n");
  EXPECT_EQ(days_after(plc, {26, 11, 21, 10, 0, 0, 7}, 30), (ClockTime{26, 12, 21, 10, 0, 0, 2}));
}

TEST(Clock, ManyDaysAtOnceLeadWhereOneAfterTheOtherDo) {
  for (const ClockTime& from :
       {ClockTime{0, 2, 28, 0, 0, 0, 1}, ClockTime{99, 12, 31, 23, 0, 0, 7}, ClockTime{25, 2, 31, 0, 0, 0, 0},
        ClockTime{26, 13, 5, 99, 99, 99, 9}, ClockTime{26, 0, 0, 0, 0, 0, 14}}) {
    Plc plc("LD SM0.0\nMEND\n");
    ClockTime step = from;
    for (int days = 1; days < 37'000; ++days) {
      step = days_after(plc, step, 1);
      if (days < 100 || days % 97 == 0 || days > 36'500) {
        ASSERT_EQ(days_after(plc, from, days), step) << days << " days after " << from;
      }
    }
  }
}

TEST(Clock, StartsOnASundayIn1990) {
  Plc plc("LD SM0.0\nMEND\n");
  EXPECT_EQ(plc.cpu.clock(), (ClockTime{90, 1, 1, 0, 0, 0, 1}));
}

TEST(Clock, TodrWritesEightBytesOfBcd) {
  Plc plc("LD SM0.0\nTODR VB100\nMEND\n");
  plc.cpu.set_clock({26, 11, 21, 23, 45, 59, 7});
  plc.set("VB106", 0xFF);
  plc.run_scans(1);
  const Ints expected{0x26, 0x11, 0x21, 0x23, 0x45, 0x59, 0, 7};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(plc.value(fmt::format("VB{}", 100 + i)), expected[i]) << i;
}

TEST(Clock, TodwSetsTheClockAndStartsItsSecond) {
  Plc plc("LD I0.0\nTODW VB100\nMEND\n");
  const std::uint32_t time[] = {0x99, 0x12, 0x31, 0x23, 0x59, 0x59, 0, 6};
  for (std::uint32_t i = 0; i < 8; ++i) plc.set(fmt::format("VB{}", 100 + i), time[i]);
  plc.input("I0.0", true);
  plc.run_until(230 * us);
  plc.input("I0.0", false);
  plc.run_until(220 * us + kSecond - 10 * us);
  EXPECT_EQ(plc.cpu.clock(), (ClockTime{99, 12, 31, 23, 59, 59, 6}));
  plc.run_until(1002 * ms);
  EXPECT_EQ(plc.cpu.clock(), (ClockTime{0, 1, 1, 0, 0, 0, 7}));
}

TEST(Clock, BytesThatAreNotBcdAre0007AndLeaveTheClockAlone) {
  Plc plc("LD SM0.1\nMOVB 16#1A, VB103\nTODW VB100\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.records.errors(), Ints{7});
  EXPECT_EQ(plc.cpu.clock().year, 90);
}

TEST(Clock, ABufferThatRunsPastItsMemoryIs0091) {
  Plc plc("LD SM0.1\nMOVD &VB4089, AC1\nTODR *AC1\nTODW *AC1\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.records.errors(), (Ints{0x91, 0x91}));
}

}  // namespace
}  // namespace test
}  // namespace s7200
