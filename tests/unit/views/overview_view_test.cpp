// What `s7200 inspect PROGRAM` shows first.
#include "tools/views/inspection/overview_view.hpp"

#include <fmt/format.h>

#include "tests/support/inspected.hpp"

namespace s7200::tools::overview_view_test {
namespace {

using nlohmann::ordered_json;

TEST(OverviewView, CountsAndNamesWhatTheProgramIsMadeOf) {
  const auto json =
      overview_json(test::inspected("NETWORK 1\nLD I0.0\nTON T37, 10\nNETWORK 2\nLD T37\n= Q0.1\nXMT VB0, 0\nMEND\nNETWORK "
                                    "3\nSBR 1\nLD I0.1\n= M0.0\nRET\n"));
  EXPECT_EQ(json["instructions"], 10);
  EXPECT_EQ(json["networks"], 3);
  EXPECT_EQ(json["inputs"], ordered_json::parse(R"(["I0.0", "I0.1"])"));
  EXPECT_EQ(json["outputs"], ordered_json::parse(R"(["Q0.1"])"));
  EXPECT_EQ(json["timers"], ordered_json::parse(R"(["T37"])"));
  EXPECT_EQ(json["outside"], ordered_json::parse(R"(["XMT once"])"));
  EXPECT_EQ(json["never_executed"], ordered_json::parse(R"(["SBR_1"])"));
  EXPECT_EQ(json["never_read"], ordered_json::parse(R"(["M0.0"])"));
}

TEST(OverviewView, SaysWhatStartsEachRoutine) {
  const std::string text =
      overview_text(test::inspected("LD SM0.1\nATCH 0, 10\nENI\nMEND\nSBR 1\nLD I0.1\n= M0.0\nRET\nINT 0\nRETI\n"));
  EXPECT_NE(text.find("SBR_1                         4 instructions      never executed\n"), std::string::npos) << text;
  EXPECT_NE(text.find("event 10: timed interrupt 0, SMB34\n"), std::string::npos) << text;
}

TEST(OverviewView, SaysHowManyCallsWereNotFollowedForRaces) {
  const auto look = test::inspected(
      "LD SM0.1\nATCH 0, 10\nENI\nCALL 1\nLD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 1\nRET\nINT 0\nRETI\n");
  EXPECT_NE(overview_text(look).find("races: 1 call not followed: see the view races\n"), std::string::npos);
  EXPECT_EQ(overview_json(look)["races"], 0);
  EXPECT_EQ(overview_json(look)["races_not_followed"], 1);
}

TEST(OverviewView, NamesBitsThatAreOnlySetOrOnlyReset) {
  const auto look = [](std::string_view stl) { return overview_json(test::inspected(stl))["worth_a_look"]; };
  const auto latch = look("LD I0.0\nS M0.0, 1\nLD M0.0\n= Q0.0\nMEND\n");
  ASSERT_EQ(latch.size(), 1U);
  EXPECT_EQ(latch[0]["kind"], "never reset");
  EXPECT_EQ(latch[0]["text"], "M0.0 is set in test.stl:2, and no instruction resets it");
  EXPECT_EQ(latch[0]["places"][0]["line"], 2);
  EXPECT_EQ(look("LD I0.0\nR M0.0, 1\nLD M0.0\n= Q0.0\nMEND\n")[0]["kind"], "never set");
  for (const std::string_view other :
       {"R M0.0, 1\n", "R M0.0, 8\n", "MOVB 0, MB0\n", "= M0.0\n", "FILL 0, MW0, 2\n", "MOVD &MB0, AC1\nMOVB 0, *AC1\n"})
    EXPECT_EQ(look(fmt::format("LD I0.0\nS M0.0, 1\nLD M0.0\n= Q0.0\nLD I0.1\n{}MEND\n", other)).size(), 0U) << other;
  EXPECT_EQ(look("LD I0.0\nS M0.0, 1\nMEND\n").size(), 0U) << "nothing looks at it";
  EXPECT_EQ(look("LD I0.0\nR M0.0, 8\nMEND\n").size(), 0U);
}

TEST(OverviewView, NamesOutputsThatAreWrittenInSeveralPlacesAndRungsThatAreOff) {
  const auto look = [](std::string_view stl) {
    std::vector<std::string> texts;
    const ordered_json json = overview_json(test::inspected(stl));
    for (const ordered_json& remark : json["worth_a_look"]) texts.push_back(remark["text"]);
    return texts;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(look("LD I0.0\n= Q0.1\nLD I0.1\nCALL 0\nMEND\nSBR 0\nLD I0.2\n= Q0.1\nRET\n"),
            Texts{"Q0.1 is a coil in test.stl:2 in every scan, and in test.stl:8 at times"});
  EXPECT_EQ(look("LD I0.0\n= Q0.1\nLD I0.1\nMOVB VB1, QB0\nMEND\n"),
            Texts{"Q0.1 is a coil in test.stl:2, and MOVB VB1, QB0 in test.stl:4 writes over it at times"});
  EXPECT_EQ(look("LDN SM0.0\n= Q0.4\nMEND\n"), Texts{"LDN SM0.0 in test.stl:1 switches = Q0.4 off"});
  for (const std::string_view other :
       {"LD I0.0\n= Q0.1\nLD I0.1\nMOVB 0, QB0\nMEND\n", "LD I0.0\n= Q0.1\nLD SM0.1\nMOVB VB1, QB0\nMEND\n",
        "LD I0.1\nMOVB VB1, QB0\nLD I0.0\n= Q0.1\nMEND\n", "LD I0.0\n= Q0.1\nLD I0.1\nMOVB VB1, QB1\nMEND\n",
        "LD I0.0\nCALL 0\nLDN I0.0\nCALL 1\nMEND\nSBR 0\nLD I0.2\n= Q0.1\nRET\nSBR 1\nLD I0.3\n= Q0.1\nRET\n",
        "LD I0.0\nLDN SM0.0\nCTU C0, 5\nLD C0\n= Q0.0\nMEND\n"})
    EXPECT_EQ(look(other), Texts{}) << other;
}

TEST(OverviewView, AnInputOfAnEventIsAnInput) {
  const auto json = overview_json(
      test::inspected("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n"));
  EXPECT_EQ(json["inputs"], ordered_json::parse(R"(["I0.0"])"));
}

}  // namespace
}  // namespace s7200::tools::overview_view_test
