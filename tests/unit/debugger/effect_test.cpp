// What `effect` says came of a change.
#include <fstream>

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/debugger/system_session.hpp"

namespace s7200::tools::effect_test {
namespace {

std::shared_ptr<const Program> for_effects(std::string_view text) {
  return check_text(text, "test.awl", cpu224(), default_times(cpu224())).program;
}

TEST(Effect, ABitThatARungReadsIsAboveWhatItWrites) {
  AtPrompt session(for_effects("LD I0.2\nA I0.3\n= Q0.0\nLD Q0.0\n= Q0.1\nLD I0.4\n= Q0.2\nMEND\n"));
  session("continue 20ms; input I0.3=1; continue 20ms; input I0.2=1; continue 100ms; input I0.4=1; continue 100ms");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "I0.2 was 0, became 1, at 40."));
  EXPECT_TRUE(
      has(text, " by 'input I0.2', from outside\n  unlike the same run in which it stays 0:\n  Q0.0 is 1, not 0, from 4"));
  EXPECT_TRUE(has(text, " on: = Q0.0 in line 3, after LD I0.2 in line 1\n    Q0.1 is 1, not 0, from 4")) << text;
  EXPECT_TRUE(has(text, ": = Q0.1 in line 5, after LD Q0.0 in line 4\n")) << text;
  EXPECT_FALSE(has(text, "Q0.2")) << text;
  EXPECT_TRUE(has(text, "(where what is known ends) the runs still differ: Q0.0, Q0.1\n")) << text;
}

TEST(Effect, WhatWouldHaveComeAnywayIsNone) {
  AtPrompt session(for_effects("LD I0.2\nO I0.3\n= Q0.0\nMEND\n"));
  session("continue 20ms; input I0.3=1; continue 50ms; input I0.2=1; continue 100ms");
  EXPECT_TRUE(has(session("effect I0.2"), "  nothing came of it: all else is as in the same run in which it stays 0\n"));
}

TEST(Effect, OfAPulseItIsFollowedWhatTheOffDelayMakesOfIt) {
  AtPrompt session(for_effects("LD I0.2\nTOF T37, 3\nLD T37\n= Q0.0\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 50ms; input I0.2=0; continue 2s");
  const std::string on = session("effect I0.2 at 60ms");
  EXPECT_TRUE(has(on, "became 1, at 20.")) << on;
  EXPECT_TRUE(has(on, ", when it changes again:\n")) << on;
  EXPECT_TRUE(has(on, "the bit of T37 is 1, not 0, from ")) << on;
  EXPECT_TRUE(has(on, ": = Q0.0 in line 4, after LD T37 in line 3\n")) << on;
  EXPECT_TRUE(has(on, "(where what is known ends) the runs still differ: T37\n")) << on << "its value stays";
}

TEST(Effect, ATimerCountsAndItsBitFollows) {
  AtPrompt session(for_effects("LD I0.2\nTON T37, 3\nLD T37\nS Q0.0, 1\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 1s");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "\n  T37 is ")) << text;
  EXPECT_TRUE(has(text, "TON T37, 3 in line 2, after LD I0.2 in line 1\n")) << text;
  EXPECT_TRUE(has(text, "\n    the bit of T37 is 1, not 0, from ")) << text;
  EXPECT_TRUE(has(text, "\n      Q0.0 is 1, not 0, from ")) << text;
  EXPECT_TRUE(has(text, "S Q0.0, 1 in line 4, after LD T37 in line 3\n")) << text;
}

