// What `why not` and `until` say holds a bit off.
#include <fmt/ranges.h>

#include "tests/unit/debugger/session.hpp"
#include "tools/session/causes/why_not.hpp"

namespace s7200::tools::why_not_test {
namespace {

std::shared_ptr<const Program> on_cpu224(std::string_view text) {
  return check_text(text, "test.awl", cpu224(), default_times(cpu224())).program;
}

constexpr std::string_view kRungs =
    "NETWORK 1\n"
    "LD I0.0\n"
    "A I0.1\n"
    "LD I0.2\n"
    "AN I0.3\n"
    "OLD\n"
    "A I0.4\n"
    "= Q0.0\n"
    "NETWORK 2\n"
    "LD I0.5\n"
    "LPS\n"
    "A I0.6\n"
    "= Q0.1\n"
    "LRD\n"
    "LD I0.7\n"
    "O M0.0\n"
    "ALD\n"
    "= Q0.2\n"
    "LPP\n"
    "NOT\n"
    "= Q0.3\n"
    "NETWORK 3\n"
    "LD I1.0\n"
    "S M1.0, 1\n"
    "LD I1.1\n"
    "O I1.2\n"
    "R M1.0, 1\n"
    "LD I1.3\n"
    "JMP 5\n"
    "LD I1.4\n"
    "= Q0.5\n"
    "LBL 5\n"
    "LD I1.5\n"
    "AENO\n"
    "= Q0.6\n"
    "MEND\n";

TEST(WhyNot, AnInputThatTwoContactsLookAtChangesOnce) {
  AtPrompt session(on_cpu224("LD I0.0\nA I0.1\nS Q0.0, 1\nLD I0.2\nON I0.1\nR Q0.0, 1\n"));
  session("input I0.0=1; scan 3");
  const std::string text = session("why not Q0.0");
  EXPECT_TRUE(has(text, "  1 contact has to change:\n    I0.1 is 0 ")) << text;
}

TEST(WhyNot, OfContactsThatLookAtTheSameTheOneInTheRungIsNamed) {
  AtPrompt session(
      on_cpu224("LD I0.0\n= Q0.0\nLDN I0.0\n= Q0.1\nLD I0.0\nA I0.1\n= Q0.2\nLDW>= VW0, 5\n= Q0.3\n"
                "LDW< VW0, 5\nA I0.1\n= Q0.4\nMEND\n"));
  session("input I0.0=1; scan 3");
  EXPECT_TRUE(has(session("why not Q0.1"), ", must be 0 (LDN I0.0 in line 3): an input\n"));
  session("input I0.0=0 I0.1=1; set VW0=7; scan 3");
  EXPECT_TRUE(has(session("why not Q0.2"), ", must be 1 (LD I0.0 in line 5): an input\n"));
  const std::string compared = session("why not Q0.4");
  EXPECT_TRUE(has(compared, "VW0=7 < 5 must hold (LDW< VW0, 5 in line 10)\n")) << compared;
}

TEST(WhyNot, AContactBehindLrdOrLppIsNamedAndNotTheOneOfTheBranchBefore) {
  AtPrompt session(on_cpu224("LD I0.4\nLPS\nA I0.5\n= Q0.4\nLRD\nAN I0.5\n= Q0.5\nLPP\nA I0.5\nA I0.6\n= Q0.6\nMEND\n"));
  session("input I0.4=1 I0.5=1; scan 3");
  EXPECT_TRUE(has(session("why not Q0.5"), ", must be 0 (AN I0.5 in line 6): an input\n"));
  session("input I0.5=0 I0.6=1; scan 3");
  EXPECT_TRUE(has(session("why not Q0.6"), ", must be 1 (A I0.5 in line 9): an input\n"));
}

constexpr std::string_view kParameters =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Outer, I1.5, VW20, Q0.7\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK Outer:SBR0\nVAR_INPUT\non : BOOL; raw : INT;\nEND_VAR\nVAR_OUTPUT\nok : BOOL;\nEND_VAR\n"
    "BEGIN\nNETWORK 1\nLD SM0.0\nCALL Guard, #on, #raw, #ok\nEND_SUBROUTINE_BLOCK\n"
    "SUBROUTINE_BLOCK Guard:SBR1\nVAR_INPUT\nen : BOOL; lim : INT;\nEND_VAR\nVAR_OUTPUT\nok : BOOL;\nEND_VAR\n"
    "BEGIN\nNETWORK 1\nLD #en\nAW>= #lim, 10\nAB< LB2, 60\n= #ok\nEND_SUBROUTINE_BLOCK\n";

/// Of a memory picture nothing has run: local memory says nothing of what a subroutine was called with.
std::string from_picture(std::uint8_t input, std::uint16_t value) {
  OnePlc plc(on_cpu224(kParameters));
  const auto state = std::make_unique<State>(plc.state());
  state->image[image::kI + 1] = input;
  store16(&state->image[image::kV + 20], value);
  plc.simulation.cpu().restore(*state);
  const Cpu& cpu = plc.simulation.cpu();
  return fmt::format("{}\n", fmt::join(lines_of(why_not(cpu, *parse_wish("Q0.7", cpu.program()))), "\n"));
}

TEST(WhyNot, AParameterIsWhatTheCallHandsOver) {
  EXPECT_TRUE(has(from_picture(0, 10), "L0.0 is 0, must be 1 (LD #en:L0.0 in line 28)"));
  const std::string low = from_picture(0x20, 9);
  EXPECT_FALSE(has(low, "L0.0 is")) << low;
  EXPECT_TRUE(has(low, ":LW1=9 >= 10 must hold")) << low;
  EXPECT_TRUE(has(low, "CALL 1, #on:L0.0, #raw:LW1, #ok:L3.0 in line 17 hands it over")) << low;
  const std::string high = from_picture(0x20, 61);
  EXPECT_FALSE(has(high, ">= 10 must")) << high;
  EXPECT_TRUE(has(high, "LB2=61 < 60 must hold")) << high;
}

/// A subroutine that several CALLs enter.
std::string with_calls(std::string_view calls) {
  return fmt::format(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\n{}END_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Motor:SBR0\nVAR_INPUT\non : BOOL;\nEND_VAR\nVAR_OUTPUT\nruns : BOOL;\nEND_VAR\n"
      "BEGIN\nNETWORK 1\nLD #on\nA I0.7\n= #runs\n= Q1.0\nEND_SUBROUTINE_BLOCK\n",
      calls);
}

constexpr std::string_view kOneOfTwo = "LD I0.4\nCALL Motor, I0.0, Q0.0\nLD I0.5\nCALL Motor, I0.1, Q0.1\n";
constexpr std::string_view kBoth = "LD SM0.0\nCALL Motor, I0.0, Q0.0\nLD SM0.0\nCALL Motor, I0.1, Q0.1\n";

/// A subroutine hands a TEMP on, at L0.1, and calls another one in whose memory nothing is on.
constexpr std::string_view kHandsOn =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Outer, I0.0\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK Outer:SBR0\nVAR_INPUT\non : BOOL;\nEND_VAR\nVAR\nheld : BOOL;\nEND_VAR\n"
    "BEGIN\nNETWORK 1\nLD #on\n= #held\nLD SM0.0\nCALL Inner, #held\nCALL Other\nEND_SUBROUTINE_BLOCK\n"
    "SUBROUTINE_BLOCK Inner:SBR1\nVAR_INPUT\nen : BOOL;\nEND_VAR\n"
    "BEGIN\nNETWORK 1\nLD #en\nA I1.0\n= Q1.1\nEND_SUBROUTINE_BLOCK\n"
    "SUBROUTINE_BLOCK Other:SBR2\nBEGIN\nNETWORK 1\nLD I0.6\n= Q1.2\nEND_SUBROUTINE_BLOCK\n";

std::string answer_now(const Cpu& cpu, std::string_view wish) {
  return fmt::format("{}\n", fmt::join(lines_of(why_not(cpu, *parse_wish(wish, cpu.program()))), "\n"));
}

/// Of memory with one input byte set.
std::string in_picture(std::string_view program, std::uint8_t inputs, std::string_view wish) {
  OnePlc plc(on_cpu224(program));
  const auto state = std::make_unique<State>(plc.state());
  state->image[image::kI] = inputs;
  plc.simulation.cpu().restore(*state);
  return answer_now(plc.simulation.cpu(), wish);
}

TEST(WhyNot, AParameterIsThatOfTheCallByWhichItWasEnteredAndNotOfTheLastInTheText) {
  AtPrompt session(on_cpu224(with_calls(kOneOfTwo)));
  session("input I0.1=1 I0.4=1; scan 3");
  const std::string text = session("why not Q1.0");
  EXPECT_TRUE(has(text, "L0.0 is 0, must be 1 (LD #on:L0.0 ")) << text;
  EXPECT_TRUE(has(text, "CALL 0, I0.0, Q0.0 in line 5 hands it over\n")) << text;
  EXPECT_FALSE(has(text, "CALL 0, I0.1")) << text;
}

TEST(WhyNot, OfAPictureOfMemoryItIsTheCallThatHasPowerFlow) {
  const std::string program = with_calls(kOneOfTwo);
  const std::string first = in_picture(program, 0x12, "Q1.0");
  EXPECT_TRUE(has(first, "L0.0 is 0, must be 1 (LD #on:L0.0 ")) << first;
  EXPECT_TRUE(has(first, "CALL 0, I0.0, Q0.0 in line 5 hands it over\n")) << first;
  const std::string second = in_picture(program, 0x22, "Q1.0");
  EXPECT_FALSE(has(second, "L0.0 is 0")) << second;
}

TEST(WhyNot, CallsThatAllHaveNoPowerFlowAreAllListed) {
  const std::string text = in_picture(with_calls(kOneOfTwo), 0x02, "Q1.0");
  EXPECT_TRUE(has(text, "L0.0 must be 1 (LD #on:L0.0 ")) << text;
  EXPECT_TRUE(has(text, "2 CALLs hand it over, and none has power flow now")) << text;
  EXPECT_TRUE(has(text, "CALL 0, I0.0, Q0.0 in line 5 hands it over\n")) << text;
  EXPECT_TRUE(has(text, "CALL 0, I0.1, Q0.1 in line 7 hands it over\n")) << text;
}

TEST(WhyNot, WhatACallGetsBackIsFollowedWithWhatThatCallHandsOver) {
  AtPrompt session(on_cpu224(with_calls(kBoth)));
  session("input I0.1=1 I0.7=1; scan 3");
  const std::string first = session("why not Q0.0");
  EXPECT_TRUE(has(first, "L0.0 is 0, must be 1 (LD #on:L0.0 ")) << first;
  EXPECT_TRUE(has(first, "CALL 0, I0.0, Q0.0 in line 5 hands it over\n")) << first;
  EXPECT_FALSE(has(first, "CALL 0, I0.1")) << first;
  const std::string other = session("input I0.1=0 I0.0=1; scan 3; why not Q0.1");
  EXPECT_TRUE(has(other, "CALL 0, I0.1, Q0.1 in line 7 hands it over\n")) << other;
  EXPECT_FALSE(has(other, "CALL 0, I0.0")) << other;
}

TEST(WhyNot, ATemporaryThatIsHandedOnIsThatOfTheCallerWhateverRunsNow) {
  AtPrompt session(on_cpu224(kHandsOn));
  session("input I0.0=1; scan 3; break 35; continue 20ms");
  ASSERT_EQ(session.state().call_depth, 2);
  EXPECT_TRUE(has(answer_now(session.simulation.cpu(), "Q1.1"), "= Q1.1 in line 30: #en:L0.0=1 and I1.0=0\n"));
}

TEST(WhyNot, TwoContactsOfTheSameBitThatExcludeEachOtherAreNoWay) {
  AtPrompt session(on_cpu224("LD I1.1\nAN I1.1\n= Q0.7\nMEND\n"));
  EXPECT_TRUE(has(session("scan 3; why not Q0.7"), "  it can never be on: I1.1 (line 1) and not I1.1 (line 2) exclude each other\n"));
}

TEST(WhyNot, OfACompoundConditionOnlyWhatIsNotAsItHasToBeIsAsked) {
  AtPrompt session(on_cpu224("LD I0.0\n= Q0.0\nLD I0.1\n= Q0.1\nLD I0.2\nEU\nINCW VW10\nMEND\n"));
  session("scan 3");
  const std::string high = session("why not VW10 > 9 and not Q0.0");
  EXPECT_TRUE(has(high, "VW10 is 16#0000 (0)")) << high;
  EXPECT_FALSE(has(high, "must be")) << high;
  session("input I0.0=1; scan 3");
  EXPECT_TRUE(has(session("why not VW10 = 0 and not Q0.0"), ", must be 0\n  "));
  const std::string both = session("why not not (Q0.0 or Q0.1)");
  EXPECT_TRUE(has(both, "Q0.0 is 1 ")) << both;
  EXPECT_FALSE(has(both, "Q0.1 is 0 since")) << both;
  EXPECT_TRUE(has(session("until VW10 = 0 and not Q0.0 within 10ms"), ", must be 0\n"));
}

TEST(WhyNot, WhatIsForcedSaysHowToReleaseItAndNamesNoInstructionThatCannotChangeIt) {
  AtPrompt session(on_cpu224("LD I0.0\nMOVW 5, VW10\n= Q0.0\n= M0.3\nMEND\n"));
  session("force VW10=3; force MB0=0; force Q0.0=0; force VB20=1; scan 3");
  for (const std::string_view asked : {"why not VW10 > 4", "why not Q0.0", "why not M0.3", "why not V11.2"}) {
    const std::string text = session(asked);
    EXPECT_TRUE(has(text, ": it is forced")) << text;
    EXPECT_TRUE(has(text, "' releases it\n")) << text;
    EXPECT_FALSE(has(text, "in line")) << text;
  }
  EXPECT_TRUE(has(session("why not V11.2"), ": it is forced with VW10; 'unforce VW10' releases it\n"));
  EXPECT_TRUE(has(session("why not VW20 = 7"), ": VB20 is forced; 'unforce VB20' releases it\n"));
}

TEST(WhyNot, TheFewestContactsThatWouldHaveToChangeComeFirst) {
  AtPrompt session(on_cpu224(kRungs));
  session("continue 20ms; input I0.2=1 I0.3=1; scan 3");
  const std::string text = session("why not Q0.0");
  EXPECT_TRUE(has(text,
                  "Q0.0 is 0 since 0.000000 ms, must be 1\n"
                  "  = Q0.0 in line 8: (I0.0=0 and I0.1=0 or I0.2=1 and not I0.3=1) and I0.4=0\n"
                  "  2 contacts have to change:\n"
                  "    I0.3 is 1 since 2"));
  EXPECT_TRUE(has(text,
                  " ms, must be 0 (AN I0.3 in line 5): an input\n"
                  "    I0.4 is 0 since 0.000000 ms, must be 1 (A I0.4 in line 7): an input\n"
                  "  or 3 contacts have to change:\n"
                  "    I0.0 is 0"));
  EXPECT_EQ(session("input I0.4=1; input I0.3=0; scan 3; why not Q0.0").find("has to change"), std::string::npos);
  EXPECT_TRUE(has(session("why not Q0.0"), "Q0.0 holds now\n"));
}

TEST(WhyNot, BranchesOfTheLogicStackAndNotAreFollowed) {
  AtPrompt session(on_cpu224(kRungs));
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not Q0.2"), "= Q0.2 in line 18: I0.5=0 and (I0.7=0 or M0.0=0)\n"));
  const std::string inverted = session("why not not Q0.3");
  EXPECT_TRUE(has(inverted, "must be 0\n  = Q0.3 in line 21: not I0.5=0\n  1 contact has to change:\n    I0.5 is 0"))
      << inverted;
}

TEST(WhyNot, ASetBitNeedsItsSetAndNoResetAfterIt) {
  AtPrompt session(on_cpu224(kRungs));
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not M1.0"), "  1 contact has to change:\n    I1.0 is 0"));
  const std::string text = session("input I1.1=1; scan 2; why not M1.0");
  EXPECT_TRUE(
      has(text, "  S M1.0, 1 in line 24: I1.0=0\n  R M1.0, 1 in line 27: I1.1=1 or I1.2=0\n  2 contacts have to change:\n"))
      << text;
  EXPECT_TRUE(has(text, "must be 0 (LD I1.1 in line 25): an input\n"));
}

TEST(WhyNot, AJumpOverTheRungHoldsItOffToo) {
  AtPrompt session(on_cpu224(kRungs));
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not Q0.5"), "  1 contact has to change:\n    I1.4"));
  const std::string text = session("input I1.3=1; scan 3; why not Q0.5");
  EXPECT_TRUE(has(text, "= Q0.5 in line 31: I1.4=0, not executed lately\n  2 contacts have to change:\n    I1.3 is 1"))
      << text;
}

constexpr std::string_view kTimes =
    "NETWORK 1 // start\n"
    "LD I0.0\n"
    "O Q0.0\n"
    "AN I0.1\n"
    "= Q0.0\n"
    "NETWORK 2\n"
    "LD Q0.0\n"
    "TON T37, 35\n"
    "NETWORK 3\n"
    "LD T37\n"
    "A I0.5\n"
    "AW>= VW10, 5\n"
    "S Q0.3, 1\n"
    "NETWORK 4\n"
    "LD I0.6\n"
    "EU\n"
    "LD I0.7\n"
    "CTU C5, 10\n"
    "NETWORK 5\n"
    "LD C5\n"
    "A M0.0\n"
    "= Q0.4\n"
    "NETWORK 6\n"
    "LDN I0.2\n"
    "R Q0.3, 1\n"
    "NETWORK 7\n"
    "LD I1.0\n"
    "CALL 1\n"
    "MEND\n"
    "SBR 1\n"
    "LD I1.1\n"
    "MOVW 7, VW10\n"
    "LD I1.2\n"
    "EU\n"
    "= Q0.5\n"
    "RET\n";

TEST(WhyNot, ATimerThatCountsSaysHowLongStillAndOneThatDoesNotWhatItsRungNeeds) {
  AtPrompt session(kTimes);
  session("continue 20ms");
  const std::string still = session("why not T37");
  EXPECT_TRUE(has(still,
                  "T37 is 0 since 0.000000 ms, must be 1: a timer, 0 s of 3.5 s have passed\n"
                  "  TON T37, 35 in line 8 must have power for 3.5 s: Q0.0=0\n"
                  "    1 contact has to change:\n"
                  "      Q0.0 is 0"))
      << still;
  EXPECT_TRUE(has(session("input I0.0=1; continue 1s; why not T37"), "must be 1: in 2.5 s (1 s of 3.5 s have passed)\n"));
  EXPECT_TRUE(has(session("input I0.0=1; continue 1s; mode stop; why not T37"),
                  "must be 1: the CPU is in STOP, where nothing counts (2 s of 3.5 s have passed)\n"));
}

TEST(WhyNot, ACounterSaysHowManyEdgesItsInputNeeds) {
  AtPrompt session(kTimes);
  session("continue 20ms; input I0.6=1; scan 2; input I0.6=0; scan 2");
  const std::string text = session("why not C5");
  EXPECT_TRUE(has(text,
                  "must be 1: a counter at 1 of 10\n  CTU C5, 10 in line 18 needs 9 more rising edges of its count input: "
                  "rising edge of (I0.6=0)\n"))
      << text;
  EXPECT_TRUE(has(text, "EU in line 16 needs a rising edge of (I0.6=0)\n")) << text;
  EXPECT_TRUE(has(session("input I0.7=1; scan 3; why not C5"), "its reset input must be off: I0.7=1\n"));
}

TEST(WhyNot, AComparisonWithATimerOrACounterSaysHowItGetsThere) {
  AtPrompt session(
      on_cpu224("LD I0.0\nTON T37, 100\nLD I0.1\nTOF T38, 50\nLD I0.2\nLD I0.3\nCTU C1, 10\nLD I0.4\nLD I0.5\nLD I0.6\n"
                "CTUD C2, 10\nLDW> T37, 29\n= Q0.0\nLDW<= 20, T38\n= Q0.1\nLDW>= C1, 3\n= Q0.2\nLDW< C2, 0\n= Q0.3\n"
                "LDW> T38, 50\n= Q0.4\nMEND\n"));
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not Q0.0"), "TON T37, 100 in line 2 must have power for 3 s: I0.0=0"));
  EXPECT_TRUE(has(session("input I0.0=1; continue 1s; why not Q0.0"), "in 2 s (1 s of 3 s have passed)"));
  EXPECT_TRUE(
      has(session("input I0.1=1; scan 3; why not Q0.1"), "TOF T38, 50 in line 4 must have no power for 2 s: I0.1=1"));
  EXPECT_TRUE(has(session("input I0.1=0; scan 3; why not Q0.1"), "in 2 s (0 s of 2 s have passed)"));
  EXPECT_TRUE(has(session("why not Q0.2"), "CTU C1, 10 in line 7 needs 3 more rising edges of its count input: I0.2=0"));
  EXPECT_TRUE(has(session("input I0.2=1; scan 3; why not Q0.2"),
                  "needs 2 more rising edges of its count input: I0.2=1, which is on already: it has to go off first"));
  EXPECT_TRUE(has(session("why not Q0.3"), "CTUD C2, 10 in line 11 needs 1 more rising edge of its count input: I0.5=0"));
  EXPECT_FALSE(has(session("why not Q0.4"), "in line 4 must")) << "a TOF stops at its preset";
}

TEST(WhyNot, ATonrGoesOffByRAlone) {
  AtPrompt session(on_cpu224("LD I0.0\nTONR T5, 1\nTONR T6, 1\nLD I0.1\nR T5, 1\nMEND\n"));
  session("input I0.0=1; continue 300ms");
  const std::string resets = session("why not not T5");
  EXPECT_TRUE(has(resets, "a timer, TONR of 100 ms, which stays on without power until R resets it\n")) << resets;
  EXPECT_TRUE(has(resets, "R T5, 1 in line 5: I0.1=0\n")) << resets;
  EXPECT_FALSE(has(resets, "must have no power")) << resets;
  EXPECT_TRUE(has(session("why not not T6"), "until R resets it; no R of the program does\n"));
}

TEST(WhyNot, AnEdgeOfWhatIsOnAlreadyHasToGoOffFirst) {
  AtPrompt session("LD I0.0\nEU\n= Q0.0\nMEND\n");
  session("continue 20ms");
  EXPECT_TRUE(
      has(session("why not Q0.0"), "EU in line 2 needs a rising edge of (I0.0=0)\n      1 contact has to change:\n"));
  EXPECT_TRUE(
      has(session("input I0.0=1; scan 3; why not Q0.0"), "of (I0.0=1), which is on already: it has to go off first\n"));
}

TEST(WhyNot, AComparisonLeadsToWhoWritesWhatItCompares) {
  AtPrompt session(kTimes);
  session("continue 20ms");
  const std::string text = session("why not Q0.3");
  EXPECT_TRUE(has(text, "  4 contacts have to change:\n"));
  EXPECT_TRUE(has(text,
                  "    VW10=0 >= 5 must hold (AW>= VW10, 5 in line 12)\n      VW10 is 16#0000 (0) since 0.000000 ms\n"
                  "        MOVW 7, VW10 in line 32: I1.1=0, not executed lately\n"))
      << text;
  EXPECT_TRUE(has(session("why not VW10 > 5"), "VW10 > 5 does not hold: VW10 is 0\n  VW10 is 16#0000 (0)"));
}

TEST(WhyNot, ARungOfASubroutineNeedsItsCall) {
  AtPrompt session(kTimes);
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not Q0.5"),
                  "I1.0 is 0 since 0.000000 ms, must be 1 (LD I1.0 in line 27): an input\n    EU in line 34 needs"));
}

