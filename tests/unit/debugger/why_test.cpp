// What `why` says of a frame without an answer when it is not the program that has left it.
#include <fmt/format.h>

#include <algorithm>

#include "tests/support/slave_bench.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::why_test {
namespace {

/// Sends each character back. I0.0 detaches event 8, I0.1 leaves Freeport mode.
constexpr std::string_view kStopsListening =
    "LD      I0.1\n"          // 1
    "EU\n"                    // 2
    "MOVB    16#08, SMB30\n"  // 3
    "LD      SM0.1\n"         // 4
    "MOVB    16#09, SMB30\n"  // 5
    "ATCH    1, 8\n"          // 6
    "ENI\n"                   // 7
    "LD      I0.0\n"          // 8
    "EU\n"                    // 9
    "DTCH    8   // busy\n"   // 10
    "MEND\n"
    "INT     1\n"
    "LD      SM0.0\n"
    "MOVB    SMB2, VB1\n"
    "MOVB    1, VB0\n"
    "XMT     VB0, 0\n"
    "RETI\n";

TEST(Why, ACharacterWhoseEventIsNotAttachedLeadsToTheInstructionThatDetachedIt) {
  AtPrompt session(kStopsListening);
  session("continue 50ms; input I0.0=1; scan 3; break unanswered; send 41 42; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 2 characters since 5"));
  EXPECT_TRUE(has(text, ": event 8 is not attached; detached at 51."));
  EXPECT_TRUE(has(text, " by DTCH 8 in line 10  // busy\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 10u);
  EXPECT_NE(session.state().attached[8], kNotAttached) << "in front of it";
}

TEST(Why, AnAnswerThatAFaultHoldsBackLongerThanTheMasterWaitsIsNamedOnceForItAndForTheNextRequest) {
  AtPrompt session(kStopsListening);
  const std::string fault = ", and no character of it has left so far: fault answer:delay=9s: 1×\n";
  session("continue 50ms; break unanswered; fault answer:delay=9s; send 41; continue");
  EXPECT_TRUE(has(session("why"), "the PLC has been sending since 51."));
  EXPECT_TRUE(has(session("why"), fault));
  const std::string later =
      ", and no character of it has left so far; it does not listen meanwhile: fault answer:delay=9s: 1×\n";
  session("continue 3s; send 42; continue");
  EXPECT_TRUE(has(session("why"), "the PLC has been sending since 51."));
  EXPECT_TRUE(has(session("why"), later));
}

TEST(Why, AnEventThatWasNeverAttachedIsNamed) {
  AtPrompt session("LD SM0.1\nMOVB 9, SMB30\nMEND\n");
  session("continue 50ms; break unanswered; send 41; continue");
  const std::string why = session("why");
  EXPECT_TRUE(
      has(why,
          "event 8 is not attached; no instruction has attached it since power-up, and the program has no ATCH for event "
          "8 and no RCV; SMB30, which puts the port in Freeport mode, was set at "));
  EXPECT_TRUE(has(why, " by MOVB 9, SMB30 in line 2\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 2u);
}

TEST(Why, AnEventThatAnInstructionCouldHaveAttachedIsNoMissingInstruction) {
  AtPrompt session("LD SM0.1\nMOVB 9, SMB30\nLD I0.0\nATCH 0, 8\nENI\nMEND\nINT 0\nRETI\n");
  session("continue 50ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"), "event 8 is not attached; no instruction has attached it since power-up\n"));
}

TEST(Why, ARequestGivenUpInAnInterruptRoutineLeadsToWhatLeftItToo) {
  const std::string program = test::changed(std::string(kStopsListening), "ENI\n", "MOVB 10, SMB34\nATCH 2, 10\nENI\n") +
                              "INT 2\nLD SM0.0\nSQRT VD8, VD12\nRETI\n";  // half of the time
  bool given_up_in_it = false;
  for (int ms = 1; ms < 10 && !given_up_in_it; ms += 3) {
    AtPrompt session(program);
    session(fmt::format("continue 50ms; input I0.0=1; scan 3; continue {}ms; break unanswered; send 41 42; continue", ms));
    given_up_in_it = session.state().in_interrupt;
    session("rwhy");
    EXPECT_EQ(session.line(), 12u) << "the DTCH";
  }
  EXPECT_TRUE(given_up_in_it);
}

TEST(Why, AClosedImmediateContactLetsPowerThroughAtZero) {
  AtPrompt session("LD I0.1\n= M0.0\nLD M0.0\nONI I0.0\n= Q0.0\nMEND\n");
  const std::string text = session("continue 20ms; why Q0.0");
  EXPECT_TRUE(has(text, "Q0.0 is 1; last written")) << text;
  EXPECT_FALSE(has(text, "M0.0 is 0; last written")) << "M0.0 has decided nothing: " << text;
}

TEST(Why, AFrameOfLongAgoIsNoPartOfTheOneThatIsAskedAbout) {
  AtPrompt session(kStopsListening);
  session("continue 50ms; input I0.0=1; scan 3; break unanswered; send 41 42; continue; send 43 44 45; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 3 characters since "));
  EXPECT_FALSE(has(text, "no answer to 2 characters"));
}

TEST(Why, APortInPpiModeLeadsToTheInstructionThatLeftFreeportMode) {
  AtPrompt session(kStopsListening);
  session("continue 50ms; input I0.1=1; scan 3; break unanswered; send 41 42; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 2 characters since 5"));
  EXPECT_TRUE(has(text, ": the port is in PPI mode, and this is not a PPI frame; SMB30 was set at 51."));
  EXPECT_TRUE(has(text, " by MOVB 16#8, SMB30 in line 3\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 3u);
}

TEST(Why, APortThatWasNeverInFreeportModeIsNamedAlsoIfPpiTakesTheCharactersForItsOwn) {
  AtPrompt session("LD SM0.0\nMOVW 1, VW2\nMEND\n");
  session("continue 50ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"),
                  "the port is in PPI mode, and this is not a PPI frame; nothing has written SMB30 since power-up\n"));
  session("continue 200ms; send 68 05 05 68; continue");  // the head of a PPI frame
  EXPECT_TRUE(has(session("why"), "no answer: port 0 is in PPI mode; nothing has written SMB30 since power-up\n"));
  session("continue 200ms; send 10 05 00 49 4e 16; continue");  // the status of station 5
  EXPECT_TRUE(has(session("why"), "the request was for PPI station 5; port 0 is station 2\n"));
}

TEST(Why, SMB30SetFromOutsideIsNamed) {
  AtPrompt session(kStopsListening);
  session("continue 50ms; set SMB30=8; scan 3; break unanswered; send 41; continue");
  EXPECT_TRUE(
      has(session("why"), "the port is in PPI mode, and this is not a PPI frame; SMB30 was set from outside at 50."));
}

/// The slave of a scenario that is asked with a fault of the line.
std::string why_with(const std::string& fault, const std::string& master = "") {
  static const auto program = test::compile(test::slave_text());
  AtPrompt session(program);
  session("continue 2s; break unanswered; fault " + fault + "; send 01 03 00 0a 00 01 crc; continue");
  return session(master + "why");
}

TEST(Why, AnAnswerThatTheLineLostIsNamedWithItsTimesAndTheFault) {
  const std::string text = why_with("missing:of=answer,character=each");
  EXPECT_TRUE(has(text, "the PLC sent 7 characters from 20"));
  EXPECT_TRUE(has(text, " ms, and the master heard none of them: fault missing:"));
  EXPECT_FALSE(has(text, "no answer to"));
  EXPECT_FALSE(has(text, "nothing has decided"));
}

