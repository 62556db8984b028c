// Upper bounds of times. Each instruction takes 10 us, powered or not; the system's part of a scan takes 800 us, the entry
// of an interrupt routine 40 us (tests/support/plc.hpp).
#include "interpreter/analysis/bounds.hpp"

#include <fmt/format.h>

#include <atomic>

#include "tests/support/plc.hpp"

namespace s7200::test::bounds_test {
namespace {

Bounds bounds(std::string_view stl) {
  const auto program = program_of(stl, *find_cpu("224"));
  const Facts facts = facts_of(*program);
  return bounds_of(facts, calls_of(*program, facts.flow), *program);
}

TEST(Bounds, AScanIsTheLongestWayThroughTheProgramAndTheSystemsPart) {
  EXPECT_EQ(bounds("LD I0.0\n= Q0.0\nMEND\n").scan, 800 * us + 30 * us);
  EXPECT_EQ(bounds("LD I0.0\nJMP 1\nLD I0.1\n= Q0.0\n= Q0.1\nLBL 1\nMEND\n").scan, 800 * us + 60 * us) << "without the jump";
  EXPECT_EQ(bounds("LD I0.0\nJMP 1\nLD I0.1\n= Q0.0\nLD SM0.0\nEND\nLBL 1\nMEND\n").scan, 800 * us + 60 * us);
}

TEST(Bounds, ALoopCountsAsOftenAsItRuns) {
  const Bounds constant = bounds("LD SM0.0\nFOR VW0, 1, 5\nINCW VW2\nNEXT\nMEND\n");
  EXPECT_EQ(constant.routines[0].time, 30 * us + 5 * 20 * us);
  EXPECT_EQ(constant.loops.at(0).times, 5);
  const Bounds set = bounds("LD SM0.0\nMOVW 3, VW10\nFOR VW0, 1, VW10\nINCW VW2\nNEXT\nMEND\n");
  EXPECT_EQ(set.loops.at(0).times, 3) << "only constants are put into VW10";
}

TEST(Bounds, ALoopCountsAsWhatIsInFrontOfItAllows) {
  EXPECT_EQ(bounds("LDW<= VW10, 16\nFOR VW0, 1, VW10\nINCW VW2\nNEXT\nMEND\n").loops.at(0).times, 16);
  EXPECT_FALSE(bounds("LD SM0.0\nFOR VW0, 1, 5\nLD I0.0\nDECW VW0\nNEXT\nMEND\n").loops.at(0).times)
      << "its passes write its index";
}

TEST(Bounds, ACommentGivesALoopItsBound) {
  const Bounds jump = bounds("LBL 1\nLD I0.0\nINCW VW0\nJMP 1 // at most 4 times\nMEND\n");
  EXPECT_EQ(jump.routines[0].time, 4 * 30 * us + 10 * us);
  EXPECT_TRUE(jump.routines[0].loops.empty());
  EXPECT_EQ(bounds("LD SM0.0\nFOR VW0, 1, VW2 // at most 9 times\nINCW VW2\nNEXT\nMEND\n").loops.at(0).times, 9);
}

TEST(Bounds, ALoopWithoutOneIsNamedAndCountsOnce) {
  const Bounds open = bounds("LD SM0.0\nFOR VW0, 1, VW2\nINCW VW4\nNEXT\nMOVW VW6, VW2\nMEND\n");
  EXPECT_EQ(open.routines[0].loops, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(open.routines[0].time, 4 * 10 * us + 20 * us);
}

TEST(Bounds, CallsCountWithWhatTheyCallAndRecursionIsNamed) {
  EXPECT_EQ(bounds("LD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\n= Q0.0\nRET\n").routines[0].time, 60 * us);
  EXPECT_EQ(bounds("LD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCALL 1\nRET\n").routines[1].loops,
            (std::vector<std::uint32_t>{5}));
}

TEST(Bounds, CountedInstructionsTakeTheMostThatTheyCount) {
  const auto program = program_of("LD SM0.0\nSLW VW0, 3\nSLW VW0, VB9\nMEND\n", *find_cpu("224"));
  Program timed = *program;
  for (Op& op : timed.ops) op.unit_cost = op.instruction->mnemonic == "SLW" ? 1000 : 0;
  const Facts facts = facts_of(*program);
  EXPECT_EQ(bounds_of(facts, calls_of(*program, facts.flow), timed).routines[0].time, 40 * us + 3 * us + 32 * us);
}

TEST(Bounds, CallsThatOneValueKeepsApartAreNotAddedUp) {
  const std::string two =
      "LDB= VB0, 3\nCALL 1\nLDB= VB0, 4\nCALL 2\nMEND\nSBR 1\nLD I0.0\n= Q0.0\nRET\nSBR 2\nLD I0.0\n= Q0.1\nRET\n";
  EXPECT_EQ(bounds(two).routines[0].time, 50 * us + 30 * us);
  EXPECT_EQ(bounds("LD I0.1\nCALL 1\nLDN I0.1\nCALL 1\nMEND\nSBR 1\nLD I0.0\n= Q0.0\nRET\n").routines[0].time,
            50 * us + 30 * us);
  const std::string written =
      "LDB= VB0, 3\nCALL 1\nLD SM0.0\nMOVB VB9, VB0\nLDB= VB0, 4\nCALL 1\nMEND\nSBR 1\nLD I0.0\nRET\n";
  EXPECT_EQ(bounds(written).routines[0].time, 70 * us + 2 * 20 * us) << "VB0 is another one then";
}

TEST(Bounds, ACopyIsKeptApartLikeItsOriginal) {
  const std::string copied =
      "LD SM0.0\nMOVB VB0, AC0\nLDB= AC0, 3\nCALL 1\nLDB= VB0, 4\nCALL 1\nMEND\nSBR 1\nLD I0.0\n= Q0.0\nRET\n";
  EXPECT_EQ(bounds(copied).routines[0].time, 70 * us + 30 * us);
}

TEST(Bounds, WhatAnInterruptRoutineWritesKeepsNothingApart) {
  const std::string disturbed =
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLDB= VB0, 3\nCALL 1\nLDB= VB0, 4\nCALL 1\nMEND\n"
      "SBR 1\nLD I0.0\nRET\nINT 0\nLD SM0.0\nMOVB VB9, VB0\nRETI\n";
  EXPECT_EQ(bounds(disturbed).routines[0].time, 90 * us + 2 * 20 * us);
}

TEST(Bounds, ALoopThatCountsDownToZeroIsKnown) {
  const Bounds down = bounds("LD SM0.0\nMOVW 5, VW0\nLBL 1\nLD SM0.0\nINCW VW2\nDECW VW0\nLDN SM1.0\nJMP 1\nMEND\n");
  EXPECT_TRUE(down.routines[0].loops.empty());
  EXPECT_EQ(down.routines[0].time, 30 * us + 5 * 50 * us);
}

TEST(Bounds, ALoopThatCountsToAComparisonIsKnown) {
  const auto loop = [](std::string_view first, std::string_view step, std::string_view compares) {
    return bounds(fmt::format("LD SM0.0\n{}\nLBL 1\nLD SM0.0\nINCW VW2\n{}\n{}\nJMP 1\nMEND\n", first, step, compares));
  };
  const Bounds down = loop("MOVW 20, VW0", "-I 8, VW0", "LDW>= VW0, 1");
  EXPECT_TRUE(down.routines[0].loops.empty());
  EXPECT_EQ(down.routines[0].time, 30 * us + 3 * 50 * us) << "with 12, 4, -4 left";
  EXPECT_EQ(down.loops.at(0).times, 3);
  EXPECT_EQ(loop("MOVW 0, VW0", "+I 3, VW0", "LDW< VW0, 10").loops.at(0).times, 4) << "3, 6, 9, 12";
  EXPECT_EQ(loop("MOVW 0, VW0", "INCW VW0", "LDW<> 7, VW0").loops.at(0).times, 7);
  EXPECT_EQ(loop("MOVW 0, AC0\nMOVB VB9, AC0", "DECW AC0", "LDW> AC0, 0").loops.at(0).times, 255) << "a byte";
  EXPECT_EQ(loop("MOVW VW8, AC0\nANDW 16#F, AC0", "DECW AC0", "LDW> AC0, 0").loops.at(0).times, 15);
  EXPECT_FALSE(loop("MOVW VW8, VW0", "INCW VW0", "LDW<= VW0, 32767").loops.at(0).times) << "it overflows";
  EXPECT_FALSE(loop("MOVW 0, VW0", "+I 3, VW0", "LDW<> VW0, 10").loops.at(0).times) << "it passes over 10";
  EXPECT_FALSE(loop("MOVW 0, VW0", "INCW VW0\nMOVW VW8, VW0", "LDW< VW0, 10").loops.at(0).times) << "it is set anew";
  EXPECT_FALSE(loop("MOVW 0, VW0", "LD I0.0\nINCW VW0", "LDW< VW0, 10").loops.at(0).times) << "not in each pass";
}

TEST(Bounds, TwoNumbersOfASumAreNotAboveIt) {
  const auto times = [](std::string_view checks, std::string_view limit) {
    return bounds(
               fmt::format("LD SM0.1\nMOVW 17, VW20\nLD SM0.0\nCALL 1\nMEND\nSBR 1\nLD SM0.0\nMOVW VW0, AC0\n+I VW2, AC0\n{}"
                           "OW>= AC0, {}\nCRET\nLD SM0.0\nMOVW VW2, AC1\n+I 7, AC1\nSRW AC1, 3\n"
                           "FOR VW10, 1, AC1\nINCW VW12\nNEXT\nRET\n",
                           checks, limit))
        .loops.at(0)
        .times;
  };
  EXPECT_EQ(times("LD SM1.1\nO V0.7\nO V2.7\n", "17"), 2) << "up to 16, eight for each pass";
  EXPECT_EQ(times("LD SM1.1\nO V0.7\nO V2.7\n", "VW20"), 2) << "only 17 is moved there";
  EXPECT_NE(times("LD SM1.1\nO V0.7\n", "17"), 2) << "VW2 may be negative";
  EXPECT_NE(times("LD I0.0\nO V0.7\nO V2.7\n", "17"), 2) << "the sum may have overflowed";
}

TEST(Bounds, SayWhatALoopWithoutOneIsCountedWith) {
  const Bounds open = bounds(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nLD SM0.0\nMOVW VW0, AC0\nCALL 1\nMEND\n"
      "SBR 1\nLD SM0.0\nFOR VW2, 1, AC0\nNEXT\nRET\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n");
  EXPECT_EQ(open.loops.at(0).open, Bounds::Loop::Open::NoLimit);
  EXPECT_EQ(open.loops.at(0).copied, std::vector<std::uint32_t>{5});
  EXPECT_EQ(open.loops.at(0).counted, std::vector<std::uint32_t>{15});
  EXPECT_EQ(bounds("LD SM0.0\nFOR VW0, 1, 5\nDECW VW0\nNEXT\nMEND\n").loops.at(0).open, Bounds::Loop::Open::WritesItsIndex);
  EXPECT_EQ(bounds("LBL 1\nLD I0.0\nJMP 1\nMEND\n").loops.at(0).open, Bounds::Loop::Open::Jumps);
}

TEST(Bounds, ALoopCountsAsTheWayToItAllows) {
  const std::string program =
      "LDW<= VW10, 4\nAW>= VW10, 1\nCALL 1\nLDW> VW10, 90\nR M0.0, 1\nMEND\nSBR 1\nLD SM0.0\nFOR VW0, 1, VW10\nINCW "
      "VW2\nNEXT\nRET\n";
  EXPECT_EQ(bounds(program).routines[0].time, 60 * us + 30 * us + 4 * 20 * us);
}

TEST(Bounds, AnAnswerTakesFromItsLastCharacterTheSilenceAScanAndTheWayToItsXmt) {
  const std::string slave =
      "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 5, SMB34\nATCH 0, 8\nENI\nLD M0.0\nCALL 1\nR M0.0, 1\nMEND\n"
      "SBR 1\nLD SM0.0\nXMT VB0, 0\nRET\n"
      "INT 0\nLD SM0.0\nATCH 1, 10\nRETI\nINT 1\nLD SM0.0\nS M0.0, 1\nDTCH 10\nRETI\n";
  const Bounds answered = bounds(slave);
  ASSERT_EQ(answered.answers.size(), 1U);
  const Time characters = 10 * us + 70 * us, silence = 5 * ms + 10 * us + 80 * us;
  const Time idle = 90 * us, sends = 70 * us + 20 * us;
  EXPECT_EQ(answered.answers[0].time, characters + silence + idle + 800 * us + sends);
  EXPECT_TRUE(answered.answers[0].loops.empty());
  EXPECT_TRUE(bounds("LD I0.0\nXMT VB0, 0\nMEND\n").answers.empty()) << "it receives nothing";
}

constexpr std::string_view kTwoInterrupts =
    "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 5, SMB34\nATCH 0, 8\nATCH 1, 10\nENI\nMEND\n"
    "INT 0\nLD SM0.0\nINCW VW0\nRETI\nINT 1\nLD SM0.0\nINCW VW2\nINCW VW4\nRETI\n";

TEST(Bounds, InterruptsComeAsOftenAsTheirPeriodsAllow) {
  const Bounds both = bounds(kTwoInterrupts);
  ASSERT_EQ(both.events.size(), 2U);
  EXPECT_EQ(both.events[0].period, 10 * kSecond / 9600) << "a character of ten bits";
  EXPECT_EQ(both.events[1].period, 5 * ms);
  EXPECT_EQ(both.events[0].longest_routine, 70 * us);
  EXPECT_EQ(both.scan_with_interrupts, both.scan + 70 * us + 80 * us);
}

TEST(Bounds, LatencyIsTheLongestInstructionAndTheRoutinesThatAreServedBefore) {
  const Bounds both = bounds(kTwoInterrupts);
  EXPECT_EQ(both.events[0].latency, 10 * us + 80 * us + 40 * us) << "the other one may just have begun";
  EXPECT_EQ(both.events[1].latency, 30 * us + 70 * us + 40 * us)
      << "a character that came between ATCH and ENI is before it";
}

TEST(Bounds, AnEventWaitsWithoutBoundOnlyForEventsBeforeItOfWhichThePeriodIsNotKnown) {
  const auto events = bounds("LD SM0.1\nATCH 1, 0\nATCH 0, 10\nENI\nMEND\nINT 0\nRETI\nINT 1\nRETI\n").events;
  EXPECT_EQ(events[0].event, 0);
  EXPECT_FALSE(events[0].may_stay_disabled);
  EXPECT_EQ(events[0].before, std::vector<std::uint8_t>{0}) << "those of its own";
  EXPECT_EQ(events[1].before, std::vector<std::uint8_t>{0}) << "inputs are served before";
  EXPECT_FALSE(events[1].latency);
  const auto of_port = bounds("LD SM0.1\nMOVB 9, SMB30\nATCH 1, 0\nATCH 0, 8\nENI\nMEND\nINT 0\nRETI\nINT 1\nRETI\n").events;
  EXPECT_EQ(of_port[0].event, 8);
  EXPECT_TRUE(of_port[0].latency) << "characters are served before the input";
  EXPECT_TRUE(bounds("LD SM0.1\nATCH 0, 10\nENI\nLD I0.0\nDISI\nMEND\nINT 0\nRETI\n").events[0].may_stay_disabled);
}

TEST(Bounds, HaveNoLatencyWhereInterruptsStayDisabledOrAnEventHasNoPeriod) {
  EXPECT_FALSE(bounds("LD SM0.1\nATCH 0, 10\nENI\nLD I0.0\nDISI\nMEND\nINT 0\nRETI\n").events[0].latency);
  EXPECT_FALSE(bounds("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nLD SM0.0\nRETI\n").scan_with_interrupts);
}

/// Two timed interrupts, each every 5 ms, with so many passes of 20 us.
std::string two_timed(int passes) {
  const std::string loop = fmt::format("LD SM0.0\nFOR VW0, 1, {}\nINCW VW2\nNEXT\nRETI\n", passes);
  return "LD SM0.1\nMOVB 5, SMB34\nMOVB 5, SMB35\nATCH 0, 10\nATCH 1, 11\nENI\nMEND\nINT 0\n" + loop + "INT 1\n" + loop;
}

TEST(Bounds, TimedInterruptsThatNeedMoreTimeThanThereIsHaveNoLatency) {
  const Bounds enough = bounds(two_timed(120)), too_much = bounds(two_timed(125));
  EXPECT_EQ(enough.events.at(0).latency, 10 * us + enough.events.at(0).longest_routine + 40 * us);
  EXPECT_FALSE(enough.events.at(0).may_be_lost);
  EXPECT_FALSE(too_much.events.at(0).latency) << "5.16 ms of 5 ms: more and more of them wait, until the queue is full";
  EXPECT_GT(too_much.events.at(0).load, 1.0);
  EXPECT_FALSE(too_much.scan_with_interrupts);
}

TEST(Bounds, SayWhereAQueueMayOverflow) {
  const std::string slow =
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nDISI\nFOR VW4, 1, {}\nINCW VW6\nNEXT\nENI\nMEND\nINT 0\nRETI\n";
  EXPECT_FALSE(bounds(fmt::format(fmt::runtime(slow), 1700)).events.at(0).may_be_lost) << "34 ms: 7 of them";
  EXPECT_TRUE(bounds(fmt::format(fmt::runtime(slow), 2300)).events.at(0).may_be_lost) << "46 ms: 10 for a queue of 8";
}

TEST(Bounds, EventsBeforeTheFirstEniWaitForIt) {
  const auto latency = [](std::string_view first_scan) {
    return bounds(fmt::format("{}MEND\nSBR 1\nATCH 0, 10\nRET\nINT 0\nLD SM0.0\nRETI\n", first_scan)).events.at(0).latency;
  };
  constexpr std::string_view kLoop = "FOR VW0, 1, 500\nINCW VW2\nNEXT\n";  // 10 ms
  const Time late = (10 + 10 + 500 * 20 + 20 + 40) * us;
  EXPECT_EQ(latency(fmt::format("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\n{}LD SM0.1\nENI\n", kLoop)), late);
  EXPECT_EQ(latency(fmt::format("LD SM0.1\nMOVB 5, SMB34\nENI\nATCH 0, 10\n{}", kLoop)), 50 * us) << "ENI is first";
  EXPECT_EQ(latency(fmt::format("LDN SM0.1\nJMP 1\nLD SM0.0\nMOVB 5, SMB34\nATCH 0, 10\n{}LD SM0.0\nENI\nLBL 1\n", kLoop)),
            late);
  EXPECT_EQ(latency(fmt::format("LD SM0.1\nMOVB 5, SMB34\nCALL 1\n{}LD SM0.1\nENI\n", kLoop)), late + 20 * us)
      << "ATCH is in a subroutine";
  EXPECT_EQ(latency("LD SM0.1\nMOVB 50, SMB34\nATCH 0, 10\nINCW VW2\nINCW VW2\nENI\n"), 50 * us) << "none comes so soon";
}

TEST(Bounds, WhatIsQueuedBeforeALateEniComesAtOnce) {
  for (const std::string_view main :
       {"LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nLD I0.0\nENI\n", "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\n",
        "LD I0.0\nMOVB 5, SMB34\nATCH 0, 10\nLD SM0.1\nENI\nLD I0.1\nDISI\n"}) {
    const Bounds late = bounds(fmt::format("{}MEND\nINT 0\nLD SM0.0\nRETI\n", main));
    EXPECT_TRUE(late.events.at(0).may_stay_disabled) << main;
    EXPECT_FALSE(late.events.at(0).latency) << main;
    EXPECT_TRUE(late.enabled_late) << main;
  }
  const Bounds late = bounds("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nLD I0.0\nENI\nMEND\nINT 0\nLD SM0.0\nRETI\n");
  EXPECT_EQ(late.scan_with_interrupts, late.scan + (8 + 1) * 60 * us) << "a full queue and one more";
}

/// With the timed interrupt 0 attached and enabled in the first scan.
Bounds with_timed(std::string_view main) {
  return bounds(fmt::format("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\n{}MEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n", main));
}

TEST(Bounds, InterruptsWaitFromADisiToTheEniThatSurelyFollows) {
  const auto latency = [](std::string_view main) { return with_timed(main).events.at(0).latency; };
  EXPECT_EQ(latency("LD SM0.0\nDISI\nINCW VW2\nENI\n"), 30 * us + 40 * us);
  EXPECT_EQ(latency("LD I0.0\nDISI\nINCW VW2\nENI\n"), 30 * us + 40 * us) << "with the power flow that DISI has";
  EXPECT_EQ(latency("LD I0.0\nDISI\nLD SM0.0\nENI\n"), 30 * us + 40 * us);
  EXPECT_EQ(latency("LD I0.0\nDISI\nLD I0.1\nENI\nLD SM0.0\nENI\n"), 50 * us + 40 * us) << "the first may have no power";
  EXPECT_EQ(latency("LD I0.0\nDISI\nJMP 1\nLD SM0.0\nINCW VW2\nENI\nLBL 1\nLD SM0.0\nENI\n"), 70 * us + 40 * us)
      << "the longest way leads through both";
}

TEST(Bounds, AnEniThatMayBePassedOverEndsNoDisi) {
  for (const std::string_view main :
       {"LD I0.0\nDISI\nLD I0.1\nENI\n", "LD SM0.0\nDISI\nLD I0.1\nJMP 1\nLD SM0.0\nENI\nLBL 1\n",
        "LD SM0.0\nDISI\nLD I0.1\nEND\nLD SM0.0\nENI\n", "LD I0.0\nDISI\nA I0.1\nENI\n",
        "LD SM0.0\nDISI\nFOR VW0, 1, VW2\nENI\nNEXT\n", "LD I0.0\nDISI\n"}) {
    const Bounds open = with_timed(main);
    EXPECT_TRUE(open.events.at(0).may_stay_disabled) << main;
    EXPECT_FALSE(open.events.at(0).latency) << main;
    EXPECT_FALSE(open.scan_with_interrupts) << main << "events that waited for several scans may come in one";
  }
}

TEST(Bounds, ALoopThatReachesDisiAgainIsPartOfTheWait) {
  EXPECT_EQ(with_timed("LD SM0.0\nFOR VW10, 1, 5\nDISI\nNEXT\nENI\n").events.at(0).latency, (10 + 5 * 20 + 10 + 40) * us);
}

TEST(Bounds, ASubroutineMayEnableInterruptsAgain) {
  const std::string_view of_callee =
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nDISI\nCALL 1\nMEND\nSBR 1\nLD SM0.0\nENI\nRET\n"
      "INT 0\nLD SM0.0\nRETI\n";
  EXPECT_EQ(bounds(of_callee).events.at(0).latency, 50 * us + 40 * us);
}

/// A slave that waits for silence with a timed interrupt; with instructions at the begin of the main program.
std::string slave_with(std::string_view interval, std::string_view main) {
  return fmt::format(
      "LD SM0.1\nMOVB 16#09, SMB30\n{}ATCH 0, 8\nENI\n{}LD M0.0\nCALL 1\nR M0.0, 1\nMEND\n"
      "SBR 1\nLD SM0.0\nXMT VB0, 0\nRET\n"
      "INT 0\nLD SM0.0\nATCH 1, 10\nRETI\nINT 1\nLD SM0.0\nS M0.0, 1\nDTCH 10\nRETI\n",
      interval, main);
}

TEST(Bounds, AnAnswerWaitsAtLeastForTheShortestTimedInterval) {
  const auto time = [](std::string_view interval, const char* cpu) {
    const auto program = program_of(slave_with(interval, ""), *find_cpu(cpu));
    const Facts facts = facts_of(*program);
    return bounds_of(facts, calls_of(*program, facts.flow), *program).answers.at(0).time;
  };
  ASSERT_TRUE(time("MOVB 5, SMB34\n", "214"));
  EXPECT_EQ(time("MOVB 1, SMB34\n", "214"), time("MOVB 5, SMB34\n", "214")) << "5 ms on CPU 214";
  EXPECT_EQ(time("MOVB 1, SMB34\n", "224"), *time("MOVB 5, SMB34\n", "224") - 4 * ms);
  EXPECT_EQ(time("", "214"), *time("MOVB 5, SMB34\n", "214") - 2 * 10 * us) << "SMB34 is 0 then; without the MOVB";
}

TEST(Bounds, AnAnswerHasNoneWhereSeveralTimedInterruptsMayMakeTheSilence) {
  const std::string once = slave_with("MOVB 5, SMB34\n", "");
  const auto changed = [&](std::string_view from, std::string_view to) {
    std::string text = once;
    return bounds(text.replace(text.find(from), from.size(), to)).answers.at(0);
  };
  EXPECT_TRUE(changed("DTCH 10", "DTCH 10").time);
  const auto third = changed("S M0.0, 1\nDTCH 10\n", "INCW VW30\nLDW>= VW30, 3\nS M0.0, 1\nDTCH 10\n");
  EXPECT_FALSE(third.time);
  EXPECT_FALSE(third.silence_is_known);
  EXPECT_FALSE(changed("DTCH 10\n", "").time);
}

TEST(Bounds, AnAnswerWaitsWhereInterruptsAreDisabled) {
  const auto time = [](std::string_view main) { return bounds(slave_with("MOVB 5, SMB34\n", main)).answers.at(0).time; };
  EXPECT_EQ(time("LD SM0.0\nDISI\nINCW VW2\nENI\n"), *time("LD SM0.0\nINCW VW2\n") + 2 * 20 * us + 2 * 20 * us)
      << "two scans with DISI and ENI, and two interrupts that each wait for ENI in place of one instruction";
  EXPECT_FALSE(time("LD I0.0\nDISI\nLD I0.1\nENI\n"));
}

/// Whoever waits, and asks to end after so many steps.
struct Impatient {
  explicit Impatient(std::uint64_t most) : left(most) {}
  std::uint64_t left, steps = 0;
  std::atomic<bool> enough = false;
  Waiter waiter() {
    return {StopToken(enough), [this] {
              ++steps;
              if (steps == left) enough = true;
            }};
  }
};

/// 16 bits that a subroutine looks at one by one, each with a loop after it.
std::string many_ways() {
  std::string text = "LD SM0.0\n";
  for (int i = 0; i < 16; ++i) text += fmt::format("LDW= VW{}, {}\nMOVW {}, VW{}\nCALL 1\n", 2 * i, i, i + 1, 2 * i + 2);
  text += "MEND\nSBR 1\n";
  for (int i = 0; i < 16; ++i) text += fmt::format("LDW= VW{}, {}\nMOVW {}, VW{}\nCRET\n", 2 * i, i + 2, i, 64 + 2 * i);
  return text + "LBL 1\nLD I0.0\nINCW VW200\nJMP 1\nRET\n";
}

TEST(Bounds, WhoeverWaitsMayEndThem) {
  const auto program = program_of(many_ways(), *find_cpu("224"));
  Impatient patient(0), impatient(50);
  const Facts facts = facts_of(*program, patient.waiter());
  const Calls calls = calls_of(*program, facts.flow);
  EXPECT_TRUE(bounds_of(facts, calls, *program, {}, patient.waiter()).is_complete);
  EXPECT_GT(patient.steps, 200U) << "it is asked on all ways";
  const Bounds ended = bounds_of(facts, calls, *program, {}, impatient.waiter());
  EXPECT_FALSE(ended.is_complete);
  EXPECT_EQ(ended.loops.size(), 1U) << "what is known without following ways";
  EXPECT_LT(impatient.steps, 150U);
}

TEST(Bounds, WithoutPatienceLessIsKnownOfPointers) {
  const auto program = program_of("LD SM0.1\nMOVD &VB100, VD0\nLD SM0.0\nMOVB 1, *VD0\nMEND\n", *find_cpu("224"));
  Impatient impatient(1);
  const Facts ended = facts_of(*program, impatient.waiter()), known = facts_of(*program);
  const auto targets = [](const Facts& facts) { return facts.pointers.targets(3, image::kV); };
  EXPECT_EQ(targets(known), (std::vector<PointerTarget>{{image::kV + 100, image::kV + 101}}));
  EXPECT_GT(targets(ended).size(), 1U) << "anywhere";
}

}  // namespace
}  // namespace s7200::test::bounds_test
