// What `why` says of characters that no RCV waits for: how the last RCV ended, and which could start the next.
#include <fmt/format.h>

#include "tests/support/slave_bench.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::reception_ended_test {
namespace {

AtPrompt session_of_cpu_224(const std::string& text) {
  return AtPrompt(check_text(text, "test.stl", cpu224(), default_times(cpu224())).program);
}

/// Takes a message up to a CR, once.
const std::string kOnce =
    "LD SM0.1\n"           // 1
    "MOVB 16#09, SMB30\n"  // 2
    "MOVB 16#E0, SMB87\n"  // 3
    "MOVB 16#41, SMB88\n"  // 4
    "MOVB 16#0D, SMB89\n"  // 5
    "MOVB 10, SMB94\n"     // 6
    "RCV VB100, 0\n"       // 7
    "MEND\n";

TEST(ReceptionEnded, WithoutRoomForACharacterTheParameterIsNamed) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnce, "MOVB 10, SMB94", "MOVB 0, SMB94"));
  session("continue 50ms; break unanswered; send 41 42 0d; continue 1s");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 3 characters since 50."));
  EXPECT_TRUE(has(text, ": no RCV waits; the last one, RCV VB100, 0 in line 7 at 0."));
  EXPECT_TRUE(has(text, " with SMB86 = 16#40 because SMB94 is 0: a message must be allowed a character; "));
  session("rwhy");
  EXPECT_EQ(session.line(), 7U);
  EXPECT_EQ(session.state().scans, 0U);
}

TEST(ReceptionEnded, WithoutAStartConditionTheControlByteIsNamed) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnce, "MOVB 16#E0, SMB87", "MOVB 16#80, SMB87"));
  session("continue 50ms; break unanswered; send 41 42 0d; continue 1s");
  EXPECT_TRUE(has(session("why"), " with SMB86 = 16#40 because SMB87 is 16#80, which has no start condition; "));
}

TEST(ReceptionEnded, WhatWorksOnlyOnceSaysWhichRcvCouldStartTheNext) {
  AtPrompt session = session_of_cpu_224(kOnce);
  session("continue 50ms; send 41 42 0d; continue; break unanswered; send 41 43 0d; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "the last one, RCV VB100, 0 in line 7 at 0."));
  EXPECT_TRUE(has(text,
                  "with SMB86 = 16#20 because the end character 16#0D came; the next would be started by RCV VB100, 0 "
                  "in line 7, which had no power flow at "));
  EXPECT_TRUE(has(text, " (LD SM0.1: SM0.1=0)\n"));
}

TEST(ReceptionEnded, LongAfterItsRcvIsFoundToo) {
  AtPrompt session = session_of_cpu_224(kOnce);
  session("continue 5s; send 41 42 0d; continue; continue 5s; break unanswered; send 41 43 0d; continue");
  EXPECT_TRUE(has(session("why"), "with SMB86 = 16#20 because the end character 16#0D came; "));
}

TEST(ReceptionEnded, AsManyCharactersAsAllowedAreCounted) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnce, "MOVB 10, SMB94", "MOVB 2, SMB94"));
  session("continue 50ms; send 41 42; continue; break unanswered; send 41 43 0d; continue");
  EXPECT_TRUE(has(session("why"), "with SMB86 = 16#02 because 2 characters came, as many as SMB94 allows; "));
}

TEST(ReceptionEnded, ATimeThatHasPassedSaysWhatItRanFrom) {
  const auto why = [](const std::string& control) {
    const std::string timed = test::changed(kOnce, "MOVB 16#E0, SMB87", "MOVW 20, SMW92\nMOVB " + control + ", SMB87");
    AtPrompt session = session_of_cpu_224(timed);
    session("continue 50ms; send 41 42; continue; break unanswered; send 41 43 0d; continue");
    return session("why");
  };
  const std::string started = "; the next would be started by RCV VB100, 0 in line 8, which had no power flow at ";
  const std::string of_message = why("16#EC"), between = why("16#E4"), from_rcv = why("16#9C");
  EXPECT_TRUE(has(of_message, " ms with SMB86 = 16#04 because 20 ms passed since the message began" + started));
  EXPECT_TRUE(has(between, " ms with SMB86 = 16#04 because 20 ms passed without another character" + started));
  EXPECT_TRUE(has(from_rcv, "RCV VB100, 0 in line 8 at 0.1")) << "an idle time of 0: any character starts the message";
  EXPECT_TRUE(has(from_rcv, " ended at 21.000000 ms with SMB86 = 16#04 because 20 ms passed after the RCV without a "));
}

