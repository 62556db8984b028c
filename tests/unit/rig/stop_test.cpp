// What runs ends when whoever has started it asks, and nobody else's run does.
#include <gtest/gtest.h>

#include <atomic>
#include <string_view>
#include <thread>

#include "interpreter/analysis/warnings/check.hpp"
#include "tools/rig/files/recorded_rig.hpp"
#include "tools/rig/run.hpp"

namespace s7200::tools::stop_test {
namespace {

std::unique_ptr<Rig> rig_with(StopToken stop) {
  const auto program = check_text("LD SM0.0\nINCW VW0\nMEND\n", "counts.stl", cpu214(), default_times(cpu214())).program;
  std::vector<std::string> problems;
  const SystemPlan plan = plan_of(program);
  auto rig = RecordedRig::assemble(plan, {.seen = {.spots = spots_of_plcs(plan)}, .stop = stop}, problems);
  rig->power_up();
  return rig;
}

TEST(Stop, TwoSessionsOnTwoThreadsStopApart) {
  constexpr Time kEnd = 100 * kSecond;
  std::atomic<bool> first_asked = false, second_asked = false;
  const auto first = rig_with(StopToken(first_asked)), second = rig_with(StopToken(second_asked));
  std::string_view first_reason, second_reason;
  {
    const std::jthread endless([&] { first_reason = run(first->simulation(), {.end = kNever}, [] { return true; }); });
    second_reason = run(second->simulation(), {.end = kEnd}, [] { return true; });
    first_asked = true;
  }
  EXPECT_EQ(first_reason, "interrupted");
  EXPECT_EQ(second_reason, "time");
  EXPECT_EQ(second->simulation().time(), kEnd);
}

TEST(Stop, ThatIsAskedForBeforehandLeavesNothingToRun) {
  const std::atomic<bool> asked = true;
  const auto rig = rig_with(StopToken(asked));
  EXPECT_EQ(run(rig->simulation(), {.end = kSecond}, [] { return true; }), "interrupted");
  EXPECT_LT(rig->simulation().time(), kSecond);
}

}  // namespace
}  // namespace s7200::tools::stop_test
