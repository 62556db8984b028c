// What is said of races: also of what was not looked at.
#include "tools/views/inspection/races_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::races_view_test {
namespace {

using test::inspected;

constexpr std::string_view kCallsItself =
    "NETWORK 1\nLD SM0.1\nATCH 0, 10\nENI\nLD SM0.0\nCALL 1\nMEND\nNETWORK 2\nSBR 1\nLD I0.0\nCALL 1\nRET\n"
    "NETWORK 3\nSBR 2\nLD SM0.0\nCALL 3\nRET\nNETWORK 4\nSBR 3\nRET\nNETWORK 5\nINT 0\nLD SM0.0\nCALL 2\nRETI\n";

TEST(RacesView, SaysWhichCallsWereNotFollowedWhereAndWhy) {
  const std::string text = races_text(inspected(kCallsItself));
  EXPECT_EQ(text,
            "not looked at: SBR_1, called in SBR_1, network 2, test.stl:11 (CALL 1, from MAIN): the CPU nests 8\n"
            "  calls; one more is run-time error 0008, and calls nothing\n"
            "not looked at: SBR_3, called in SBR_2, network 3, test.stl:16 (CALL 3, from INT_0): the CPU nests 1\n"
            "  call in an interrupt routine; one more is run-time error 0008, and calls nothing\n"
            "no races found in the rest\n");
  EXPECT_EQ(races_text(inspected("LD SM0.1\nATCH 0, 10\nENI\nMEND\nINT 0\nRETI\n")), "no races found\n");
}

TEST(RacesView, JsonHasTheCallsThatWereNotFollowed) {
  const auto json = not_followed_json(inspected(kCallsItself));
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["call"]["line"], 11);
  EXPECT_EQ(json[0]["called"], "SBR_1");
  EXPECT_EQ(json[0]["from"], "MAIN");
  EXPECT_EQ(json[1]["from"], "INT_0");
  EXPECT_EQ(json[1]["why"],
            "the CPU nests 1 call in an interrupt routine; one more is run-time error 0008, and calls nothing");
  EXPECT_EQ(not_followed_json(inspected(kCallsItself, {"SBR_2"})).size(), 1U);
}

}  // namespace
}  // namespace s7200::tools::races_view_test
