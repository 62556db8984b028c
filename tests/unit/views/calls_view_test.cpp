// What `s7200 inspect PROGRAM calls` shows.
#include "tools/views/inspection/calls_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::calls_view_test {
namespace {

using test::inspected;

constexpr std::string_view kProgram =
    "LD SM0.1\nCALL 1\nATCH 0, 9\nATCH 1, 10\nENI\nMEND\n"
    "SBR 1\nLD I0.0\nCALL 2\nCALL 2\nDTCH 9\nRET\n"
    "SBR 2\nLD I0.1\n= Q0.0\nRET\n"
    "SBR 3\nLD I0.1\nCALL 4\nRET\n"
    "SBR 4\nLD I0.1\n= Q0.1\nRET\n"
    "INT 0\nLD I0.1\n= Q0.2\nRETI\nINT 1\nRETI\nINT 2\nLD I0.1\n= Q0.3\nRETI\n";

TEST(CallsView, ShowsTheTreeWithThePlacesAndTheDepth) {
  const std::string text = calls_text(inspected("LD I0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 2\nCALL 2\nRET\nSBR 2\nRET\n"));
  EXPECT_EQ(text,
            "MAIN\n"
            "  SBR_1                                 test.stl:2\n"
            "    SBR_2                               test.stl:6, test.stl:7\n"
            "Deepest nesting: 2 of 8 calls: MAIN > SBR_1 > SBR_2\n");
}

TEST(CallsView, ShowsEventsInTheOrderInWhichTheCpuServesThem) {
  const auto json = calls_json(inspected(kProgram, {}, *find_cpu("215")));
  ASSERT_EQ(json["events"].size(), 2U);
  EXPECT_EQ(json["events"][0]["event"], 9);
  EXPECT_EQ(json["events"][0]["cause"], "port 0: transmit complete");
  EXPECT_EQ(json["events"][0]["attached"][0]["to"], "INT_0");
  EXPECT_EQ(json["events"][0]["detached"][0]["instruction"], "DTCH 9");
  EXPECT_EQ(json["events"][1]["queue"], "timed");
}

TEST(CallsView, NamesWhatNothingStartsAndWhy) {
  const std::string text = calls_text(inspected(kProgram, {}, *find_cpu("215")));
  EXPECT_NE(text.find("  SBR_3, test.stl:17: no CALL calls it\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  SBR_4, test.stl:21: called only by SBR_3, never executed itself\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  INT_2, test.stl:31: no ATCH attaches it\n"), std::string::npos) << text;
}

TEST(CallsView, NamesRecursionOnceAndKnowsNoDepthThen) {
  const std::string text =
      calls_text(inspected("LD I0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 2\nRET\nSBR 2\nLD I0.0\nCALL 1\nRET\n"));
  EXPECT_NE(text.find("Recursion\n  SBR_1 > SBR_2 > SBR_1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Deepest nesting: unknown, there is recursion\n"), std::string::npos) << text;
}

TEST(CallsView, OfARoutineAlsoSaysWhoStartsIt) {
  const std::string text = calls_text(inspected(kProgram, {"SBR_2", "INT_1"}, *find_cpu("215")));
  EXPECT_NE(text.find("  called by SBR_1   1   test.stl:9              CALL 2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("event 10: timed interrupt 0, SMB34 (timed queue)\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("SBR_3"), std::string::npos) << text;
}

TEST(CallsView, SaysIfNothingEnablesInterrupts) {
  EXPECT_NE(calls_text(inspected("LD SM0.1\nATCH 0, 9\nMEND\nINT 0\nRETI\n")).find("No instruction enables interrupts"),
            std::string::npos);
}

}  // namespace
}  // namespace s7200::tools::calls_view_test