TEST(ReceptionEnded, ADamagedCharacterIsNamed) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnce, "MOVB 16#09, SMB30", "MOVB 16#49, SMB30"));
  session("continue 50ms; send 41 42p; continue; break unanswered; send 41 43 0d; continue");
  EXPECT_TRUE(has(session("why"), "with SMB86 = 16#01 because the character 42 had a parity error; the next would be "));
}

/// Sends back what an end character has ended, and begins again once that is sent.
const std::string kOnlyWithEnd =
    "LD SM0.1\n"
    "MOVB 16#49, SMB30\n"
    "MOVB 16#E4, SMB87\n"
    "MOVB 16#41, SMB88\n"
    "MOVB 16#0D, SMB89\n"
    "MOVW 20, SMW92\n"
    "MOVB 10, SMB94\n"
    "ATCH 0, 23\n"
    "ATCH 1, 9\n"
    "ENI\n"
    "RCV VB100, 0\n"
    "MEND\n"
    "INT 0\n"
    "LDB= SMB86, 16#20\n"
    "XMT VB100, 0\n"  // 15
    "RETI\n"
    "INT 1\n"
    "LD SM0.0\n"
    "RCV VB100, 0\n"  // 19
    "RETI\n";

TEST(ReceptionEnded, ARequestThatATimeOrADamagedCharacterHasEndedSaysSo) {
  for (const auto& [sent, ended] : std::vector<std::pair<std::string, std::string>>{{"41 42", "16#04 (the time has passed)"},
                                                                                    {"41 42p", "16#01 (a bad character)"}}) {
    AtPrompt session = session_of_cpu_224(kOnlyWithEnd);
    session("continue 50ms; break unanswered; send " + sent + "; continue 500ms");
    const std::string text = session("why");
    EXPECT_TRUE(has(text, "no answer to 2 characters since 50.")) << text;
    EXPECT_TRUE(has(text, ": RCV took them and ended at ")) << text;
    EXPECT_TRUE(has(text, " ms with SMB86 = " + ended + ", and nothing was sent since: XMT VB100, 0 in line 15, ")) << text;
  }
}

TEST(ReceptionEnded, ARequestThatItsCountHasEndedEarlySaysWhatKeptTheAnswerAndWhatTookNoMore) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnlyWithEnd, "MOVB 10, SMB94", "MOVB 2, SMB94"));
  session("continue 50ms; break unanswered; send 41 42 43 44; continue 500ms");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 2 characters since 50.")) << text;
  EXPECT_TRUE(has(text,
                  ": RCV took them, and nothing was sent since: XMT VB100, 0 in line 15, without power flow (LDB= SMB86, "
                  "16#20: SMB86=16#02)\n"))
      << text;
  EXPECT_TRUE(has(text, "no answer to 2 characters since 52.")) << text;
  EXPECT_TRUE(has(text, "because 2 characters came, as many as SMB94 allows; ")) << text;
}

TEST(ReceptionEnded, AnRcvThatIsNotEnabledReceivesNothing) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnce, "MOVB 16#E0, SMB87", "MOVB 16#60, SMB87"));
  session("continue 50ms; break unanswered; send 41 42 0d; continue 1s");
  EXPECT_TRUE(
      has(session("why"), ", received nothing because SM87.7 is 0: SMB87 = 16#60; the next would be started by RCV "));
}