TEST(Why, AnAnswerThatTheLineChangedIsNamedWithWhatWasSentAndHeard) {
  const std::string text = why_with("flip:of=answer,character=2");
  EXPECT_TRUE(has(text, "the PLC sent 7 characters from 20"));
  EXPECT_TRUE(has(text, "and the master heard 01 02p 02 00 00 b8 44 instead of 01 03 02 00 00 b8 44: fault flip:"));
  EXPECT_TRUE(has(text, ": 1×"));
  EXPECT_TRUE(
      has(why_with("collision:of=answer,character=3,bytes=00"), " instead of 01 03 02 00 00 b8 44: fault collision:"));
}

TEST(Why, ARequestThatThePlcHasNotHeardIsNamedWithTheFault) {
  const std::string text = why_with("cut:from=0ms");
  EXPECT_TRUE(has(text, "the master sent 8 characters from 20"));
  EXPECT_TRUE(has(text, ", and the PLC heard nothing: fault cut:from=0"));
}

constexpr std::string_view kAsk = "; send 01 03 00 0a 00 01 crc; continue";

/// What `why` says of the last request after those commands.
std::string why_after(const std::string& commands) {
  static const auto program = test::compile(test::slave_text());
  AtPrompt session(program);
  session("continue 2s; break unanswered; " + commands);
  return session("why");
}

TEST(Why, OnlyFaultsThatStruckThisRequestAreNamed) {
  const std::string text = why_after(
      "fault flip:character=1,exchange=1; fault gap:character=2,length=1ms,exchange=9; fault "
      "missing:of=answer,character=each,exchange=2" +
      std::string(kAsk) + "; continue 100ms" + std::string(kAsk));
  EXPECT_TRUE(has(text, "and the master heard none of them: fault missing:character=each,of=answer,exchange=2: 7×\n"));
  EXPECT_FALSE(has(text, "flip"));
  EXPECT_FALSE(has(text, "gap"));
}

TEST(Why, AllFaultsThatStruckARequestAreNamedWithTheirCharacters) {
  const std::string text = why_after(
      "fault flip:character=3,bit=2; fault flip:character=6,bit=0; fault flip:of=answer,character=1" + std::string(kAsk));
  EXPECT_TRUE(has(text, "the master sent 8 characters from 20"));
  EXPECT_TRUE(has(text, ", and the PLC heard 01 03 04p "));
  EXPECT_TRUE(has(text,
                  " instead of 01 03 00 0a 00 01 a4 08: fault flip:character=3,bit=2: 1×, in character 3; fault "
                  "flip:character=6: 1×, in character 6\n"));
  EXPECT_FALSE(has(text, "of=answer"));
}

TEST(Why, ACollisionIsNamedWithTheCharactersThatItStruckWhateverElseMovedThem) {
  const auto why = [](const std::string& faults) { return why_after("fault " + faults + std::string(kAsk)); };
  EXPECT_TRUE(has(why("collision:character=3,bytes=0000"), ": 2×, in characters 3 and 4\n"));
  EXPECT_TRUE(has(why("collision:character=3,bytes=000000; fault gap:character=4,length=5ms"), ": 3×, in character 3; "));
  EXPECT_TRUE(has(why("gap:character=2,length=3ms; fault collision:character=1,bytes=0000"), ": 2×, in character 1; "));
  EXPECT_TRUE(has(why("collision:character=2,at=25bit,bytes=00"), ": 1×, in characters 4 and 5\n"));
  const std::string behind = why("extra:behind=2,bytes=55; fault collision:character=2,bytes=0000");
  EXPECT_TRUE(has(behind, "fault extra:behind=2,bytes=55: 1×, behind character 2; ")) << behind;
  EXPECT_TRUE(has(behind, "fault collision:character=2,bytes=0000: 2×, in character 2\n")) << behind;
  EXPECT_TRUE(has(why("break:character=2,length=40bit"), ": 1×, in characters 2, 3, 4 and 5\n"));
}

TEST(Why, AnEchoIsNotToBlameForWhatAnotherFaultChanged) {
  const std::string text = why_after("fault echo; fault flip:of=answer,character=3" + std::string(kAsk));
  EXPECT_TRUE(has(text, ": fault flip:character=3,of=answer: 1×, in character 3\n")) << text;
  EXPECT_FALSE(has(text, "echo"));
}

TEST(Why, AFaultThatDamagedARequestIsNamedBeforeWhatTheProgramMadeOfIt) {
  const std::string text = why_after("fault parity:character=2" + std::string(kAsk));
  EXPECT_TRUE(has(text, "and the PLC heard them with wrong parity: fault parity:character=2: 1×, in character 2\n"));
  EXPECT_TRUE(has(text, "no answer to 8 characters since 20"));
  EXPECT_LT(text.find("fault parity"), text.find("no answer to"));
}

TEST(Why, ABreakThatBeganBeforeTheRequestIsNamedWithItsTimes) {
  const std::string text = why_after("fault break:from=1ms,length=200ms; continue 20ms" + std::string(kAsk));
  EXPECT_TRUE(has(text, ", and the PLC heard nothing: fault break:length=200ms,from=1ms: 1×, from 2001."));
  EXPECT_FALSE(has(why_after("fault break:from=1ms,length=200ms; continue 20ms; fault none; continue 5ms; fault missing:"
                             "character=each" +
                             std::string(kAsk)),
                   "break"))
      << "which had been taken away";
}

TEST(Why, APauseThatAFaultMadeInARequestIsNamed) {
  const std::string text = why_after("fault gap:character=4,length=10ms" + std::string(kAsk));
  EXPECT_TRUE(has(text, "and the PLC heard them with a pause: fault gap:character=4,length=10ms: 1×, in character 4\n"));
  EXPECT_LT(text.find("with a pause"), text.find("no answer to 3 characters"));
}

TEST(Why, ABitThatAFaultInvertsInTheAnswerIsNotSomebodySendingAtTheSameTime) {
  const std::string text = why_after("fault flip:of=answer,character=2" + std::string(kAsk));
  EXPECT_TRUE(has(text, "fault flip:character=2,of=answer: 1×"));
  EXPECT_FALSE(has(text, "receiver is off"));
}

TEST(Why, ACharacterWhoseParityTheMasterWantsWrongIsNotTheFaultOfTheLine) {
  EXPECT_FALSE(has(why_after("send 01 03p 00 0a 00 01 crc; continue"), "the master sent"));
}

TEST(Why, AnAnswerThatCameDamagedIsNamedThoughTheRequestWasAnswered) {
  const std::string text = why_after("fault parity:of=answer,character=3" + std::string(kAsk));
  EXPECT_TRUE(
      has(text, "and the master heard them with wrong parity: fault parity:character=3,of=answer: 1×, in character 3"));
  EXPECT_TRUE(has(why_after("fault missing:of=answer,character=5,count=3" + std::string(kAsk)),
                  "and the master heard 01 03 02 00 instead of 01 03 02 00 00 b8 44: fault "
                  "missing:character=5,count=3,of=answer: 3×, in characters 5, 6 and 7\n"));
}