TEST(WhyNot, OfSeveralCoilsTheOneThatIsExecutedLastDecides) {
  constexpr std::string_view kTwo = "LD I0.0\n= Q0.6\n{}\nCALL 0\nMEND\nSBR 0\nLD I0.1\n= Q0.6\nRET\n";
  AtPrompt always(on_cpu224(fmt::format(kTwo, "LD SM0.0")));
  always("input I0.0=1; scan 3");
  const std::string text = always("why not Q0.6");
  EXPECT_TRUE(has(text, "  1 contact has to change:\n    I0.1 is 0 ")) << text;
  AtPrompt sometimes(on_cpu224(fmt::format(kTwo, "LD I0.2")));
  sometimes("input I0.0=1 I0.2=1; scan 3");
  const std::string other = sometimes("why not Q0.6");
  EXPECT_TRUE(has(other, "    I0.1 is 0 ")) << other;
  EXPECT_TRUE(has(other, "    I0.2 is 1 ")) << other << "then the coil of the subroutine is not executed";
  AtPrompt before(on_cpu224("LD SM0.0\nCALL 0\nLD I0.0\n= Q0.6\nMEND\nSBR 0\nLD I0.1\n= Q0.6\nRET\n"));
  before("input I0.1=1; scan 3");
  const std::string first = before("why not Q0.6");
  EXPECT_TRUE(has(first, "  1 contact has to change:\n    I0.0 is 0 ")) << first;
}