TEST(ReceptionEnded, ABreakThatStartsTheMessageIsNotWaitedForAnyMore) {
  const std::string text = test::changed(test::changed(kOnlyWithEnd, "MOVB 16#E4, SMB87", "MOVB 16#A2, SMB87"),
                                         "MOVB 16#49, SMB30", "MOVB 16#09, SMB30");
  for (const auto& [length, awaited] : std::vector<std::pair<std::string, std::string>>{
           {"40bit", "RCV waits for the first character of a message; the break before it has come"},
           {"12bit", "RCV took it and waits for the end of its message: the character 16#0D or 10 characters (1 so far)"}}) {
    AtPrompt session = session_of_cpu_224(text);
    session("continue 50ms; break unanswered; fault break:character=1,length=" + length + "; send 41 0d; continue 500ms");
    const std::string why = session("why");
    EXPECT_TRUE(has(why, awaited)) << length;
    EXPECT_FALSE(has(why, "the start of a message: a break")) << length;
  }
}

TEST(ReceptionEnded, WhoCouldStartTheNextIsSaidOfEachRcv) {
  AtPrompt session = session_of_cpu_224(kOnlyWithEnd);
  session("continue 50ms; send 41 42; continue 500ms; send cancel; break unanswered; send 41 43 0d; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "the next would be started by RCV VB100, 0 in line 11, which had no power flow at ")) << text;
  EXPECT_TRUE(has(text, "; or by RCV VB100, 0 in line 19: INT 1, which serves event 9, has not executed it since\n"))
      << text;
}

TEST(ReceptionEnded, AnInterruptRoutineThatNoEventCallsStartsNothing) {
  const std::string text = test::changed(kOnce, "MEND\n", "MEND\nINT 3\nLD SM0.0\nRCV VB100, 0\nRETI\n");
  AtPrompt session = session_of_cpu_224(text);
  session("continue 50ms; send 41 42 0d; continue; break unanswered; send 41 43 0d; continue");
  EXPECT_TRUE(has(session("why"), "; or by RCV VB100, 0 in line 11: INT 3 is attached to no event\n"));
}

TEST(ReceptionEnded, AnRcvRightAfterXmtWasRefused) {
  const std::string text = test::changed(test::changed(kOnce, "MOVB 10, SMB94\n", "MOVB 10, SMB94\nATCH 0, 23\nENI\n"),
                                         "MEND\n", "MEND\nINT 0\nLD SM0.0\nXMT VB100, 0\nRCV VB100, 0\nRETI\n");
  AtPrompt session = session_of_cpu_224(text);
  session("continue 50ms; send 41 42 0d; continue; break unanswered; send 41 43 0d; continue");
  EXPECT_TRUE(has(session("why"), "the last one, RCV VB100, 0 in line 14 at "));
  EXPECT_TRUE(has(session.out.str(), " was refused with run-time error 0009, "));
  session("rwhy");
  EXPECT_EQ(session.line(), 14U);
}

TEST(ReceptionEnded, AReceptionThatStopHasGivenUpIsSaidToBe) {
  AtPrompt session = session_of_cpu_224(test::changed(kOnce, "RCV VB100, 0", "AN M0.0\nRCV VB100, 0"));
  session("continue 50ms; mode stop; continue 20ms; mode run; continue 20ms; mode stop; continue 20ms");
  session("set M0.0=1; mode run; continue 20ms; break unanswered; send 41 43 0d; continue");
  EXPECT_TRUE(has(session("why"), " was given up when the CPU went to STOP at "));
}

/// Sends each character back while RCV waits for another message: XMT is refused.
TEST(ReceptionEnded, AnXmtThatWasRefusedIsNamedWithWhatHadThePort) {
  AtPrompt session = session_of_cpu_224(
      "LD SM0.1\n"
      "MOVB 9, SMB30\n"
      "MOVB 16#B0, SMB87\n"
      "MOVB 16#0D, SMB89\n"
      "MOVW 5, SMW90\n"
      "MOVB 10, SMB94\n"
      "ATCH 0, 23\n"
      "ENI\n"
      "RCV VB100, 0\n"
      "MEND\n"
      "INT 0\n"
      "LD SM0.0\n"
      "RCV VB100, 0\n"
      "XMT VB100, 0\n"  // 14
      "RETI\n");
  session("continue 50ms; break unanswered; send 41 42 0d; continue 2s");
  EXPECT_TRUE(has(session("why"), "no answer: XMT VB100, 0 in line 14 was refused with run-time error 0009, "));
  EXPECT_TRUE(has(session("why"), ": RCV was waiting for the start of a message"));
}

}  // namespace
}  // namespace s7200::tools::reception_ended_test