TEST(Why, AnAnswerThatTheProgramSentWithoutARightCrcIsNotTheFaultOfTheLine) {
  AtPrompt session(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nENI\nMOVW 16#0103, VW1\nMOVB 2, VB0\nMEND\n"
      "INT 1\nLD SM0.0\nINCW VW90\nLDW= VW90, 8\nXMT VB0, 0\nRETI\n");
  session("continue 50ms; fault flip:exchange=2; send 01 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(has(session("why"), "the PLC sent 2 characters from 5"));
  EXPECT_TRUE(has(session("why"),
                  "and the master heard them as they were sent; they are not a Modbus RTU frame with a right CRC\n"));
  EXPECT_FALSE(has(why_after("send 01 03 00 0a 00 01 crc; continue"), "heard"));
}

TEST(Why, NoiseThatTheMasterTookForTheAnswerIsNamed) {
  const std::string text = why_after("fault noise:ber=5%" + std::string(kAsk));
  EXPECT_TRUE(has(text, "the master heard ff fd ffp fb ef fe from 2010."));
  EXPECT_TRUE(has(text, ", which no S7-200 has sent: fault noise:ber=0.05: "));
}

TEST(Why, ARequestForAnotherStationIsSaidToBeSoFirst) {
  const std::string text = why_after("send 02 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(has(
      text, "the request was for station 2; the program compared its first character with 1: LDB= SMB2, VB4095 in line "));
  EXPECT_TRUE(has(text, "CRETI in line 662, not taken"));
  EXPECT_LT(text.find("the request was for"), text.find("CRETI"));
  EXPECT_FALSE(has(why_after("send 01 03 00 0a 00 01 00 00; continue"), "the request was for"));
}

std::string why_station_5(const std::string& program) {
  AtPrompt session(check_text(program, "test.stl", cpu224(), default_times(cpu224())).program);
  session("continue 100ms; break unanswered; send 05 03 00 00 00 01 crc; continue 2s");
  session("send 05 03 00 00 00 01 crc; continue 2s");
  return session("why");
}

TEST(Why, ARequestForAnotherStationNamesTheCompareWhereverTheFirstCharacterHasGone) {
  const std::string frame = "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMOVD &VB101, VD0\n";
  const std::string copied =
      "LDB= VB50, 8\nMOVB 0, VB50\nMOVD &VB101, VD0\nLDB= VB101, 2\nXMT VB100, 0\nMEND\n"
      "INT 0\nLD SM0.0\nMOVB SMB2, *VD0\nINCD VD0\nINCB VB50\nRETI\n";
  EXPECT_TRUE(has(why_station_5(frame + copied),
                  "the request was for station 5; the program compared its first "
                  "character with 2: LDB= VB101, 2 in line 9\n"));
  const std::string received =
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#94, SMB87\nMOVW 5, SMW90\nMOVW 5, SMW92\nMOVB 100, SMB94\nATCH 0, 23\nENI\n"
      "RCV VB100, 0\nMEND\nINT 0\nLDB= VB101, 2\nXMT VB100, 0\nLD SM0.0\nRCV VB100, 0\nRETI\n";
  EXPECT_TRUE(has(why_station_5(received),
                  "the request was for station 5; the program compared its first character "
                  "with 2: LDB= VB101, 2 in line 12\n"));
  const std::string library =
      "LD SM0.1\nCALL MBUS_INIT, 1, 2, 9600, 2, 0, 128, 32, 100, &VB1000, M0.1, MB1\n"
      "LD SM0.0\nCALL MBUS_SLAVE, M0.2, MB2\n";
  const std::string text = why_station_5(library);
  EXPECT_TRUE(has(text, "the request was for station 5; the program compared its first character with 2: LDB= mbTo"));
  EXPECT_TRUE(has(text.substr(0, text.find('\n')), " in stand-in:modbus_slave.awl:"));
}

TEST(Why, ACompareOfAnotherCharacterIsNotThatOfTheStation) {
  const std::string text = why_station_5(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#94, SMB87\nMOVW 5, SMW90\nMOVW 5, SMW92\nMOVB 100, SMB94\nATCH 0, 23\nENI\n"
      "MOVB 5, VB7\nRCV VB100, 0\nMEND\nINT 0\nLDB= VB7, 6\nXMT VB100, 0\nLD SM0.0\nRCV VB100, 0\nRETI\n");
  EXPECT_TRUE(has(text, "LDB= VB7, 6: VB7=16#05"));
  EXPECT_FALSE(has(text, "the request was for"));
}

/// Keeps a line of text in VB101 …; sends it when its end has come, M0.0.
constexpr std::string_view kLines =
    "LD      SM0.1\n"  // 1
    "MOVB    16#09, SMB30\n"
    "MOVB    0, VB100\n"
    "MOVD    &VB101, VD0\n"
    "ATCH    1, 8\n"
    "ENI\n"
    "LD      M0.0\n"             // 7
    "XMT     VB100, 0  // it\n"  // 8
    "R       M0.0, 1\n"
    "MEND\n"
    "INT     1\n"
    "LD      SM0.0\n"
    "MOVB    SMB2, *VD0\n"
    "INCD    VD0\n"
    "INCB    VB100\n"
    "LDB=    SMB2, 16#0D\n"  // 16
    "S       M0.0, 1\n"
    "RETI\n";

/// Without INCB, which it does not have.
std::string lines_of_cpu_214() { return test::changed(std::string(kLines), "INCB    VB100\n", "INCW    VW90\n"); }

