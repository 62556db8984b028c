#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/load.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/slave_bench.hpp"
#include "tests/support/source_path.hpp"
#include "tests/unit/debugger/session.hpp"
#include "tools/host/files/files.hpp"
#include "tools/session/observers/call_stack.hpp"
#include "tools/session/past/past_words.hpp"

namespace s7200::tools::debugger_test {
namespace {

// --- running ---

TEST(Debugger, StepShowsTheInstructionItExecutedAndStandsInFrontOfTheNext) {
  AtPrompt session(kNested);
  const std::string text = session("step 4; until 17; step");
  EXPECT_TRUE(has(text, "line 17    MOVW    7, VW20"));
  EXPECT_TRUE(has(text, "S0=1 VW20=16#0007"));
  EXPECT_EQ(session.line(), 18U);
  EXPECT_EQ(session.vw(20), 7U);
}

TEST(Debugger, ShowsTheCommentOfTheLineItStandsAt) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("until 4"), "INCW    VW10                 // one more scan"));
}

TEST(Debugger, FirstStepExecutesTheFirstInstructionOfTheProgram) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("step"), "line 1     LD      SM0.1"));
  EXPECT_EQ(session.line(), 2U);
}

TEST(Debugger, StepGoesIntoACallAndOverDoesNot) {
  AtPrompt session(kNested);
  session("step; step");
  EXPECT_EQ(session.line(), 8U);
  session("back; over");
  EXPECT_EQ(session.line(), 3U);
  EXPECT_EQ(session.vw(20), 7U);
}

TEST(Debugger, OutLeavesTheInnermostSubroutineOnly) {
  AtPrompt session(kNested);
  session("break SBR 2; continue; out");
  EXPECT_EQ(session.line(), 14U);
  session("out");
  EXPECT_EQ(session.line(), 3U);
}

TEST(Debugger, OutOfAnInterruptRoutineGoesBackToWhatWasInterrupted) {
  AtPrompt session(kNested);
  session("break INT 0; continue; step");
  EXPECT_TRUE(session.state().in_interrupt);
  session("out");
  EXPECT_FALSE(session.state().in_interrupt);
  EXPECT_EQ(session.vw(30), 1U);
}

TEST(Debugger, AStepOverACallInAnInterruptRoutineStaysInTheRoutineAndOutLeavesWhatItCalls) {
  constexpr std::string_view kCalls =
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nCALL 2\nMEND\n"  // 1
      "SBR 1\nLD SM0.0\nINCW VW20\nRET\n"                                   // 8
      "SBR 2\nLD SM0.0\nINCW VW30\nRET\n"                                   // 12
      "INT 0\nLD SM0.0\nCALL 1\nINCW VW10\nRETI\n";                         // 16
  AtPrompt session(check_text(kCalls, "test.stl", cpu224(), default_times(cpu224())).program);
  session("break 18; continue; over");
  EXPECT_EQ(session.line(), 19U);
  session("continue; step");
  EXPECT_EQ(session.line(), 8U);
  session("out");
  EXPECT_EQ(session.line(), 19U);
  EXPECT_TRUE(session.state().in_interrupt);
  session("out");
  EXPECT_FALSE(session.state().in_interrupt);
}

TEST(Debugger, OutOfTheMainProgramRunsNothing) {
  AtPrompt session(kNested);
  session("step");
  const auto before = session.simulation.snapshot();
  EXPECT_TRUE(has(session("out"), "no subroutine"));
  EXPECT_EQ(session.simulation.snapshot(), before);
}

TEST(Debugger, OverNeverStopsInAnInterruptThatComesInBetween) {
  AtPrompt session(kNested);
  session("over; over");
  for (int i = 0; i < 100; ++i) {
    session("over");
    ASSERT_FALSE(session.state().in_interrupt);
  }
  EXPECT_GT(session.vw(30), 2U);
}

TEST(Debugger, ScanStopsAtTheFirstInstructionOfThatScan) {
  AtPrompt session(kNested);
  session("step 3; scan");
  EXPECT_EQ(session.line(), 1U);
  EXPECT_EQ(session.state().scans, 1U);
  session("scan 20");
  EXPECT_EQ(session.line(), 1U);
  EXPECT_EQ(session.state().scans, 21U);
  EXPECT_FALSE(session.state().in_interrupt);
}

TEST(Debugger, NetworkStepsOverNetworksOfTheRoutineInBothDirections) {
  AtPrompt session(
      "NETWORK 1\nLD SM0.0\nCALL 1\nNETWORK 2\nLD SM0.0\nINCW VW0\nNETWORK 3\nLD SM0.0\nINCW VW2\nMEND\n"
      "SBR 1\nNETWORK 4\nLD SM0.0\nINCW VW4\nRET\n");
  session("step; network");
  EXPECT_EQ(session.line(), 5u) << "what is called belongs to it";
  session("network");
  EXPECT_EQ(session.line(), 8u);
  session("rnetwork");
  EXPECT_EQ(session.line(), 5u);
  session("rnetwork");
  EXPECT_EQ(session.line(), 2u);
}

TEST(Debugger, InterruptRunsToWhereTheNextOneBeginsOrEndsAndBack) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("interrupt"), "INT 0 for event 10"));
  EXPECT_EQ(session.line(), 19u);
  const Time begun = session.simulation.time();
  session("interrupt end");
  EXPECT_FALSE(session.state().in_interrupt);
  EXPECT_EQ(session.vw(30), 1u);
  session("interrupt; interrupt");
  EXPECT_EQ(session.vw(30), 2u) << "the third has not counted yet";
  session("rinterrupt ends");
  EXPECT_EQ(session.line(), 22u) << "in front of its RETI";
  EXPECT_EQ(session.vw(30), 2u);
  session("rinterrupt; rinterrupt");
  EXPECT_EQ(session.line(), 19u);
  EXPECT_EQ(session.simulation.time(), begun);
  EXPECT_EQ(session.error_of("interrupt now"), "interrupt expects nothing, begins or ends");
}

TEST(Debugger, OfAnOverflowingQueueAndOfTheEndOfRcvItStopsToo) {
  AtPrompt busy("LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nLD SM0.0\nINCW VW0\nMEND\nINT 0\nRETI\n");
  EXPECT_TRUE(
      has(busy("break overflow; scan 3; send 01 02 03 04 05 06; continue"), "breakpoint 1, overflow, hit for the first"));
  AtPrompt receiving(
      check_text("LD SM0.1\nMOVB 9, SMB30\nLD V0.0\nEU\nRCV VB100, 0\nMEND\n", "test.stl", cpu224(), default_times(cpu224()))
          .program);
  receiving("scan 3; set SMB87=16#90 SMB94=4 V0.0=1; scan 2; break rcv; send 01 02 03 04");
  EXPECT_TRUE(has(receiving("continue"), "breakpoint 1, rcv, hit for the first time"));
}

TEST(Debugger, AFaultOfTheLineBeginsNowAndGoingBackUndoesIt) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session("scan 3; fault flip:bit=0; send 41; continue"), "on the line from now on: flip\n"));
  EXPECT_TRUE(has(session("print /x VB1"), "VB1      16#40"));
  session("at 1ms; fork; continue 10ms; send 41; continue");
  EXPECT_TRUE(has(session("print /x VB1"), "VB1      16#41"));
  EXPECT_TRUE(has(session("fault flip; fault none; send 42; continue; print /x VB1"), "VB1      16#42"));
  EXPECT_TRUE(has(session.error_of("fault flip:bit=12"), "fault, column 10: "));
}

TEST(Debugger, FaultAloneListsTheFaultsInForceAndHowOftenEachHasHappened) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session("fault"), "the line has no fault now; "));
  session("scan 3; fault flip:bit=0; fault missing:character=9; send 41; continue");
  EXPECT_EQ(session("fault"), "fault flip: 1×\nfault missing:character=9: 0×\n");
  EXPECT_TRUE(has(session("fault none; fault"), "the line has no fault now; "));
}

TEST(Debugger, OnlyTheCpuWritesItsReadOnlySpecialMemory) {
  AtPrompt session(kEcho);
  EXPECT_EQ(session.error_of("set SM0.0=0"), "SM0.0 cannot be set: only the CPU writes SM0.0 to SM29.7");
  EXPECT_TRUE(has(session.error_of("set VB0=1 SMW29=5"), "SMW29 cannot be set"));
  EXPECT_TRUE(has(session("set SMB28=77 SMB34=5; scan 2; print /x SMB34"), "16#05")) << "a potentiometer is turned";
  EXPECT_TRUE(has(session("set SM0.7=0; scan 2; print SM0.7"), "0")) << "so is the mode switch";
}

TEST(Debugger, AMomentBeforeTheOldestIsRefusedHoweverItIsWritten) {
  AtPrompt session(kEcho);
  session("continue 100ms");
  EXPECT_TRUE(has(session.error_of("at -3s"), "the oldest moment is 0.000000 ms"));
  EXPECT_TRUE(has(session.error_of("at 99s"), "nothing has run after"));
}

TEST(Debugger, RwhyThatGoesNowhereSaysSo) {
  AtPrompt session("LD SM0.0\n= Q0.0\nMEND\n");
  EXPECT_TRUE(has(session("rwhy"), "rwhy goes nowhere: no instruction is named"));
}

TEST(Debugger, ContinueEndsAtItsTimeAndSaysSo) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("continue 50 ms"), "50 ms of simulated time passed"));
  EXPECT_GE(session.simulation.time(), 50 * kMillisecond);
  EXPECT_LT(session.simulation.time(), 52 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "the limit"));
}

TEST(Debugger, UntilTheLineItStandsAtGoesOnceAround) {
  AtPrompt session(kNested);
  session("until 4; until 4");
  EXPECT_EQ(session.line(), 4U);
  EXPECT_EQ(session.vw(10), 1U);
}

TEST(Debugger, StopRequestEndsARun) {
  std::atomic<bool> stop = true;
  AtPrompt session(program_of(kNested), StopToken(stop));
  EXPECT_TRUE(has(session("continue 1h"), "Ctrl-C"));
  EXPECT_LT(session.simulation.time(), kSecond);
}

TEST(Debugger, BetweenTwoScansItSaysSoAndNamesTheNextInstruction) {
  AtPrompt session(kNested);
  session("continue 20ms");
  while (standing_at(session.state())) session.simulation.run_until(session.simulation.time() + 10 * kMicrosecond);
  session.out.str("");
  session.debugger->show_place();
  EXPECT_TRUE(has(session.out.str(), "  between two scans, the system"));
  EXPECT_TRUE(has(session.out.str(), " >     1  LD      SM0.1"));
  EXPECT_EQ(open_routines(session.state()).front().op, 0U);
}

TEST(Debugger, AViewWhoseSearchIsInterruptedNeverSaysNotExecuted) {
  std::atomic<bool> stop = false;
  AtPrompt session(program_of(kNested), StopToken(stop));
  session("continue 200ms");
  stop = true;
  for (const std::string& line : session.debugger->view(15)) EXPECT_EQ(line.find("not executed"), std::string::npos) << line;
}

// --- stopping ---

TEST(Debugger, LineWithoutInstructionStandsForTheNextOneAndItSaysSo) {
  AtPrompt session(kNested);
  const std::string text = session("break 6");
  EXPECT_TRUE(has(text, "line 6 has no instruction; the next one is in line 8"));
  EXPECT_TRUE(has(text, "breakpoint 1 in SBR 1 line 8"));
  session("continue");
  EXPECT_EQ(session.line(), 8U);
}

