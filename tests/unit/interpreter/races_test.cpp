// Which shared words are a race, and which are none.
#include "interpreter/analysis/races.hpp"

#include <fmt/format.h>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/selection.hpp"
#include "interpreter/base/text/joined.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::races_test {
namespace {

/// `KIND MEMORY FIRST-LAST`, with `?` if only a run can tell, with ops of the main program counted from the one after ENI.
std::string races_in(const std::string& stl) {
  const auto program = program_of(stl, *find_cpu("224"));
  const Facts facts = facts_of(*program);
  return stl::joined(
      find_races(facts, calls_of(*program, facts.flow)).races,
      [](const Race& race) {
        constexpr std::array kKinds{"lost", "overwritten", "scratch", "torn read", "torn write", "mixed"};
        return fmt::format("{}{} {} {}-{}", kKinds[static_cast<std::size_t>(race.kind)], race.suspected ? "?" : "",
                           memory_text(race.bits), race.first - 3, race.last - 3);
      },
      "; ");
}

std::string races(std::string_view main, std::string_view interrupt, std::string_view subroutines = "") {
  return races_in(fmt::format("LD SM0.1\nATCH 0, 10\nENI\n{}MEND\n{}INT 0\n{}RETI\n", main, subroutines, interrupt));
}

/// The same with blocks: subroutine 0 is `Work`, with a parameter `x`. Its main program calls it.
std::string races_with_parameter(std::string_view main, std::string_view interrupt, std::string_view section,
                                 std::string_view work) {
  return races_in(
      fmt::format("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.1\nATCH 0, 10\nENI\n{}END_ORGANIZATION_BLOCK\n"
                  "SUBROUTINE_BLOCK Work:SBR0\n{}\n x : INT;\nEND_VAR\nBEGIN\nNETWORK 1\n{}END_SUBROUTINE_BLOCK\n"
                  "INTERRUPT_BLOCK Comes:INT0\nBEGIN\nNETWORK 1\n{}END_INTERRUPT_BLOCK\n",
                  main, section, work, interrupt));
}

constexpr std::string_view kCounts = "LD SM0.0\nINCW VW10\n";

TEST(Races, AWordThatIsReadAndWrittenBackLater) {
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\n", kCounts), "lost VW10 1-3");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, VW20\n+I 5, VW20\nLD I0.1\nMOVW VW20, VW10\n", kCounts), "lost VW10 1-4");
  EXPECT_EQ(races("LDW= VW10, 9\nMOVW 0, VW10\n", kCounts), "lost? VW10 0-1") << "what the rung depends on";
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

TEST(Races, DisiInASubroutineKeepsTheInterruptAwayIfTheSubroutineIsSurelyCalled) {
  constexpr std::string_view kUpdate = "LD SM0.0\nMOVW VW10, AC0\n+I 3, AC0\nMOVW AC0, VW10\n";
  const auto after = [&](std::string_view call, std::string_view subroutines) {
    return races(std::string(call) + std::string(kUpdate), kCounts, subroutines);
  };
  for (const std::string_view away : {"DISI", "DTCH 10"}) {
    const std::string one = fmt::format("SBR 1\nLD SM0.0\n{}\nRET\n", away);
    EXPECT_EQ(after("LD SM0.0\nCALL 1\n", one), "") << away;
    EXPECT_EQ(after("LD I0.0\nCALL 1\n", one), "lost VW10 3-5") << away;
    EXPECT_EQ(after("LD SM0.0\nCALL 2\n", one + "SBR 2\nLD I0.0\nCALL 1\nRET\n"), "lost VW10 3-5") << away;
    EXPECT_EQ(after("LD SM0.0\nCALL 2\n", one + "SBR 2\nLD I0.0\nCRET\nLD SM0.0\nCALL 1\nRET\n"), "lost VW10 3-5") << away;
    EXPECT_EQ(after("LD SM0.0\nCALL 2\n", one + "SBR 2\nLD SM0.0\nCALL 1\nRET\n"), "") << away;
  }
  EXPECT_EQ(
      races("LD I0.0\nCALL 1\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\nENI\n", kCounts, "SBR 1\nLD SM0.0\nDISI\nRET\n"), "")
      << "in the rung of the CALL";
}