TEST(Why, ATextThatAProgramSwallowsLeadsToTheXmtWithoutPowerFlow) {
  AtPrompt session(lines_of_cpu_214());
  session("continue 50ms; break unanswered; send 'one'; continue; send 'two'; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, "no answer to 3 characters since "));
  EXPECT_TRUE(has(why,
                  ": INT 1 took them, and nothing was sent since: XMT VB100, 0 in line 8, without power flow (LD M0.0: "
                  "M0.0=0)  // it\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 8u);
}

TEST(Why, ATextThatAProgramSwallowsLeadsToTheJumpOverItsXmt) {
  AtPrompt session(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nENI\nLDN M0.0\nJMP 1\nLD SM0.0\nXMT VB0, 0\nLBL 1\nLD SM0.0\nINCW VW10\nMEND\n"
      "INT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n");
  session("continue 50ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"), "no answer to a character since 5"));
  EXPECT_TRUE(has(session("why"), ": INT 1 took it, and nothing was sent since: JMP 1 in line 6 (LDN M0.0: M0.0=0)\n"));
}

TEST(Why, ATextThatAProgramWithoutXmtSwallowsIsSaidToBeTaken) {
  AtPrompt session("LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n");
  session("continue 50ms; break unanswered; send 41 42; continue");
  EXPECT_TRUE(has(session("why"), ": INT 1 took them, and nothing was sent since (no XMT was executed)\n"));
}

TEST(Why, ATextThatAProgramTakesIsNamedWhileTheMasterStillWaits) {
  AtPrompt session(lines_of_cpu_214());
  session("continue 50ms; send 'one'; continue 200ms");
  EXPECT_TRUE(has(session("why"), "no answer to 3 characters since "));
  EXPECT_TRUE(has(session.out.str(), ": INT 1 took them, and nothing was sent since: XMT VB100, 0 in line 8, without"));
  session("rwhy");
  EXPECT_EQ(session.line(), 8u);
}

TEST(Why, ATextIsNotSaidToBeTakenBeforeThePauseThatEndsIt) {
  AtPrompt session(lines_of_cpu_214());
  session("continue 50ms; send 'one'; continue 4ms");
  EXPECT_FALSE(has(session("why"), "no answer"));
}

TEST(Why, AMessageThatRCVTookLeadsToTheXmtWithoutPowerFlow) {
  constexpr std::string_view kReceiver =
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#B0, SMB87\nMOVB 16#0D, SMB89\nMOVW 5, SMW90\nMOVB 10, SMB94\n"
      "ATCH 0, 23\nENI\nRCV VB100, 0\nLD M0.0\nXMT VB200, 0\nMEND\n"  // 7
      "INT 0\nLD SM0.0\nINCW VW0\nRCV VB100, 0\nRETI\n";              // 13
  AtPrompt session(check_text(kReceiver, "test.stl", cpu224(), default_times(cpu224())).program);
  session("continue 50ms; break unanswered; send 41 0d; continue");
  EXPECT_TRUE(has(session("why"), "no answer to 2 characters since 5"));
  EXPECT_TRUE(has(session.out.str(),
                  ": INT 0 took the message, and RCV in line 16 waits for the next one: XMT VB200, 0 in "
                  "line 11, without power flow (LD M0.0: M0.0=0)\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 11u);
}

/// The flag by which RCV waits again has been switched on by what was wrong with the message.
TEST(Why, WhatHasSwitchedTheDecidingContactIsNamedToo) {
  constexpr std::string_view kSlave =
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#94, SMB87\nMOVW 5, SMW90\nMOVW 5, SMW92\nMOVB 100, SMB94\n"
      "ATCH 0, 23\nENI\nRCV VB100, 0\nLD M0.0\nR M0.0, 1\nRCV VB100, 0\nMEND\n"  // 7
      "INT 0\nLDB<> VB101, 2\nS M0.0, 1\nCRETI\nLDW<> VW103, 16#FFFF\nS M0.0, 1\nCRETI\n"  // 14
      "LD SM0.0\nXMT VB100, 0\nRETI\n";
  const auto why = [&](const std::string& frame) {
    AtPrompt session(check_text(kSlave, "test.stl", cpu224(), default_times(cpu224())).program);
    session("continue 50ms; break unanswered; send " + frame + "; continue");
    return session("why");
  };
  const std::string other_station = why("03 41 ff ff"), wrong_sum = why("02 41 ff fe");
  EXPECT_TRUE(has(other_station, " by S M0.0, 1 in line 16 (LDB<> VB101, 2: VB101=16#03)\n")) << other_station;
  EXPECT_TRUE(has(wrong_sum, ": the contact in line 10 (LD M0.0: M0.0=1)\n")) << wrong_sum;
  EXPECT_TRUE(has(wrong_sum, "ms  M0.0 was 1: last written at ")) << wrong_sum;
  EXPECT_TRUE(has(wrong_sum, " by S M0.0, 1 in line 19 (LDW<> VW103, 16#FFFF: VW103=16#FFFE)\n")) << wrong_sum;
}

/// RCV takes what comes after a pause, to a CR or 10 characters.
constexpr std::string_view kMessages =
    "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#B0, SMB87\nMOVB 16#0D, SMB89\nMOVW 5, SMW90\nMOVB 10, SMB94\n"
    "ATCH 0, 23\nENI\nRCV VB100, 0 // a line\nLD M0.0\nJMP 1\nLBL 1\nMEND\n"  // 7
    "INT 0\nLD SM0.0\nRCV VB100, 0\nRETI\n";                                  // 14

AtPrompt session_of_cpu_224(const std::string& text) {
  return AtPrompt(check_text(text, "test.stl", cpu224(), default_times(cpu224())).program);
}

TEST(Why, AMessageThatHasNotEndedLeadsToItsRCVWhichSaysWhatItWaitsFor) {
  for (const std::string_view pause : {"", "; step", "; step 2"}) {
    AtPrompt session = session_of_cpu_224(std::string(kMessages));
    session("continue 50ms; break unanswered; send 41 42; continue" + std::string(pause));
    EXPECT_TRUE(has(session("why"),
                    ": RCV took them and waits for the end of its message: the character 16#0D or 10 characters (2 so far); "
                    "executed at "));
    EXPECT_TRUE(has(session.out.str(), " by RCV VB100, 0 in line 9  // a line\n"));
    session("rwhy");
    EXPECT_EQ(session.line(), 9U) << pause;
    EXPECT_EQ(session.state().scans, 0U);
  }
}

TEST(Why, CharactersBeforeTheStartOfAMessageLeadToTheRCVThatWaitsForIt) {
  const std::string from_stx =
      test::changed(std::string(kMessages), "MOVB 16#B0, SMB87\n", "MOVB 16#F0, SMB87\nMOVB 2, SMB88\n");
  AtPrompt session = session_of_cpu_224(from_stx);
  session("continue 50ms; break unanswered; send 41 42; continue");
  EXPECT_TRUE(has(session("why"),
                  ": RCV waits for the start of a message: an idle line of 5 ms, then the character 16#02; executed at "));
  session("rwhy");
  EXPECT_EQ(session.line(), 10U);
}

/// Answers a request of 8 characters with three XMT, two characters each.
constexpr std::string_view kInParts =
    "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nMEND\n"
    "INT 0\nLD SM0.0\nMOVB SMB2, VB100\nINCW VW90\nLDW>= VW90, 8\nMOVW 0, VW90\nMOVD 16#02010302, VD0\nATCH 1, 9\n"
    "XMT VB0, 0\nRETI\n"
    "INT 1\nLD SM0.0\nMOVD 16#02020000, VD0\nATCH 2, 9\nXMT VB0, 0\nRETI\n"
    "INT 2\nLD SM0.0\nMOVB 2, VB0\nMOVW 16#B844, VW1\nDTCH 9\nXMT VB0, 0\nRETI\n";

TEST(Why, AnAnswerOfSeveralXmtIsOneFrame) {
  AtPrompt session(kInParts);
  session("continue 50ms; send 01 03 00 0a 00 01 crc; continue 50ms");
  EXPECT_TRUE(has(session("why"), "the PLC sent 6 characters from "));
  EXPECT_TRUE(has(session.out.str(), "heard them as they were sent; they are not a Modbus RTU frame with a right CRC\n"));
  session("continue 100ms; send 41 42 43 44 45 46 47 48; continue 50ms");
  EXPECT_FALSE(has(session("why"), "sent")) << "to a text it is an answer";
}

TEST(Why, NoiseThatDamagedTheRequestIsNamedBesideTheNoiseThatWasTakenForItsAnswer) {
  const std::string text = why_after("fault noise:ber=0.02,seed=3" + std::string(kAsk));
  const std::size_t request = text.find("the master sent 8 characters from 20"),
                    answer = text.find("which no S7-200 has sent");
  EXPECT_TRUE(has(text, " instead of 01 03 00 0a 00 01 a4 08: fault noise:ber=0.02,seed=3: "));
  EXPECT_TRUE(has(text, "the master heard ffp from 20"));
  EXPECT_LT(request, answer) << text;
}

TEST(Why, TwoFramesThatASlaveTookWhileItWaitedForSilenceAreTold) {
  static const auto program = test::compile(test::slave_text());
  AtPrompt session(program);
  session(
      "continue 2s; break unanswered; send 02 03 00 0a 00 01 crc; continue 13300us; send cancel; "
      "send 01 03 00 0a 00 01 crc; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 8 characters since 201")) << "the second alone";
  EXPECT_TRUE(has(text, " took them without reading SMB2"));
  EXPECT_FALSE(has(text, "16 characters"));
  EXPECT_FALSE(has(text, "since 2000."));
}

TEST(Why, OfAFrameThatAPauseBrokeUpTheFirstPartIsWhereToGoBackTo) {
  static const auto program = test::compile(test::slave_text());
  AtPrompt session(program);
  session("continue 2s; break unanswered; fault gap:character=4,length=10ms; send 01 03 00 0a 00 01 crc; continue");
  const std::string text = session("why");
  const std::size_t first = text.find("no answer to 3 characters");
  ASSERT_NE(first, std::string::npos);
  const std::size_t second = text.find("no answer to 5 characters", first);
  ASSERT_NE(second, std::string::npos) << text;
  session("rwhy");
  EXPECT_LT(session.simulation.time(), 2013 * kMillisecond) << "before the second part";
}

TEST(Why, AFrameTooSoonAfterOneOfTheSameMasterIsSaidToBeSo) {
  static const auto program = test::compile(test::slave_text());
  AtPrompt session(program);
  session(
      "continue 2s; break unanswered; send 02 03 00 0a 00 01 crc; continue 10200us; send cancel; "
      "send 01 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(
      has(session("why"), "and the PLC heard no pause between that and others: the master sent 8 characters from 20"));
}

TEST(Why, TheAnswerComesBeforeWhatLedToWhereItStands) {
  const std::string text = why_after("fault cut:from=0ms" + std::string(kAsk) + "; until 85");
  ASSERT_TRUE(has(text, "what led here: main"));
  EXPECT_LT(text.find("the PLC heard nothing"), text.find("what led here"));
}

TEST(Why, AFrameWithALongBreakInItsFirstCharacterIsOneThatTheProgramHasLeft) {
  const std::string text = why_with("break:character=1,length=40bit");
  EXPECT_TRUE(has(text, "no answer to 5 characters since 20"));
  EXPECT_TRUE(has(text, ": JMP 255 in line 141 (LDW= AC0, 0"));
}

TEST(Why, AnAnswerThatArrivesIsNotMentioned) {
  EXPECT_FALSE(has(why_with("none"), "the PLC sent"));
  EXPECT_FALSE(has(why_with("flip:of=answer,character=2,exchange=2"), "the PLC sent"));
  EXPECT_FALSE(has(why_with("missing:of=answer,character=each", "continue 200ms; "), "the PLC sent")) << "long ago";
}

TEST(Why, AnAnswerAfterTheMasterHasGivenUpIsNamedSo) {
  serial::Simulation simulation(program_of(kEcho));
  simulation.power_up();
  std::ostringstream out;
  PromptSettings options{};
  options.session.master.timeout = 10 * kMicrosecond;
  Prompt debugger(std::vector{&simulation}, out, options);
  EXPECT_FALSE(debugger.execute("continue 50ms; break unanswered; send 41; continue; continue 10ms; why"));
  EXPECT_TRUE(has(out.str(), "the PLC sent a character from 5"));
  EXPECT_TRUE(has(out.str(), "and the master heard nothing of it: the master had given up at 51."));
}

TEST(Why, AnAnswerThatBeganBeforeTheRequestHadEndedIsNamedSo) {
  AtPrompt session(kEcho);
  session("continue 50ms; break unanswered; send 41 42; continue");
  EXPECT_TRUE(has(session("why"), "the master was still sending, up to 52."));
}

/// The slave with its ENI replaced, after a request that nothing has answered.
struct SlaveWithoutEni : AtPrompt {
  explicit SlaveWithoutEni(const std::string& instead)
      : AtPrompt(test::changed(test::slave_text(), "\nENI", "\n" + instead)) {
    (*this)("continue 1s; break unanswered; send 01 03 00 0a 00 01 crc; continue");
  }
};

TEST(Why, CharactersThatWaitForDisabledInterruptsWereNotTakenByTheirRoutine) {
  constexpr std::string_view kWait =
      ": interrupts are disabled; 4 characters wait in the queue, 4 were lost because it was full; ";
  SlaveWithoutEni never("NOP 0");
  EXPECT_TRUE(has(never("why"), "no answer to 8 characters since 100"));
  EXPECT_TRUE(has(never.out.str(), std::string(kWait) + "no ENI was executed since power-up\n"));
  EXPECT_FALSE(has(never.out.str(), "took"));
  SlaveWithoutEni disabled("DISI");
  EXPECT_TRUE(has(disabled("why"), std::string(kWait) + "disabled at 52."));
  EXPECT_TRUE(has(disabled.out.str(), " by DISI in line 122"));
  disabled("rwhy");
  EXPECT_EQ(disabled.line(), 122u) << "in front of it";
  EXPECT_LT(disabled.state().time, 60 * kMillisecond);
}

TEST(Why, ACpuThatWentToRunHasDisabledInterruptsItself) {
  AtPrompt session("LDN M0.0\nAN SM0.1\nENI\nLD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nMEND\nINT 1\nRETI\n");
  session(
      "continue 50ms; set M0.0=1; mode stop; continue 10ms; mode run; continue 50ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"),
                  ": interrupts are disabled; a character waits in the queue; no ENI was executed since the "
                  "CPU went to RUN at "));
}

