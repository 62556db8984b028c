// What `s7200 compare` finds different in what two programs do.
#include "tools/compare/behaviour.hpp"

#include <fmt/format.h>

#include <utility>

#include "tests/support/inspected.hpp"

namespace s7200::tools::behaviour_test {
namespace {

using test::inspected;
using End = BehaviourResult::End;

const std::string kTimer = "LD I0.0\nTON T37, 5\nLD T37\nA I0.1\n= Q0.0\nMEND\n";
const std::string kEcho =
    "LD SM0.1\nMOVB 9, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\nINT 0\nMOVB SMB2, VB1\nXMT VB0, 0\nRETI\n";

struct Behaviours {
  Behaviours(std::string_view old_text, std::string_view new_text,
             BehaviourSettings settings = {.runs = 3000, .seconds = 60})
      : older(inspected(old_text, {}, *find_cpu("214"))),
        newer(inspected(new_text, {}, *find_cpu("214"))),
        result(compare_behaviour(older, newer, settings)) {}
  Inspection older, newer;
  BehaviourResult result;

  std::string scenario() const {
    return difference_scenario(older, newer, result, "difference.yaml", {.program = "old.stl"}).value_or("");
  }
};

std::string with_change(std::string text, std::string_view what, std::string_view by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(Behaviour, OneMoreTickOfATimerIsFoundWithTheShortestInputs) {
  const Behaviours both(kTimer, with_change(kTimer, "T37, 5", "T37, 6"));
  ASSERT_TRUE(both.result.difference);
  EXPECT_EQ(both.result.difference->what, "Q0.0");
  EXPECT_EQ(both.result.difference->older, "1");
  EXPECT_EQ(both.result.difference->newer, "0");
  EXPECT_LE(both.result.difference->trial.size(), 2U);
  EXPECT_EQ(both.result.difference->older_op, 4U);
  EXPECT_EQ(both.result.difference->newer_op, 4U);
}

TEST(Behaviour, TheScenarioOfADifferenceIsKnownToPassWithTheOldProgramOnly) {
  const Behaviours both(kTimer, with_change(kTimer, "A I0.1", "AN I0.1"));
  ASSERT_TRUE(both.result.difference);
  const std::string scenario = both.scenario();
  ASSERT_FALSE(scenario.empty());
  EXPECT_TRUE(findings_of(scenario, "difference.yaml", both.older.program)->empty());
  EXPECT_FALSE(findings_of(scenario, "difference.yaml", both.newer.program)->empty());
}

TEST(Behaviour, ACounterGetsAsManyEdgesAsItsPresetAsks) {
  const std::string counts = "LD I0.4\nLD I0.5\nCTU C1, 12\nLD C1\nA I0.0\n= Q0.0\nMEND\n";
  const Behaviours both(counts, with_change(counts, "C1, 12", "C1, 13"));
  ASSERT_TRUE(both.result.difference);
  EXPECT_EQ(both.result.difference->what, "Q0.0");
}

TEST(Behaviour, ACounterThatCountsFarGetsThereToo) {
  const std::string counts = "LD I0.4\nLD I0.5\nCTU C1, 500\nLD C1\n= Q0.0\nMEND\n";
  const Behaviours both(counts, with_change(counts, "C1, 500", "C1, 501"));
  ASSERT_TRUE(both.result.difference);
  EXPECT_EQ(both.result.difference->what, "Q0.0");
  EXPECT_TRUE(both.result.beyond.empty());
}

TEST(Behaviour, ACounterThatCountsFartherThanEdgesComeIsSaidToBeOne) {
  const std::string counts = "LD I0.4\nLD I0.5\nCTU C1, 20000\nLD C1\n= Q0.0\nMEND\n";
  const Behaviours both(counts, with_change(counts, "C1, 20000", "C1, 30000"), {.runs = 20});
  EXPECT_FALSE(both.result.difference);
  EXPECT_EQ(both.result.beyond, (std::vector<std::uint32_t>{20000, 30000}));
  EXPECT_NE(
      behaviour_text(both.older, both.newer, both.result)
          .find("  not counted to the end: counters with presets of 20000 and 30000; no input gets more than 6000 edges "
                "running\n"),
      std::string::npos);
}

TEST(Behaviour, MemoryThatOnlyAPointerReadsIsSetToo) {
  const std::string points =
      "LD SM0.1\nMOVD &VB100, VD50\nLD SM0.0\nMOVW *VD50, VW60\nLDW>= VW60, 50\nA V200.0\n= Q0.7\nMEND\n";
  for (const auto& [what, by] : {std::pair("&VB100", "&VB102"), std::pair("VW60, 50", "VW60, 51")}) {
    const Behaviours both(points, with_change(points, what, by));
    ASSERT_TRUE(both.result.difference) << by;
    EXPECT_EQ(both.result.difference->what, "Q0.7");
  }
}

TEST(Behaviour, TheBoundaryOfAComparisonIsTriedThroughSumsAndDifferences) {
  for (const std::string_view works_out : {"MOVW VW10, AC0\n+I 5, AC0\n", "MOVW 300, AC0\n-I VW10, AC0\n"}) {
    const std::string compares = fmt::format("LD SM0.0\n{}MOVW AC0, VW20\nLDW>= VW20, 12345\n= Q0.0\nMEND\n", works_out);
    const Behaviours both(compares, with_change(compares, "12345", "12344"));
    ASSERT_TRUE(both.result.difference) << works_out;
    EXPECT_EQ(both.result.difference->older, "0");
    EXPECT_EQ(both.result.difference->newer, "1");
  }
}

TEST(Behaviour, ProgramsThatDoTheSameInOtherWordsHaveAllContactsSeenAndNoDifference) {
  const Behaviours both("LD I0.0\nA I0.1\n= Q0.0\nMEND\n", "LDN I0.0\nON I0.1\nNOT\n= Q0.0\nMEND\n");
  EXPECT_FALSE(both.result.difference);
  EXPECT_EQ(both.result.end, End::AllContacts);
  EXPECT_EQ(both.result.both_ways[0], both.result.contacts[0]);
  EXPECT_EQ(both.result.contacts[1], 3U);
}

TEST(Behaviour, ALongerScanAloneIsNoDifference) {
  const std::string slow = with_change(kTimer, "MEND", "LD SM0.5\n= Q0.1\nLDN T38\nTON T38, 3\nLD T38\n= Q0.2\nMEND");
  const Behaviours both(slow, with_change(slow, "MEND", "LD SM0.0\nFILL 0, VW1000, 200\nFILL 0, VW1000, 200\nMEND"),
                        {.runs = 300, .seconds = 60});
  EXPECT_FALSE(both.result.difference) << behaviour_text(both.older, both.newer, both.result);
}

TEST(Behaviour, AnInputThatOnlyAFasterScanWouldSeeIsNotTried) {
  const std::string counts = "LD I0.0\nEU\nINCW VW0\nLDW>= VW0, 3\n= Q0.0\nMEND\n";
  std::string longer;
  for (int i = 0; i < 40; ++i) longer += "FILL 0, VW1000, 100\n";
  const Behaviours both(counts, with_change(counts, "MEND", "LD SM0.0\n" + longer + "MEND"), {.runs = 400, .seconds = 60});
  EXPECT_FALSE(both.result.difference) << behaviour_text(both.older, both.newer, both.result);
}

TEST(Behaviour, WhatIsSentIsComparedByItsCharacters) {
  const Behaviours both(kEcho, with_change(kEcho, "XMT", "LDB= VB1, 65\nMOVB 66, VB1\nLD SM0.0\nXMT"));
  ASSERT_TRUE(both.result.difference);
  EXPECT_EQ(both.result.difference->older, "41");
  EXPECT_EQ(both.result.difference->newer, "42");
  EXPECT_EQ(both.result.difference->trial.size(), 1U);
  EXPECT_NE(both.scenario().find("expect: 41"), std::string::npos) << behaviour_text(both.older, both.newer, both.result);
}

TEST(Behaviour, AConstantInAComparisonIsFoundThroughTheValuesOfTheProgram) {
  const std::string program = "LDW>= VW10, 1234\n= Q0.0\nMEND\n";
  const Behaviours both(program, with_change(program, "1234", "1235"));
  ASSERT_TRUE(both.result.difference);
  ASSERT_EQ(both.result.difference->trial.size(), 1U);
  EXPECT_EQ(both.result.difference->trial[0].bytes, (std::vector<std::uint8_t>{1234 >> 8, 1234 & 0xFF}));
}

TEST(Behaviour, AStopOfOneIsADifference) {
  const Behaviours both("LD I0.3\n= Q0.0\nMEND\n", "LD I0.3\n= Q0.0\nLD I0.5\nSTOP\nMEND\n");
  ASSERT_TRUE(both.result.difference);
  EXPECT_EQ(both.result.difference->newer, both.result.difference->what == "mode" ? "STOP" : "0");
}

TEST(Behaviour, MemoryIsComparedIfItIsAskedFor) {
  const std::string program = "LD I0.0\nMOVW 5, VW20\nMEND\n";
  const std::string other = with_change(program, "MOVW 5", "MOVW 6");
  EXPECT_FALSE(Behaviours(program, other, {.runs = 500, .seconds = 60}).result.difference);
  BehaviourSettings settings{.runs = 500, .seconds = 60};
  settings.watched.push_back(*parse_range("VW20", *find_cpu("214")));
  const Behaviours both(program, other, settings);
  ASSERT_TRUE(both.result.difference);
  EXPECT_EQ(both.result.difference->what, "VW20");
}

TEST(Behaviour, TheSameSeedFindsTheSame) {
  const std::string other = with_change(kTimer, "T37, 5", "T37, 6");
  const Behaviours once(kTimer, other), again(kTimer, other);
  EXPECT_EQ(once.scenario(), again.scenario());
  EXPECT_EQ(once.result.runs, again.result.runs);
}

}  // namespace
}  // namespace s7200::tools::behaviour_test
