// What breakpoints and watches count, what they say, and what they refuse.
#include <gtest/gtest.h>

#include "tests/unit/debugger/session.hpp"
#include "tools/session/stops/stop_words.hpp"

namespace s7200::tools::stops_test {
namespace {

TEST(Stops, HitsCountFromTheMomentWhereTheStopWasSetWhateverIsPlayedAgain) {
  AtPrompt session(kNested);
  session("continue 22ms; break INT 0 hits 3");
  EXPECT_EQ(session.vw(30), 4U);
  EXPECT_TRUE(has(session("continue"), "hit 3 times"));
  EXPECT_EQ(session.vw(30), 6U);
  const Time third = session.simulation.time();
  EXPECT_TRUE(has(session("rc"), "this is the oldest moment"));
  EXPECT_TRUE(has(session.out.str(), "breakpoint 1 counts its hits from 22.")) << "with a word why there are none";
  EXPECT_TRUE(has(session("break"), "0 hits"));
  EXPECT_TRUE(has(session("continue"), "hit 3 times"));
  EXPECT_EQ(session.simulation.time(), third) << "what came before it was set does not count";
  EXPECT_TRUE(has(session("break"), "3 hits"));
  EXPECT_TRUE(has(session("back; break"), "0 hits")) << "going back takes counts back";
}

TEST(Stops, AStopWithoutANumberStopsAtWhatWasBeforeItToo) {
  AtPrompt session(kNested);
  session("continue 22ms; break INT 0; rc");
  EXPECT_EQ(session.vw(30), 3U);
  EXPECT_TRUE(has(session("break"), "0 hits"));
  session("rc; continue");
  EXPECT_EQ(session.vw(30), 3U);
  EXPECT_TRUE(has(session("break"), "0 hits"));
}

TEST(Stops, HitsCountOnANewBranchFromItsBeginning) {
  AtPrompt session(kNested);
  session("continue 22ms; break INT 0 hits 2; restart");
  EXPECT_TRUE(has(session("continue"), "hit 2 times"));
  EXPECT_EQ(session.vw(30), 1U);
  session("back 2; at 12ms; set VW100=1; continue");
  EXPECT_EQ(session.vw(30), 3U) << "the second after 12 ms";
}

TEST(Stops, AWatchStopsAtWhatWasSetFromOutside) {
  AtPrompt session(kNested);
  session("watch VW100; continue 5ms; set VW100=7; continue 5ms");
  const std::string text = session("rc");
  EXPECT_TRUE(has(text, "watch 1: VW100 was 16#0000 (0), is 16#0007 (7)\n  by 'set VW100', from outside\n"));
  EXPECT_EQ(session.vw(100), 7U);
  const Time set = session.simulation.time();
  EXPECT_TRUE(has(session("at start; continue"), "by 'set VW100', from outside"));
  EXPECT_EQ(session.simulation.time(), set) << "forwards at the same place";
  EXPECT_TRUE(has(session("break"), "0 hits")) << "only what the CPU does counts";
  EXPECT_TRUE(has(session("rc"), "this is the oldest moment"));
}

TEST(Stops, ABreakpointStopsBeforeWhatWasDoneWhereItStands) {
  AtPrompt session(kNested);
  session("until INT 0");
  const serial::Simulation::Snapshot there = session.simulation.snapshot();
  session("set VW100=7; set VW102=8; continue 12ms; break INT 0; at start; continue");
  EXPECT_TRUE(session.simulation.snapshot() == there) << "as it stood there, before anything was set";
  EXPECT_EQ(session.vw(100), 0U);
  EXPECT_TRUE(has(session("continue"), "breakpoint 1")) << "not a second time in front of the same instruction";
  EXPECT_EQ(session.vw(30), 1U);
  EXPECT_EQ(session.vw(100), 7U);
  EXPECT_EQ(session.vw(102), 8U);
  session("rc");
  EXPECT_TRUE(session.simulation.snapshot() == there) << "a part of the past that is searched begins right there";
  EXPECT_TRUE(has(session("rc"), "this is the oldest moment"));
  EXPECT_EQ(session("delete all; break INT 0 log '{VW100} at {time}'; at start; continue 6ms").find("7 at "),
            std::string::npos)
      << "looked at once, and that before";
}

TEST(Stops, AWatchStopsAtAForcedValue) {
  AtPrompt session(kNested);
  session("watch VW100; continue 5ms; force VW100=9; continue 5ms");
  EXPECT_TRUE(has(session("rc"), "is 16#0009 (9)\n  by 'force VW100', from outside\n"));
}

TEST(Stops, AConditionThatCannotBeComputedIsSaidOnceAStop) {
  AtPrompt session(kNested);
  const std::string text = session("break 4 if 10/VW20 = 5; continue 10ms");
  EXPECT_TRUE(has(text, "nothing to stop for")) << "VW20 is 7 after the first scan";
  AtPrompt never("LD SM0.0\nINCW VW10\nMEND\n");
  const std::string said = never("break 2 if 1/VW20 = 1; continue 5ms");
  EXPECT_TRUE(has(said, "the condition of breakpoint 1 could not be computed "));
  EXPECT_TRUE(has(said, " times: a division by 0\n"));
  EXPECT_EQ(said.find("could not", said.find("could not") + 1), std::string::npos) << "once";
}

TEST(Stops, WhatCanNeverBeComputedIsRefused) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session.error_of("break 4 if 1/0 = 1"), "a division by 0"));
  EXPECT_TRUE(has(session.error_of("expect 1/0"), "a division by 0"));
  EXPECT_EQ(session.error_of("expect 1/VW100 = 1"),
            "expected 1/VW100 = 1, which does not hold here: VW100 is 0; a division by 0");
}