TEST(Debugger, BreakpointAtTheFirstInstructionStopsInTheFirstScan) {
  AtPrompt session(kNested);
  session("break 1; continue");
  EXPECT_EQ(session.state().scans, 0U);
  session("continue");
  EXPECT_EQ(session.state().scans, 1U);
}

TEST(Debugger, BreakListsHitsAndKnowsWhatIsAlreadySet) {
  AtPrompt session(kNested);
  session("break 4; continue; continue");
  EXPECT_TRUE(has(session("break"), "2 hits  main line 4"));
  EXPECT_TRUE(has(session("break 4"), "breakpoint 1 is already in main line 4"));
  session("delete 1");
  EXPECT_TRUE(has(session("break"), "no breakpoints"));
}

TEST(Debugger, ABreakpointThatNeedNotStopDoesNotReplaceOneThatDoes) {
  AtPrompt session(kNested);
  session("break 4 if VW30 > 100; break 4");
  EXPECT_TRUE(has(session.out.str(), "breakpoint 2 in main line 4"));
  session("continue");
  EXPECT_EQ(session.line(), 4U);
}

TEST(Debugger, ALogTextWhoseQuotationMarkIsOpenIsRefused) {
  AtPrompt session(kNested);
  EXPECT_EQ(session.error_of("break INT 0 log 'x; continue 1ms"), "the closing ' is missing");
  EXPECT_TRUE(has(session("break"), "no breakpoints"));
}

TEST(Debugger, WatchTellsOldValueNewValueAndTheInstructionInARoutineToo) {
  AtPrompt session(kNested);
  const std::string text = session("watch VW30; continue");
  EXPECT_TRUE(has(text, "watch 1: VW30 was 16#0000 (0), is 16#0001 (1)"));
  EXPECT_TRUE(has(text, "by INT 0 line 21    INCW    VW30"));
  EXPECT_EQ(session.line(), 22U);
}

TEST(Debugger, WatchKnowsBitsBytesAndDoubles) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("watch V31.0; continue"), "V31.0 was 0, is 1"));
  EXPECT_TRUE(has(session("delete all; watch VB31 VD28; continue"), "VB31 was 16#01 (1), is 16#02 (2)"));
  EXPECT_TRUE(has(session.out.str(), "VD28 was 16#00000001 (1), is 16#00000002 (2)"));
  AtPrompt accumulator("LD SM0.0\nINCW AC1\nMEND\n");
  EXPECT_TRUE(has(accumulator("watch AC1; continue"), "AC1 was 16#00000000 (0), is 16#00000001 (1)\n  by main line 2"));
}

TEST(Debugger, WatchSaysWhenTheSystemChangedIt) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("step; watch I0.4; input I0.4=1; continue"), "by the system"));
  EXPECT_EQ(session.state().scans, 1U);
}

TEST(Debugger, InputEdgeCausesItsInterruptBeforeTheNextInstruction) {
  AtPrompt session(kEcho);
  session("scan; input I0.0 = 1; step");
  EXPECT_TRUE(session.state().in_interrupt);
  EXPECT_EQ(session.state().serving_routine, 2);
  session("back; over");
  EXPECT_FALSE(session.state().in_interrupt);
  EXPECT_EQ(session.vw(40), 1U);
  EXPECT_EQ(session.line(), 2U);
}

// --- stops ---

TEST(Debugger, BoxWithoutPowerFlowIsPassedAndItSaysSoUnlessAlwaysWasAsked) {
  constexpr std::string_view kText = "LD M0.0\nINCW VW10\nLD SM0.0\nINCW VW20\nMEND\n";
  AtPrompt session(kText);
  EXPECT_TRUE(has(session("break 2; break 4 if VW20 = 5; continue"),
                  "breakpoint 2, hit for the first time\n"
                  "breakpoint 1 was passed 6 times without power flow"));
  EXPECT_EQ(session.line(), 4U);
  session("set M0.0=1; continue");
  EXPECT_EQ(session.line(), 2U);
  AtPrompt other(kText);
  other("break 2 always; continue");
  EXPECT_EQ(other.line(), 2U);
  EXPECT_FALSE(other.state().stack.top());
}

TEST(Debugger, ConditionIsInStlTerms) {
  AtPrompt session(kNested);
  session("break 4 if VW10 >= 7 and (VW20 = 16#07 or not SM0.0); continue");
  EXPECT_EQ(session.vw(10), 7U);
  EXPECT_TRUE(has(session("break"), "1 hit  main line 4: INCW    VW10                 // one more scan, if VW10 >= 7 and"));
}

TEST(Debugger, HitCountStopsFromThatHitOn) {
  AtPrompt session(kNested);
  session("break 4 hits 5; continue");
  EXPECT_EQ(session.vw(10), 4U);
  session("continue");
  EXPECT_EQ(session.vw(10), 5U);
}

TEST(Debugger, AHitHasTheSameNumberForwardsBackwardsAndAgain) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("break INT 0 hits 3; continue"), "hit 3 times"));
  const Time third = session.simulation.time();
  EXPECT_EQ(session.vw(30), 2U);
  EXPECT_TRUE(has(session("at 1ms; break"), "0 hits  INT 0"));
  EXPECT_TRUE(has(session("continue"), "hit 3 times"));
  EXPECT_EQ(session.simulation.time(), third);
  session("continue; continue");
  EXPECT_TRUE(has(session("break"), "5 hits  INT 0"));
  EXPECT_TRUE(has(session("rcontinue"), "hit 4 times"));
  EXPECT_TRUE(has(session("rcontinue"), "hit 3 times"));
  EXPECT_EQ(session.simulation.time(), third);
  EXPECT_TRUE(has(session("break"), "3 hits  INT 0"));
  EXPECT_TRUE(has(session("rcontinue"), "this is the oldest moment"));
}

TEST(Debugger, ABranchHasTheHitsBeforeItAndItsOwn) {
  AtPrompt session(kNested);
  session("break INT 0; continue; continue; continue; rcontinue; set VW100=1");
  EXPECT_TRUE(has(session("continue; continue"), "hit 4 times"));
  session("back 3");
  EXPECT_TRUE(has(session("break"), "2 hits  INT 0"));
  EXPECT_TRUE(has(session("continue"), "hit 3 times"));
  EXPECT_TRUE(has(session("restart; break"), "0 hits  INT 0"));
}

TEST(Debugger, PlayingAgainCountsNoErrorTwice) {
  AtPrompt session("LD SM0.0\nMOVD 16#7FFFFFFF, VD100\nMOVB 1, *VD100\nMEND\n");
  session("break error; continue; continue; at start; continue; continue");
  EXPECT_TRUE(has(session("break"), "2 hits  error"));
}

TEST(Debugger, LogPrintsALineAndGoesOn) {
  AtPrompt session(kNested);
  const std::string text =
      session("break INT 0 log 'VW30 is {VW30}, twice {2*VW30}, line {line}, event {event} at {time}'; continue 12ms");
  EXPECT_TRUE(has(text, "VW30 is 0, twice 0, line 19, event 10 at 5."));
  EXPECT_TRUE(has(text, "VW30 is 1, twice 2, line 19, event 10 at 10."));
  EXPECT_GE(session.simulation.time(), 12 * kMillisecond);
}

TEST(Debugger, StopsAtANetwork) {
  AtPrompt session("NETWORK 1\nLD SM0.0\nNETWORK 2 // second\nLDN SM0.0\nINCW VW0\nNETWORK 3\nMEND\n");
  session("break network 2; continue");
  EXPECT_EQ(session.line(), 4U);
  EXPECT_TRUE(has(session.error_of("break network 7"), "the program has no NETWORK 7"));
}

TEST(Debugger, StopsWhenAnEventOccursAndWhenItIsServed) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("break event 10; continue"), "breakpoint 1, event 10, hit for the first time\n  5."));
  EXPECT_EQ(session.line(), 19U);
  EXPECT_TRUE(has(session.out.str(), "INT 0 begins: event 10 (timed interrupt 0, SMB34)"));
  EXPECT_TRUE(has(session("delete all; break event 10 occurs; continue"), "event 10 (timed interrupt 0, SMB34) occurred"));
}

TEST(Debugger, StopsAtFramesReceivedAndSentAndAtXmt) {
  AtPrompt session(kEcho);
  const std::string text = session("scan 3; send 5a; break received; break sent; break xmt; continue; continue; continue");
  EXPECT_TRUE(has(text, "breakpoint 3, xmt, hit for the first time\n"));
  EXPECT_TRUE(has(text, "XMT: 1 character"));
  EXPECT_TRUE(has(text, "breakpoint 2, sent, hit for the first time\n"));
  AtPrompt listening("LD SM0.1\nMOVB 16#09, SMB30\nMEND\n");
  EXPECT_TRUE(has(listening("scan 3; send 01 02 03; break received; break lost; continue; delete 2; continue"),
                  "breakpoint 2, lost, hit for the first time\n"));
  EXPECT_TRUE(has(listening.out.str(), "breakpoint 1, received, hit for the first time\n  "));
  EXPECT_TRUE(has(listening("break unanswered; continue"), "breakpoint 3, unanswered, hit for the first time"));
}

constexpr std::string_view kListening =
    "LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nLD SM0.0\nINCW VW0\nRETI\n";

TEST(Debugger, AFaultSaysWhatItDoesAndWhereIfThatWasNotSaid) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session("fault gap:length=10ms"),
                  "on the line from now on: gap:length=10ms\n  a pause before a character: character=2, of=request\n"));
  EXPECT_TRUE(has(session("fault flip:character=3,bit=5,of=answer"), "  one bit inverted\n"));
  EXPECT_TRUE(has(session("fault cut:from=2ms"), "  the line is cut: everybody hears mark"));
}

TEST(Debugger, ARunIsTheSameWhetherAlikeScansArePassedOverOrNot) {
  AtPrompt passing(kEcho), looking(kEcho);
  looking("break 15");  // in an interrupt routine that never runs
  for (AtPrompt* session : {&passing, &looking}) (*session)("continue 3s; send 41; continue; continue 20s");
  EXPECT_EQ(passing.simulation.snapshot(), looking.simulation.snapshot());
  EXPECT_EQ(passing("at -9s; past"), looking("at -9s; past"));
  EXPECT_EQ(passing.simulation.snapshot(), looking.simulation.snapshot());
}

TEST(Debugger, OnlyARunThatMayStopWithinAScanLooksAtEachOfThem) {
  const auto looked = [](const StopPoint& stop, const Stepper::Goal& goal) {
    serial::Simulation simulation(program_of(kNested));
    simulation.power_up();
    History history(simulation, {});
    Stepper stepper(history, StopToken());
    stepper.add(stop);
    std::size_t instructions = 0, wanted = 0;
    stepper.on_instruction = [&](std::size_t, const InstructionRecord&, bool) {
      ++instructions;
      wanted += stepper.wants_scans();
    };
    stepper.run(goal, 3 * kSecond, true);
    return static_cast<double>(wanted) / static_cast<double>(instructions);
  };
  const MemoryRange range = *parse_range("VW100", *program_of(kNested));
  EXPECT_LT(looked({.on = StopPoint::On::RuntimeError}, {}), 0.2) << "the last checkpoint's time, up to the limit";
  EXPECT_EQ(looked({.on = StopPoint::On::Place, .op = 9}, {}), 1);
  EXPECT_EQ(looked({.on = StopPoint::On::Change, .range = range}, {}), 1);
  EXPECT_EQ(looked({.on = StopPoint::On::RuntimeError}, [](auto&&...) { return false; }), 1);
}

