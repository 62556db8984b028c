// Which shared words are a race, and which are none.
#include "interpreter/analysis/races.hpp"

#include <fmt/format.h>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/joined.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::races_test {
namespace {

/// `KIND MEMORY FIRST-LAST`, with ops of the main program counted from the one after ENI.
std::string races(std::string_view main, std::string_view interrupt, std::string_view subroutines = "") {
  const auto program = program_of(
      fmt::format("LD SM0.1\nATCH 0, 10\nENI\n{}MEND\n{}INT 0\n{}RETI\n", main, subroutines, interrupt), *find_cpu("224"));
  const Facts facts = facts_of(*program);
  return stl::joined(
      find_races(facts, calls_of(*program, facts.flow)),
      [](const Race& race) {
        constexpr std::array kKinds{"lost", "torn read", "torn write"};
        return fmt::format("{} {} {}-{}", kKinds[static_cast<std::size_t>(race.kind)], memory_text(race.bits),
                           race.first - 3, race.last - 3);
      },
      "; ");
}

constexpr std::string_view kCounts = "LD SM0.0\nINCW VW10\n";

TEST(Races, AWordThatIsReadAndWrittenBackLater) {
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\n", kCounts), "lost VW10 1-3");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, VW20\n+I 5, VW20\nLD I0.1\nMOVW VW20, VW10\n", kCounts), "lost VW10 1-4");
  EXPECT_EQ(races("LDW= VW10, 9\nMOVW 0, VW10\n", kCounts), "lost VW10 0-1") << "what the rung depends on";
}

TEST(Races, AccessesInOneInstructionAreNone) {
  EXPECT_EQ(races("LD I0.0\nINCW VW10\n", kCounts), "");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\nMOVW AC0, VW20\n", kCounts), "");
  EXPECT_EQ(races("LD I0.0\nMOVW 0, VW10\n", kCounts), "");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\n-I AC0, VW10\n", kCounts), "") << "takes away what it has read";
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\nMOVW 1, AC0\nMOVW AC0, VW10\n", kCounts), "") << "depends on it no more";
}

TEST(Races, DisiKeepsTheInterruptAway) {
  EXPECT_EQ(races("LD I0.0\nDISI\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\nENI\n", kCounts), "");
  EXPECT_EQ(races("LD I0.0\nDISI\nMOVW VW10, AC0\nENI\n+I 5, AC0\nMOVW AC0, VW10\n", kCounts), "lost VW10 2-5");
  EXPECT_EQ(races("LD I0.0\nDISI\nLD I0.1\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\nLD SM0.0\nENI\n", kCounts),
            "lost VW10 3-5")
      << "DISI has no power flow without I0.0";
  EXPECT_EQ(races("LD I0.0\nDISI\nLDN I0.1\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\nLD SM0.0\nENI\n", kCounts),
            "lost VW10 3-5");
  EXPECT_EQ(
      races("LD SM0.0\nDISI\nCALL 1\nENI\n", kCounts, "SBR 1\nLD I0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\nRET\n"),
      "");
}

TEST(Races, PointersLeadToThem) {
  EXPECT_EQ(races("LD I0.0\nMOVD &VB10, AC1\nMOVW *AC1, AC0\nINCW AC0\nMOVW AC0, *AC1\n", kCounts), "lost VW10 2-4");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n", "LD SM0.0\nMOVD &VB10, AC1\nINCW *AC1\n"),
            "lost VW10 1-3");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n", "LD SM0.0\nMOVD &VB20, AC1\nINCW *AC1\n"), "");
}

TEST(Races, PartsOfWhatTheInterruptAccessesAsAWhole) {
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, VW20\nMOVW VW12, VW22\n", "LD SM0.0\nINCD VD10\n"), "torn read VD10 1-2");
  EXPECT_EQ(races("LD I0.0\nMOVD VD10, VD20\n", "LD SM0.0\nINCD VD10\n"), "");
  EXPECT_EQ(races("LD I0.0\nMOVB VB30, VB10\nMOVB VB31, VB11\n", "LD SM0.0\nMOVW VW10, VW20\n"), "torn write VW10 1-2");
}

TEST(Races, BitsAndAccumulatorsAndBuffersAreNone) {
  EXPECT_EQ(races("LD M0.0\nR M0.0, 1\n", "LD SM0.0\nS M0.0, 1\n"), "") << "a handshake";
  EXPECT_EQ(
      races("LD I0.0\nMOVW VW30, AC0\nINCW AC0\nMOVW AC0, VW30\n", "LD SM0.0\nMOVW VW40, AC0\nINCW AC0\nMOVW AC0, VW40\n"),
      "");
  EXPECT_EQ(races("LDB= VB10, 0\nRCV VB10, 0\n", "LD SM0.0\nRCV VB10, 0\n"), "");
}

TEST(Races, SubroutinesOfBothSidesCount) {
  constexpr std::string_view kMain = "LD SM0.0\nCALL 1\n",
                             kRead = "SBR 1\nLD I0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\nRET\n";
  EXPECT_EQ(races(kMain, kCounts, kRead), "lost VW10 5-7");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n", "LD SM0.0\nCALL 2\n",
                  "SBR 2\nLD SM0.0\nINCW VW10\nRET\n"),
            "lost VW10 1-3");
}

}  // namespace
}  // namespace s7200::test::races_test