TEST(Effect, ACounterThatCountsLeadsToTheStepItSwitches) {
  AtPrompt session(
      for_effects("LD I0.2\nLD I0.3\nCTU C5, 2\nLD SM0.1\nS S0.1, 1\nLSCR S0.1\nLD C5\nSCRT S0.2\nSCRE\n"
                  "LSCR S0.2\nLD SM0.0\n= Q0.5\nSCRE\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 20ms; input I0.2=0; continue 20ms; input I0.2=1; continue 200ms");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "\n  C5 is 16#0002 (2), not 16#0001 (1), from ")) << text;
  EXPECT_TRUE(has(text, "the bit of C5 is 1, not 0")) << text;
  EXPECT_TRUE(has(text, "S0.2 is 1, not 0")) << text;
  EXPECT_TRUE(has(text, "S0.1 is 0, not 1")) << text;
  EXPECT_TRUE(has(text, "LSCR S0.2 in line 10 is active, from ")) << text;
  EXPECT_TRUE(has(text, "  Q0.5 is 1, not 0, from ")) << text;
}

TEST(Effect, ACallThatIsNotMadeOtherwiseIsAboveWhatItsSubroutineWrites) {
  AtPrompt session(for_effects("LD I0.2\nCALL 1\nMEND\nSBR 1\nLD SM0.0\nMOVW 7, VW20\nRET\n"));
  session("continue 20ms; input I0.2=1; continue 100ms");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "\n  CALL 1 in line 2 is executed, from ")) << text;
  EXPECT_TRUE(has(text, "\n    VW20 is 16#0007 (7), not 16#0000 (0), from ")) << text;
}

TEST(Effect, AJumpThatGoesAnotherWayIsAboveWhatItLeavesOut) {
  AtPrompt session(for_effects("LD I0.2\nJMP 1\nLD SM0.0\nINCW VW20\nLBL 1\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 300ms");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "\n  JMP 1 in line 2 jumps, from ")) << text;
  EXPECT_TRUE(has(text, "\n    VW20 is ")) << text;
  EXPECT_TRUE(has(text, "INCW VW20 in line 4\n")) << text;
}

TEST(Effect, AccumulatorsAndPointersHandOn) {
  AtPrompt session(for_effects("LD SM0.0\nMOVW VW10, AC0\n+I 1, AC0\nMOVD &VB100, VD30\nMOVW AC0, *VD30\nMEND\n"));
  session("continue 20ms; set VW10=5; continue 100ms");
  const std::string text = session("effect VW10");
  EXPECT_TRUE(has(text, "VW10 was 16#0000 (0), became 16#0005 (5), at ")) << text;
  EXPECT_TRUE(has(text, "AC0 is ")) << text;
  EXPECT_TRUE(has(text, "VW100 is 16#0006 (6), not 16#0001 (1), from ")) << text;
  EXPECT_TRUE(has(text, ": MOVW AC0, *VD30 in line 5\n")) << text;
}

constexpr std::string_view kCountsEdges = "LD I0.0\nEU\nINCW VW0\nLD SM0.0\n";

/// The effects of I0.0 in a program that counts its edges in VW0, and hands that on.
std::string effects_of_an_edge(std::string_view hands_on) {
  AtPrompt session(for_effects(std::string(kCountsEdges) + std::string(hands_on)));
  session("continue 100ms; input I0.0=1; continue 100ms");
  return session("effect I0.0") + session("effect VW0");
}

TEST(Effect, AWordThatIsWrittenTwiceInAScanHandsOnWhatItHadInBetween) {
  for (const std::string_view between : {"AC0", "VW30", "LW2", "QW2"}) {
    const std::string word(between);
    const std::string text = effects_of_an_edge("MOVW VW0, " + word + "\n+I 3, " + word + "\nMOVW " + word +
                                                ", VW20\nLDW>= VW20, 4\n= Q0.0\nMEND\n");
    EXPECT_TRUE(has(text, "VW20 is 16#0004 (4), not 16#0003 (3), from 10")) << text;
    EXPECT_TRUE(has(text, ": MOVW " + word + ", VW20 in line 7\n")) << text;
    EXPECT_TRUE(has(text, "Q0.0 is 1, not 0, from 10")) << text;
    EXPECT_FALSE(has(text, "only because scans take other times")) << text;
    EXPECT_FALSE(has(text, "nothing came of it")) << text;
  }
}

