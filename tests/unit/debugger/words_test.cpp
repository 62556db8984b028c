// What the prompt makes of words: comments, variables of blocks, conditions, slips of the pen.
#include "tests/support/slave_bench.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::words_test {
namespace {

TEST(Words, ACommentBeginsWithTwoSlashesOrWithAHashAtTheStartOfALine) {
  AtPrompt session(kNested);
  EXPECT_EQ(session("# scan 3"), "");
  EXPECT_EQ(session("  #scan 3"), "");
  EXPECT_EQ(session("// scan 3"), "");
  EXPECT_FALSE(session("scan 3 // three; scan 4").empty());
  EXPECT_EQ(session.state().scans, 3U);
  EXPECT_EQ(session.error_of("print VW10 # the number of scans"), "no error");
}

TEST(Words, AssignmentsHaveBlanksWithinAndCommasBetweenThem) {
  AtPrompt session(kNested);
  EXPECT_EQ(session.error_of("set VW 100=3"), "no error");
  EXPECT_EQ(session.error_of("set VW 102 = 4"), "no error");
  EXPECT_EQ(session.error_of("set VW104=5,VW106=6"), "no error");
  EXPECT_EQ(session.error_of("set VW108=7, VB110=','"), "no error");
  EXPECT_EQ(session.error_of("expect VW100 = 3 and VW102 = 4 and VW104 = 5 and VW106 = 6 and VW108 = 7 and VB110 = 44"),
            "no error");
}

constexpr std::string_view kScale =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL SBR0, 7, VW100\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK Scale:SBR0\nVAR_INPUT\nraw : INT;\nEND_VAR\nVAR_OUTPUT\nresult : INT;\nEND_VAR\nVAR\nratio : REAL;\n"
    "END_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW #raw, #result\nMOVR 1.5, #ratio\nEND_SUBROUTINE_BLOCK\n";

AtPrompt session_of_cpu_224(std::string_view text) {
  return AtPrompt(check_text(text, "test.awl", cpu224(), default_times(cpu224())).program);
}

TEST(Words, AVariableOfABlockIsItsLocalMemoryWhereTheProgramStands) {
  AtPrompt session = session_of_cpu_224(kScale);
  session("until SBR 0; step 4");
  EXPECT_TRUE(has(session("print #raw"), "#raw is LW0 in SBR 0\n"));
  EXPECT_TRUE(has(session.out.str(), "7"));
  EXPECT_TRUE(has(session("print #ratio"), "1.5"));
  EXPECT_EQ(session.error_of("expect #raw = 7 and #result = 7"), "no error");
  EXPECT_TRUE(
      has(session.error_of("print #row"), "#row is no variable of SBR 0, which is executed now; did you mean #raw?"));
}

TEST(Words, AConditionOfABreakpointKnowsTheVariablesOfItsPlace) {
  AtPrompt session = session_of_cpu_224(kScale);
  session("break SBR 0 if #raw = 7; continue");
  EXPECT_TRUE(has(session.out.str(), "breakpoint 1, hit for the first time"));
  EXPECT_TRUE(has(session.error_of("print #raw").empty() ? "" : "fine", "fine"));
}

TEST(Words, BreakWithAConditionStopsWhereItComesToHold) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session("break VW10 > 3"), "breakpoint 1 at VW10 > 3\n"));
  session("continue");
  EXPECT_TRUE(has(session.out.str(), "breakpoint 1, VW10 > 3, hit for the first time\n  VW10 is 4\n  by main "));
  EXPECT_EQ(session.vw(10), 4U);
  session("continue 100ms");
  EXPECT_FALSE(has(session.out.str(), "hit 2 times")) << "it holds all the time";
  session("set VW10=0; continue");
  EXPECT_EQ(session.vw(10), 4U);
  session("rcontinue");
  EXPECT_NE(session.vw(10), 0U);
}

TEST(Words, AConditionOfABitAloneStopsWhereItIsSet) {
  AtPrompt session("LD SM0.0\nINCW VW0\nLDW>= VW0, 5\n= M0.0\nMEND\n");
  session("break M0.0; continue");
  EXPECT_TRUE(has(session.out.str(), "breakpoint 1, M0.0, hit for the first time\n  M0.0 is 1\n"));
  EXPECT_EQ(session.vw(0), 5U);
}