TEST(Why, CharactersLostBecauseTheirQueueWasFullAreNotTaken) {
  std::string text = "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nDISI\nLD I0.0\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n";
  AtPrompt session(text);
  session("continue 50ms; break unanswered; send 41 42 43 44 45 46; continue 50ms; input I0.0=1; continue");
  EXPECT_TRUE(has(session("why"), "of 6 characters since 5"));
  EXPECT_TRUE(has(session.out.str(), ", 2 were lost because the interrupt queue was full\n"));
  EXPECT_TRUE(has(session.out.str(), "no answer to 4 characters since 5"));
  EXPECT_TRUE(has(session.out.str(), ": INT 1 took them"));
}

/// At 38400 baud a character takes 0.286 ms.
TEST(Why, CharactersAreLostWhereTheirRoutineTakesLongerThanACharacter) {
  AtPrompt session(
      "LD SM0.1\nMOVB 16#41, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nMOVR 1.5, AC0\n*R 1.5, AC0\n"
      "*R 1.5, AC0\n*R 1.5, AC0\n*R 1.5, AC0\nRETI\n");
  std::string many;
  for (int i = 0; i < 60; ++i) many += " 41";
  session("continue 50ms; break lost; send" + many + "; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(
      why, "1 was lost because the interrupt queue was full; until then a character came every 286.458 us, and INT 1 took "))
      << why;
}

TEST(Why, ACharacterThatIsLostIsNamedWhileTheRequestIsBeingSent) {
  AtPrompt session("LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nDISI  // too long\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n");
  session("continue 50ms; break lost; send 41 42 43 44 45 46 47 48; continue");
  EXPECT_TRUE(
      has(session("why"), ": interrupts are disabled; 4 characters wait in the queue, 1 was lost because it was full; "))
      << session.out.str();
}

TEST(Why, CharactersLostBeforeInterruptsWereDisabledAreNotBlamedOnThat) {
  std::string text =
      "LD I0.1\nEU\nDISI  // short\nLD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nDISI\nLD I0.0\nENI\nMEND\n"
      "INT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n";
  AtPrompt session(text);
  session("continue 50ms; break unanswered; send 41 42 43 44 45 46; continue 50ms; input I0.0=1; continue 10ms");
  session("input I0.0=0; input I0.1=1; continue 10ms");
  const std::string why = session("continue; why");
  EXPECT_TRUE(has(why, "of 6 characters since 5")) << why;
  EXPECT_TRUE(has(why, ", 2 were lost because the interrupt queue was full\n")) << why;
  EXPECT_FALSE(has(why, "short")) << why;
  EXPECT_FALSE(has(why, "RCV")) << why;
}

TEST(Why, AllCharactersLostAreNotSaidToBeTakenByRCV) {
  std::string text = "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nDISI\nLD I0.0\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n";
  AtPrompt session(text);
  session("continue 50ms; send 41 42 43 44; continue 50ms; send cancel; break unanswered; send 51 52; continue 50ms");
  const std::string why = session("input I0.0=1; continue; why");
  EXPECT_TRUE(has(why, "of 2 characters since ")) << why;
  EXPECT_TRUE(has(why, ", 2 were lost because the interrupt queue was full\n")) << why;
  EXPECT_FALSE(has(why, "RCV")) << why;
}