TEST(Effect, WhatAnAccumulatorHadIsToldOfEachOfItsInstructions) {
  const std::string text = effects_of_an_edge("MOVW VW0, AC0\n+I 3, AC0\nMOVW AC0, VW20\nMEND\n");
  EXPECT_TRUE(has(text, "AC0 is 16#0001 (1), not 16#0000 (0), from 10")) << text;
  EXPECT_TRUE(has(text, " on: MOVW VW0, AC0 in line 5\n")) << text;
  EXPECT_TRUE(has(text, "AC0 is 16#0004 (4), not 16#0003 (3), from 10")) << text;
  EXPECT_TRUE(has(text, " on: +I 3, AC0 in line 6\n")) << text;
}

TEST(Effect, AWordHasWhatTheLastOfItsInstructionsHasWrittenInAScan) {
  const std::string text = effects_of_an_edge("MOVW VW0, VW30\n+I 3, VW30\nMOVW VW30, VW40\nMEND\n");
  EXPECT_TRUE(has(text, "VW30 is 16#0004 (4), not 16#0003 (3), from 10")) << text;
  EXPECT_TRUE(has(text, " on: +I 3, VW30 in line 6, after MOVW VW0, VW30 in line 5\n")) << text;
}

TEST(Effect, AnAccumulatorThatIsWrittenAnewHandsOnNothingOfWhatItHadBefore) {
  const std::string text =
      effects_of_an_edge("MOVW VW0, AC0\nMOVW AC0, VW20\nMOVW VW50, AC0\n+I 1, AC0\nMOVW AC0, VW52\nINCW VW50\nMEND\n");
  EXPECT_TRUE(has(text, "VW20 is 16#0001 (1), not 16#0000 (0), from 10")) << text;
  EXPECT_FALSE(has(text, "VW52 is")) << text;
}

constexpr std::string_view kAddsThree =
    "SUBROUTINE_BLOCK ramp:SBR0\nVAR_INPUT\ncount : INT;\nEND_VAR\nVAR_OUTPUT\nres : INT;\nEND_VAR\n"
    "VAR\ntmp : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW #count, #tmp\n+I 3, #tmp\nMOVW #tmp, #res\n"
    "END_SUBROUTINE_BLOCK\nORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD I0.0\nEU\nINCW VW0\n"
    "NETWORK 2\nLD SM0.0\nCALL ramp, VW0, VW20\nEND_ORGANIZATION_BLOCK\n";

TEST(Effect, AParameterThatASubroutineCountsWithComesBackOtherwise) {
  AtPrompt session(for_effects(kAddsThree));
  session("continue 100ms; input I0.0=1; continue 100ms");
  for (const std::string_view asked : {"effect I0.0", "effect VW0"}) {
    const std::string text = session(asked);
    EXPECT_TRUE(has(text, "VW20 is 16#0004 (4), not 16#0003 (3), from 10")) << text;
    EXPECT_FALSE(has(text, "only because scans take other times")) << text;
  }
}

TEST(Effect, ACallThatIsMadeIsExecutedWhicheverOfTheRunsComesToItFirst) {
  AtPrompt session(
      for_effects("LD I0.0\nTON T37, 5\nLD T37\nEU\nS M0.0, 1\nLD M0.0\nCALL 1\nMEND\nSBR 1\nLD SM0.0\n"
                  "INCW VW200\nRET\n"));
  session("continue 100ms; input I0.0=1; continue 1s");
  for (const std::string_view asked : {"effect T37", "effect M0.0", "effect I0.0"}) {
    const std::string text = session(asked);
    EXPECT_TRUE(has(text, "CALL 1 in line 7 is executed, from 6")) << text;
    EXPECT_FALSE(has(text, "is not executed")) << text;
  }
}