TEST(WhyNot, AResetInASubroutineIsNamedWhereItIsInTheWay) {
  AtPrompt session(on_cpu224("LD I0.0\nS M0.0, 1\nLD I0.7\nCALL 0\nMEND\nSBR 0\nLD SM0.0\nR M0.0, 1\nRET\n"));
  session("scan 3");
  const std::string idle = session("why not M0.0");
  EXPECT_FALSE(has(idle, "R M0.0, 1")) << idle << "nothing calls it now";
  session("input I0.7=1; scan 3");
  const std::string called = session("why not M0.0");
  EXPECT_TRUE(has(called, "  R M0.0, 1 in line 8: always\n")) << called;
  EXPECT_TRUE(has(called, "    I0.7 is 1 ")) << called;
}

TEST(WhyNot, WhatExcludesEachOtherCanNeverBe) {
  AtPrompt session(
      on_cpu224("LDW>= VW2, 950\nAW<= VW2, 90\n= Q0.0\nLD I0.0\nLDW> VW2, 5\nALD\nAN I0.0\nO M0.0\nS M1.0, 1\n"
                "LD I0.1\n= Q0.1\nLDN I0.1\n= Q0.1\nLD I0.1\nA M0.0\n= Q0.2\n"));
  session("scan 3");
  const std::string text = session("why not Q0.0");
  EXPECT_TRUE(has(text, "  it can never be on: VW2 >= 950 (line 1) and VW2 <= 90 (line 2) exclude each other")) << text;
  const std::string other = session("why not M1.0");
  EXPECT_TRUE(has(other, "  1 contact has to change:\n    M0.0 is 0")) << other;
  EXPECT_FALSE(has(session("why not Q0.2"), "exclude"));
}

