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

constexpr std::string_view kTooLong =
    "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\nINT 0\nLD SM0.0\nFOR VW0, 1, 500\nINCW VW2\nNEXT\nRETI\n";

TEST(BoundsView, SaysHowMuchTimeInterruptsNeedThatLeaveNone) {
  const nlohmann::ordered_json json = bounds_json(inspected(kTooLong));
  const std::string reason = json["events"][0]["latency_reason"];
  EXPECT_TRUE(reason.starts_with("the interrupts that are served up to then can need ")) << reason;
  EXPECT_TRUE(reason.ends_with("those that find its queue full are lost")) << reason;
  EXPECT_TRUE(bounds_text(inspected(kTooLong)).find("when it begins has no bound: the interrupts that are") !=
              std::string::npos);
}

TEST(BoundsView, SaysWhyALoopHasNoBoundAndWhatToDo) {
  const Inspection open = inspected("LD SM0.0\nMOVW VW0, AC0\nFOR VW2, 1, AC0\nNEXT\nMEND\n");
  EXPECT_TRUE(bounds_text(open).find("nothing in front of it limits AC0, a copy of VW0 (test.stl:2); if") !=
              std::string::npos)
      << bounds_text(open);
  const std::string reason = bounds_json(open)["loops"][0]["reason"];
  EXPECT_TRUE(reason.starts_with("nothing in front of it limits AC0")) << reason;
}

TEST(BoundsView, SaysWhichLoopsWithoutABoundAWaitDependsOn) {
  const std::string text = bounds_text(inspected(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 5, SMB34\nATCH 0, 10\nATCH 1, 8\nENI\nMEND\nINT 0\nLD SM0.0\nFOR VW0, 1, AC0\n"
      "NEXT\nRETI\nINT 1\nRETI\n"));
  EXPECT_TRUE(text.find("and begins no bound; with one pass of the loop") != std::string::npos) << text;
  EXPECT_TRUE(text.find("come in it no\n  bound; with one pass of the loop in test.stl:10") != std::string::npos) << text;
}

TEST(BoundsView, WhereTheJsonHasNoTimeItHasTheReason) {
  const nlohmann::ordered_json
      good = bounds_json(inspected(kTimed)),
      late = bounds_json(inspected(
          "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nLD I0.0\nENI\nXMT VB0, 0\nMEND\nINT 0\nLD SM0.0\nS M0.0, 1\nRETI\n"));
  EXPECT_TRUE(good["reason"].is_null());
  EXPECT_TRUE(good["scan_with_interrupts_reason"].is_null());
  EXPECT_TRUE(good["events"][0]["latency_reason"].is_null());
  EXPECT_EQ(late["events"][0]["latency_reason"],
            "interrupts may come before the program executes ENI, and nothing says how long before");
  EXPECT_EQ(late["answers"][0]["reason"], late["events"][0]["latency_reason"]);
  EXPECT_EQ(bounds_json(with_slowest(kTimed, 3 * kMillisecond))["events"][0]["latency_reason"], nullptr);
  EXPECT_TRUE(bounds_json(with_slowest(kTimed, 3 * kMillisecond))["events"][0]["latency_slowest_reason"].is_string());
  const nlohmann::ordered_json inputs = bounds_json(inspected("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nRETI\n"));
  EXPECT_EQ(inputs["scan_with_interrupts_reason"], "how often event 0 comes is not known");
  Inspection wrong = inspected("LD I0.0\n= Q0.0\nMEND\n");
  wrong.has_errors = true;
  EXPECT_EQ(bounds_json(wrong)["reason"], "a program with errors has no times");
}

}  // namespace
}  // namespace s7200::tools::bounds_view_test