TEST(Effect, APointerThatPointsElsewhereIsAboveWhatIsWrittenThere) {
  AtPrompt session(for_effects("LD SM0.1\nMOVD &VB100, VD30\nLD SM0.0\nMOVB 9, *VD30\nMEND\n"));
  session("continue 20ms; set VD30=&VB200; continue 100ms");
  const std::string text = session("effect VD30");
  EXPECT_TRUE(has(text, "\n  VB200 is 16#09 (9), not 16#00 (0), from ")) << text;
}

TEST(Effect, AnEdgeThatStartsAnInterruptIsAboveWhatItsRoutineWrites) {
  AtPrompt session(for_effects("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW40\nRETI\n"));
  session("continue 20ms; input I0.0=1; continue 100ms");
  const std::string text = session("effect I0.0");
  EXPECT_TRUE(has(text, "\n  INT 0 runs for event 0 (")) << text;
  EXPECT_TRUE(has(text, "\n    VW40 is 16#0001 (1), not 16#0000 (0), from ")) << text;
}

TEST(Effect, CharactersThatAreSentAreEffectsToo) {
  AtPrompt session(
      for_effects("LD SM0.1\nMOVB 16#09, SMB30\nMOVB 1, VB0\nMOVB 16#41, VB1\nLD I0.2\nEU\nXMT VB0, 0\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 100ms");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "\n  XMT VB0, 0 in line 7 is executed, at ")) << text;
  EXPECT_TRUE(has(text, "\n    port 0 sends 41, at ")) << text;
}