TEST(WhyNot, WhatIsInARoutineThatNothingCallsSaysSo) {
  AtPrompt session(on_cpu224("LD T37\n= Q0.0\nMEND\nSBR 7\nLD I0.0\nTON T37, 10\nLD I0.1\n= Q0.1\nRET\n"));
  session("scan 3");
  const std::string text = session("why not Q0.0");
  EXPECT_TRUE(has(text, "no contact can do that: SBR 7 is never called")) << text;
  const std::string coil = session("why not Q0.1");
  EXPECT_TRUE(has(coil, "  it can never be on: SBR 7 is never called")) << coil;
}

TEST(WhyNot, ABitThatNothingWritesIsChangedFromOutsideOnly) {
  AtPrompt session(kTimes);
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not M5.0"), "must be 1: no instruction writes it: only somebody outside can"));
  EXPECT_TRUE(has(session("why not not SM0.0"), "always 1; the CPU writes it"));
}

TEST(WhyNot, AStepOfASequenceLeadsToTheTransitionIntoIt) {
  AtPrompt session(
      "LD SM0.1\n"
      "S S0.1, 1\n"
      "LSCR S0.1\n"
      "LD I0.0\n"
      "SCRT S0.2\n"
      "SCRE\n"
      "LSCR S0.2\n"
      "LD I0.1\n"
      "= Q0.0\n"
      "SCRE\n"
      "MEND\n");
  session("continue 20ms");
  const std::string text = session("why not Q0.0");
  EXPECT_TRUE(has(text, "must be 1 (LSCR S0.2 in line 7): a step of the sequence\n      SCRT S0.2 in line 5: I0.0=0\n"))
      << text;
  EXPECT_TRUE(has(session("why not not S0.1"), "  SCRT S0.2 in line 5: I0.0=0\n  1 contact has to change:\n"));
  session("input I0.0=1; scan 3");
  EXPECT_TRUE(has(session("why not Q0.0"), "  1 contact has to change:\n    I0.1 is 0"));
}

