// What is said where a time has no bound.
#include "tools/views/inspection/bounds_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::bounds_view_test {
namespace {

using test::inspected;

constexpr std::string_view kTimed =
    "LD SM0.1\nMOVB 5, SMB34\nMOVB 5, SMB35\nATCH 0, 10\nATCH 0, 11\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n";

/// With times that each instruction of the slowest CPU takes.
Inspection with_slowest(std::string_view stl, Time each) {
  Inspection made = inspected(stl);
  made.slowest = [program = made.program, each] {
    auto slow = std::make_shared<Program>(*program);
    for (Op& op : slow->ops) op.cost = static_cast<std::int32_t>(each);
    return slow;
  };
  return made;
}

TEST(BoundsView, SaysThatTheSlowestTimesHaveNoBound) {
  const std::string text = bounds_text(with_slowest(kTimed, 3 * kMillisecond));
  EXPECT_TRUE(text.find("0.092 ms (no bound with the slowest times)") != std::string::npos) << text;
  EXPECT_TRUE(text.find("(0.000 ms)") == std::string::npos) << text;
}

TEST(BoundsView, SaysThatInterruptsMayStayDisabled) {
  const std::string text =
      bounds_text(inspected("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD I0.0\nDISI\nLD I0.1\nENI\n"
                            "MEND\nINT 0\nRETI\n"));
  EXPECT_TRUE(text.find("with interrupts it has no bound: they may") != std::string::npos) << text;
}

}  // namespace
}  // namespace s7200::tools::bounds_view_test