TEST(Effect, WhatTheProgramWroteIsFollowedAsWhatSomebodySet) {
  AtPrompt session(for_effects("LD I0.2\n= M0.0\nLD M0.0\n= Q0.0\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 100ms; input I0.2=0; continue 100ms");
  const std::string text = session("effect M0.0 at 100ms");
  EXPECT_TRUE(has(text, "M0.0 was 0, became 1, at ")) << text;
  EXPECT_TRUE(has(text, " by = M0.0 in line 2\n")) << text;
  EXPECT_TRUE(has(text, "\n  Q0.0 is 1, not 0, from ")) << text;
  EXPECT_TRUE(has(text, "  all is alike again from ")) << text;
}

constexpr std::string_view kScaled =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Scale, I0.2, VW10, M0.0, VW20\nLD M0.0\n= Q0.0\n"
    "LDW> VW20, 100\n= Q0.1\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK Scale:SBR0\nVAR_INPUT\non : BOOL; raw : INT;\nEND_VAR\n"
    "VAR_OUTPUT\nruns : BOOL; result : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD #on\n= #runs\nLD SM0.0\nMOVW #raw, #result\n"
    "+I 90, #result\nEND_SUBROUTINE_BLOCK\n";

TEST(Effect, ParametersOfASubroutineHandOnInAndOut) {
  AtPrompt session(for_effects(kScaled));
  session("continue 20ms; input I0.2=1; continue 100ms; set VW10=11; continue 100ms");
  const std::string bit = session("effect I0.2");
  EXPECT_TRUE(has(bit, "M0.0 is 1, not 0, from ")) << bit;
  EXPECT_TRUE(has(bit, "Q0.0 is 1, not 0, from ")) << bit;
  EXPECT_FALSE(has(bit, "Q0.1")) << bit;
  EXPECT_FALSE(has(bit, "only because scans take other times")) << bit;
  const std::string word = session("effect VW10");
  EXPECT_TRUE(has(word, "VW20 is 16#0065 (101), not 16#005A (90), from ")) << word;
  EXPECT_TRUE(has(word, "Q0.1 is 1, not 0, from ")) << word;
  EXPECT_FALSE(has(word, "Q0.0")) << word;
  EXPECT_FALSE(has(word, "only because scans take other times")) << word;
}

/// An interrupt comes within each call, while it loops.
constexpr std::string_view kInterrupted =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\n"
    "NETWORK 2\nLD SM0.0\nCALL Copy, VW10, VW20\nLDW> VW20, 100\n= Q0.6\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK Copy:SBR1\nVAR_INPUT\nin1 : INT;\nEND_VAR\nVAR_OUTPUT\nout1 : INT;\nEND_VAR\nBEGIN\nNETWORK 1\n"
    "LD SM0.0\nFOR VW50, 1, 300\nINCW VW52\nNEXT\nMOVW #in1, #out1\nEND_SUBROUTINE_BLOCK\n"
    "INTERRUPT_BLOCK INT_0:INT0\nBEGIN\nNETWORK 1\nLD SM0.0\nINCW VW40\nMOVW 7, LW0\nMOVW VW40, AC0\n"
    "END_INTERRUPT_BLOCK\n";

std::string effect_of_vw10(std::string_view program) {
  AtPrompt session(for_effects(program));
  session("set VW10=200; continue 1s; set VW10=90; continue 1s");
  return session("effect VW10");
}

TEST(Effect, AnInterruptTakesNoParameterFromTheSubroutineItInterrupts) {
  const std::string text = effect_of_vw10(kInterrupted);
  EXPECT_TRUE(has(text, " VW20 is 16#005A (90), not 16#00C8 (200), from ")) << text;
  EXPECT_TRUE(has(text, " Q0.6 is 0, not 1, from ")) << text;
  EXPECT_FALSE(has(text, "only because scans take other times: VW20")) << text;
}

TEST(Effect, AnInterruptGivesBackTheAccumulatorsThatItUses) {
  const std::string text =
      effect_of_vw10(test::changed(test::changed(std::string(kInterrupted), "FOR VW50", "MOVW #in1, AC0\nFOR VW50"),
                                   "MOVW #in1, #out1", "MOVW AC0, #out1"));
  EXPECT_TRUE(has(text, " VW20 is 16#005A (90), not 16#00C8 (200), from ")) << text;
  EXPECT_FALSE(has(text, "only because scans take other times: VW20")) << text;
}

TEST(Effect, ASubroutineFindsItsParametersAgainAfterACall) {
  const std::string text = effect_of_vw10(
      test::changed(test::changed(std::string(kInterrupted), "FOR VW50, 1, 300\nINCW VW52\nNEXT", "CALL Other, 5"),
                    "INTERRUPT_BLOCK INT_0",
                    "SUBROUTINE_BLOCK Other:SBR2\nVAR_INPUT\nin1 : INT;\nEND_VAR\nBEGIN\nNETWORK 1\n"
                    "LD SM0.0\nMOVW #in1, VW60\nEND_SUBROUTINE_BLOCK\nINTERRUPT_BLOCK INT_0"));
  EXPECT_TRUE(has(text, " VW20 is 16#005A (90), not 16#00C8 (200), from ")) << text;
  EXPECT_FALSE(has(text, "only because scans take other times: VW20")) << text;
}

TEST(Effect, AMessageIsStoredBecauseOfWhatStartedItsRcv) {
  AtPrompt session(for_effects(
      "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 16#B0, SMB87\nMOVB 16#0D, SMB89\nMOVW 5, SMW90\nMOVB 10, SMB94\nATCH 0, 23\nENI\n"
      "LD I0.2\nEU\nRCV VB100, 0\nLDB= VB101, 16#41\n= Q0.0\nMEND\nINT 0\nLD SM0.0\nINCW VW40\nRETI\n"));
  session("continue 20ms; input I0.2=1; continue 50ms; send 41 42 0d; continue 300ms");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "VB101 is 16#41 (65), not 16#00 (0), from ")) << text;
  EXPECT_TRUE(has(text, ": RCV VB100, 0 in line 11, after LD I0.2 in line 9\n")) << text;
  EXPECT_TRUE(has(text, "Q0.0 is 1, not 0, from ")) << text;
  EXPECT_TRUE(has(text, "INT 0 runs for event 23 (")) << text;
  EXPECT_TRUE(has(text, "\n    VW40 is 16#0001 (1), not 16#0000 (0), from ")) << text;
  EXPECT_FALSE(has(text, "only because scans take other times")) << text;
}