TEST(Debugger, ALongCommandShowsHowFarItHasComeAndTakesThatAwayBeforeItsOutput) {
  serial::Simulation simulation(program_of(kNested));
  simulation.power_up();
  std::ostringstream out;
  std::string output_before;
  std::size_t shown = 0, taken_away = 0;
  PromptSettings options{};
  options.patience = 0;
  options.progress = [&](std::string_view text) {
    if (text.empty()) {
      ++taken_away;
      output_before = out.str();
    } else {
      ++shown;
      EXPECT_TRUE(has(std::string(text), " ms; Ctrl-C ends it"));
    }
  };
  Prompt debugger(std::vector{&simulation}, out, options);
  for (const char* command : {"continue 3s", "rcontinue", "at 1.9s", "who VW20"}) {
    shown = taken_away = 0;
    out.str("");
    EXPECT_FALSE(debugger.execute(command));
    EXPECT_GT(shown, 0u) << command;
    EXPECT_EQ(taken_away, 1u) << command;
    EXPECT_EQ(output_before, "") << command;
    EXPECT_NE(out.str(), "") << command;
  }
  shown = 0;
  EXPECT_FALSE(debugger.execute("step; regs"));
  EXPECT_EQ(shown, 0u);
}

/// A master on a bridge sends its frames at their times.
struct Bridged {
  explicit Bridged(std::string_view text, std::vector<Time> times,
                   Bytes request = {0x01, 0x03, 0x00, 0x0a, 0x00, 0x01, 0xa4, 0x08})
      : simulation(program_of(text)), asks(std::move(times)), asked_for(std::move(request)) {
    simulation.power_up();
    PromptSettings options{};
    options.history.drive = [this](Time end, const auto&) { return drive(end); };
    debugger = std::make_unique<Prompt>(std::vector{&simulation}, out, options);
  }
  serial::Halt drive(Time end) {
    serial::HostPort& port = simulation.host_port();
    if (!port.state().attached) port.attach(kFormat, simulation.time());
    for (;;) {
      const Time next = asked < asks.size() ? asks[asked] : kNever;
      const serial::Halt halt = simulation.run_until(std::min(end, next));
      if (halt != serial::Halt::Time || next > end) return halt;
      std::vector<serial::HostCharacter> frame;
      for (const std::uint8_t byte : pieces.empty() ? asked_for : pieces[asked])
        frame.push_back({.byte = byte, .format = kFormat});
      port.send(frame, simulation.time());
      ++asked;
    }
  }
  std::string operator()(std::string_view commands) {
    out.str("");
    const auto error = debugger->execute(commands);
    EXPECT_FALSE(error.has_value()) << *error;
    return out.str();
  }

  static constexpr SerialFormat kFormat{9600, 8, Parity::None, 1};
  serial::Simulation simulation;
  std::ostringstream out;
  std::unique_ptr<Prompt> debugger;
  std::vector<Time> asks;
  Bytes asked_for;
  std::vector<Bytes> pieces{};  ///< instead of it, one each time
  std::size_t asked = 0;
};

TEST(Debugger, ARequestThatComesOverABridgeInPiecesIsOne) {
  Bridged session(kListening, {2 * kSecond, 2'020 * kMillisecond, 2'060 * kMillisecond});
  session.pieces = {{0x01, 0x03}, {0x00, 0x0a, 0x00}, {0x01, 0xa4, 0x08}};
  EXPECT_TRUE(has(session("break unanswered; continue"),
                  "breakpoint 1, unanswered, hit for the first time\n  01 03 00 0a 00 01 a4 08\n"));
  const Time end_of_frame = 2'060 * kMillisecond + 30 * kSecond / 9600, stopped = session.simulation.time();
  EXPECT_GE(stopped, end_of_frame + kSecond);
  EXPECT_LT(stopped, end_of_frame + kSecond + 10 * kMillisecond);
  EXPECT_FALSE(has(session("continue"), "breakpoint"));
  session("rcontinue");
  EXPECT_EQ(session.simulation.time(), stopped);
  EXPECT_TRUE(has(session("rcontinue"), "this is the oldest moment"));
}

