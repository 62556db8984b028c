// Why: the line of the program beside a record, and what an interrupt waited for. Times: plc.hpp.
#include "interpreter/trace/trace_reasons.hpp"

#include <sstream>

#include "interpreter/trace/text/text_trace.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::trace_reasons_test {
namespace {

/// The trace of a program whose I0.0 and I0.1 rise when they are told to.
std::string traced(std::string_view stl, std::initializer_list<Time> i00, std::initializer_list<Time> i01 = {}) {
  Plc plc(stl);
  std::ostringstream out;
  TextTrace trace(out, program_of(stl), TraceDetail::Way);
  trace.record({.kind = TraceKind::ModeChange, .code = 1});
  plc.cpu.set_sink(&trace);
  std::vector<std::pair<Time, std::string_view>> edges;
  for (const Time at : i00) edges.emplace_back(at, "I0.0");
  for (const Time at : i01) edges.emplace_back(at, "I0.1");
  std::sort(edges.begin(), edges.end());
  for (const auto& [at, point] : edges) plc.input_at(at, point, true);
  plc.run_until(20 * ms);
  return out.str();
}

testing::AssertionResult has(const std::string& text, std::string_view part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in:\n" << text;
}

constexpr std::string_view kRoutine = "INT 0\nLD SM0.0\nINCW VW0\nRETI\n";

TEST(TraceReasons, TheLineAndItsCommentStandBesideWhatTheProgramDoesWithInterruptsAndThePort) {
  const std::string text = traced(
      "LD SM0.1\nMOVB 9, SMB30 // Freeport\nATCH 0, 0 // the light barrier\nENI\nDTCH 0\nDISI // busy\nXMT VB0, "
      "0\nMEND\n" +
          std::string(kRoutine),
      {});
  EXPECT_TRUE(has(text, "SMB30 = 16#09  line 2: MOVB    9, SMB30  // Freeport\n"));
  EXPECT_TRUE(has(text, "ATCH: INT 0 to event 0 (rising edge of I0.0)  line 3: ATCH    0, 0  // the light barrier\n"));
  EXPECT_TRUE(has(text, "ENI: interrupts are enabled  line 4: ENI\n"));
  EXPECT_TRUE(has(text, "DTCH: event 0 (rising edge of I0.0)  line 5: DTCH    0\n"));
  EXPECT_TRUE(has(text, "DISI: interrupts are disabled  line 6: DISI  // busy\n"));
  EXPECT_TRUE(has(text, "XMT: break  line 7: XMT     VB0, 0\n"));
}

TEST(TraceReasons, AnInterruptThatWaitedForEniNamesDisiAndEni) {
  const std::string program =
      "LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nDISI\nSQRT VD8, VD12\nENI\nMEND\n" + std::string(kRoutine);
  EXPECT_TRUE(has(traced(program, {2 * ms}), "waited 3.26 ms: DISI in line 5 until ENI in line 7\n"));
}

TEST(TraceReasons, AnInterruptBeforeTheFirstEniSaysSo) {
  const std::string program = "LD SM0.1\nATCH 0, 0\nSQRT VD8, VD12\nENI\nMEND\n" + std::string(kRoutine);
  EXPECT_TRUE(has(traced(program, {2 * ms}), ": no ENI until ENI in line 4\n"));
}

TEST(TraceReasons, ADisiBeforeTheFirstEniIsNamedAndASecondOneIsNot) {
  const std::string program = "LD SM0.1\nATCH 0, 0\nDISI\nDISI\nSQRT VD8, VD12\nENI\nMEND\n" + std::string(kRoutine);
  EXPECT_TRUE(has(traced(program, {2 * ms}), ": DISI in line 3 until ENI in line 6\n"));
}

TEST(TraceReasons, AnInterruptBehindAnotherNamesItsRoutine) {
  const std::string program =
      "LD SM0.1\nATCH 0, 0\nATCH 1, 2\nENI\nMEND\nINT 0\nLD SM0.0\nSQRT VD8, VD12\nRETI\nINT 1\nLD SM0.0\nRETI\n";
  EXPECT_TRUE(has(traced(program, {2 * ms}, {3 * ms}), ": INT 0 of event 0 until then\n"));
}

TEST(TraceReasons, AnInterruptThatWaitedForALongInstructionNamesItAndItsDuration) {
  const std::string program = "LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nSQRT VD8, VD12\nMEND\n" + std::string(kRoutine);
  EXPECT_TRUE(has(traced(program, {2 * ms}), ": line 5 was being executed for 5 ms: SQRT    VD8, VD12\n"));
}

TEST(TraceReasons, AnEventThatWaitsForEniSaysSoWhenItOccurs) {
  const std::string program =
      "LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nDISI\nSQRT VD8, VD12\nENI\nMEND\n" + std::string(kRoutine);
  EXPECT_TRUE(has(traced(program, {2 * ms}), "occurred, for INT 0; it waits: interrupts are disabled by DISI in line 5\n"));
}

/// Characters, from 1 ms on; a frame is complete when I0.0 rises, at 10 ms.
std::string trace_of_frame(std::string_view stl, std::initializer_list<std::uint8_t> bytes,
                           const CpuModel& model = cpu214()) {
  Plc plc(stl, model);
  std::ostringstream out;
  TextTrace trace(out, program_of(stl, model), TraceDetail::Way);
  trace.record({.kind = TraceKind::ModeChange, .code = 1});
  plc.cpu.set_sink(&trace);
  Time at = 2 * ms;
  for (const std::uint8_t byte : bytes) plc.received_at({.byte = byte, .start = at - ms, .end = at}), at += ms;
  plc.input_at(10 * ms, "I0.0", true);
  plc.run_until(20 * ms);
  return out.str();
}

/// INT 0 stores a character; the main program looks at it when I0.0 is on.
constexpr std::string_view kJudge =
    "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\n"                                         // 1
    "LDN I0.0\nJMP 9\n"                                                                 // 5
    "LDB= VB1, 16#41 // ours\nJMP 1\nLD SM0.0\nDTCH 8\nATCH 0, 8 // the next\nJMP 9\n"  // 7
    "LBL 1\nLD SM0.0\nXMT VB0, 0\nLBL 9\nMEND\n"                                        // 13
    "INT 0\nLD SM0.0\nMOVB SMB2, VB1\nMOVB 1, VB0\nRETI\n";

TEST(TraceReasons, AFrameWithoutAnswerNamesTheLastJumpBeforeItsRoutineIsAttachedAgain) {
  EXPECT_TRUE(
      has(trace_of_frame(kJudge, {0x40, 0x42}),
          "  no answer to 2 characters since 1.000000 ms: JMP 1 in line 8, not taken (LDB= VB1, 16#41: VB1=16#42)\n"));
}

TEST(TraceReasons, AJumpThatASubroutineHasTakenCountsAfterItAndOneThatItPassedDoesNot) {
  const auto judged_in = [](std::string_view subroutine) {
    return "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nENI\nLDN I0.0\nJMP 9\nLD SM0.0\nCALL 1\nLD SM0.0\nATCH 0, 8\nLBL 9\nMEND\n" +
           std::string(subroutine) + "INT 0\nLD SM0.0\nMOVB SMB2, VB1\nMOVB 1, VB0\nRETI\n";
  };
  EXPECT_TRUE(
      has(trace_of_frame(judged_in("SBR 1\nLDB= VB1, 16#41\nNOT\nCRET // not ours\nLD SM0.0\nXMT VB0, 0\nRET\n"), {0x42}),
          "no answer to a character since 1.000000 ms: CRET in line 16 (LDB= VB1, 16#41: VB1=16#42; NOT)  // not ours\n"));
  EXPECT_TRUE(has(trace_of_frame(judged_in("SBR 1\nLDB= VB1, 16#41\nJMP 1\nLBL 1\nRET\n"), {0x42}),
                  "no answer to a character since 1.000000 ms: JMP 9 in line 6, not taken (LDN I0.0: I0.0=1)\n"));
}

TEST(TraceReasons, AFrameThatNoRoutineReadIsLeftWhenAnotherOneIsAttached) {
  constexpr std::string_view kWait =
      "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8 // wait\nATCH 1, 0\nENI\nMEND\n"
      "INT 0\nLD SM0.0\nINCW VW0\nRETI\n"
      "INT 1\nLD SM0.0\nATCH 2, 8\nRETI\n"
      "INT 2\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n";
  EXPECT_TRUE(
      has(trace_of_frame(kWait, {0x40, 0x42}),
          "no answer to 2 characters since 1.000000 ms: INT 0 (attached in line 3) took them without reading SMB2\n"));
  std::string reads(kWait);
  reads.replace(reads.find("INCW VW0"), 8, "BMB SMB0, VB0, 4");
  EXPECT_FALSE(has(trace_of_frame(reads, {0x40, 0x42}), "no answer")) << "the program has them, and may answer";
}

TEST(TraceReasons, AFrameThatWasHandedToARoutineThatReadsNothingEndsAtThePauseBehindIt) {
  constexpr std::string_view kNotOurs =
      "LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nATCH 2, 0\nENI\nMEND\n"               // 1
      "INT 0\nLDB= SMB2, 16#41\nCRETI\nLD SM0.0\nATCH 1, 8 // not ours\nRETI\n"  // 7
      "INT 1\nLD SM0.0\nINCW VW0\nRETI\n"                                        // 13
      "INT 2\nLD SM0.0\nATCH 0, 8\nRETI\n";                                      // 17
  Plc plc(kNotOurs);
  std::ostringstream out;
  TextTrace trace(out, program_of(kNotOurs), TraceDetail::Way);
  trace.record({.kind = TraceKind::ModeChange, .code = 1});
  plc.cpu.set_sink(&trace);
  for (const Time end : {2, 3, 8, 9, 10}) plc.received_at({.byte = 0x42, .start = (end - 1) * ms, .end = end * ms});
  plc.input_at(12 * ms, "I0.0", true);
  plc.run_until(20 * ms);
  EXPECT_TRUE(
      has(out.str(),
          "no answer to 2 characters since 1.000000 ms: CRETI in line 9, not taken (LDB= SMB2, 16#41: SMB2=16#42)\n"));
  EXPECT_TRUE(
      has(out.str(),
          "no answer to 3 characters since 7.000000 ms: INT 1 (attached in line 11) took them without reading SMB2\n"));
}

TEST(TraceReasons, AMessageAfterWhichRCVIsExecutedAgainNamesTheTransmissionThatWasNotExecuted) {
  std::string receiver =
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#B0, SMB87\nMOVB 16#0D, SMB89\nMOVW 0, SMW90\nMOVB 10, SMB94\n"
      "ATCH 0, 23\nENI\nRCV VB100, 0\nLD I0.1\nXMT VB200, 0\nMEND\n"  // 7
      "INT 0\nLD SM0.0\nINCW VW0\nRCV VB100, 0\nRETI\n";              // 13
  EXPECT_TRUE(has(trace_of_frame(receiver, {0x41, 0x0D}, cpu224()),
                  "no answer to 2 characters since 1.000000 ms: INT 0 took the message, and RCV in line 16 waits for the "
                  "next one: XMT VB200, 0 in line 11, without power flow (LD I0.1: I0.1=0)\n"));
  receiver.replace(receiver.find("XMT"), 3, "BMB");
  receiver.replace(receiver.find("VB200, 0\n"), 9, "VB200, VB210, 1\n");
  EXPECT_TRUE(has(trace_of_frame(receiver, {0x41, 0x0D}, cpu224()), "waits for the next one (no XMT was executed)\n"));
}

TEST(TraceReasons, AFrameWithAnAnswerIsNotSaidToHaveNone) {
  EXPECT_FALSE(has(trace_of_frame(kJudge, {0x41}), "no answer"));
  EXPECT_FALSE(has(trace_of_frame(kJudge, {}), "no answer"));
}

TEST(TraceReasons, ACharacterThatNobodyWantedSaysWhy) {
  Plc plc("LD SM0.0\nMEND\n");
  plc.character_at(1 * ms, 0x41);
  plc.run_until(2 * ms);
  const auto ignored = plc.records.of(TraceKind::CharacterIgnored);
  ASSERT_EQ(ignored.size(), 1U);
  EXPECT_EQ(describe(ignored[0], plc.cpu.program()),
            "ignored  41 and the rest up to the next pause: the port is in PPI mode, and this is not a PPI frame");
}

TEST(TraceReasons, ACharacterWithoutAnRcvSaysSoWhereTheProgramReceivesWithRcvAtThatPort) {
  const auto reason = [](const std::string& program) {
    Plc plc("LD SM0.1\nMOVB 9, SMB30\n" + program + "MEND\n", cpu216());
    plc.character_at(1 * ms, 0x41);
    plc.run_until(2 * ms);
    return describe(plc.records.of(TraceKind::CharacterIgnored).at(0), plc.cpu.program());
  };
  EXPECT_EQ(reason("AN SM0.0\nRCV VB100, 0\n"), "ignored  41: no RCV waits");
  EXPECT_EQ(reason("AN SM0.0\nRCV VB100, 1\n"), "ignored  41: event 8 is not attached");
  EXPECT_EQ(reason(""), "ignored  41: event 8 is not attached");
}

TEST(TraceReasons, ARoutineThatIsAttachedAlreadyIsNoSignThatTheProgramLeavesAFrame) {
  EXPECT_FALSE(has(trace_of_frame("LD SM0.1\nMOVB 9, SMB30\nENI\nLD SM0.0\nATCH 0, 8 // in every scan\nMEND\n"
                                  "INT 0\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n",
                                  {0x41}),
                   "no answer"));
}

TEST(TraceReasons, ALongInstructionInFrontOfTheRoutineThatRanFirstIsNamedToo) {
  const std::string program =
      "LD SM0.1\nATCH 0, 0\nATCH 0, 2\nENI\nLD SM0.0\nSQRT VD8, VD12\nSQRT VD8, VD12\nMEND\n" + std::string(kRoutine);
  const std::string text = traced(program, {2 * ms}, {2 * ms});
  EXPECT_TRUE(has(text, "SQRT"));
  EXPECT_TRUE(has(text, ", then INT 0 of event 0 until then\n")) << "the instruction that was not over comes first";
}

}  // namespace
}  // namespace s7200::test::trace_reasons_test