TEST(WhyNot, WhatLeavesAStepIsNoWayToIt) {
  AtPrompt session(
      "LD SM0.1\n"
      "S S0.1, 1\n"
      "LSCR S0.1\n"
      "LD I0.0\n"
      "SCRT S0.2\n"
      "SCRE\n"
      "LSCR S0.2\n"
      "LD I0.1\n"
      "SCRT S0.3\n"
      "SCRE\n"
      "MEND\n");
  session("continue 20ms");
  const std::string text = session("why not S0.2");
  EXPECT_TRUE(has(text, "  SCRT S0.2 in line 5: I0.0=0\n  1 contact has to change:\n")) << text;
  EXPECT_FALSE(has(text, "SCRT S0.3")) << text;
}

TEST(WhyNot, WhatHasBeenToldIsReferredTo) {
  AtPrompt session(
      "LD I0.0\n"
      "A I0.1\n"
      "= M0.0\n"
      "LD M0.0\n"
      "= M0.1\n"
      "LD M0.0\n"
      "= M0.2\n"
      "LD M0.1\n"
      "A M0.2\n"
      "= Q0.0\n"
      "MEND\n");
  session("continue 20ms");
  const std::string text = session("why not Q0.0");
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  ASSERT_EQ(lines.size(), 15U) << text;
  EXPECT_TRUE(has(lines[6], "M0.0 is 0")) << text;
  EXPECT_TRUE(has(lines[14], "M0.0 is 0 since 0.000000 ms, must be 1 (LD M0.0 in line 6): as above, line 7 of this answer"))
      << text;
}