TEST(Debugger, ARequestThatIsPlayedAgainIsNamedWithWhatWasHeardBefore) {
  constexpr std::string_view kStop = "breakpoint 1, unanswered, hit for the first time\n  01 03 00 0a 00 01 a4 08\n";
  Bridged session(kListening, {2 * kSecond, 2'300 * kMillisecond});
  EXPECT_TRUE(has(session("break unanswered; continue"), kStop));
  EXPECT_TRUE(has(session("at 2004ms; continue"), kStop)) << "while it came in";
  EXPECT_TRUE(has(session("at 2100ms; continue"), kStop)) << "after it";
  session("at 2004ms; break received; delete 1");
  EXPECT_TRUE(has(session("continue"), "received, hit for the first time\n  01 03 00 0a 00 01 a4 08\n"));
}

TEST(Debugger, WhyTellsOfTheRequestThatAMasterOnABridgeHasGivenUpByAskingAgain) {
  Bridged session(
      "LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nMEND\n"
      "INT 1\nLDB= SMB2, 9\nNOT\nCRETI\nLD SM0.0\nMOVB SMB2, VB1\nMOVB 1, VB0\nXMT VB0, 0\nRETI\n",
      {2 * kSecond, 2'300 * kMillisecond});
  session("break unanswered; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, " characters since 2000.000000 ms: INT 1 took them, and nothing was sent since"));
  EXPECT_TRUE(has(why, "LDB= SMB2, 9"));
}

TEST(Debugger, AMessageShowsAllOfAnAddressWithACount) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(
      has(session("continue 50ms; set VB10=1 VB11=2; break 8 log 'got {VB10:2}'; send 41; continue"), "got 01 02\n"));
}

TEST(Debugger, AMessageOfWhatHappensHasItsTimeAndItsEvent) {
  AtPrompt stops(kEcho), tells(kEcho);
  const std::string text = stops("continue 50ms; break event 8 occurs; send 41; continue");
  const std::size_t event = text.find("  event 8 (");
  ASSERT_NE(event, std::string::npos) << text;
  const std::size_t moment = text.rfind("\n  ", event) + 3;
  EXPECT_TRUE(has(tells("continue 50ms; break event 8 occurs log 'event {event} at {time}.'; send 41; continue"),
                  "event 8 at " + text.substr(moment, event - moment) + "."));
}

TEST(Debugger, AnAddressThatDoesNotExistIsNamedAmongOthersThatPrintIsGiven) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session.error_of("print VB0 VB9999"), "'VB9999' does not exist on CPU 214"));
  EXPECT_TRUE(has(session.error_of("print VB0 and"), "column"));
}

TEST(Debugger, MemoryIsPrintedAsAnyType) {
  AtPrompt session(kEcho);
  session("set VD20=16#41200000 AC1=16#12345678");
  EXPECT_TRUE(has(session("print VD20:word:2"), "VW20"));
  EXPECT_TRUE(has(session.out.str(), "16#4120"));
  EXPECT_TRUE(has(session("print VB20:real"), "10"));
  EXPECT_TRUE(has(session("print AC1:word"), "16#5678"));
  EXPECT_TRUE(has(session("print AC1:word + 1"), "= 22137 "));
  EXPECT_TRUE(has(session.error_of("print T37:word"), "are for memory in bytes"));
  EXPECT_TRUE(has(session.error_of("print VB2047:word:9000"), "does not exist on CPU 214"));
  EXPECT_TRUE(has(session("print -VW40"), "= 0 ")) << "no sign";
}

TEST(Debugger, AFormOfARealThatIsComputedShowsItsBits) {
  AtPrompt session(kEcho);
  session("set VD20=16#41200000");
  EXPECT_TRUE(has(session("print VD20:real * 2"), "= 20\n"));
  EXPECT_TRUE(has(session("print /x VD20:real * 2"), "= 16#41A00000\n"));
  EXPECT_TRUE(has(session("print /d VD20:real * 2"), "= 20\n"));
  EXPECT_TRUE(has(session("print /x VD20:real"), "16#41200000\n")) << "as of memory";
}

TEST(Debugger, HelpOnPrintNamesTheTypesOfAPlainAddress) {
  AtPrompt session(kEcho);
  const std::string help = session("help print");
  for (const std::string_view type : {"byte", "word", "dword", "real"}) EXPECT_TRUE(has(help, type));
  EXPECT_TRUE(has(help, "VB100:word:4"));
}

TEST(Debugger, ATimelineCountsInterruptsThatOccurredBeforeIt) {
  AtPrompt session(
      "LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nLD SM0.0\nDISI\nFILL 0, VW100, 200\nFILL 0, VW100, 200\n"
      "FILL 0, VW100, 200\nFILL 0, VW100, 200\nENI\nMEND\nINT 1\nLD SM0.0\nINCW VW0\nRETI\n");
  session("continue 50ms; send 01 02 03; break event 8 served; continue; scan");
  const Time waited = session.simulation.time();
  EXPECT_TRUE(has(session("timeline 2ms"), " 1 interrupt served")) << waited;
  EXPECT_FALSE(has(session.out.str(), "0 interrupts served"));
}

TEST(Debugger, HelpOnFaultListsTheKinds) {
  AtPrompt session(kEcho);
  for (const char* kind : {"  flip:", "  noise:", "  cut:"}) EXPECT_TRUE(has(session("help fault"), kind));
}

TEST(Debugger, WhatAFaultMakesOfThePortsOwnCharactersIsNotLost) {
  AtPrompt session(test::compile(test::slave_text()));
  const std::string text =
      session("continue 2s; break lost; fault flip:character=3,bit=5,of=answer; send 01 03 00 0a 00 01 crc; continue");
  EXPECT_FALSE(has(text, "receiver is off"));
}

TEST(Debugger, ABroadcastThatComesOverABridgeInPiecesIsNeverUnanswered) {
  Bridged session(kListening, {2 * kSecond, 2'020 * kMillisecond});
  session.pieces = {{0x00, 0x03, 0x00}, {0x0a, 0x00, 0x01, 0xa5, 0xd9}};
  EXPECT_FALSE(has(session("break unanswered; continue"), "breakpoint 1, unanswered, hit"));
}

TEST(Debugger, AWholeRequestOverABridgeIsOverWithTheNextOneHoweverSoonItComes) {
  Bridged session(kListening, {2 * kSecond, 2'020 * kMillisecond});
  session("break unanswered; continue");
  EXPECT_GT(session.simulation.time(), 2'020 * kMillisecond);
  EXPECT_LT(session.simulation.time(), 2'030 * kMillisecond);
}

TEST(Debugger, ARequestOfAMasterOnABridgeIsUnansweredAfterTheTimeOut) {
  Bridged session(kListening, {2 * kSecond});
  EXPECT_TRUE(has(session("break unanswered; continue"),
                  "breakpoint 1, unanswered, hit for the first time\n  01 03 00 0a 00 01 a4 08\n"));
  const Time end_of_frame = 2 * kSecond + 80 * kSecond / 9600, stopped = session.simulation.time();
  EXPECT_GE(stopped, end_of_frame + kSecond);
  EXPECT_LT(stopped, end_of_frame + kSecond + 10 * kMillisecond);
  EXPECT_FALSE(has(session("continue"), "breakpoint")) << "once";
  EXPECT_TRUE(has(session("rcontinue"), "breakpoint 1, unanswered"));
  EXPECT_EQ(session.simulation.time(), stopped);
}

TEST(Debugger, ARequestOfAMasterOnABridgeIsUnansweredThoughThePortSpeaksPpi) {
  Bridged session("LD SM0.0\n= Q0.0\nMEND\n", {2 * kSecond});
  EXPECT_TRUE(has(session("break unanswered; continue"), "breakpoint 1, unanswered, hit for the first time\n"))
      << "with the characters that a port of another format makes of it";
  EXPECT_GT(session.simulation.time(), 3 * kSecond);
  EXPECT_LT(session.simulation.time(), 3'020 * kMillisecond);
  EXPECT_FALSE(has(session("continue 3s"), "breakpoint")) << "once";
}

TEST(Debugger, ARequestOfAMasterOnABridgeIsUnansweredThoughTheCpuIsInStop) {
  Bridged session(kListening, {2 * kSecond});
  EXPECT_TRUE(has(session("continue 1s; mode stop; break unanswered; continue"), "breakpoint 1, unanswered, hit"));
  EXPECT_GT(session.simulation.time(), 3 * kSecond);
  EXPECT_LT(session.simulation.time(), 3'020 * kMillisecond);
}

TEST(Debugger, AFrameThatComesInStopHasBeenReceivedWhenItEnds) {
  AtPrompt session(kListening);
  EXPECT_TRUE(has(session("continue 100ms; mode stop; break received; send 01 03 00 0a 00 01 crc; continue"),
                  "breakpoint 1, received, hit for the first time\n  01 03 00 0a 00 01 a4 08\n"));
  EXPECT_LT(session.simulation.time(), 120 * kMillisecond);
}

/// Asks station 1 once a second, and station 0 before that.
constexpr std::string_view kAsks =
    "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 8, VB0\nMOVD 16#01030000, VD1\nMOVD 16#0001840A, VD5\nENI\n"
    "LD SM0.5\nEU\nXMT VB0, 0\nMEND\n";

TEST(Debugger, ARequestOfTheOnlyProgramIsUnansweredAfterTheTimeOutOrWhenItAsksAgain) {
  AtPrompt session(kAsks);
  EXPECT_TRUE(has(session("break sent; continue; delete 1; break unanswered; continue"),
                  "breakpoint 2, unanswered, hit for the first time\n  01 03 00 00 00 01 84 0a  asked by the program\n"));
  const Time first = session.simulation.time();
  EXPECT_GE(first, 2 * kSecond) << "the XMT, less than 1 s after the end of the one before";
  EXPECT_LT(first, 2'001 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "hit 2 times"));
  session("rcontinue");
  EXPECT_EQ(session.simulation.time(), first);
}

TEST(Debugger, ABroadcastOfAProgramIsNeverUnanswered) {
  AtPrompt session(
      "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 8, VB0\nMOVD 16#0003000A, VD1\nMOVD 16#0001A5D9, VD5\nENI\n"
      "LD SM0.5\nEU\nXMT VB0, 0\nMEND\n");
  EXPECT_TRUE(has(session("break sent; continue; delete 1"), "  00 03 00 0a 00 01 a5 d9\n"));
  EXPECT_FALSE(has(session("break unanswered; continue 5s"), "unanswered, hit"));
}

TEST(Debugger, ABridgeThatAnswersAProgramIsNoMaster) {
  Bytes answer{0x01, 0x03, 0x02, 0x00, 0x05};
  modbus::add_crc(answer);
  Bridged session(kAsks, {1'600 * kMillisecond, 2'600 * kMillisecond, 3'600 * kMillisecond}, answer);
  session("continue 1550ms; break unanswered");
  EXPECT_FALSE(has(session("continue 2900ms"), "breakpoint 1, unanswered, hit")) << "each has its answer";
  EXPECT_TRUE(has(session("continue 1500ms"), "asked by the program")) << "nobody has answered the last";
}

TEST(Debugger, AnAnswerThatComesOverABridgeInPiecesIsOne) {
  Bytes answer{0x01, 0x03, 0x02, 0x00, 0x05};
  modbus::add_crc(answer);
  const auto half = answer.begin() + 3;
  Bridged session(kAsks, {1'600 * kMillisecond, 1'620 * kMillisecond, 2'600 * kMillisecond, 2'630 * kMillisecond});
  session.pieces = {{answer.begin(), half}, {half, answer.end()}, {answer.begin(), half}, {half, answer.end()}};
  session("continue 1550ms; break unanswered");
  EXPECT_FALSE(has(session("continue 1900ms"), "breakpoint 1, unanswered, hit")) << "each has its answer";
  EXPECT_TRUE(has(session("continue 2s"), "asked by the program")) << "nobody has answered the last";
  EXPECT_TRUE(has(session("continue 100ms; rc"), "breakpoint 1, unanswered, hit"));
}

TEST(Debugger, APieceOfAnAnswerOverABridgeMayTakeLongerThanTheNextOneIsWaitedFor) {
  Bytes answer{0x01, 0x03, 0x78};
  answer.resize(3 + 0x78);
  modbus::add_crc(answer);
  const auto head = answer.begin() + 10;  // the rest lasts 120 ms
  Bridged session(kAsks, {1'600 * kMillisecond, 1'650 * kMillisecond});
  session.pieces = {{answer.begin(), head}, {head, answer.end()}};
  session("continue 1550ms; break unanswered");
  EXPECT_TRUE(has(session("continue 1900ms"), "asked by the program")) << "the next request, at 2 s";
  EXPECT_GT(session.simulation.time(), 2'900 * kMillisecond);
}

TEST(Debugger, AProgramAndAMasterOnABridgeThatAskOneAfterTheOtherAreBothUnanswered) {
  Bytes other{0x09, 0x03, 0x00, 0x0a, 0x00, 0x01};
  modbus::add_crc(other);
  Bridged session(kAsks, {1'600 * kMillisecond}, other);
  session("continue 1550ms; break unanswered");
  EXPECT_TRUE(has(session("continue"), "  01 03 00 00 00 01 84 0a  asked by the program\n"));
  const Time first = session.simulation.time();
  EXPECT_GT(first, 1'600 * kMillisecond);
  EXPECT_LT(first, 1'610 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "  09 03 00 0a 00 01 a5 40\n")) << session.out.str();
  const Time second = session.simulation.time();
  EXPECT_GT(second, 2 * kSecond) << "the program asks again";
  EXPECT_LT(second, 2'020 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "asked by the program"));
  session("rcontinue");
  EXPECT_EQ(session.simulation.time(), second);
  session("rcontinue");
  EXPECT_EQ(session.simulation.time(), first);
}

TEST(Debugger, ACancelledRequestIsSaidWhereItWasAndTheMasterIsReadyForTheNext) {
  AtPrompt session(kListening);
  EXPECT_TRUE(has(session.error_of("send cancel"), "no request of the simulated master is under way"));
  EXPECT_TRUE(
      has(session("continue 100ms; send 01 02 03 04; send cancel"), "given up before its first character: 01 02 03 04\n"));
  EXPECT_TRUE(has(session("continue 20ms; expect VW0 = 0; send 01 02 03 04; continue 1500us; send cancel"),
                  "given up on the line: character 2 of 4 is its last, and ends at 1"));
  EXPECT_TRUE(has(session("break unanswered; port"), "idle; has given up 01 02 03 04"));
  EXPECT_TRUE(
      has(session("send 05 06; continue 20ms; expect VW0 = 4; send cancel"), "given up while it waited for the answer, "));
  EXPECT_FALSE(has(session("continue 3s"), "unanswered, hit"));
  EXPECT_FALSE(has(session("rcontinue"), "unanswered, hit"));
}

TEST(Debugger, ARequestThatIsCancelledInTheFirstCharacterOfItsAnswerIsWithinIt) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session("continue 100ms; send 41; break xmt; continue; delete all; continue 500us; send cancel"),
                  "given up within its answer, after 0 characters of it: 41\n"));
}

TEST(Debugger, ACancelledRequestIsInThePastAndInASavedSession) {
  AtPrompt session(kListening);
  session("continue 100ms; send 01 02 03 04; continue 1500us; send cancel; continue 50ms; rscan");
  const serial::Simulation::Snapshot there = session.simulation.snapshot();
  session("at 50ms; at end; rscan 2");
  session("at end");
  const std::string file = test::scratch_folder() + "cancelled.json";
  session("rscan; save " + file + " !");
  AtPrompt other(kListening);
  other("load " + file + "; at end; rscan");
  EXPECT_EQ(other.vw(0), 2) << "characters that have come";
  session("at end; rscan");
  EXPECT_TRUE(other.simulation.snapshot() == session.simulation.snapshot());
  session("back 2; at 101ms");
  EXPECT_TRUE(session.simulation.master().asks());
}

TEST(Debugger, AnAnswerWhereTheNextRequestIsSentIsSeenInBothDirections) {
  AtPrompt session(kEcho);
  session("continue 50ms; send 41; continue");
  const auto answered = session.simulation.snapshot();
  session("send 42; continue");
  const std::string back = session("rcontinue");
  EXPECT_TRUE(has(back, "request  41\n         'A'\nanswer   41"));
  EXPECT_EQ(session.simulation.snapshot(), answered) << "before 42 was sent";
  EXPECT_TRUE(has(session("at start; continue"), "request  41\n         'A'\nanswer   41"));
  EXPECT_EQ(session.simulation.snapshot(), answered);
  EXPECT_TRUE(has(session("continue"), "request  42\n         'B'\nanswer   42"));
}

TEST(Debugger, AnUnansweredRequestWhereTheNextOneIsSentIsSeenInBothDirections) {
  AtPrompt session("LD SM0.0\nMEND\n");
  session("continue 50ms; break unanswered; send 01; continue");
  const auto unanswered = session.simulation.snapshot();
  EXPECT_TRUE(has(session("send 02; continue"), "unanswered, hit 2 times"));
  EXPECT_TRUE(has(session("rcontinue"), "unanswered, hit for the first time\nrequest  01"));
  EXPECT_EQ(session.simulation.snapshot(), unanswered) << "before 02 was sent";
  EXPECT_TRUE(has(session("continue"), "unanswered, hit 2 times"));
  EXPECT_TRUE(has(session("at start; continue"), "unanswered, hit for the first time"));
  EXPECT_EQ(session.simulation.snapshot(), unanswered);
}

TEST(Debugger, ABroadcastIsNeverUnanswered) {
  Bytes broadcast{0x00, 0x06, 0x00, 0x0a, 0x00, 0x01};
  modbus::add_crc(broadcast);
  Bridged bridged(kListening, {2 * kSecond, 2'200 * kMillisecond}, broadcast);
  EXPECT_FALSE(has(bridged("break unanswered; continue"), "breakpoint 1, unanswered, hit"));
  EXPECT_FALSE(has(bridged("rcontinue"), "breakpoint 1, unanswered, hit"));
  AtPrompt session(kListening);
  EXPECT_FALSE(has(session("break unanswered; send 00 06 00 0a 00 01 crc; continue"), "breakpoint 1, unanswered, hit"));
  EXPECT_FALSE(has(session("rcontinue"), "breakpoint 1, unanswered, hit"));
  EXPECT_TRUE(has(session("at end; send 00 06 00 0a 00 01 00 00; continue"), "breakpoint 1, unanswered, hit"))
      << "disturbed";
}

TEST(Debugger, WhyNamesOfAMasterOnABridgeOnlyItsLastRequest) {
  Bridged session(test::slave_text(), {2 * kSecond, 2'500 * kMillisecond, 3 * kSecond},
                  {0x01, 0x03, 0x00, 0x0a, 0x00, 0x01, 0x00, 0x00});
  const std::string text = session("continue 3.5s; why");
  EXPECT_TRUE(has(text, "since 3000."));
  EXPECT_FALSE(has(text, "since 2500."));
}

TEST(Debugger, AddressesArePointersAsInStl) {
  AtPrompt session(kEcho);
  session("continue 10ms; set VD100=&VB200 VD104=&T5");
  EXPECT_EQ(session("print &VB200"), "&VB200 = 134217928 (16#080000C8)\n");
  EXPECT_EQ(session("print &T5"), "&T5 = 117440522 (16#0700000A)\n");
  session("expect VD100 = &VB200 and VD104 = &T5 and VD100 + 1 = &vb201");
  EXPECT_TRUE(has(session("print VD100 - &VB0"), "= 200 (16#000000C8)"));
  EXPECT_TRUE(has(session("print *VD100"), "*VD100 is VB200\n"));
  for (const char* wrong : {"print &M0.1", "print &AC0", "print &VB0:2", "expect VD100 = &HC0", "set VD100=&SMB2"})
    EXPECT_TRUE(has(session.error_of(wrong), "a pointer can point to bytes of I, Q, M, V or S")) << wrong;
  EXPECT_TRUE(has(session.error_of("print &VB99999"), "does not exist on CPU"));
  EXPECT_TRUE(has(session.error_of("set VW100=&VB0"), "a value that fits it")) << "too wide";
}

TEST(Debugger, AtAMomentBeforeSomethingWasDoneStandsBeforeThat) {
  AtPrompt session(kEcho);
  session("continue 100ms; scan");
  const Time at = session.simulation.time();
  session("set VW20=7; continue 10ms");
  session("at " + format_duration(at - 1, 9));
  EXPECT_EQ(session.simulation.time(), at);
  EXPECT_EQ(session.vw(20), 0);
  session("at " + format_duration(at, 9));
  EXPECT_EQ(session.vw(20), 7);
}

TEST(Debugger, WhoNamesTheActionThatHasWrittenOfSeveralAtOneMoment) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session("continue 100ms; set VW20=7; force VW22=9; who VW20"), "by 'set VW20', from outside"));
  EXPECT_TRUE(has(session("send 41; who VW20"), "by 'set VW20', from outside"));
  EXPECT_TRUE(has(session("who VB23"), "by 'force VW22', from outside"));
  session("unforce all; step; set VW20=7 VW24=8; set VW20=9");
  EXPECT_TRUE(has(session("who VW20"), "VW20 was 16#0007 (7), became 16#0009 (9)"));
  EXPECT_TRUE(has(session("force VW22=9; who VW22"), "by 'force VW22', from outside")) << "the value that was there";
}

TEST(Debugger, BackToAWriteFromOutsideStopsBeforeItAndFindsTheEarlierOneNext) {
  AtPrompt session(kEcho);
  session("continue 100ms; set VW20=7; step; set VW20=8; set VB100=1");
  EXPECT_TRUE(has(session("rwho VW20"), "VW20 was 16#0007 (7), became 16#0008 (8)"));
  EXPECT_EQ(session.vw(20), 7);
  EXPECT_TRUE(has(session("rwho VW20"), "VW20 was 16#0000 (0), became 16#0007 (7)"));
  EXPECT_EQ(session.vw(20), 0);
  EXPECT_TRUE(has(session("rwho VW20"), "nothing has written VW20"));
  session("at end; expect VW20 = 8 and VB100 = 1");
}

TEST(Debugger, ARequestOfAMasterOnABridgeIsUnansweredWhenItSendsAgain) {
  Bridged session(kListening, {2 * kSecond, 2'200 * kMillisecond});
  session("break unanswered; continue");
  const Time stopped = session.simulation.time();
  EXPECT_GT(stopped, 2'200 * kMillisecond);
  EXPECT_LT(stopped, 2'210 * kMillisecond);
  session("continue 10ms; rcontinue");
  EXPECT_EQ(session.simulation.time(), stopped);
}

TEST(Debugger, AnAnsweredRequestOfAMasterOnABridgeDoesNotStop) {
  Bridged session(
      "LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nLD SM0.0\nINCW VW2\nLDW= VW2, 8\nMOVB 1, VB0\nXMT VB0, "
      "0\nRETI\n",
      {2 * kSecond});
  session("break unanswered; break sent");
  EXPECT_TRUE(has(session("continue"), "breakpoint 2, sent"));
  EXPECT_FALSE(has(session("continue 5s"), "unanswered"));
}

TEST(Debugger, WhatAPlcSendsToAMasterOnABridgeIsAWrongAnswerUnlessItAnswersTheRequest) {
  Bridged wrong(
      "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 10, SMB34\nATCH 1, 8\nENI\nMEND\n"
      "INT 1\nLD SM0.0\nINCW VW2\nLDW= VW2, 8\nATCH 2, 10\nRETI\n"
      "INT 2\nLD SM0.0\nDTCH 10\nMOVB 1, VB0\nXMT VB0, 0\nRETI\n",
      {2 * kSecond});
  EXPECT_TRUE(has(wrong("break wrong; continue"),
                  "breakpoint 1, wrong, hit for the first time\n  01 03 00 0a 00 01 a4 08\n  answered 00: too short for an "
                  "answer: 00\n"));
  const Time at = wrong.simulation.time();
  EXPECT_FALSE(has(wrong("continue 3s"), "wrong, hit"));
  wrong("rcontinue");
  EXPECT_EQ(wrong.simulation.time(), at);
}

TEST(Debugger, AnAnswerOfABridgeInPiecesIsWrongOnlyIfAllOfItIs) {
  Bytes answer{0x01, 0x03, 0x02, 0x00, 0x05};
  modbus::add_crc(answer);
  const auto half = answer.begin() + 3;
  const Bytes first(answer.begin(), half), second(half, answer.end());
  Bridged right(kAsks, {1'600 * kMillisecond, 1'630 * kMillisecond}), torn(kAsks, {1'600 * kMillisecond});
  right.pieces = {first, second};
  torn.pieces = {first};
  EXPECT_FALSE(has(right("continue 1550ms; break wrong; continue 400ms"), "wrong, hit"));
  EXPECT_TRUE(has(torn("continue 1550ms; break wrong; continue 400ms"), "  answered 01 03 02: too short for an answer"));
  EXPECT_GE(torn.simulation.time(), 1'700 * kMillisecond) << "the rest might have come up to then";
}

TEST(Debugger, AFrameHasEndedAtTheSameMomentWhereverARunPausedInIt) {
  AtPrompt whole(kListening), paused(kListening);
  for (AtPrompt* session : {&whole, &paused}) (*session)("continue 100ms; break received; send 01 02 03 04");
  const std::string text = whole("continue");
  EXPECT_TRUE(has(text, "breakpoint 1, received, hit for the first time\n  01 02 03 04\n"));
  EXPECT_TRUE(has(paused("continue 2ms; continue 1ms; step; continue"), "  01 02 03 04\n"));
  EXPECT_EQ(paused.simulation.time(), whole.simulation.time());
  const Time ended = whole.simulation.time();
  EXPECT_TRUE(has(whole("continue 20ms; rcontinue"), "breakpoint 1, received"));
  EXPECT_EQ(whole.simulation.time(), ended);
  EXPECT_TRUE(has(whole("at 102ms; continue"), "breakpoint 1, received"));
  EXPECT_EQ(whole.simulation.time(), ended) << "it went there in the middle of the frame";
  EXPECT_TRUE(has(whole("delete all; continue 2s; break received; send 05 06; continue"),
                  "received, hit for the first time\n  05 06\n"));
}

TEST(Debugger, ALineOnWhichNothingCameHasNoFrame) {
  AtPrompt session(kListening);
  EXPECT_TRUE(has(session("break received; continue 90ms"), "nothing to stop for"));
  EXPECT_TRUE(has(session("rcontinue"), "this is the oldest moment"));
}

TEST(Debugger, WhatTheProgramSendsIsNotReceived) {
  AtPrompt session("LD SM0.1\nMOVB 16#09, SMB30\nMOVW 16#0155, VW0\nXMT VB0, 0\nMEND\n");
  EXPECT_TRUE(has(session("break received; continue 90ms"), "nothing to stop for"));
}

TEST(Debugger, StopsAtRunTimeErrorsOfACodeOrAny) {
  AtPrompt session("LD SM0.0\nMOVD 16#7FFFFFFF, VD100\nMOVB 1, *VD100\nMEND\n");
  EXPECT_TRUE(has(session("break error 0091; break error; continue"), "breakpoint 2, error, hit for the first time\n  "));
  EXPECT_TRUE(has(session.out.str(), "run-time error 0006"));
  EXPECT_TRUE(has(session("delete 2; break error 6; continue"), "breakpoint 3, error 6"));
}

TEST(Debugger, StopsWhenTheModeChanges) {
  AtPrompt session("LD SM0.0\nINCW VW0\nAW= VW0, 3\nSTOP\nMEND\n");
  EXPECT_TRUE(has(session("break mode; continue"), "breakpoint 1, mode, hit for the first time\n"));
  EXPECT_EQ(session.state().mode, Mode::Stop);
}

TEST(Debugger, WatchTellsReadsAndWritesEvenOfAnEqualValue) {
  AtPrompt session("LD SM0.0\nMOVW 5, VW0\nMOVW VW0, VW2\nMOVW 5, VW0\nMEND\n");
  EXPECT_TRUE(
      has(session("step 2; watch VW0 write; continue"), "watch 1: VW0 write is 16#0005 (5) as before\n  by main line 4"));
  EXPECT_TRUE(
      has(session("delete all; watch VB1 read; continue"), "watch 2: VB1 read is 16#05 (5) as before\n  by main line 3"));
  EXPECT_TRUE(has(session("delete all; watch VW2 if VW2 > 7; continue 20ms"), "nothing to stop for"));
}

TEST(Debugger, StopsWithConditionsWorkBackwardsToo) {
  AtPrompt session(kNested);
  session("continue 60ms; break 4 if VW10 = 12; rc");
  EXPECT_EQ(session.vw(10), 12U);
  EXPECT_EQ(session.line(), 4U);
  session("delete all; watch VW30 if VW30 = 2; at end; rc");
  EXPECT_EQ(session.vw(30), 2U);
  session("delete all; break event 10 if VW30 = 3; at end; rc");
  EXPECT_EQ(session.line(), 19U);
  EXPECT_EQ(session.vw(30), 3U);
}

TEST(Debugger, StopsAndObserversNeverChangeTheRun) {
  const auto program = program_of(kEcho);
  AtPrompt plain(program), watched(program);
  plain("scan 3; send 5a 5b; continue; continue 500ms");
  watched("scan 3; send 5a 5b");
  watched(
      "break event 8 occurs; break event 8; break received; break sent; break xmt; break lost; break overflow; break "
      "unanswered;"
      "watch VB0:4 read; watch SMB2 write; watch AC0; break 9 log '{VB1}'; trace on");
  const Time end = plain.simulation.time();
  while (watched.simulation.time() < end) watched("continue 1ms; step");
  plain("delete all");
  const Time then = watched.simulation.time() + kMillisecond;
  plain.simulation.run_until(then);
  watched.debugger.reset();
  watched.simulation.run_until(then);
  EXPECT_TRUE(plain.simulation.snapshot() == watched.simulation.snapshot());
}

// --- the line ---

TEST(Debugger, ContinueStopsWhenTheAnswerIsCompleteAndShowsIt) {
  AtPrompt session(kEcho);
  const std::string text = session("scan 3; send 5a; continue");
  EXPECT_TRUE(has(text, "request  5a"));
  EXPECT_TRUE(has(text, "answer   5a   after"));
  EXPECT_LT(session.simulation.time(), 20 * kMillisecond);
}

TEST(Debugger, AnswerThatArrivesDuringAnotherCommandIsPrintedAndDoesNotStopIt) {
  AtPrompt session(kEcho);
  EXPECT_TRUE(has(session("scan 3; send 5a; scan 30"), "answer   5a"));
  EXPECT_EQ(session.state().scans, 33U);
}

TEST(Debugger, SendWhileAFrameIsUnderWayIsAWrongCommand) {
  AtPrompt session(kEcho);
  session("scan 3; send 5a");
  EXPECT_TRUE(has(session.error_of("send 5b"), "send: the last frame is still under way or waiting for its answer"));
}

TEST(Debugger, SendTakesTextInQuotationMarks) {
  AtPrompt session(kEcho);
  const std::string text = session("scan 3; send 'Z'; continue # the first");
  EXPECT_TRUE(has(text, "on the line from now on: 5a  'Z' (9600 baud"));
  EXPECT_TRUE(has(text, "request  5a\n         'Z'\nanswer   5a   after"));
  EXPECT_TRUE(has(session("send ';'; continue"), "answer   3b   after"));
  EXPECT_TRUE(has(session("send \" # \" ; continue"), "request  20 23 20\n         ' # '\n"));
  EXPECT_TRUE(has(session("send 'Z' crc"), "on the line from now on: 5a 3f 7b ("));
}

TEST(Debugger, ContinueStopsWhenNoAnswerCame) {
  AtPrompt session(kNested);
  const std::string text = session("scan 3; send 5a; continue");
  EXPECT_TRUE(has(text, "not in Freeport mode"));
  EXPECT_TRUE(has(text, "answer   none within 1 s"));
  EXPECT_LT(session.simulation.time(), 2 * kSecond);
}

TEST(Debugger, BackTakesTheFrameOnTheLineAlong) {
  AtPrompt session(kEcho);
  session("scan 3; send 5a; continue");
  const auto answered = session.simulation.snapshot();
  EXPECT_TRUE(has(session("back; continue"), "answer   5a"));
  EXPECT_EQ(session.simulation.snapshot(), answered);
}

TEST(Debugger, PortShowsModeTransmitterAndMaster) {
  AtPrompt session(kEcho);
  const std::string text = session("scan 3; send 5a; break 12; continue; port");
  EXPECT_TRUE(has(text, "Freeport, 9600 baud, 8 data bits, no parity"));
  EXPECT_TRUE(has(text, "event 8 → INT 1"));
  EXPECT_TRUE(has(text, "sending 5a, 0 more to send"));
}

TEST(Debugger, TraceShowsInterruptsWhileRunning) {
  AtPrompt session(kNested);
  EXPECT_FALSE(has(session("continue 20ms"), "INT 0 begins"));
  EXPECT_TRUE(has(session("trace on; continue 20ms"), "INT 0 begins"));
}

/// I0.0 has an interrupt, which waits for the ENI after a long instruction.
constexpr std::string_view kDisables =
    "LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nDISI // not now\nSQRT VD8, VD12\nENI\nLD SM0.0\nMOVB 1, VB0\nMEND\n"
    "INT 0\nLD SM0.0\nINCW VW20\nRETI\n";

TEST(Debugger, ATraceAfterGoingBackNamesTheDisiThatWasExecutedBeforeThat) {
  AtPrompt session(kDisables);
  session("continue 50ms; until 6; over");
  EXPECT_EQ(session.line(), 7u) << "disabled, and the interrupt waits from here on";
  session("input I0.0=1; continue 30ms; back");
  EXPECT_EQ(session.line(), 7u);
  EXPECT_TRUE(has(session("trace on; continue 20ms"), ": DISI in line 5 until ENI in line 7\n"));
  session("at -25ms; runtil 7; input I0.0=0; input I0.0=1");
  EXPECT_TRUE(has(session.out.str(), "it waits: interrupts are disabled by DISI in line 5\n"));
}

TEST(Debugger, ATimelineNamesTheDisiThatWasExecutedBeforeIt) {
  AtPrompt session(kDisables);
  session("continue 50ms; until 6; over; input I0.0=1; step 6");
  EXPECT_TRUE(has(session("timeline 300us"), "DISI in line 5 until ENI in line 7"));
}

/// Of what commands print, the lines of a trace within (from, to].
std::string trace_within(const std::string& printed, Time from, Time to) {
  std::string lines;
  for (const std::string& line : stl::split_lines(printed)) {
    const std::size_t number = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t point = line.find_first_not_of("0123456789", number);
    if (number < 2 || point == std::string::npos || line[point] != '.') continue;
    const auto at = static_cast<Time>(std::llround(std::stod(line.substr(number)) * kMillisecond));
    if (at > from && at <= to) lines.append(line).append("\n");
  }
  return lines;
}

TEST(Debugger, ATraceAfterGoingBackIsThatOfARunThatOnlyWentForward) {
  for (const std::string_view program : {kDisables, kNested, kEcho}) {
    AtPrompt session(program);
    std::string forward = session("trace on");
    for (int i = 0; i < 8; ++i)
      forward += session(
          fmt::format("continue {}us; input I0.0={}{}", 20'000 + 1'300 * i, 1 - i % 2, i == 4 ? "; send 41 42" : ""));
    forward += session("continue 100ms; continue 50ms");
    const Time newest = session.state().time;
    for (int ms = 30; ms < 190; ms += 17) {
      session(fmt::format("at {}ms", ms));
      const Time from = session.state().time;
      std::string again;
      while (session.state().time < newest) again += session("continue 50ms");
      EXPECT_EQ(trace_within(again, from, newest), trace_within(forward, from, newest)) << "from " << ms << " ms";
    }
    EXPECT_NE(trace_within(forward, 0, newest), "");
  }
}

// --- back ---

TEST(Debugger, BackRestoresExactlyTheStateBefore) {
  AtPrompt session(kNested);
  session("scan 5");
  const auto before = session.simulation.snapshot();
  session("step 7; over; continue 20ms");
  EXPECT_TRUE(has(session("back 3"), "back to before 'step 7'"));
  EXPECT_EQ(session.simulation.snapshot(), before);
}

TEST(Debugger, BackSaysWhenThereIsNoEarlierState) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("back"), "no earlier state"));
}

TEST(Debugger, KeepsNoMoreStatesThanItSays) {
  AtPrompt session(kNested);
  for (std::size_t i = 0; i < Session::kKeptStates + 10; ++i) session("step");
  EXPECT_TRUE(has(session("back 1000"), "only 64 earlier states are kept"));
  EXPECT_EQ(session.state().instructions, 10U);
  EXPECT_TRUE(has(session("back"), "no earlier state"));
}

TEST(Debugger, RestartKeepsBreakpointsAndIsTakenBack) {
  AtPrompt session(kNested);
  session("break 4; continue; continue");
  const auto before = session.simulation.snapshot();
  session("restart");
  EXPECT_EQ(session.simulation.time(), 0);
  session("continue");
  EXPECT_EQ(session.line(), 4U);
  EXPECT_EQ(session.state().scans, 0U);
  session("back 2");
  EXPECT_EQ(session.simulation.snapshot(), before);
}

// --- back in time ---

TEST(Debugger, StepsBackwardsUndoStepsForwards) {
  AtPrompt session(kNested);
  session("step 3");
  std::vector<serial::Simulation::Snapshot> states;
  for (int i = 0; i < 300; ++i) {
    states.push_back(session.simulation.snapshot());
    session("step");
  }
  for (; !states.empty(); states.pop_back()) {
    session("rs");
    ASSERT_TRUE(session.simulation.snapshot() == states.back()) << states.size();
  }
  const auto start = session.simulation.snapshot();
  session("step 250; rstep 250");
  EXPECT_TRUE(session.simulation.snapshot() == start);
}

TEST(Debugger, BackwardsOverACallPassesAllThatItCalled) {
  AtPrompt session(kNested);
  session("until 3; ro");
  EXPECT_EQ(session.line(), 2U);
  session("until 18; ru");
  EXPECT_EQ(session.line(), 13U);
  session("ru");
  EXPECT_EQ(session.line(), 2U);
  EXPECT_TRUE(has(session("ru"), "this is the main program"));
}

TEST(Debugger, BackwardsOutOfAnInterruptRoutineIsWhatItInterrupted) {
  AtPrompt session(kNested);
  session("until 21; ru");
  EXPECT_FALSE(session.state().in_interrupt);
  EXPECT_EQ(session.vw(30), 0U);
}

TEST(Debugger, BackwardsOverNeverStopsInAnInterruptThatCameInBetween) {
  AtPrompt session(kNested);
  session("until 3; continue 50ms; over");
  for (int i = 0; i < 60; ++i) {
    session("rover");
    ASSERT_FALSE(session.state().in_interrupt);
  }
}

TEST(Debugger, BackwardsScanGoesToTheStartOfThisOneThenOfTheOneBefore) {
  AtPrompt session(kNested);
  session("scan 20; step 2; rn");
  EXPECT_EQ(session.line(), 1U);
  EXPECT_EQ(session.state().scans, 20U);
  session("rn");
  EXPECT_EQ(session.state().scans, 19U);
  session("rn 5");
  EXPECT_EQ(session.line(), 1U);
  EXPECT_EQ(session.state().scans, 14U);
}

TEST(Debugger, BackwardsContinueStopsWhereContinueStopped) {
  AtPrompt session(kNested);
  session("watch VW30; break 17");
  std::vector<serial::Simulation::Snapshot> stops;
  for (int i = 0; i < 5; ++i) {
    session("continue");
    stops.push_back(session.simulation.snapshot());
  }
  session("continue 2ms");
  for (; !stops.empty(); stops.pop_back()) {
    session("rc");
    EXPECT_TRUE(session.simulation.snapshot() == stops.back()) << stops.size();
  }
  EXPECT_TRUE(has(session("rc"), "this is the oldest moment"));
  EXPECT_EQ(session.simulation.time(), 0);
}

TEST(Debugger, BackwardsUntilIsTheLastTimeItWasThere) {
  AtPrompt session(kNested);
  session("until 21; scan 3; rt INT 0");
  EXPECT_EQ(session.line(), 19U);
}

TEST(Debugger, AtGoesToAMomentAndSaysThatItIsThePast) {
  AtPrompt session(kNested);
  session("continue 50ms");
  const std::string text = session("at 15.193ms");
  EXPECT_GE(session.simulation.time(), 15'193'000);
  EXPECT_LT(session.simulation.time(), 16 * kMillisecond);
  EXPECT_TRUE(has(text, "in the past; going forward plays what has run, up to 50."));
  session("at -5ms");
  EXPECT_LT(session.simulation.time(), 11 * kMillisecond);
  session("at start");
  EXPECT_EQ(session.simulation.time(), 0);
  EXPECT_FALSE(has(session("at end"), "in the past"));
  EXPECT_GE(session.simulation.time(), 50 * kMillisecond);
}

TEST(Debugger, WhoNamesInstructionValuesInterruptAndTimeWithoutGoingThere) {
  AtPrompt session(kNested);
  session("continue 12ms");
  const auto here = session.simulation.snapshot();
  const std::string text = session("who VW30");
  EXPECT_TRUE(has(text, "VW30 was 16#0001 (1), became 16#0002 (2), at 10."));
  EXPECT_TRUE(has(text, "by INT 0 line 21    INCW    VW30"));
  EXPECT_TRUE(has(text, "VW30=16#0002, serving event 10 (timed interrupt 0, SMB34)"));
  EXPECT_EQ(session.simulation.snapshot(), here);
  session("rwho VW30");
  EXPECT_EQ(session.line(), 21U);
  EXPECT_EQ(session.vw(30), 1U);
}

TEST(Debugger, WhoKnowsWhatWasSetAndWhatTheSystemWrote) {
  AtPrompt session(kNested);
  session("step; set VW40=7; continue 10ms");
  EXPECT_TRUE(has(session("who VW40"), "by 'set VW40', from outside"));
  EXPECT_TRUE(has(session("who SM0.1"), "by the system, between two instructions"));
  EXPECT_TRUE(has(session("who VW500"), "nothing has written VW500 since power-up; it is 16#0000 (0)"));
}

TEST(Debugger, ChangingMemoryInThePastBeginsABranchAndBackReturnsToTheOldOne) {
  AtPrompt session(kNested);
  session("continue 50ms");
  const auto end = session.simulation.snapshot();
  EXPECT_TRUE(has(session("at 20ms; set VW30=100"), "a new branch begins here; what ran up to 50."));
  session("continue 10ms");
  EXPECT_GT(session.vw(30), 100U);
  session("back 3; at end");
  EXPECT_TRUE(session.simulation.snapshot() == end);
}

TEST(Debugger, ForwardFromThePastDoesAgainWhatWasDoneUntilABranchForgetsIt) {
  AtPrompt session(kNested);
  session("scan 3; set VW40=7; scan 3; at start; continue 40ms");
  EXPECT_EQ(session.vw(40), 7U);
  session("at start; fork; continue 40ms");
  EXPECT_EQ(session.vw(40), 0U);
}

TEST(Debugger, PastSaysHowFarBackItCanGoAndWhy) {
  AtPrompt session(kNested);
  const std::string text = session("continue 2s; past");
  EXPECT_TRUE(has(text, "from 0.000000 ms, where this session powered the CPU up, to 2000."));
  EXPECT_TRUE(has(text, "of 256 MB; 0 actions from outside"));
}

TEST(Debugger, ThePastOfAPowerCycleBeginsWherePowerCameBackAndBackLeadsBeforeIt) {
  AtPrompt session(kNested);
  session("continue 50ms; power 1h; continue 20ms");
  constexpr std::string_view kBegins = "power came back after 1 h ('back' leads to before that)";
  EXPECT_TRUE(has(session("past"), std::string("from 0.000000 ms, where ") + std::string(kBegins)));
  EXPECT_TRUE(has(session.error_of("at -150ms"), kBegins));
  EXPECT_TRUE(has(session("who VW500"), std::string("since ") + std::string(kBegins)));
  EXPECT_TRUE(has(session("rc"), kBegins));
  session("back 3");
  EXPECT_TRUE(has(session("past"), "where this session powered the CPU up"));
}

// --- observing changes nothing ---

TEST(Debugger, OneOfAThingIsNotInThePlural) {
  AtPrompt session(kEcho);
  const std::string text = session("scan 3; set VB100=1; past");
  EXPECT_TRUE(has(text, "\n1 checkpoint, one every"));
  EXPECT_TRUE(has(text, "; 1 action from outside\n"));
}

TEST(Debugger, SteppedRunAndPlainRunEndInTheSameState) {
  const auto program = program_of(kEcho);
  AtPrompt session(program);
  session("trace on; display VB0:4; watch VW40 SM0.6; break INT 1; break 6");
  session("step 9; over; scan; continue; send 5a; continue; regs; stack; port; errors; list; out");
  const Time sent = session.simulation.master().exchange().request_start;
  session("delete all");
  for (int i = 0; i < 200; ++i) session("step; over; until 6");
  session("back 30; scan; continue 3ms");
  session.debugger.reset();

  serial::Simulation plain(program);
  plain.power_up();
  plain.run_until(sent);
  plain.configure_master(plain.cpu().state().port[0].format);
  plain.master().start({.frame = {{0x5a, false}}}, plain.time());
  const Time end = session.simulation.time() + kSecond;
  plain.run_until(end);
  session.simulation.run_until(end);
  EXPECT_EQ(plain.master().exchange().response_bytes(), Bytes{0x5a});
  EXPECT_EQ(session.simulation.snapshot(), plain.snapshot());
}

// --- STOP and errors ---

TEST(Debugger, StopOfTheCpuIsReportedWithTheInstruction) {
  AtPrompt session("LD SM0.0\nSTOP // enough\nMEND\n");
  EXPECT_TRUE(has(session("continue"), "the CPU went to STOP; the last instruction was in main line 2: STOP"));
  const auto before = session.simulation.snapshot();
  EXPECT_TRUE(has(session("step; scan"), "the CPU is in STOP"));
  EXPECT_EQ(session.simulation.snapshot(), before);
  session("back");
  EXPECT_EQ(session.state().mode, Mode::Run);
}

TEST(Debugger, FatalErrorIsReportedWithItsMeaningAndPlace) {
  AtPrompt session("LBL 1\nLD SM0.0\nJMP 1\nMEND\n");
  const std::string text = session("continue");
  EXPECT_TRUE(has(text, "fatal error 0003, scan watchdog"));
  EXPECT_TRUE(has(text, "in main line"));
}

TEST(Debugger, RunTimeErrorIsReportedOnceARunWithHowManyMoreThereWere) {
  AtPrompt session("LD SM0.0\nMOVD 16#7FFFFFFF, VD100\nMOVB 1, *VD100\nMEND\n");
  const std::string text = session("step 3; continue 10ms");
  EXPECT_TRUE(has(text, "run-time error 0006"));
  EXPECT_TRUE(has(text, "*VD100=?"));
  EXPECT_TRUE(has(text, "more; 'errors' lists them"));
}

// --- looking ---

TEST(Debugger, RegsShowsWhatWaitsInTheQueues) {
  AtPrompt session("LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nINCW VW0\nMEND\nINT 0\nLD SM0.0\nINCW VW2\nINCW VW4\nRETI\n");
  session("scan 2; input I0.0=1; interrupt; input I0.0=0; step; input I0.0=1; step");
  EXPECT_TRUE(has(session("regs"), "waiting    "));
  EXPECT_TRUE(has(session.out.str(), "event 0"));
}

TEST(Debugger, RegsShowsWhereWithTheCallsAndAttachments) {
  AtPrompt session(kNested);
  const std::string text = session("break SBR 2; continue; regs");
  EXPECT_TRUE(has(text, "SBR 2 line 15, called in SBR 1 line 13, called in main line 2"));
  EXPECT_TRUE(has(text, "event 10 → INT 0  timed interrupt 0, SMB34, every 5 ms"));
  EXPECT_TRUE(has(text, "enabled (ENI)"));
  EXPECT_TRUE(has(session("stack"), "S0 1   S1 0"));
}

TEST(Debugger, ListMarksTheCurrentLineAndBreakpoints) {
  AtPrompt session(kNested);
  const std::string text = session("break 2; continue; over; list");
  EXPECT_TRUE(has(text, "*      2  CALL    1"));
  EXPECT_TRUE(has(text, " >     3  LD      SM0.0"));
  EXPECT_TRUE(has(text, "       4  INCW    VW10                 // one more scan"));
  EXPECT_TRUE(has(text, "       7  // The first"));
  EXPECT_TRUE(has(session("list INT 0"), "   19  INT     0"));
}

TEST(Debugger, DisplayComesAfterEveryStop) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("display VW20; until 18"), "VW20     16#0007"));
  EXPECT_FALSE(has(session("display off; step"), "VW20 "));
}

TEST(Debugger, ADoubleWordThatTheProgramUsesAsARealIsShownAsOneTooWhereverItIsShown) {
  AtPrompt session("LD SM0.0\nMOVR 1.5, VD20\n+R 1.0, VD20\nMOVR VD20, AC1\nMEND\n");
  EXPECT_TRUE(has(session("watch VD20 VD20:real; step 2"), "VD20=16#3FC00000 (1.5)"));
  EXPECT_TRUE(has(session.out.str(), "watch 1: VD20 was 16#00000000 (0, 0.0), is 16#3FC00000 (1069547520, 1.5)\n"));
  EXPECT_TRUE(has(session.out.str(), "watch 2: VD20:REAL was 16#00000000 (0.0), is 16#3FC00000 (1.5)\n"));
  EXPECT_TRUE(has(session("print VD20 VD20:real VD24"),
                  "VD20     16#3FC00000  1069547520             1.5\nVD20     16#3FC00000             1.5\n"
                  "VD24     16#00000000           0\n"));
  const std::string regs = session("delete all; step 2; regs");
  EXPECT_TRUE(has(regs, "AC0        16#00000000           0\nAC1        16#40200000  1075838976             2.5\n"));
}

TEST(Debugger, SetWritesMemoryWithOrWithoutBlanks) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("set VW100=5 VB102 = 16#FF; print VW100 VB102"), "VW100    16#0005"));
  EXPECT_TRUE(has(session.out.str(), "ff"));
}

// --- the language ---

TEST(Debugger, CommandsMayBeCutShortWhileTheyStayClear) {
  AtPrompt session(kNested);
  session("cont 5ms; s; ste");
  EXPECT_TRUE(has(session.error_of("de 1; re"), "no breakpoint or watch 1"));
  EXPECT_TRUE(has(session.error_of("re"), "'re' may be restart, regs"));
}

TEST(Debugger, EveryWrongCommandTellsWhatIsExpected) {
  AtPrompt session(kNested);
  const std::pair<std::string_view, std::string_view> wrong[] = {
      {"jump", "unknown command 'jump'; 'until' runs to a line; no command skips instructions"},
      {"step x", "step expects how many"},
      {"step 0", "step expects how many"},
      {"scan -1", "scan expects how many"},
      {"over 3", "over takes no argument"},
      {"out now", "out takes no argument"},
      {"back x", "back expects how many"},
      {"rstep x", "rstep expects how many"},
      {"rover 1", "rover takes no argument"},
      {"rscan 0", "rscan expects how many"},
      {"rcontinue 5ms", "rcontinue takes no argument"},
      {"runtil", "runtil expects a line number, SBR n, INT n, LBL n or NETWORK n"},
      {"at", "at expects a moment"},
      {"at 1h", "nothing has run after 0.000000 ms"},
      {"who", "who expects one address"},
      {"rwho VW1 VW2", "rwho expects one address"},
      {"past 1", "takes no argument"},
      {"continue 5", "continue expects a duration"},
      {"continue 0s", "continue expects a duration"},
      {"until", "until expects a line number, SBR n, INT n, LBL n or NETWORK n"},
      {"break main",
       "break expects a line number, SBR n, INT n, LBL n or NETWORK n; or what happens: event n, received, sent, xmt, rcv, "
       "error, overflow, lost, mode, unanswered, wrong"},
      {"break SBR", "break expects a line number, SBR n, INT n, LBL n or NETWORK n"},
      {"break INT x", "break expects a line number, SBR n, INT n, LBL n or NETWORK n"},
      {"break SBR 9", "the program has no SBR 9"},
      {"break if VW0 = 1", "break expects a place or what happens first"},
      {"break 4 if", "if expects a condition"},
      {"break 4 if VW0 >", "'VW0 >', column 6: an address or a number is missing"},
      {"break 4 if VW0 = 1 2", "column 9: an operator is missing"},
      {"break 4 if (VW0", "the closing ) is missing"},
      {"break 4 if VX", "is not an address"},
      {"break 4 hits 0", "hits expects a number above 0"},
      {"break 4 log '{VX}'", "is not an address"},
      {"break event 99", "break event expects the number of an event"},
      {"break error xyz", "break error expects nothing or a code in hex"},
      {"break mode 1", "break mode expects nothing more"},
      {"break network", "break expects a line number"},
      {"break 99", "the last instruction is in line 22"},
      {"list 99", "the last instruction is in line 22"},
      {"watch if VW2 > 8", "watch expects an address"},
      {"watch X1", "is not an address"},
      {"delete", "delete expects numbers"},
      {"delete x", "delete expects numbers"},
      {"delete 7", "there is no breakpoint or watch 7"},
      {"regs 1", "takes no argument"},
      {"print", "print expects addresses"},
      {"print VB99999", "does not exist on CPU 214"},
      {"set", "set expects an address and a value"},
      {"set VB0=300", "a value that fits"},
      {"set =5", "is not an address"},
      {"input Q0.0=1", "is not an input"},
      {"input", "input expects an input"},
      {"send", "send expects a frame in hex"},
      {"send crc", "send expects a frame in hex"},
      {"send 0g", "column 2: 'g' is not a hex digit"},
      {"send 'A\\q'", "send 'A\\q': column 3: \\ is followed by r, n, t, xHH"},
      {"send 'A ; # B", "send 'A ; # B: column 1: the closing ' is missing"},
      {"send 'A' 42", "column 4: nothing follows the closing quotation mark"},
      {"trace", "trace expects on or off"},
      {"help x", "unknown command 'x'"},
      {"quit 1", "takes no argument"},
  };
  const auto before = session.simulation.snapshot();
  for (const auto& [command, message] : wrong) EXPECT_TRUE(has(session.error_of(command), message)) << command;
  EXPECT_EQ(session.simulation.snapshot(), before);
}

TEST(Debugger, WhatTakesATimeNamesItsUnits) {
  AtPrompt session(kNested);
  for (const char* wrong : {"continue 20m", "at 20m", "power 20m"})
    EXPECT_TRUE(has(session.error_of(wrong), "in ns, us, ms, s, min or h")) << wrong;
  for (const char* command : {"help continue", "help at", "help power"})
    EXPECT_TRUE(has(session(command), "in ns, us, ms, s, min or h")) << command;
  EXPECT_EQ(kTimeUnits, "ns, us, ms, s, min or h");
  for (const char* unit : {"ns", "us", "ms", "s", "min", "h"}) EXPECT_TRUE(parse_duration(std::string("20") + unit)) << unit;
}

TEST(Debugger, WrongAssignmentMeansThatNoneOfItsLineIsMade) {
  AtPrompt session(kNested);
  session.error_of("set VW100=5 VB102=300");
  EXPECT_EQ(session.vw(100), 0U);
}

TEST(Debugger, ScriptEndsAtTheFirstWrongCommandWithItsLine) {
  AtPrompt session(kNested);
  std::istringstream script("# a comment\n\nstep # and one after\nstep; jmp; step\nstep\n");
  const auto error = session.debugger->run_script(script);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->line, 4U);
  EXPECT_TRUE(has(error->message, "unknown command 'jmp'"));
  EXPECT_EQ(session.state().instructions, 2U);
}

TEST(Debugger, ScriptEchoesEachCommandInFrontOfWhatItPrints) {
  AtPrompt session(kNested);
  std::istringstream script("step; stack # look\n");
  EXPECT_FALSE(session.debugger->run_script(script).has_value());
  EXPECT_TRUE(session.out.str().starts_with("(s7200) step\n"));
  EXPECT_TRUE(has(session.out.str(), "(s7200) stack\nS0 1"));
}

TEST(Debugger, ScriptEndsAtQuitAndAtItsEnd) {
  AtPrompt session(kNested);
  std::istringstream script("step\r\nquit\r\nstep\r\n"), no_line_end("step");
  EXPECT_FALSE(session.debugger->run_script(script).has_value());
  EXPECT_EQ(session.state().instructions, 1U);
  EXPECT_TRUE(session.debugger->quit_asked());
  AtPrompt other(kNested);
  EXPECT_FALSE(other.debugger->run_script(no_line_end).has_value());
  EXPECT_EQ(other.state().instructions, 1U);
}

TEST(Debugger, OnlyCommandsThatRunAreRepeatable) {
  AtPrompt session(kNested);
  session("step 2");
  EXPECT_EQ(session.debugger->repeatable(), "step 2");
  session("regs");
  EXPECT_EQ(session.debugger->repeatable(), "");
}

TEST(Debugger, HelpExplainsEveryCommand) {
  AtPrompt session(kNested);
  std::istringstream list(session("help"));
  EXPECT_TRUE(has(session("help watch"), "short: w"));
  EXPECT_TRUE(has(session("help send"), "p after a byte"));
  EXPECT_TRUE(has(session("help; help quit"), "continue [TIME]"));
}

TEST(Debugger, EveryFaultInAHelpTextIsOneThatIsAccepted) {
  AtPrompt session(kEcho);
  for (const std::string command : {"fault", "help fault"}) {
    const std::string text = session(command);
    int examples = 0;
    for (std::size_t at = 0; (at = text.find("fault ", at)) != std::string::npos; at += 6) {
      const std::string fault = text.substr(at + 6, text.find_first_of(" \n;", at + 6) - at - 6);
      if (fault.find('=') == std::string::npos || fault.front() == 'K') continue;  // KIND is a place holder
      ++examples;
      EXPECT_EQ(session.error_of("fault " + fault.substr(0, fault.find_last_not_of(",.") + 1)), "no error");
    }
    EXPECT_GT(examples, 0) << text;
  }
}

// --- the tip document ---

TEST(Debugger, StepsThroughTheTipDocument) {
  const auto bytes = read_file(test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt"));
  if (!bytes) GTEST_SKIP() << "the tip document is not here: " << bytes.why();
  auto text = read_source(*bytes, "tip");
  ASSERT_TRUE(text.has_value()) << text.why();
  AtPrompt session(check(std::move(text->parsed), cpu214(), default_times(cpu214())).program);

  EXPECT_TRUE(has(session("continue 2s; break INT 123; send 01 03 00 00 00 02 crc; continue"), "breakpoint 1"));
  EXPECT_TRUE(has(session("print SMB2"), "SMB2     03"));
  EXPECT_TRUE(session.state().in_interrupt);
  session("out; delete all; break SBR 51; continue; step 4");
  const auto in_front_of_call = session.simulation.snapshot();
  session("over");
  EXPECT_EQ(session.state().call_depth, 1);
  session("back; step; out");
  EXPECT_EQ(session.state().call_depth, 1);
  session("back 2");
  EXPECT_EQ(session.simulation.snapshot(), in_front_of_call);
  EXPECT_TRUE(has(session("delete all; continue"), "2 registers: 16#0000 16#0000"));
}

TEST(Debugger, AfterAStopRequestTheRestOfALineIsNotDoneAndCounted) {
  std::atomic<bool> stop = true;
  AtPrompt session(program_of(kNested), StopToken(stop));
  const std::string text = session("scan 5; step; set VW100=7 # not this; nor this");
  EXPECT_TRUE(has(text, "interrupted by Ctrl-C"));
  EXPECT_TRUE(has(text, "not done any more: 2 commands\n"));
  EXPECT_EQ(session.vw(100), 0);
  EXPECT_FALSE(has(session("scan 5"), "not done")) << "nothing was left";
  stop = false;
  EXPECT_FALSE(has(session("scan 1; set VW100=7"), "not done"));
  EXPECT_EQ(session.vw(100), 7);
}

TEST(Debugger, AfterAStopRequestTheRestOfAScriptIsNotDoneAndCounted) {
  std::atomic<bool> stop = true;
  AtPrompt session(program_of(kNested), StopToken(stop));
  std::istringstream script("scan 5; step ; ;\n\n# a comment\nset VW100=7\n");
  EXPECT_FALSE(session.debugger->run_script(script));
  EXPECT_TRUE(has(session.out.str(), "not done any more: 3 commands\n"));
  session.out.str("");
  std::istringstream pipe("scan 5\nstep\n");
  EXPECT_FALSE(session.debugger->run_script(pipe, false));
  EXPECT_FALSE(has(session.out.str(), "not done")) << "what is still to come over a pipe is not known";
}

TEST(Debugger, TheFieldHasItsLevelsWhenPowerComesBack) {
  AtPrompt session("LD I0.3\n= Q0.0\nMEND\n");
  session("input I0.3=1; continue 20ms; power; continue 20ms");
  EXPECT_TRUE(has(session("print I0.3"), "1"));
  EXPECT_TRUE(has(session("print Q0.0"), "1"));
  session("input I0.3=0; power; continue 20ms");
  EXPECT_TRUE(has(session("print I0.3"), "0"));
  session("at start; step");
  EXPECT_TRUE(has(session("print I0.3"), "0"));
}

TEST(Debugger, ATimeFromThePastOnEndsWhereItEndsWhereverScansArePassedOver) {
  serial::Simulation simulation(program_of("LD I0.0\n= Q0.0\nMEND\n"));
  simulation.power_up();
  std::ostringstream out;
  PromptSettings options{};
  options.history.drive = [&](Time end, const auto&) {  // Ctrl-C between two scans
    const serial::Halt halt = simulation.run_until(std::min<Time>(end, 700 * kMillisecond));
    return simulation.time() < end ? serial::Halt::Request : halt;
  };
  Prompt debugger(std::vector{&simulation}, out, options);
  EXPECT_FALSE(debugger.execute("continue 60s; at 300ms; continue 10ms"));
  EXPECT_GE(simulation.time(), 310 * kMillisecond);
  EXPECT_LT(simulation.time(), 312 * kMillisecond);
}

TEST(Debugger, APeerThatIsLostIsSaidOnceAndTheSessionGoesOn) {
  serial::Simulation simulation(program_of("LD SM0.0\nINCW VW0\nMEND\n"));
  simulation.power_up();
  std::ostringstream out;
  PromptSettings options{};
  std::string failure = "the device is gone";
  options.history.drive = [&](Time end, const auto&) {
    const serial::Halt halt = simulation.run_until(failure.empty() ? end : std::min<Time>(end, 5 * kMillisecond));
    return failure.empty() ? halt : serial::Halt::Request;
  };
  options.session.take_failure = [&] { return std::exchange(failure, {}); };
  Prompt debugger(std::vector{&simulation}, out, options);
  EXPECT_FALSE(debugger.execute("continue 60s"));
  EXPECT_TRUE(has(out.str(), "the device is gone\n"));
  EXPECT_FALSE(has(out.str(), "Ctrl-C"));
  out.str("");
  EXPECT_FALSE(debugger.execute("continue 10ms"));
  EXPECT_TRUE(has(out.str(), "10 ms of simulated time passed"));
  EXPECT_FALSE(has(out.str(), "gone"));
}

}  // namespace
}  // namespace s7200::tools::debugger_test