TEST(Stops, ABraceThatIsNotClosedIsRefused) {
  AtPrompt session(kNested);
  EXPECT_EQ(session.error_of("break 4 log 'a {VW2'"), "'a {VW2', column 3: the closing } is missing");
  EXPECT_TRUE(has(session("break 4 log 'a {VW10} b'; continue 2ms"), "a 0 b\n"));
}

TEST(Stops, EachOptionSaysWhatItExpects) {
  AtPrompt session(kNested);
  EXPECT_EQ(session.error_of("watch VW100 hits 0"), "hits expects a number above 0, for example: hits 4");
  EXPECT_EQ(session.error_of("watch VW100 if"), "if expects a condition, for example: if VW100 > 8");
  EXPECT_EQ(session.error_of("break 4 log"), "log expects a text, for example: log '{VW100} at {time}'");
  EXPECT_EQ(session.error_of("break 4 log ''"), session.error_of("break 4 log")) << "it would stop instead of logging";
}

TEST(Stops, AWatchForReadsAndWritesIsOneWithOneCount) {
  AtPrompt session("LD SM0.0\nMOVW 5, VW0\nMOVW VW0, VW2\nMEND\n");
  EXPECT_TRUE(has(session("watch VW0 read write; continue"), "watch 1: VW0 read write was 16#0000 (0), is 16#0005 (5)"));
  EXPECT_TRUE(has(session("continue"), "by main line 3"));
  EXPECT_TRUE(has(session("continue"), "VW0 read write is 16#0005 (5) as before\n  by main line 2"));
  EXPECT_TRUE(has(session("break"), "3 hits"));
}

TEST(Stops, WhatTheProgramSendsUnaskedIsShown) {
  AtPrompt session(
      "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 2, VB0\nMOVB 16#48, VB1\nMOVB 16#49, VB2\nMOVB 50, SMB34\nATCH 0, 10\nENI\nMEND\n"
      "INT 0\nLD SM0.0\nXMT VB0, 0\nRETI\n");
  const std::string text = session("continue 60ms");
  EXPECT_TRUE(has(text, "unasked  48 49\n         'HI'\n         from 50."));
  EXPECT_TRUE(has(session("continue 1s"), "no more of this run are shown; 'break sent' stops at each"));
  EXPECT_TRUE(has(session("break sent; continue"), "\n  48 49\n"));
}