/// Q0.0 hangs on eight bits, each of which hangs on three others, and those on an input each.
std::string deep_program() {
  std::string text;
  for (int bit = 0; bit < 8; ++bit) {
    for (int of = 0; of < 3; ++of) text += fmt::format("LD I{}.{}\n= M{}.{}\n", of, bit, 10 + of, bit);
    text += fmt::format("LD M10.{0}\nA M11.{0}\nA M12.{0}\n= M0.{0}\n", bit);
  }
  for (int bit = 0; bit < 8; ++bit) text += fmt::format("{} M0.{}\n", bit == 0 ? "LD" : "A", bit);
  return text + "= Q0.0\nLD M0.7\n= Q0.1\nMEND\n";
}

TEST(WhyNot, OfALongAnswerTheNearestIsShownAndWhatToAskForMore) {
  AtPrompt session(deep_program());
  session("continue 20ms");
  const std::string some = session("why not Q0.0"), all = session("why not Q0.0 all");
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  EXPECT_LE(lines(some), 38) << some;
  EXPECT_GT(lines(all), 100);
  for (int bit = 0; bit < 8; ++bit) EXPECT_TRUE(has(some, fmt::format("\n    M0.{} is 0", bit))) << some;
  EXPECT_TRUE(has(some, "(A M0.7 in line ")) << some;
  EXPECT_TRUE(has(some, "): … more: why not M0.7\n")) << some;
  EXPECT_FALSE(has(all, "more:"));
  EXPECT_TRUE(has(session("why not M0.7"), "(A M11.7 in line "));
}