TEST(Effect, WhatNetrAndNetwLetTheSystemStoreComesOfThem) {
  const std::string folder = test::scratch_folder();
  std::ofstream(folder + "other.stl") << "LD SM0.1\nMOVB 7, VB0\nSPA VB0, 0\nMOVB 9, VB500\nMEND\n";
  for (const std::string_view job : {"NETR", "NETW"}) {
    std::ofstream(folder + "asks.stl") << "LD SM0.1\nMOVB 2, SMB30\nMOVB 7, VB101\nMOVD &VB500, VD102\nMOVB 1, VB106\n"
                                       << "LD I0.2\nEU\n"
                                       << job << " VB100, 0\nLDB= VB107, 9\n= Q0.0\nLD V100.7\n= Q0.1\nMEND\n";
    SystemSession session("plcs:\n  asks: {program: " + folder + "asks.stl, cpu: 224}\n  other: {program: " + folder +
                              "other.stl, cpu: 224}\nlines: {bus: {stations: [asks, other]}}\n",
                          0);
    session("continue 50ms; input I0.2=1; continue 500ms");
    const std::string text = session("effect I0.2");
    EXPECT_TRUE(has(text, "VB100 is ")) << text;
    EXPECT_TRUE(has(text, std::string(job) + " VB100, 0 in line 8")) << text;
    EXPECT_TRUE(has(text, "Q0.1 is 1, not 0, from ")) << text;
    EXPECT_EQ(has(text, "VB107 is 16#09 (9), not 16#00 (0), from "), job == "NETR") << text;
    EXPECT_EQ(has(text, "Q0.0 is 1, not 0, from "), job == "NETR") << text;
    EXPECT_FALSE(has(text, "only because scans take other times")) << text;
  }
}

TEST(Effect, AFatalErrorAndItsStopAreNamed) {
  AtPrompt session(for_effects("LD I0.2\nJMP 2\nJMP 3\nLBL 2\nLBL 4\nJMP 4\nLBL 3\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 2s");
  const std::string text = session("effect I0.2");
  EXPECT_TRUE(has(text, "fatal error ")) << text;
  EXPECT_TRUE(has(text, "the CPU goes to STOP")) << text;
}

TEST(Effect, WhatTurnsBeforeTheFirstScanOrJustBeforeNowIsFollowedToo) {
  AtPrompt session(for_effects("LD I0.2\nS Q0.0, 1\nMEND\n"));
  session("input I0.2=1; scan 3");
  EXPECT_TRUE(has(session("effect I0.2"), "\n  Q0.0 is 1, not 0, from "));
}

TEST(Effect, ItLeavesTheSessionWhereItStands) {
  AtPrompt session(for_effects("LD I0.2\n= Q0.0\nMEND\n"));
  session("continue 20ms; input I0.2=1; continue 100ms; at 60ms");
  const std::string before = session("regs; past");
  session("effect I0.2; effect I0.2 at 80ms within 10ms");
  EXPECT_EQ(session("regs; past"), before);
}

TEST(Effect, WhatCannotBeAskedSaysWhy) {
  AtPrompt session(for_effects("LD I0.2\n= Q0.0\nMEND\n"));
  session("continue 20ms");
  EXPECT_TRUE(has(session("effect I0.2"), "I0.2 is 0; nothing has changed it since power-up\n"));
  EXPECT_TRUE(has(session.error_of("effect"), "effect expects one address"));
  EXPECT_TRUE(has(session.error_of("effect AC0"), "AC0 holds values for a moment only"));
  EXPECT_TRUE(has(session.error_of("effect I0.2 within 0ms"), "a duration above 0"));
  EXPECT_TRUE(has(session.error_of("effect I0.2 at"), "a time after at"));
}

}  // namespace
}  // namespace s7200::tools::effect_test