TEST(Stops, AnAnswerIsNotUnaskedUnlessTheMasterHasGivenUp) {
  AtPrompt session(kEcho);
  const std::string text = session("scan 3; send 5a; continue; continue 100ms");
  EXPECT_EQ(text.find("unasked"), std::string::npos) << text;
  EXPECT_TRUE(has(session("break sent; send 41; continue"), "\n  41\n"));
}

TEST(Stops, WatchAloneListsAsBreakAloneDoes) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("watch"), "no breakpoints and no watches\n"));
  session("break 4; watch VW10");
  EXPECT_TRUE(has(session("watch"), "2   watch    0 hits  VW10 is"));
  EXPECT_EQ(session("watch"), session("break"));
}

TEST(Stops, CompletionOffersWhatMayComeNext) {
  using Words = std::vector<std::string>;
  AtPrompt session(kNested);
  const auto offered = [&](std::string_view line) { return session.debugger->completions(line).candidates; };
  EXPECT_EQ(offered("break event 8 "), (Words{"occurs", "served", "if", "hits", "log"}));
  EXPECT_EQ(offered("break event 8 occurs "), (Words{"if", "hits", "log"}));
  EXPECT_EQ(offered("break unanswered "), (Words{"if", "hits", "log"}));
  EXPECT_EQ(offered("break INT 0 "), (Words{"always", "if", "hits", "log"}));
  EXPECT_EQ(offered("break 4 hits 3 "), (Words{"always", "if", "log"}));
  EXPECT_EQ(offered("break 4 hits "), Words{});
  EXPECT_EQ(offered("break 4 if VW1"), Words{"VW10"});
  EXPECT_EQ(offered("break une"), Words{});
  EXPECT_EQ(offered("break una"), Words{"unanswered"});
  EXPECT_EQ(offered("watch VW10 "), (Words{"read", "write", "change", "if", "hits", "log"}));
  EXPECT_EQ(offered("watch VW10 read if VW2"), Words{"VW20"});
  EXPECT_EQ(offered("watch VW10 read "), (Words{"write", "if", "hits", "log"}));
  EXPECT_EQ(offered("watch VW10 read write "), (Words{"if", "hits", "log"}));
  for (const char* const condition : {"not ", "not ( ", "VW20 > ", "VW20 + 1 <= "})
    EXPECT_EQ(offered(std::string("break 4 if ") + condition + "VW1"), Words{"VW10"}) << condition;
  EXPECT_EQ(offered("break 4 if not (VW1"), Words{"(VW10"});
  EXPECT_EQ(offered("break 4 if VW20>VW1"), Words{"VW20>VW10"});
  EXPECT_EQ(offered("break 4 if VW20 VW1"), Words{}) << "nothing connects them";
  EXPECT_EQ(offered("force S"), Words{}) << "special memory cannot be forced";
  EXPECT_EQ(offered("force VW1"), Words{"VW10"});
  session("force VW10=5");
  EXPECT_EQ(offered("unforce "), (Words{"all", "VW10"}));
  EXPECT_EQ(offered("fault fli"), Words{"flip:"});
  EXPECT_EQ(offered("mode "), (Words{"run", "stop"}));
}

TEST(Stops, HelpNamesAllThatHappensAndEachOption) {
  AtPrompt session(kNested);
  const std::string help = session("help break"), of_watch = session("help watch");
  for (const std::string_view word : happening_words()) EXPECT_TRUE(has(help, word));
  for (const StopOption& option : kStopOptions) EXPECT_TRUE(has(help, option.word));
  for (const AccessWord& access : kAccesses) EXPECT_TRUE(has(of_watch, access.word));
}

TEST(Stops, OptionsComeInAnyOrderAfterATextInQuotesTooAndOnce) {
  AtPrompt session(kNested);
  const std::string logged = session("break 4 log 'scan of {VW10}' hits 3; continue 10ms; break");
  EXPECT_FALSE(has(logged, "scan of 1\n"));
  EXPECT_TRUE(has(logged, "scan of 2\n"));
  EXPECT_TRUE(has(logged, "from hit 3, logs 'scan of {VW10}'"));
  EXPECT_EQ(session.error_of("break 4 hits 2 hits 3"), "'hits' is there twice; give it once");
  EXPECT_EQ(session.error_of("break 4 log 'x' log 'y'"), "'log' is there twice; give it once");
  EXPECT_TRUE(has(session.error_of("break 4 log 'x' frob"), "always, if CONDITION, hits N, log 'TEXT'"));
}

