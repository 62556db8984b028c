#include <gtest/gtest.h>

#include "interpreter/base/time.hpp"

namespace s7200::duration_test {
namespace {

TEST(Duration, ReadsEveryUnit) {
  EXPECT_EQ(parse_duration("100ns"), 100);
  EXPECT_EQ(parse_duration("40us"), 40 * kMicrosecond);
  EXPECT_EQ(parse_duration("250ms"), 250 * kMillisecond);
  EXPECT_EQ(parse_duration("2s"), 2 * kSecond);
  EXPECT_EQ(parse_duration("3min"), 180 * kSecond);
  EXPECT_EQ(parse_duration("1h"), 3600 * kSecond);
  EXPECT_EQ(parse_duration("0s"), 0);
}

TEST(Duration, ReadsDecimalsExactly) {
  EXPECT_EQ(parse_duration("1.5ms"), 1'500'000);
  EXPECT_EQ(parse_duration("0.000000001s"), 1);
  EXPECT_EQ(parse_duration("1.50000000000s"), 1'500'000'000);
  EXPECT_EQ(parse_duration("0.1h"), 360 * kSecond);
  EXPECT_EQ(parse_duration("9223372036.854775806s"), kNever - 1);
}

TEST(Duration, RefusesTextThatIsNotADuration) {
  for (const char* text :
       {"", "5", "ms", "-1s", "+1s", "1.s", ".5s", "1,5s", "1 s ", "1  s", "1S", "1d", "1e3s", "0x1s", "1s2"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
}

TEST(Duration, RefusesDurationsThatTimeCannotHold) {
  EXPECT_EQ(parse_duration("0.5ns"), std::nullopt);
  EXPECT_EQ(parse_duration("9223372036.854775807s"), std::nullopt);
  EXPECT_EQ(parse_duration("293000000h"), std::nullopt);
  EXPECT_EQ(parse_duration(std::string(10'000, '9') + "h"), std::nullopt);
}

TEST(Duration, FormatsInTheLargestUnitThatFits) {
  EXPECT_EQ(format_duration(0), "0 ns");
  EXPECT_EQ(format_duration(999), "999 ns");
  EXPECT_EQ(format_duration(40'000), "40 us");
  EXPECT_EQ(format_duration(690'123'000), "690.123 ms");
  EXPECT_EQ(format_duration(2 * kSecond), "2 s");
  EXPECT_EQ(format_duration(90 * kSecond), "90 s");
  EXPECT_EQ(format_duration(120 * kSecond), "2 min");
  EXPECT_EQ(format_duration(7200 * kSecond), "2 h");
  EXPECT_EQ(format_duration(-1'500'000), "-1.5 ms");
  EXPECT_EQ(format_duration(kNever), "never");
}

TEST(Duration, FormatsRoundedToTheDecimalsAskedFor) {
  EXPECT_EQ(format_duration(690'123'456), "690.123 ms");
  EXPECT_EQ(format_duration(690'123'500), "690.124 ms");
  EXPECT_EQ(format_duration(1'050'000), "1.05 ms");
  EXPECT_EQ(format_duration(690'123'456, 0), "690 ms");
  EXPECT_EQ(format_duration(690'123'456, 6), "690.123456 ms");
  EXPECT_EQ(format_duration(690'123'456, 9), "690.123456 ms");
  EXPECT_EQ(format_duration(1'234, 9), "1.234 us");
  EXPECT_EQ(format_duration(999'999'999), "1 s");
  EXPECT_EQ(format_duration(999'999), "999.999 us");
}

TEST(Duration, WhatIsFormattedReadsBack) {
  for (const Time time : {Time{1}, Time{1'001}, Time{123'456'789}, 61 * kSecond, 3600 * kSecond, kNever - 1}) {
    EXPECT_EQ(parse_duration(format_duration(time, 9)), time) << time;
  }
}

}  // namespace
}  // namespace s7200::duration_test
