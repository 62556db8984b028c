#include "tools/plan/clock_text.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::clock_text_test {
namespace {

TEST(ClockText, ADateHasItsDayOfTheWeek) {
  EXPECT_EQ(parse_clock("2026-11-21 10:00:00"), (ClockTime{26, 11, 21, 10, 0, 0, 7}));
  EXPECT_EQ(parse_clock("1990-01-01 00:00:00"), (ClockTime{90, 1, 1, 0, 0, 0, 2}));
  EXPECT_EQ(parse_clock("2000-02-29 23:59:59"), (ClockTime{0, 2, 29, 23, 59, 59, 3}));
  EXPECT_EQ(parse_clock("2089-12-31 00:00:00"), (ClockTime{89, 12, 31, 0, 0, 0, 7}));
}

TEST(ClockText, TextThatIsNotATimeIsRefused) {
  for (const char* text :
       {"", "2026-11-21", "2026-11-21 24:00:00", "2026-11-21 10:60:00", "2026-02-29 10:00:00", "1989-12-31 10:00:00",
        "2090-01-01 00:00:00", "2026-13-01 00:00:00", "26-11-21 10:00:00", "2026-11-21T10:00:00", "2026-11-21 10:00:00 "})
    EXPECT_FALSE(parse_clock(text)) << text;
}

TEST(ClockText, AClockErrorIsInMillionthsWithItsUnit) {
  EXPECT_EQ(parse_clock_error("50ppm"), 50);
  EXPECT_EQ(parse_clock_error("+50ppm"), 50);
  EXPECT_EQ(parse_clock_error("-1000ppm"), -1000);
  for (const char* text : {"", "50", "ppm", "1001ppm", "-1001ppm", "0.5ppm", "+-5ppm", "50 ppm", "1%"})
    EXPECT_FALSE(parse_clock_error(text)) << text;
}

}  // namespace
}  // namespace s7200::tools::clock_text_test
