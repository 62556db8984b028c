// What `why` says of a frame without an answer when it is not the program that has left it.
#include "tests/support/slave_bench.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools {
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
  Session session(kStopsListening);
  session("continue 50ms; input I0.0=1; scan 3; break unanswered; send 41 42; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 2 characters since 5"));
  EXPECT_TRUE(has(text, ": event 8 is not attached; detached at 51."));
  EXPECT_TRUE(has(text, " by DTCH 8 in line 10  // busy\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 10u);
  EXPECT_NE(session.state().attached[8], kNotAttached) << "in front of it";
}

TEST(Why, AnEventThatWasNeverAttachedIsNamed) {
  Session session("LD SM0.1\nMOVB 9, SMB30\nMEND\n");
  session("continue 50ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"), "event 8 is not attached; no instruction has attached it since power-up\n"));
}

TEST(Why, AFrameOfLongAgoIsNoPartOfTheOneThatIsAskedAbout) {
  Session session(kStopsListening);
  session("continue 50ms; input I0.0=1; scan 3; break unanswered; send 41 42; continue; send 43 44 45; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 3 characters since "));
  EXPECT_FALSE(has(text, "no answer to 2 characters"));
}

TEST(Why, APortInPpiModeLeadsToTheInstructionThatLeftFreeportMode) {
  Session session(kStopsListening);
  session("continue 50ms; input I0.1=1; scan 3; break unanswered; send 41 42; continue");
  const std::string text = session("why");
  EXPECT_TRUE(has(text, "no answer to 2 characters since 5"));
  EXPECT_TRUE(has(text, ": in PPI mode, and no PPI frame; SMB30 was set at 51."));
  EXPECT_TRUE(has(text, " by MOVB 16#8, SMB30 in line 3\n"));
  session("rwhy");
  EXPECT_EQ(session.line(), 3u);
}

TEST(Why, APortThatWasNeverInFreeportModeIsNamedAlsoIfPpiTakesTheCharactersForItsOwn) {
  Session session("LD SM0.0\nMOVW 1, VW2\nMEND\n");
  session("continue 50ms; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"), "in PPI mode, and no PPI frame; nothing has written SMB30 since power-up\n"));
  session("continue 200ms; send 68 05 05 68; continue");  // the head of a PPI frame
  EXPECT_TRUE(has(session("why"), "no answer: port 0 is in PPI mode; nothing has written SMB30 since power-up\n"));
}

TEST(Why, SMB30SetFromOutsideIsNamed) {
  Session session(kStopsListening);
  session("continue 50ms; set SMB30=8; scan 3; break unanswered; send 41; continue");
  EXPECT_TRUE(has(session("why"), "in PPI mode, and no PPI frame; SMB30 was set from outside at 50."));
}

/// The slave of a scenario that is asked with a fault of the line.
std::string why_with(const std::string& fault, const std::string& master = "") {
  static const auto program = test::compile(test::slave_text());
  Session session(program);
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
  EXPECT_TRUE(has(text, "and the master heard 01 02 02 00 00 b8 44 instead of 01 03 02 00 00 b8 44: fault flip:"));
  EXPECT_TRUE(has(text, ": 1×"));
  EXPECT_TRUE(
      has(why_with("collision:of=answer,character=3,bytes=00"), " instead of 01 03 02 00 00 b8 44: fault collision:"));
}

TEST(Why, ARequestThatThePlcHasNotHeardIsNamedWithTheFault) {
  const std::string text = why_with("cut:from=0ms");
  EXPECT_TRUE(has(text, "the master sent 8 characters from 20"));
  EXPECT_TRUE(has(text, ", and the PLC heard nothing: fault cut:from=0"));
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
  DebuggerOptions options{};
  options.master.timeout = 10 * kMicrosecond;
  Debugger debugger(simulation, out, options);
  EXPECT_FALSE(debugger.execute("continue 50ms; break unanswered; send 41; continue; continue 10ms; why"));
  EXPECT_TRUE(has(out.str(), "the PLC sent a character from 5"));
  EXPECT_TRUE(has(out.str(), "and the master heard nothing of it: the master had given up at 51."));
}

TEST(Why, AnAnswerThatBeganBeforeTheRequestHadEndedIsNamedSo) {
  Session session(kEcho);
  session("continue 50ms; break unanswered; send 41 42; continue");
  EXPECT_TRUE(has(session("why"), "the master was still sending, up to 52."));
}

TEST(Why, AStopWithinARequestIsWhatKeptItsCharactersFromTheProgram) {
  Session session(kEcho);
  session("continue 50ms; break unanswered; send 41 42 43 44 45 46 47 48; continue 3ms; mode stop; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, "the CPU is in STOP"));
  EXPECT_TRUE(has(why, "a programming device has switched the CPU to STOP"));
  EXPECT_FALSE(has(why, "SMB30")) << "which the program had set to Freeport";
}

}  // namespace
}  // namespace s7200::tools