TEST(WhyNot, OfALongAnswerWhatWasToldDeepDownIsToldWhereItIsNearest) {
  std::string text;
  for (int level = 1; level < 4; ++level) {
    for (int of = 1; of < 6; ++of)
      text += fmt::format("LD M{}.{}\nA M{}.0\n= M{}.{}\n", level + 1, of, level + 1, level, of);
    text += fmt::format("LD M{}.5\n= M{}.0\n", level + 1, level);
  }
  AtPrompt session("LD M1.1\nA M1.2\nA M1.3\nA M1.4\nA M1.5\nA M2.5\n= Q0.0\n" + text + "MEND\n");
  session("continue 20ms");
  const std::string some = session("why not Q0.0");
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < some.size(); at = some.find('\n', at) + 1)
    lines.push_back(some.substr(at, some.find('\n', at) - at));
  ASSERT_LE(lines.size(), 38U) << some;
  std::size_t references = 0;
  for (const std::string& line : lines) {
    const std::size_t at = line.find(", line ");
    if (at == std::string::npos || !has(line, " of this answer")) continue;
    ++references;
    const std::size_t number = std::stoul(line.substr(at + 7));
    ASSERT_LE(number, lines.size());
    const auto name = [](const std::string& of) { return of.substr(of.find('M'), 4); };
    EXPECT_EQ(name(lines[number - 1]), name(line)) << some;
  }
  EXPECT_GT(references, 0U) << some;
}

constexpr std::string_view kTwoCoils =
    "LD I0.0\n"
    "= Q0.0\n"
    "= M0.0\n"
    "LD I0.1\n"
    "= Q0.0\n"
    "= M0.0\n"
    "MEND\n";

TEST(WhyNot, UntilLooksAtAnOutputWithSeveralCoilsWhenAScanIsOver) {
  AtPrompt session(kTwoCoils);
  session("continue 20ms; input I0.0=1");
  const std::string never = session("until Q0.0 within 50ms");
  EXPECT_TRUE(has(never, "Q0.0 is written by = Q0.0 in line 2 and = Q0.0 in line 5: it is looked at when a scan is over\n"))
      << never;
  EXPECT_TRUE(has(never, "Q0.0 is 0")) << never;
  EXPECT_TRUE(has(session("input I0.1=1; until Q0.0 within 50ms; print Q0.0"), "Q0.0     1\n"));
  session("input I0.0=0; scan");
  EXPECT_TRUE(has(session("step 3; why Q0.0"), "= Q0.0 in line 5 still follows in this scan\n"));
}

TEST(WhyNot, ABitThatALaterCoilMayOverwriteIsSaidToBeOne) {
  AtPrompt session(kTwoCoils);
  session("continue 20ms; input I0.0=1");
  const std::string text = session("until M0.0 within 50ms");
  EXPECT_TRUE(has(text, "  = M0.0 in line 6 still follows in this scan\n")) << text;
  EXPECT_TRUE(has(session("why M0.0"), "  = M0.0 in line 6 still follows in this scan\n"));
  EXPECT_FALSE(has(session("scan; why M0.0"), "still follow")) << "none has been passed";
}

constexpr std::string_view kOthers =
    "LD I0.7\n"
    "EU\n"
    "ATCH 1, 8\n"
    "LD SM0.1\n"
    "MOVB 5, SMB34\n"
    "ATCH 0, 10\n"
    "ENI\n"
    "RCV VB100, 0\n"
    "MOVD &VB200, AC1\n"
    "LDB= VB101, 5\n"
    "= Q0.2\n"
    "LDB= VB205, 5\n"
    "= Q0.3\n"
    "LD SM0.0\n"
    "MOVB 7, *AC1\n"
    "LD I0.3\n"
    "MOVB VB300, QB1\n"
    "MEND\n"
    "INT 0\n"
    "LD I0.0\n"
    "= Q0.0\n"
    "RETI\n"
    "INT 1\n"
    "LD I0.1\n"
    "= Q0.1\n"
    "RETI\n";

TEST(WhyNot, AnInterruptRoutineNeedsItsEvent) {
  AtPrompt session(on_cpu224(kOthers));
  session("continue 20ms");
  EXPECT_TRUE(
      has(session("why not Q0.0"), "I0.0=0, in INT 0 at event 10 (timed interrupt 0, SMB34)\n  1 contact has to change:\n"));
  const std::string detached = session("why not Q0.1");
  EXPECT_TRUE(
      has(detached,
          "INT 1 has to run, and is attached to no event\n      ATCH 1, 8 in line 3 attaches it: rising edge of (I0.7=0)\n"))
      << detached;
  session("input I0.7=1; scan 3");
  EXPECT_TRUE(has(session("why not Q0.1"), "INT 1 has to run, at event 8 (port 0: character received)\n"));
}

TEST(WhyNot, MessagesMovesAndPointersAreNamed) {
  AtPrompt session(on_cpu224(kOthers));
  session("continue 20ms");
  EXPECT_TRUE(has(session("why not Q0.2"), "        RCV VB100, 0 in line 8 stores character 1 of a message there\n"));
  EXPECT_TRUE(has(session("why not Q1.4"), "  MOVB VB300, QB1 in line 17 writes it: I0.3=0\n    V300.4 is 0"));
  EXPECT_TRUE(has(session("why not VW200 = 3"), "MOVB 7, *AC1 in line 15 may reach it through a pointer\n"));
}