TEST(Why, OfSeveralDisiInARowTheFirstIsNamed) {
  AtPrompt session(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nENI\nLD I0.0\nEU\nDISI  // first\nLD I0.0\nDISI  // again\nMEND\n"
      "INT 1\nMOVB SMB2, VB1\nRETI\n");
  session("continue 50ms; input I0.0=1; continue 20ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"), "interrupts are disabled; a character waits in the queue; disabled at 5"))
      << session.out.str();
  EXPECT_TRUE(has(session.out.str(), "// first\n"));
}

/// What a slave's characters are kept by: I0.4 and I0.5 change it once, I0.6 and I0.7 in every scan.
constexpr std::string_view kTurns =
    "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\n"                       // 1 to 4
    "LD I0.4\nEU\nMOVB 8, SMB30  // to PPI\n"                         // 7
    "LD I0.5\nEU\nDTCH 8  // not now\n"                               // 10
    "LD I0.6\nMOVB 8, SMB30\nLD I0.7\nDTCH 8\nLD I1.0\nDISI\nMEND\n"  // 12, 14, 16
    "INT 0\nLD SM0.0\nMOVB SMB2, VB50\nRETI\n";

TEST(Why, WhatChangedWithinTheFirstCharacterIsNamed) {
  for (const std::string wait : {"100us", "400us", "900us"})
    for (const std::string& send : {"continue " + wait + "; send 'mn'; continue 1100us", "send 'mn'; continue " + wait}) {
      AtPrompt ppi(kTurns), detached(kTurns);
      ppi("continue 20ms; break unanswered; input I0.4=1; " + send + "; continue");
      EXPECT_TRUE(has(ppi("why"), "the port is in PPI mode, and this is not a PPI frame; SMB30 was set at 2")) << send;
      EXPECT_TRUE(has(ppi.out.str(), " by MOVB 8, SMB30 in line 7  // to PPI\n"));
      detached("continue 20ms; break unanswered; input I0.5=1; " + send + "; continue");
      EXPECT_TRUE(has(detached("why"), "event 8 is not attached; detached at 2")) << send;
      EXPECT_TRUE(has(detached.out.str(), " by DTCH 8 in line 10  // not now\n"));
      detached("rwhy");
      EXPECT_EQ(detached.line(), 10u);
    }
}

TEST(Why, WhatWasSoAlreadyIsNotToBlame) {
  const auto why_with = [](const std::string& first, const std::string& again) {
    AtPrompt session(kTurns);
    session("continue 20ms; break unanswered; input " + first + "=1; continue 20ms; input " + again + "=1; continue 50ms");
    return session("send 'ab'; continue; why");
  };
  EXPECT_TRUE(has(why_with("I0.4", "I0.6"), " by MOVB 8, SMB30 in line 7"));
  EXPECT_TRUE(has(why_with("I0.5", "I0.7"), " by DTCH 8 in line 10"));
  const std::string every_scan = why_with("I0.7", "I0.0");
  EXPECT_TRUE(has(every_scan, "detached at 2")) << every_scan;
  EXPECT_TRUE(has(every_scan, " by DTCH 8 in line 14\n"));
  const std::string disabled = why_with("I1.0", "I0.0");
  EXPECT_TRUE(has(disabled, "interrupts are disabled; 2 characters wait in the queue; disabled at 2")) << disabled;
  EXPECT_TRUE(has(disabled, " by DISI in line 16\n"));
}

TEST(Why, AllTransmissionsThatATextCouldHaveMeantAreNamedAsTheyWereAfterIt) {
  AtPrompt session(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 1, VB99\nATCH 0, 8\nENI\n"
      "LD M0.0\nA I0.5\nXMT VB99, 0\nLD M0.0\nR M0.0, 1\nLD I0.6\nXMT VB98, 0  // alarm\nMEND\n"  // 8, 12
      "INT 0\nLD SM0.0\nMOVB SMB2, VB100\nS M0.0, 1\nRETI\n");
  session("continue 50ms; break unanswered; send 41; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, "XMT VB99, 0 in line 8, without power flow (LD M0.0: M0.0=1; A I0.5: I0.5=0)")) << why;
  EXPECT_TRUE(has(why, "XMT VB98, 0 in line 12, without power flow (LD I0.6: I0.6=0)  // alarm")) << why;
}

TEST(Why, AFaultThatBrokeAnAnswerOffIsNamedWhileThePlcIsStillSending) {
  for (const std::string fault : {"cut:character=4,of=answer", "gap:character=4,length=20ms,of=answer"}) {
    AtPrompt session(test::compile(test::slave_text()));
    session("continue 1s; break wrong; fault " + fault + "; send 01 03 00 0a 00 01 crc; continue");
    EXPECT_TRUE(has(session.out.str(), "wrong, hit"));
    EXPECT_TRUE(has(session("why"), "the PLC has been sending since 10")) << fault;
    EXPECT_TRUE(has(session.out.str(), ", and the master heard 01 03 02: fault " + fault + ": 1×, in character 4\n"));
  }
}

TEST(Why, ABreakIsNamedWithTheXmtThatHadNothingToSend) {
  AtPrompt session(
      "LD SM0.1\nMOVB 9, SMB30\nATCH 1, 8\nENI\nMEND\n"
      "INT 1\nLD SM0.0\nXMT VB0, 0   // length in VB0\nRETI\n");
  session("continue 50ms; break wrong; send 41; continue");
  EXPECT_TRUE(
      has(session("why"), "the PLC sent a break: 0 characters to send for XMT VB0, 0 in line 8  // length in VB0\n"));
}

TEST(Why, AStopWithinARequestIsWhatKeptItsCharactersFromTheProgram) {
  AtPrompt session(kEcho);
  session("continue 50ms; break unanswered; send 41 42 43 44 45 46 47 48; continue 3ms; mode stop; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, "the CPU is in STOP"));
  EXPECT_TRUE(has(why, "a programming device has switched the CPU to STOP"));
  EXPECT_FALSE(has(why, "SMB30")) << "which the program had set to Freeport";
}

TEST(Why, AStopByTheProgramIsNamedWithItsContacts) {
  AtPrompt session("LD I0.0\nSTOP\nMEND\n");
  session("continue 20ms; input I0.0=1; continue 1s");
  EXPECT_TRUE(has(session("why"), "the CPU went to STOP by STOP in line 2 (LD I0.0: I0.0=1)\n"));
}

TEST(Why, AWatchdogNamesTheLoopThatTookTheTime) {
  AtPrompt session("LBL 1\nLD SM0.0\nMOVW 1, VW0\nLD I0.0\nJMP 1\nMEND\n");
  session("continue 20ms; input I0.0=1; continue 2s");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "the CPU went to STOP with fatal error 0003, "));
  EXPECT_TRUE(has(text, "; the scan that began at "));
  EXPECT_TRUE(has(text, " took longer than the watchdog allows: JMP 1 in line 5 was executed "));
}

TEST(Why, AFailedExpectationIsWhatItIsAboutAsLongAsItStandsThere) {
  AtPrompt session("LD I0.3\n= Q0.1\nLD SM0.0\nMOVW 7, VW0\nMEND\n");
  session("continue 20ms");
  EXPECT_TRUE(has(session.error_of("expect Q0.1 = 1"), "does not hold"));
  EXPECT_TRUE(has(session("why"), "Q0.1 is 0; last written at "));
  EXPECT_TRUE(has(session("why"), " by = Q0.1 in line 2 (LD I0.3: I0.3=0)\n"));
  session("step");
  EXPECT_FALSE(has(session("why"), "Q0.1 is 0"));
}