TEST(Races, DisiInAForThatMayRunNoPassIsNotSure) {
  constexpr std::string_view kUpdate = "LD SM0.0\nMOVW VW10, AC0\n+I 3, AC0\nMOVW AC0, VW10\n";
  for (const std::string_view away : {"DISI", "DTCH 10"}) {
    const auto after = [&](std::string_view condition, std::string_view passes) {
      return races(fmt::format("{}\nFOR VW0, {}\nLD SM0.0\n{}\nNEXT\n{}", condition, passes, away, kUpdate), kCounts);
    };
    EXPECT_EQ(after("LD SM0.0", "1, VW2"), "lost VW10 6-8") << away;
    EXPECT_EQ(after("LD SM0.0", "1, 0"), "lost VW10 6-8") << away;
    EXPECT_EQ(after("LD I0.0", "1, 3"), "lost VW10 6-8") << away;
    EXPECT_EQ(after("LD SM0.0", "1, 3"), "") << away;
    EXPECT_EQ(after("LD SM0.0", "3, 3"), "") << away;
  }
  EXPECT_EQ(races(fmt::format("LD SM0.0\nFOR VW0, 1, VW2\nLD SM0.0\nDISI\n{}ENI\nNEXT\n", kUpdate), kCounts), "")
      << "in the same pass";
}

TEST(Races, EniInAPassOfAForComesInFrontOfTheNextPass) {
  const auto in_pass = [](std::string_view end, std::string_view passes) {
    return races(fmt::format("LD SM0.0\nDISI\nFOR VW0, {}\nLD SM0.0\nMOVW VW10, AC0\n+I 3, AC0\nMOVW AC0, VW10\n{}\nNEXT\n"
                             "LD SM0.0\nENI\n",
                             passes, end),
                 kCounts);
  };
  EXPECT_EQ(in_pass("ENI", "1, 3"), "lost VW10 4-6");
  EXPECT_EQ(in_pass("ENI\nDISI", "1, 3"), "");
  EXPECT_EQ(in_pass("ENI\nLD I0.0\nDISI", "1, 3"), "lost VW10 4-6");
  EXPECT_EQ(in_pass("INCW VW2", "1, 3"), "");
  EXPECT_EQ(
      races("LD SM0.0\nDISI\nLBL 1\nLD SM0.0\nMOVW VW10, AC0\n+I 3, AC0\nMOVW AC0, VW10\nENI\nLD I0.0\nJMP 1\n", kCounts),
      "lost VW10 4-6")
      << "a jump back";
}

TEST(Races, DisiInASegmentHoldsWhileTheSegmentIsActive) {
  constexpr std::string_view kUpdate = "LD SM0.0\nMOVW VW10, AC0\n+I 3, AC0\nMOVW AC0, VW10\n";
  EXPECT_EQ(races(fmt::format("LSCR S0.1\nLD SM0.0\nDISI\nSCRE\n{}", kUpdate), kCounts), "lost VW10 5-7");
  EXPECT_EQ(races(fmt::format("LD SM0.0\nDISI\nLSCR S0.1\nLD SM0.0\nENI\nSCRE\n{}", kUpdate), kCounts), "lost VW10 7-9");
  EXPECT_EQ(races(fmt::format("LD SM0.0\nDISI\nLSCR S0.1\nLD SM0.0\nINCW VW2\nSCRE\n{}", kUpdate), kCounts), "");
  EXPECT_EQ(races(fmt::format("LSCR S0.1\nLD SM0.0\nDISI\n{}LD SM0.0\nENI\nSCRE\n", kUpdate), kCounts), "");
  EXPECT_EQ(races(fmt::format("LSCR S0.1\nLD I0.0\nDISI\n{}SCRE\n", kUpdate), kCounts), "lost VW10 4-6");
  EXPECT_EQ(races(fmt::format("LSCR S0.1\nLD SM0.0\nDISI\nSCRE\nLSCR S0.2\n{}SCRE\n", kUpdate), kCounts), "lost VW10 6-8");
}