TEST(Words, ABreakpointWithAConditionIsSavedAndLoaded) {
  AtPrompt session(kNested);
  session("break VW10 > 3 hits 1");
  EXPECT_TRUE(has(session("break"), "VW10 > 3"));
  EXPECT_FALSE(has(session.out.str(), "if VW10"));
}

TEST(Words, WhatIsNoConditionIsExplained) {
  AtPrompt session(kNested);
  EXPECT_TRUE(
      has(session.error_of("break VW10"), "'watch VW10' stops when it changes, 'break VW10 > 3' when that comes to hold"));
  EXPECT_TRUE(has(session.error_of("break 3 > 2"), "no address is in it"));
  EXPECT_TRUE(has(session.error_of("break VW10 > "), "an address or a number is missing"));
  EXPECT_TRUE(has(session.error_of("break VW10 > 3 if M0.0"), "write 'break VW10 > 3 and …'"));
  EXPECT_TRUE(
      has(session("break VW10 > 3; scan 9; break VW10 > 3"), "it holds now: the run stops when it comes to hold again"));
}

TEST(Words, ACommandThatIsNearlyOneIsOffered) {
  AtPrompt session(kNested);
  EXPECT_EQ(session.error_of("contineu 1s"), "unknown command 'contineu'; did you mean continue?");
  EXPECT_EQ(session.error_of("xyzzyplugh"), "unknown command 'xyzzyplugh'; 'help' lists them");
}

TEST(Words, WordsOfOtherDebuggersAndOfProgramsAreExplained) {
  AtPrompt session(kNested);
  EXPECT_EQ(session.error_of("run"), "unknown command 'run'; 'continue' runs");
  EXPECT_EQ(session.error_of("next"), "unknown command 'next'; 'over' executes a CALL with all that it calls");
  EXPECT_EQ(session.error_of("x/4 VB0"), "unknown command 'x/4'; 'print VB0:16' shows memory");
  EXPECT_EQ(session.error_of("movw 5, VW10"),
            "unknown command 'movw'; MOVW is an instruction: 'set' changes memory, 'print' shows it");
  EXPECT_EQ(session.error_of("VW10=5"), "unknown command 'VW10=5'; 'set VW10=5' changes memory");
}

TEST(Words, RelationsOfOtherLanguagesAreRead) {
  AtPrompt session(kNested);
  session("set VW10=5");
  EXPECT_TRUE(has(session("print VW10 == 5"), "= 1"));
  EXPECT_TRUE(has(session("print VW10 != 5"), "= 0"));
}

TEST(Words, ABreakpointStopsWhereSomebodyHasMadeItsConditionHold) {
  AtPrompt session(kNested);
  session("break VW10 > 3; set VW10=5; continue 100ms");
  EXPECT_TRUE(has(session.out.str(), "breakpoint 1, VW10 > 3"));
  EXPECT_TRUE(has(session.out.str(), "by 'set VW10', from outside"));
  EXPECT_EQ(session.state().instructions, 0U);
  EXPECT_TRUE(has(session("continue 100ms"), "passed with nothing to stop for")) << "once";
  EXPECT_TRUE(has(session("set VW10=0; continue 1ms; set VW10=7; continue 1ms"), "breakpoint 1, VW10 > 3"));
}

TEST(Words, ContinueSaysThatItStandsWithinAScanAndGoesToItsEnd) {
  std::string program = "LD SM0.0\n";
  for (int i = 0; i < 60; ++i) program += "INCW VW0\n";
  AtPrompt session(program + "MEND\n");
  session("continue 20ms");
  bool within = false;
  for (int i = 0; i < 20 && !within; ++i)
    within =
        session("continue 1001us").find("; it stands within a scan; 'continue 1.001 ms scan' goes on to the end of it") !=
        std::string::npos;
  EXPECT_TRUE(within) << session.out.str();
  const auto scans = session.state().scans;
  session("continue 10ms scan");
  EXPECT_EQ(session.line(), 1U);
  EXPECT_GT(session.state().scans, scans);
  EXPECT_TRUE(has(session.error_of("continue soon scan"), "continue expects a duration above 0"));
}

}  // namespace
}  // namespace s7200::tools::words_test
