// What a figure of the bench is, and when it is none.
#include "tools/measuring/measure.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace s7200::tools::measure_test {
namespace {

const std::atomic<bool> kGoesOn = false, kStopped = true;

TEST(Measure, AFigureThatIsStoppedIsNone) {
  EXPECT_EQ(measure_tip_like({kMillisecond, StopToken(kGoesOn)}, true).size(), 1U);
  EXPECT_TRUE(measure_tip_like({kMillisecond, StopToken(kStopped)}, true).empty());
  EXPECT_TRUE(measure_start("/bin/echo", {kMillisecond, StopToken(kStopped)}).empty());
}

TEST(Measure, ACommandThatPrintsNothingHasNoFirstOutput) {
  EXPECT_EQ(measure_start("/bin/echo", {kMillisecond, StopToken(kGoesOn)}).size(), 1U);
  EXPECT_THROW(measure_start("/bin/true", {kMillisecond, StopToken(kGoesOn)}), std::runtime_error);
}

}  // namespace
}  // namespace s7200::tools::measure_test