TEST(WhyNot, TheStatusOfAMessageIsNoCharacterOfIt) {
  AtPrompt session(
      on_cpu224("NETWORK 1\nLD SM0.1\nMOVB 16#09, SMB30\nMOVB 16#B0, SMB87\nRCV VB700, 0\n"
                "NETWORK 2\nLDB= SMB86, 16#20\n= Q0.0\nMEND\n"));
  const std::string reply = session("continue 20ms; why not Q0.0");
  EXPECT_TRUE(has(reply, "RCV VB700, 0 in line 5 receives messages, whose status stands there\n")) << reply;
}

TEST(WhyNot, AForcedInputSaysHowToReleaseIt) {
  AtPrompt session(on_cpu224(kOthers));
  EXPECT_TRUE(
      has(session("continue 20ms; force I0.0=0; why not Q0.0"), "an input; it is forced; 'unforce I0.0' releases it\n"));
}

TEST(WhyNot, ParametersOfASubroutineAreFollowedBothWays) {
  AtPrompt session(
      on_cpu224("ORGANIZATION_BLOCK MAIN:OB1\n"
                "BEGIN\n"
                "Network 1\n"
                "LD SM0.0\n"
                "CALL SBR_0, I0.0, M0.0\n"
                "Network 2\n"
                "LD M0.0\n"
                "= Q0.0\n"
                "LD I0.3\n"
                "TOF T33, 100\n"
                "LD T33\n"
                "TONR T5, 20\n"
                "LDN SM0.5\n"
                "CTD C2, 4\n"
                "END_ORGANIZATION_BLOCK\n"
                "SUBROUTINE_BLOCK SBR_0:SBR0\n"
                "VAR_INPUT\n"
                "asked:BOOL;\n"
                "END_VAR\n"
                "VAR_OUTPUT\n"
                "runs:BOOL;\n"
                "END_VAR\n"
                "BEGIN\n"
                "Network 1\n"
                "LD L0.0\n"
                "A I0.5\n"
                "= L0.1\n"
                "END_SUBROUTINE_BLOCK\n"));
  session("continue 20ms");
  const std::string text = session("why not Q0.0");
  EXPECT_TRUE(has(text,
                  "      CALL 0, I0.0, M0.0 in line 5 gets it back: always\n        L0.1 is 0, must be 1\n"
                  "          = L0.1 in line 27: L0.0=0 and I0.5=0\n"))
      << text;
  EXPECT_TRUE(has(text, "              CALL 0, I0.0, M0.0 in line 5 hands it over\n                I0.0 is 0")) << text;
  EXPECT_TRUE(has(session("why not T33"), "a timer, TOF of 10 ms\n  TOF T33, 100 in line 10 must have power: I0.3=0\n"));
  session("input I0.3=1; scan 3; input I0.3=0; scan 3");
  EXPECT_TRUE(has(session("why not not T33"), "must be 0: in 1 s (0 s of 1 s have passed)\n"));
}

TEST(WhyNot, StandsWhereItStoodAndSaysTheSameInJson) {
  AtPrompt session(kTimes);
  session("continue 20ms");
  const auto here = session.simulation.snapshot();
  session("why not Q0.3");
  EXPECT_EQ(session.simulation.snapshot(), here);
}

TEST(WhyNot, WhatCannotBeReadIsRefused) {
  AtPrompt session(kTimes);
  EXPECT_TRUE(has(session.error_of("why not"), "why not expects a bit or a condition"));
  EXPECT_TRUE(has(session.error_of("why not XX"), "'XX' is not an address"));
  EXPECT_TRUE(has(session.error_of("until XX"), "or a condition, for example: until Q0.3"));
  EXPECT_TRUE(has(session.error_of("until VW10 >"), "until: 'VW10 >', column 7"));
  EXPECT_TRUE(has(session.error_of("until Q0.0 within soon"), "after within"));
}

TEST(Until, ARunEndsInFrontOfTheInstructionThatFindsTheConditionHolding) {
  AtPrompt session(kTimes);
  session("continue 20ms; input I0.0=1; until Q0.0");
  EXPECT_EQ(session.state().image[image::kQ] & 1, 1);
  EXPECT_LT(session.state().time, 25 * kMillisecond);
  session("until T37");
  EXPECT_GE(session.state().time, 3500 * kMillisecond);
  EXPECT_LT(session.state().time, 3700 * kMillisecond);
  EXPECT_TRUE(has(session("until T37 and Q0.0"), "holds now: T37 is "));
}

TEST(Until, AConditionThatDoesNotComeToHoldIsAnsweredWithWhatBlocksIt) {
  AtPrompt session(kTimes);
  const std::string text = session("input I0.0=1; until Q0.3 within 6s");
  EXPECT_TRUE(has(text, "6 s of simulated time passed"));
  EXPECT_TRUE(
      has(text, "Q0.3 is 0 since 0.000000 ms, must be 1\n  S Q0.3, 1 in line 13: T37=1 and I0.5=0 and VW10=0 >= 5\n"))
      << text;
}

}  // namespace
}  // namespace s7200::tools::why_not_test