TEST(Why, AnAddressIsAnsweredFromItsWriterToAnInput) {
  AtPrompt session("LD I0.3\n= M0.0\nLDN M0.0\n= Q0.1\nLD I0.4\nMOVW 7, VW0\nMEND\n");
  session("continue 20ms");
  const std::string output = session("why Q0.1");
  EXPECT_TRUE(has(output, "Q0.1 is 1; last written at "));
  EXPECT_TRUE(has(output, "\n  M0.0 was 0: last written at "));
  EXPECT_TRUE(has(output, " by = M0.0 in line 2 (LD I0.3: I0.3=0)\n"));
  EXPECT_TRUE(has(session("why VW0"), "nothing has written it since power-up; MOVW 7, VW0 in line 6 could, which had no "));
  EXPECT_TRUE(has(session("why I0.3"), "it is an input, which the program does not write"));
}

/// A line of `why` each.
std::size_t lines_of(const std::string& text) { return static_cast<std::size_t>(std::ranges::count(text, '\n')); }

TEST(Why, ACoilThatHoldsItselfIsOneLineWithWhatSwitchedItOn) {
  AtPrompt session("LD I0.0\nO Q0.0\nAN I0.1\n= Q0.0\nMEND\n");
  session("continue 20ms; input I0.0=1; continue 20ms; input I0.0=0; continue 100ms");
  const std::string on = session("why Q0.0");
  EXPECT_TRUE(has(on, "\n  Q0.0 was 1: it holds itself since 2")) << on;
  EXPECT_TRUE(has(on, ", switched on by = Q0.0 in line 4 (LD I0.0: I0.0=1; O Q0.0: Q0.0=0; AN I0.1: I0.1=0)\n")) << on;
  EXPECT_EQ(lines_of(on), 2u) << on;
  session("input I0.1=1; continue 20ms; input I0.1=0; continue 100ms");
  const std::string off = session("why Q0.0");
  EXPECT_TRUE(has(off, "\n  Q0.0 was 0: it has been so since 14")) << off;
  EXPECT_TRUE(has(off, ", switched off by = Q0.0 in line 4 (LD I0.0: I0.0=0; O Q0.0: Q0.0=1; AN I0.1: I0.1=1)\n")) << off;
}

TEST(Why, BitsThatHoldEachOtherLeadToWhatSwitchedThemOn) {
  AtPrompt session("LD I0.2\nO M0.1\n= M0.0\nLD M0.0\n= M0.1\nMEND\n");
  session("continue 20ms; input I0.2=1; continue 20ms; input I0.2=0; continue 100ms");
  const std::string text = session("why M0.1");
  EXPECT_TRUE(has(text, "M0.1 was 1: it holds itself since 2")) << text;
  EXPECT_TRUE(has(text, "M0.0 was 1: it holds itself since 2")) << text;
  EXPECT_TRUE(has(text, ", switched on by = M0.0 in line 3 (LD I0.2: I0.2=1; O M0.1: M0.1=0)\n")) << text;
}

TEST(Why, ABitThatDecidesInTwoPlacesDoesNotHoldItself) {
  AtPrompt session("LD I0.0\n= M0.0\nLD M0.0\n= M0.1\nLD M0.0\nA M0.1\n= Q0.0\nMEND\n");
  session("continue 20ms; input I0.0=1; continue 20ms");
  EXPECT_FALSE(has(session("why Q0.0"), "holds itself"));
}

/// CPU 224 has subroutines with parameters, and BTI.
std::shared_ptr<const Program> with_blocks(std::string_view text) {
  return check_text(text, "test.awl", cpu224(), default_times(cpu224())).program;
}

TEST(Why, AMoveLeadsToWhatItMoved) {
  AtPrompt session(
      with_blocks("LD I0.7\nMOVB IB0, MB0\nMOVW VW2, VW4\nMOVW VW4, AC0\nMOVW AC0, VW10\nLD I1.0\nMOVW 5, VW2\n"
                  "LD SM0.0\nMOVB MB0, MB1\nMOVB MB1, MB2\nMOVB MB2, MB1\nBTI MB0, VW20\nMEND\n"));
  session("input I0.7=1 I1.0=1; scan 3");
  const std::string word = session("why VW10");
  EXPECT_TRUE(has(word, "VW10 is 16#0005 (5); last written at ")) << word;
  EXPECT_TRUE(has(word, "\n  VW4 was 16#0005 (5): last written at ")) << word;
  EXPECT_TRUE(has(word, "\n  VW2 was 16#0005 (5): last written at ")) << word;
  EXPECT_TRUE(has(word, " by MOVW 5, VW2 in line 7 (LD I1.0: I1.0=1)\n")) << word;
  const std::string bit = session("why M0.7");
  EXPECT_TRUE(has(bit, " by MOVB IB0, MB0 in line 2 (LD I0.7: I0.7=1)\n  I0.7 was 1: an input\n")) << bit;
  EXPECT_TRUE(has(session("why V21.7"), "\n  M0.7 was 1: last written at ")) << "the lower byte of the word";
  EXPECT_FALSE(has(session("why V20.7"), "M0.7 was")) << "BTI fills it up";
  EXPECT_TRUE(has(session("why MB2"), "\n  MB1 was ")) << "words in a circle end";
}

TEST(Why, SHRBLeadsToWhereTheBitEnteredAndToItsNeighbour) {
  AtPrompt session(with_blocks("LD I0.1\nEU\nSHRB M9.0, V0.7, 3\nLD I0.0\n= M9.0\nMEND\n"));
  session("input I0.0=1; scan 3; input I0.1=1; scan 3; input I0.0=0 I0.1=0; scan 3; input I0.1=1; scan 3");
  const std::string shifted = session("why V1.0");
  EXPECT_TRUE(has(shifted, "V1.0 is 1; last written at ")) << shifted;
  EXPECT_TRUE(has(shifted, "\n  V0.7 was 1: last written at ")) << shifted;
  EXPECT_TRUE(has(shifted, "\n  M9.0 was 1: last written at ")) << shifted;
  EXPECT_TRUE(has(shifted, " by = M9.0 in line 5 (LD I0.0: I0.0=1)\n")) << shifted;
  const std::string entered = session("why V0.7");
  EXPECT_TRUE(has(entered, "V0.7 is 0; last written at ")) << entered;
  EXPECT_TRUE(has(entered, "\n  M9.0 was 0: last written at ")) << entered;
}

/// SBR 0 has an input L0.0 and an output L0.1; Motor is its output.
constexpr std::string_view kWithParameters =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\nCALL SBR_0, I0.0, M0.0\n"
    "Network 2\nLD M0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK SBR_0:SBR0\nVAR_INPUT\nasked:BOOL;\nEND_VAR\nVAR_OUTPUT\nruns:BOOL;\nEND_VAR\nBEGIN\n"
    "Network 1\nLD L0.0\nA I0.5\n= L0.1\nEND_SUBROUTINE_BLOCK\n";

TEST(Why, AnOutputOfACallIsWrittenByItsReturnAlsoWithTheSameValue) {
  AtPrompt session(with_blocks(kWithParameters));
  session("continue 50ms");
  const std::string text = session("why M0.0");
  EXPECT_TRUE(has(text, "M0.0 is 0; last written at ")) << text;
  EXPECT_TRUE(has(text, ", as an output of CALL 0, I0.0, M0.0 in line 5\n")) << text;
  EXPECT_TRUE(has(text, "\n  L0.1 was 0: last written at ")) << text;
  EXPECT_TRUE(has(session("who M0.0"), ", as an output of CALL 0, I0.0, M0.0 in line 5"));
  const std::string watched = session("watch M0.0 write; continue");
  EXPECT_TRUE(has(watched, "M0.0 write is 0 as before")) << watched;
}