TEST(Races, ARungThatBeginsBehindDisiHasPowerFlowWithoutIt) {
  EXPECT_EQ(races("LD I0.0\nDISI\nLDW= VW10, 9\nMOVW 0, VW10\n", kCounts), "lost? VW10 2-3");
  EXPECT_EQ(races("LD I0.0\nDISI\nAW= VW10, 9\nMOVW 0, VW10\n", kCounts), "");
  EXPECT_EQ(races("LD I0.0\nJMP 1\nLD SM0.0\nDISI\nLBL 1\nLD SM0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n", kCounts),
            "lost VW10 6-8")
      << "jumped over";
}

TEST(Races, ASubroutineThatHandsSomethingBackDoesNotEndWhatDisiCovers) {
  constexpr std::string_view kUpdate = "DISI\nCALL Work, VW50\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\nENI\n";
  const auto of = [&](std::string_view condition, std::string_view update) {
    return races_with_parameter(std::string(condition) + std::string(update), kCounts, "VAR_OUTPUT",
                                "LD SM0.0\nMOVW 1, #x\n");
  };
  EXPECT_EQ(of("LD I0.0\n", kUpdate), "");
  EXPECT_EQ(of("LD I0.0\nEND\nLD SM0.0\n", kUpdate), "");
  EXPECT_EQ(of("LD I0.0\n", kUpdate.substr(5)), "lost VW10 2-4");
}

