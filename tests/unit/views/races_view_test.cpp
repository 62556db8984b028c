// What is said of races: also of what was not looked at.
#include "tools/views/inspection/races_view.hpp"

#include "tests/support/inspected.hpp"
#include "tools/views/inspection/shared_view.hpp"

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

constexpr std::string_view kSharing =
    "LD SM0.1\nATCH 0, 10\nENI\nLD SM0.0\nMOVW VW10, VW20\nMOVW VW30, VW32\nCALL 1\nMEND\nSBR 1\nLD SM0.0\nMOVW 0, VW10\nRET\n"
    "INT 0\nLD SM0.0\nINCW VW10\nMOVW VW40, VW42\nCALL 2\nRETI\nSBR 2\nLD SM0.0\nMOVB VB31, VB50\nRET\nINT 1\nLD SM0.0\n"
    "MOVW VW20, VW60\nRETI\n";

TEST(RacesView, WhatBothSidesUseIsListedWithWhoWritesIt) {
  EXPECT_EQ(shared_text(inspected(kSharing)),
            "VW10\n"
            "  MAIN        writes in test.stl:11; reads in test.stl:5\n"
            "  INT_0       writes in test.stl:15; reads in test.stl:15\n")
      << "VW30 is read on both sides, and INT 1 is not attached";
  EXPECT_EQ(shared_text(inspected(kSharing, {"VW20"})), "the main program and interrupt routines share no memory\n");
  const auto json = shared_json(inspected(kSharing, {"INT_0"}));
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["address"], "VW10");
  EXPECT_EQ(json[0]["sides"][1]["routine"], "INT_0");
  EXPECT_EQ(json[0]["sides"][1]["writes"][0]["line"], 15);
}

}  // namespace
}  // namespace s7200::tools::races_view_test