TEST(Why, AnInputOfASubroutineLeadsToWhatItsCallHandedOver) {
  const std::string program =
      test::changed(test::changed(std::string(kWithParameters), "CALL SBR_0, I0.0,", "CALL SBR_0, M1.0,"), "A I0.5\n", "");
  AtPrompt session(with_blocks(test::changed(program, "Network 1\nLD SM0.0\n", "Network 1\nLD I0.7\n= M1.0\nLD SM0.0\n")));
  session("continue 50ms; input I0.7=1; continue 50ms");
  const std::string text = session("why Q0.0");
  EXPECT_TRUE(has(text, "\n  L0.0 was 1: last written at ")) << text;
  EXPECT_TRUE(has(text, "\n  M1.0 was 1: last written at ")) << text;
  EXPECT_TRUE(has(text, "= M1.0 in line 5 (LD I0.7: I0.7=1)\n")) << text;
}

TEST(Why, AnOutputOfACallThatWasNotExecutedNamesTheCallThatCould) {
  AtPrompt session(with_blocks(test::changed(std::string(kWithParameters), "LD SM0.0\n", "LD I0.6\n")));
  session("continue 50ms");
  const std::string text = session("why M0.0");
  EXPECT_TRUE(has(text, "nothing has written it since power-up; CALL 0, I0.0, M0.0 in line 5 could, which had no ")) << text;
}

TEST(Why, ContactsOfABranchThatWasLeftAreNotAmongThoseThatDecided) {
  AtPrompt session("LD I0.4\nLPS\nA I0.5\n= Q0.4\nLRD\nAN I0.5\n= Q0.5\nLPP\nA I0.6\nLD I0.7\nO I1.0\nALD\n= Q0.6\nMEND\n");
  session("input I0.4=1 I0.5=1; scan 3");
  EXPECT_TRUE(has(session("why Q0.5"), "= Q0.5 in line 7 (LD I0.4: I0.4=1; AN I0.5: I0.5=1)\n"));
  const std::string last = session("why Q0.6");
  EXPECT_TRUE(has(last, "(LD I0.4: I0.4=1; A I0.6: I0.6=0; LD I0.7: I0.7=0; O I1.0: I1.0=0; ALD)\n")) << last;
}

TEST(Why, AForcedContactIsSaidToBeSo) {
  AtPrompt session("LD I0.0\nAN M0.1\n= Q0.0\nMEND\n");
  session("force I0.0=1; scan 3");
  EXPECT_TRUE(has(session("why Q0.0"), "(LD I0.0: I0.0=1; AN M0.1: M0.1=0); I0.0 was forced\n"));
  session("unforce all; scan 3");
  EXPECT_FALSE(has(session("why Q0.0"), "forced"));
}

constexpr std::string_view kKeepsAway =
    "LD I0.0\n"   // 1
    "JMP 1\n"     // 2
    "LD I0.1\n"   // 3
    "= Q0.0\n"    // 4
    "LBL 1\n"     // 5
    "LD I0.2\n"   // 6
    "END\n"       // 7
    "LD I0.3\n"   // 8
    "CALL 1\n"    // 9
    "MEND\n"      // 10
    "SBR 1\n"     // 11
    "LD I0.4\n"   // 12
    "CALL 2\n"    // 13
    "RET\n"       // 14
    "SBR 2\n"     // 15
    "LD I0.5\n"   // 16
    "CRET\n"      // 17
    "LD SM0.0\n"  // 18
    "= Q0.1\n"    // 19
    "RET\n"       // 20
    "INT 3\n"     // 21
    "LD SM0.0\n"  // 22
    "= Q0.2\n"    // 23
    "RETI\n";     // 24

TEST(Why, WhatKeepsTheWriterOfAnAddressAwayIsNamed) {
  AtPrompt session(kKeepsAway);
  session("input I0.0=1 I0.1=1; scan 3");
  EXPECT_TRUE(
      has(session("why Q0.0"), "= Q0.0 in line 4 could, which was not executed lately: JMP 1 in line 2 jumped over it at "));
  EXPECT_TRUE(has(session("why Q0.0"), " (LD I0.0: I0.0=1)\n"));
  EXPECT_TRUE(has(session("why Q0.1"),
                  "not executed lately: CALL 2 in line 13 was not executed lately: CALL 1 in line 9 had no power flow at "));
  EXPECT_TRUE(has(session("why Q0.2"), "= Q0.2 in line 23 could, which was not executed lately: INT 3 did not run\n"));
  session("input I0.3=1 I0.4=1 I0.5=1; scan 3");
  EXPECT_TRUE(has(session("why Q0.1"), ": CRET in line 17 ended the routine in front of it at "));
  session("input I0.2=1; scan 3");
  EXPECT_TRUE(has(session("why Q0.1"), ": CRET in line 17 ended the routine in front of it at "));
}

TEST(Why, AForWithoutAPassIsNamedAndNoCallThatWasMade) {
  AtPrompt session(
      "LD SM0.0\nCALL 1\nMEND\nSBR 1\nLD SM0.0\nFOR VW0, 5, 1\nLD SM0.0\nMOVB 7, VB100\nNEXT\nLD I0.0\nCRET\nRET\n");
  session("continue 100ms");
  const std::string text = session("why VB100");
  EXPECT_TRUE(has(text, "could, which was not executed lately: FOR VW0, 5, 1 in line 6 ran no pass\n")) << text;
}

TEST(Why, AnEndInFrontOfACallIsNamedThoughItHadNoPowerBefore) {
  AtPrompt session(kKeepsAway);
  session("scan 3; input I0.2=1; scan 3");
  const std::string text = session("why Q0.1");
  EXPECT_TRUE(has(text, "CALL 1 in line 9 was not executed after ")) << text;
  EXPECT_TRUE(has(text, ": END in line 7 ended the scan in front of it at ")) << text;
}

TEST(Why, TheEndOfAMainProgramThatStandsBehindASubroutineEndsTheScan) {
  AtPrompt session(
      with_blocks("SUBROUTINE_BLOCK sub:SBR0\nBEGIN\nNETWORK 1\nLD I0.2\n= Q0.1\nEND_SUBROUTINE_BLOCK\n"
                  "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL sub\nLD I0.3\nEND\n"
                  "NETWORK 2\nLD SM0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n"));
  session("input I0.3=1; scan 3");
  EXPECT_TRUE(has(session("why Q0.0"), ": END in line 13 ended the scan in front of it at "));
}

TEST(Why, WhatIsAskedAboutAnAddressMayHaveBeenSetFromOutside) {
  AtPrompt session("LD SM0.0\nMEND\n");
  session("continue 20ms; set VW0=5; continue 1ms");
  EXPECT_TRUE(has(session("why VW0"), "VW0 is 16#0005 (5); last written at "));
  EXPECT_TRUE(has(session("why VW0"), " by 'set VW0', from outside\n"));
}

TEST(Why, AnInterruptRoutineWithoutContactsIsLedToByItsEventAndTheATCH) {
  AtPrompt session(kStopsListening);
  session("continue 50ms; watch VB1; send 41; continue");
  EXPECT_TRUE(has(session("why"),
                  "main: ATCH 1, 8 in line 6 attached INT 1 to event 8 (port 0: character received), which called "));
  session("rwhy");
  EXPECT_EQ(session.line(), 6u);
}

/// It has no Freeport mode up to I0.0.
TEST(Why, WhatSetThePortAfterTheRequestIsNotToBlame) {
  AtPrompt session("LD I0.0\nEU\nMOVB 9, SMB30\nMEND\n");
  session("continue 50ms; break unanswered; send 68 05 05 68; continue 100ms; input I0.0=1; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "port 0 is in PPI mode; nothing has written SMB30 since power-up\n"));
}

}  // namespace
}  // namespace s7200::tools::why_test