TEST(Races, AParameterThatAPointerLeadsToIsAnyOfItsPlaces) {
  constexpr std::string_view kPointer = "LD I0.1\nMOVD &VB10, AC1\nLDN I0.1\nMOVD &VB20, AC1\nLD SM0.0\n";
  const auto of = [&](std::string_view interrupt) {
    return races_with_parameter(std::string(kPointer) + "CALL Work, *AC1\n", interrupt, "VAR_IN_OUT", "LD SM0.0\nINCW #x\n");
  };
  EXPECT_EQ(of(kCounts).substr(0, 10), "lost? VW10");
  EXPECT_EQ(of("LD SM0.0\nINCW VW20\n").substr(0, 10), "lost? VW20");
  EXPECT_EQ(of("LD SM0.0\nINCW VW30\n"), "");
  constexpr std::string_view kUpdate = "LD I0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n",
                             kIncrement = "LD SM0.0\nINCW #x\n";
  EXPECT_EQ(races_with_parameter(kUpdate, "LD SM0.0\nMOVD &VB10, AC1\nCALL Work, *AC1\n", "VAR_IN_OUT", kIncrement),
            "lost VW10 1-3");
  EXPECT_EQ(races_with_parameter(kUpdate, "LD SM0.0\nMOVD VD100, AC1\nCALL Work, *AC1\n", "VAR_IN_OUT", kIncrement), "")
      << "it may lead anywhere";
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

TEST(Races, AValueOfTwoWordsThatTheInterruptWritesTogether) {
  constexpr std::string_view kPair = "LD SM0.0\nMOVW VW30, VW10\nMOVW VW32, VW14\n";
  constexpr std::string_view kMixes = "MOVW VW10, AC0\n-I VW14, AC0\nMOVW AC0, VW20\n";
  const auto main = [](std::string_view lines) { return fmt::format("LD I0.0\n{}", lines); };
  EXPECT_EQ(races(main(kMixes), kPair), "mixed? VW10 1-2");
  EXPECT_EQ(races(main("MOVW VW10, AC0\nMOVW VW14, AC1\nINCW AC1\n*I AC1, AC0\n"), kPair), "mixed? VW10 1-2");
  EXPECT_EQ(races(main("MOVW VW10, VW20\nMOVW VW14, VW22\nMOVD VD20, VD40\n"), kPair), "mixed? VW10 1-2")
      << "a double word made of both";
  EXPECT_EQ(races(main("MOVW VW10, VW20\nMOVW VW14, VW22\n"), kPair), "") << "each for itself";
  EXPECT_EQ(races(main("MOVW VW10, AC0\nMOVW 0, AC0\n-I VW14, AC0\n"), kPair), "") << "the first is no longer used";
  EXPECT_EQ(races(main("MOVD VD10, AC0\nMOVW VW14, AC0\n+I 1, AC0\n"), "LD SM0.0\nINCD VD10\nINCW VW14\n"), "")
      << "written over in the lower half";
  EXPECT_EQ(races(main(fmt::format("DISI\n{}ENI\n", kMixes)), kPair), "");
  EXPECT_EQ(races(main(kMixes), "LD SM0.0\nMOVW VW30, VW10\nLD I0.1\nMOVW VW32, VW14\n"), "") << "one without the other";
  EXPECT_EQ(races(main(kMixes), "LD SM0.0\nMOVW VW30, VW10\nLD SM0.0\nMOVW VW32, VW14\n"), "mixed? VW10 1-2");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, AC0\nLD I0.1\n-I VW14, AC0\n", kPair), "") << "in other rungs";
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

TEST(Races, ABitThatACoilWritesBack) {
  EXPECT_EQ(races("LD M1.0\nAN I0.1\n= M1.0\n", "LD SM0.0\nR M1.0, 1\n"), "lost M1.0 0-2");
  EXPECT_EQ(races("LD I0.0\nO M1.0\nAN I0.1\n= M1.0\n", "LD SM0.0\nS M1.0, 1\n"), "lost M1.0 1-3");
  EXPECT_EQ(races("LD M1.0\n= M2.0\nLD M2.0\n= M1.0\n", "LD SM0.0\nR M1.0, 1\n"), "lost M1.0 0-3")
      << "by way of another bit";
  EXPECT_EQ(races("LD M1.0\nLD I0.0\nALD\n= M1.0\n", "LD SM0.0\nR M1.0, 1\n"), "lost M1.0 0-3");
  EXPECT_EQ(races("LD M1.0\n= Q0.0\nLD I0.0\n= M1.0\n", "LD SM0.0\nR M1.0, 1\n"), "") << "does not depend on it";
  EXPECT_EQ(races("LD I0.0\nS M1.0, 1\nLD I0.1\nR M1.0, 1\n", "LD SM0.0\n= M1.3\n"), "") << "another bit of the byte";
}

TEST(Races, WhatIsReadAndWrittenOver) {
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, VW20\nMOVW 0, VW10\n", kCounts), "overwritten? VW10 1-2");
  EXPECT_EQ(races("LD I0.0\n+I VW10, VW20\nMOVW 0, VW10\n", kCounts), "overwritten? VW10 1-2");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, VW20\nFILL 0, VW10, 4\n", kCounts), "overwritten? VW10 1-2");
  EXPECT_EQ(races("LD I0.0\nMOVW VW10, VW20\nLD I0.1\nMOVW 0, VW10\n", kCounts), "") << "reset for another reason";
  EXPECT_EQ(races("LD I0.0\nMOVW 0, VW10\nMOVW VW10, VW20\n", kCounts), "") << "read afterwards";
  EXPECT_EQ(races("LDW> VW10, 5\n= Q0.0\nLD SM0.0\nMOVW 0, VW10\n", kCounts), "") << "nothing keeps the value";
}

TEST(Races, ScratchMemoryOfBothSides) {
  constexpr std::string_view kWrites = "LD SM0.0\nMOVW 0, VW50\n";
  EXPECT_EQ(races("LD SM0.0\nMOVW VW10, VW50\n+I 2, VW50\nMOVW VW50, VW20\n", kWrites), "scratch? VW50 1-3");
  EXPECT_EQ(races("LD SM0.0\nMOVW 0, VW50\nLDW= VW50, 1\n= Q0.0\n", "LD SM0.0\nMOVW 1, VW50\n"), "")
      << "a sign to the other";
  EXPECT_EQ(races("LD SM0.0\nMOVW VW50, VW22\nMOVW VW10, VW50\n+I 2, VW50\nMOVW VW50, VW20\n", kWrites),
            "overwritten? VW50 1-2")
      << "what the interrupt wrote is looked at";
  EXPECT_EQ(
      races("LD SM0.0\nMOVD &VB500, VD60\n+D 4, VD60\nMOVW *VD60, VW20\n", "LD SM0.0\nMOVD &VB600, VD60\nMOVW 7, *VD60\n"),
      "scratch? VD60 1-3");
}

TEST(Races, TheIndexOfALoopThatTheInterruptWrites) {
  constexpr std::string_view kLoop = "LD SM0.0\nMOVW 0, VW30\nFOR VW100, 1, 50\nINCW VW30\nNEXT\n";
  EXPECT_EQ(races(kLoop, "LD SM0.0\nMOVW 40, VW100\n"), "scratch VW100 2-4");
  EXPECT_EQ(races(kLoop, "LD SM0.0\nFOR VW100, 1, 3\nINCW VW32\nNEXT\n"), "scratch VW100 2-4");
  EXPECT_EQ(races(kLoop, "LD SM0.0\nFOR VW102, 1, 3\nINCW VW32\nNEXT\n"), "");
  EXPECT_EQ(races(kLoop, "LD SM0.0\nMOVW VW100, VW40\n"), "") << "it only reads the index";
  EXPECT_EQ(races("LD SM0.0\nDISI\n" + std::string(kLoop) + "LD SM0.0\nENI\n", "LD SM0.0\nMOVW 40, VW100\n"), "");
  EXPECT_EQ(races("LD SM0.0\nCALL 1\n", "LD SM0.0\nMOVW 40, VW100\n", "SBR 1\n" + std::string(kLoop) + "RET\n"),
            "scratch VW100 6-8");
}

TEST(Races, TheCountOfALoopThatAJumpCloses) {
  constexpr std::string_view kLoop = "LD SM0.0\nMOVW 50, VW100\nLBL 1\nLD SM0.0\nDECW VW100\nLDN SM1.0\nJMP 1\n";
  EXPECT_EQ(races(kLoop, "LD SM0.0\nMOVW 40, VW100\n"), "scratch? VW100 1-6");
  EXPECT_EQ(races(kLoop, "LD SM0.0\nINCW VW102\n"), "");
  EXPECT_EQ(races("LBL 1\nLD SM0.0\nINCW VW100\nLDN SM1.0\nJMP 1\n", kCounts), "") << "nothing is put there first";
}

TEST(Races, PointersThatMove) {
  constexpr std::string_view kLoop =
      "LD SM0.0\nMOVD &VB100, AC1\nFOR VW0, 1, 5\nLD SM0.0\nMOVW *AC1, AC0\nINCW AC0\nMOVW AC0, *AC1\n+D 2, AC1\nNEXT\n";
  EXPECT_EQ(races(kLoop, "LD SM0.0\nINCW VW106\n"), "lost? VW106 4-6");
  EXPECT_EQ(races(kLoop, "LD SM0.0\nINCW VW110\n"), "") << "the last is VW108";
  EXPECT_EQ(races("LD SM0.0\nMOVD &VB100, AC1\n+D VD20, AC1\nMOVW *AC1, AC0\nINCW AC0\nMOVW AC0, *AC1\n",
                  "LD SM0.0\nINCW VW100\n"),
            "lost? VW100 3-5")
      << "an index that is not known";
}

TEST(Races, ReadInOneRoutineAndWrittenInAnother) {
  constexpr std::string_view kReads = "SBR 1\nLD SM0.0\nMOVW VW10, AC0\nRET\n",
                             kWrites = "SBR 2\nLD SM0.0\n+I 2, AC0\nMOVW AC0, VW10\nRET\n";
  const std::string both = std::string(kReads) + std::string(kWrites);
  EXPECT_EQ(races("LD SM0.0\nCALL 1\n+I 2, AC0\nMOVW AC0, VW10\n", kCounts, kReads), "lost VW10 7-3");
  EXPECT_EQ(races("LD SM0.0\nMOVW VW10, AC0\nCALL 2\n", kCounts, kWrites), "lost VW10 1-7");
  EXPECT_EQ(races("LD SM0.0\nCALL 1\nCALL 2\n", kCounts, both), "lost VW10 6-11");
  EXPECT_EQ(races("LD SM0.0\nDISI\nCALL 1\nCALL 2\nENI\n", kCounts, both), "");
}

TEST(Races, ABlockOfAnyConstantLengthIsWrittenByTheInterrupt) {
  constexpr std::string_view kUpdate = "LD I0.0\nMOVW VW410, AC0\nINCW AC0\nMOVW AC0, VW410\n";
  EXPECT_EQ(races(kUpdate, "LD SM0.0\nFILL 0, VW100, 200\n"), "lost VW410 1-3");
  EXPECT_EQ(races(kUpdate, "LD SM0.0\nFILL 0, VW100, 100\n"), "") << "the last is VW298";
}

TEST(Races, ATableCountsInItsSecondWord) {
  EXPECT_EQ(races("LD SM0.0\nMOVW VW302, AC0\nDECW AC0\nMOVW AC0, VW302\n", "LD SM0.0\nATT VW0, VW300\n"), "lost VW302 1-3");
  EXPECT_EQ(races("LDW> VW302, 0\nFIFO VW300, VW200\n", "LD SM0.0\nATT VW0, VW300\n"), "") << "in one instruction";
}

TEST(Races, AStringMayHaveWhatTheOtherSideWrites) {
  EXPECT_EQ(races("LD SM0.0\nMOVB VB100, AC0\nINCB AC0\nMOVB AC0, VB100\n", "LD SM0.0\nSCAT \"A\", VB100\n"),
            "lost VB100 1-3");
  EXPECT_EQ(races("LD SM0.0\nSCPY VB100, VB200\nSCPY VB200, VB100\n", "LD SM0.0\nINCB VB101\n"), "lost? VB101 1-2");
}

TEST(Races, WhatAnInterruptCallsOftenIsLookedAtOnce) {
  const auto looks = [](std::size_t calls) {
    std::string stl = "LD SM0.1\nATCH 0, 10\nENI\nMEND\nSBR 1\nLD SM0.0\nINCW VW10\nRET\nINT 0\nLD SM0.0\n";
    for (std::size_t i = 0; i < calls; ++i) stl += "CALL 1\n";
    const auto program = program_of(stl + "RETI\n", *find_cpu("224"));
    const Facts facts = facts_of(*program);
    std::size_t count = 0;
    find_races(facts, calls_of(*program, facts.flow), {.goes_on = [&count] { ++count; }});
    return count;
  };
  EXPECT_EQ(looks(1), looks(50));
}

TEST(Races, DtchKeepsItsInterruptAway) {
  constexpr std::string_view kUpdate = "MOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n";
  const auto after = [&](std::string_view first) {
    return races(fmt::format("LD SM0.0\n{}\n{}ATCH 0, 10\n", first, kUpdate), kCounts);
  };
  EXPECT_EQ(after("DTCH 10"), "");
  EXPECT_EQ(after("DTCH 11"), "lost VW10 2-4") << "another event";
}

TEST(Races, DtchHoldsOnlyIfNoOtherInterruptAttachesTheEventAgain) {
  constexpr std::string_view kMain = "LD SM0.0\nATCH 1, 11\nDTCH 10\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\nATCH 0, 10\n";
  const auto with = [&](std::string_view routines, std::string_view interrupt = kCounts) {
    return races(kMain, interrupt, routines);
  };
  EXPECT_EQ(with("INT 1\nLD SM0.0\nATCH 0, 10\nRETI\n"), "lost VW10 3-5");
  EXPECT_EQ(with("SBR 1\nLD SM0.0\nATCH 0, 10\nRET\nINT 1\nLD SM0.0\nCALL 1\nRETI\n"), "lost VW10 3-5");
  EXPECT_EQ(with("INT 1\nLD SM0.0\nINCW VW20\nRETI\n"), "");
  EXPECT_EQ(with("INT 1\nRETI\n", "LD SM0.0\nINCW VW10\nATCH 0, 10\n"), "") << "it does not come itself";
}

/// `CALLED by CALL: REASON` of each, with the CALL's op counted as in races().
std::string not_followed(const std::string& stl) {
  const auto program = program_of(stl, *find_cpu("224"));
  const Facts facts = facts_of(*program);
  return stl::joined(
      find_races(facts, calls_of(*program, facts.flow)).not_followed,
      [&](const NotFollowed& left) {
        const bool deep = left.reason == NotFollowed::Reason::DeeperThanTheCpuCalls;
        return fmt::format("{} of {} by {}: {}", routine_text(facts.flow.routines[left.routine]),
                           routine_text(facts.flow.routines[left.from]), left.call, deep ? "deep" : "many");
      },
      "; ");
}

constexpr std::string_view kHead = "LD SM0.1\nATCH 0, 10\nENI\n";

/// Subroutines from `first` to `last`, each of which calls the next one `times` times; the last has other instructions.
std::string chain(int first, int last, int times, std::string_view end) {
  std::string stl;
  for (int number = first; number < last; ++number) {
    stl += fmt::format("SBR {}\nLD SM0.0\n", number);
    for (int i = 0; i < times; ++i) stl += fmt::format("CALL {}\n", number + 1);
    stl += "RET\n";
  }
  return stl + fmt::format("SBR {}\n{}RET\n", last, end);
}

constexpr std::string_view kUpdates = "LD SM0.0\nMOVW VW10, AC0\nINCW AC0\nMOVW AC0, VW10\n";

TEST(Races, CallsAreFollowedAsDeepAsTheCpuNestsThem) {
  const auto of = [](int deepest) {
    return fmt::format("{}LD SM0.0\nCALL 1\nMEND\n{}INT 0\n{}RETI\n", kHead, chain(1, deepest, 1, kUpdates), kCounts);
  };
  EXPECT_EQ(races_in(of(8)), "lost VW10 33-35");
  EXPECT_EQ(not_followed(of(8)), "");
  EXPECT_EQ(races_in(of(9)), "") << "the CPU does not call it";
  EXPECT_EQ(not_followed(of(9)), "SBR_9 of MAIN by 36: deep");
}

TEST(Races, CallsOfAnInterruptRoutineAreFollowedAsDeepAsTheCpuNestsThem) {
  const auto of = [](int deepest) {
    return fmt::format("{}{}MEND\n{}INT 0\nLD SM0.0\nCALL 1\nRETI\n", kHead, kUpdates, chain(1, deepest, 1, kCounts));
  };
  EXPECT_EQ(races_in(of(1)), "lost VW10 1-3");
  EXPECT_EQ(not_followed(of(1)), "");
  EXPECT_EQ(not_followed(of(2)), "SBR_2 of INT_0 by 10: deep");
}

TEST(Races, ARoutineThatCallsItselfIsFollowed) {
  const std::string stl =
      fmt::format("{}LD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 1\n{}RET\nINT 0\n{}RETI\n", kHead, kUpdates, kCounts);
  EXPECT_EQ(races_in(stl), "lost VW10 7-9");
  EXPECT_EQ(not_followed(stl), "SBR_1 of MAIN by 8: deep");
}

TEST(Races, CallsBehindTooManyStepsAreNamed) {
  const auto of = [](int times) {
    return fmt::format("{}LD SM0.0\nCALL 1\nLD SM0.0\nCALL 20\nMEND\n{}{}INT 0\n{}RETI\n", kHead,
                       chain(1, 7, times, "LD SM0.0\n"), chain(20, 20, 1, kUpdates), kCounts);
  };
  EXPECT_EQ(not_followed(of(6)), "") << "more than 60 000";
  EXPECT_EQ(races_in(of(6)).substr(0, 9), "lost VW10");
  EXPECT_NE(not_followed(of(12)).find("SBR_20 of MAIN by 6: many"), std::string::npos) << not_followed(of(12));
}

TEST(Races, WithoutEniNothingIsLeftOut) {
  EXPECT_EQ(not_followed("LD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 1\nRET\n"), "");
}

}  // namespace
}  // namespace s7200::test::races_test