TEST(Stops, AnOptionOfPlacesIsRefusedForWhatHappensAndForMemory) {
  AtPrompt session(kNested);
  for (const char* const command : {"break xmt always", "break event 10 hits 2 ALWAYS", "watch VW20 always"})
    EXPECT_EQ(session.error_of(command), "'always' is for places; what happens has no power flow") << command;
  EXPECT_TRUE(has(session("break INT 0 always; break"), "always"));
}

TEST(Stops, ACharacterDroppedFromItsQueueIsLost) {
  AtPrompt session(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nDISI\nLD I0.0\nEU\nDTCH 8\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n");
  session("continue 50ms; break lost; send 41; continue 50ms; input I0.0=1");
  EXPECT_TRUE(has(session("continue"), "breakpoint 1, lost, hit for the first time\n"));
  EXPECT_TRUE(has(session.out.str(), " ms dropped: detached while it waited\n"));
}

TEST(Stops, WhatRunsWithoutPowerFlowTooStopsWithoutIt) {
  AtPrompt session(
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nCALL 1\nFOR VW0, 1, 2\nLD I0.0\nNEXT\nLD I0.0\nLBL 3\nLD I0.0\n"
      "MEND\nSBR 1\nLD I0.0\nRET\nINT 0\nLD I0.0\nRETI\n");
  for (const char* const place : {"9", "LBL 3", "13", "16", "19"}) {
    const std::string text = session(std::string("delete all; break ") + place + "; continue 20ms");
    EXPECT_TRUE(has(text, "for the first time")) << place;
    EXPECT_FALSE(has(text, "without power flow")) << place;
  }
}

TEST(Stops, WhatIsPassedWithoutPowerFlowIsSaidBackwardsTooWithTheConditionThatHeld) {
  AtPrompt session("LD I0.0\n= Q0.0\nLD SM0.0\nINCW VW0\nMEND\n");
  session("continue 5ms; break 2 if VW0 > 1");
  EXPECT_TRUE(has(session("scan"), "breakpoint 1 was passed once without power flow; 'break 2 always if VW0 > 1' stops"));
  const std::string back = session("rscan 3");
  EXPECT_TRUE(has(back, "breakpoint 1 was passed 3 times without power flow"));
  EXPECT_FALSE(has(session("delete 1; break 2 if VW0 < 0; rscan; scan"), "was passed")) << "the condition did not hold";
}

TEST(Stops, TheLineInTheMessageOfAWatchIsThatOfTheInstructionThatDidIt) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("watch VW10 log '{VW10} in line {line}'; continue 2ms"), "1 in line 4\n"));
}

TEST(Stops, AWatchOfWritesSaysThatItIsForInstructions) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("watch SMB2 write"), "it is for writes of instructions; 'watch SMB2' stops at what the system"));
  EXPECT_FALSE(has(session("watch SMB2"), "instructions"));
}

TEST(Stops, WhatCanNeverHappenIsRefused) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session.error_of("break event 27"), "event 27 needs CPU"));
  EXPECT_TRUE(has(session.error_of("break rcv"), "RCV needs CPU"));
  EXPECT_TRUE(has(session.error_of("break error 9999"), "'9999' is not the code of a run-time error"));
  EXPECT_EQ(session.error_of("break error 0006"), "no error");
}

TEST(Stops, AConditionOfAnyLengthIsAnsweredOrRefused) {
  AtPrompt session(kNested);
  const auto chain = [](int operators) {
    std::string text = "print 1";
    for (int i = 0; i < operators; ++i) text += "+1";
    return text;
  };
  EXPECT_TRUE(has(session(chain(1000)), "+1 = 1001 (16#"));
  EXPECT_TRUE(has(session.error_of(chain(1001)), "more than 1000 operators"));
  EXPECT_TRUE(has(session.error_of(chain(200'000)), "more than 1000 operators"));
}

}  // namespace
}  // namespace s7200::tools::stops_test
