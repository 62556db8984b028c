// The scan: its parts, SMB0, scan times, watchdog, END and STOP. Times: plc.hpp.
#include "tests/support/plc.hpp"

namespace s7200::test::scan_cycle_test {
namespace {

/// The same instruction `count` times.
std::string repeated(std::string_view instruction, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text.append(instruction).append("\n");
  return text;
}

// Read 0–200, program 200–230, communication –430, self-test –630, write –830.
TEST(ScanCycle, InputsAreReadBeforeAndOutputsWrittenAfterTheProgram) {
  Plc plc("LD I0.0\n= Q0.0\nMEND\n");
  plc.input_at(199 * us, "I0.0", true);
  plc.run_until(2 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), Times{830 * us});
}

TEST(ScanCycle, AnInputThatComesAfterTheReadWaitsForTheNextScan) {
  Plc plc("LD I0.0\n= Q0.0\nMEND\n");
  plc.input_at(201 * us, "I0.0", true);
  plc.run_until(2 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), Times{1660 * us});
  EXPECT_EQ(plc.value("I0.0"), 1);
}

// NOPs 200–220, LDI 220–230, =I 230–240.
TEST(ScanCycle, ImmediateInstructionsUseThePointsThemselves) {
  Plc plc("NOP 0\nNOP 0\nLDI I0.0\n=I Q0.0\nMEND\n");
  plc.input_at(215 * us, "I0.0", true);
  plc.run_until(300 * us);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), Times{240 * us});
  EXPECT_EQ(plc.value("I0.0"), 0) << "LDI does not update the image";
  EXPECT_EQ(plc.value("Q0.0"), 1) << "=I writes the image too";
}

TEST(ScanCycle, AnInstructionSeesTheWorldAsItWasAtItsStart) {
  Plc plc("NOP 0\nNOP 0\nLDI I0.0\n=I Q0.0\nMEND\n");
  plc.input_at(221 * us, "I0.0", true);
  plc.run_until(300 * us);
  EXPECT_TRUE(plc.records.times(TraceKind::OutputChanged).empty());
}

TEST(ScanCycle, SpecialMemoryByteZeroOverTheFirstScans) {
  Plc plc("LD SM0.0\nINCW VW0\nLD SM0.1\nINCW VW2\nLD SM0.2\nINCW VW4\nLD SM0.3\nINCW VW6\nLD SM0.6\nINCW VW8\nLD SM0.7\n"
          "INCW VW10\nMEND\n");
  plc.run_scans(4);
  EXPECT_EQ(plc.value("VW0"), 4) << "SM0.0 is always 1";
  EXPECT_EQ(plc.value("VW2"), 1) << "SM0.1 in the first scan";
  EXPECT_EQ(plc.value("VW4"), 0) << "SM0.2 only if retentive data were lost";
  EXPECT_EQ(plc.value("VW6"), 1) << "SM0.3 in the scan after power-up";
  EXPECT_EQ(plc.value("VW8"), 2) << "SM0.6 alternates";
  EXPECT_EQ(plc.value("VW10"), 4) << "SM0.7: mode switch in RUN";
}

TEST(ScanCycle, SM06IsZeroInTheFirstScanAndThenAlternates) {
  Plc plc("LD SM0.6\n= M0.0\nMEND\n");
  for (std::uint64_t scan = 1; scan <= 5; ++scan) {
    plc.run_scans(scan);
    EXPECT_EQ(plc.value("M0.0"), scan % 2 == 0) << scan;
  }
}

// Scans of 830 us. The 603rd ends at 500.490 ms, the 1205th at 1000.150 ms; the output follows one scan later.
TEST(ScanCycle, TheHalfSecondClockChangesAtScanEnds) {
  Plc plc("LD SM0.5\n= Q0.0\nMEND\n");
  plc.run_until(1200 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), (Times{830 * us, 501'320 * us, 1'000'980 * us}));
}

// The 36145th scan ends at 30.000350 s.
TEST(ScanCycle, TheHalfMinuteClockChangesAtScanEnds) {
  Plc plc("LD SM0.4\n= Q0.0\nMEND\n");
  plc.run_until(31 * kSecond);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), (Times{830 * us, 30'001'180 * us}));
}

// Scan 1: 800 + 10 + 5000 + 10 us. Later ones, without power flow: 830 us.
TEST(ScanCycle, LastShortestAndLongestScanInWholeMilliseconds) {
  Plc plc("LD SM0.1\nSQRT VD0, VD4\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.value("SMW22"), 5);
  EXPECT_EQ(plc.value("SMW24"), 5);
  EXPECT_EQ(plc.value("SMW26"), 5);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("SMW22"), 0);
  EXPECT_EQ(plc.value("SMW24"), 0);
  EXPECT_EQ(plc.value("SMW26"), 5);
}

// 700 * (100 ms + WDR 10 us + NEXT 10 us) is more than 65.535 s.
TEST(ScanCycle, AScanTooLongForAWordIs65535) {
  Plc plc("LD SM0.1\nFOR VW0, 1, 700\nDIV VW2, VD4\nWDR\nNEXT\nMEND\n");
  plc.set("VW2", 1);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("SMW22"), -1);
  EXPECT_EQ(plc.value("SMW26"), -1);
}

TEST(ScanCycle, TheWatchdogExpires300MillisecondsIntoTheScan) {
  Plc plc("LD SM0.0\nLBL 0\nJMP 0\nMEND\n");
  plc.run_until(301 * ms);
  ASSERT_EQ(plc.records.of(TraceKind::FatalError).size(), 1u);
  EXPECT_EQ(plc.records.of(TraceKind::FatalError)[0].at, 300 * ms);
  EXPECT_EQ(plc.cpu.state().fatal_code, 3);
  EXPECT_TRUE(plc.stopped());
}

// 800 us + 420 * 10 us + 2 * 100 ms + 19 * 5 ms = 300 ms.
TEST(ScanCycle, AScanOfExactly300MillisecondsPassesAndOneInstructionMoreDoesNot) {
  const std::string begin = "LD SM0.0\n" + repeated("DIV VW100, VD104", 2) + repeated("SQRT VD0, VD4", 19);
  for (const int more : {0, 1}) {
    Plc plc(begin + repeated("NOP 0", 418 + more) + "MEND\n");
    plc.set("VW100", 1);
    plc.run_until(299 * ms);
    EXPECT_FALSE(plc.stopped());
    plc.run_until(302 * ms);
    EXPECT_EQ(plc.stopped(), more == 1);
    EXPECT_EQ(plc.records.times(TraceKind::FatalError), more == 1 ? Times{300 * ms} : Times{});
  }
}

TEST(ScanCycle, WdrGivesTheScanAnother300Milliseconds) {
  const std::string divide = repeated("DIV VW100, VD104", 2);
  Plc with("LD SM0.0\n" + divide + "WDR\n" + divide + "MEND\n"), without("LD SM0.0\n" + divide + divide + "MEND\n");
  with.set("VW100", 1);
  without.set("VW100", 1);
  with.run_until(2 * kSecond);
  without.run_until(2 * kSecond);
  EXPECT_FALSE(with.stopped());
  EXPECT_EQ(without.cpu.state().fatal_code, 3);
}

// A routine of more than 10 ms every 5 ms from 5.23 ms: the seventh scan, begun at 5.1 ms, never gets any further.
TEST(ScanCycle, TheWatchdogSeesABurstOfInterruptsAndWdrInTheRoutineHelps) {
  const std::string main = "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\nINT 0\n", work = repeated("SQRT VD0, VD4", 2);
  Plc without(main + work + "RETI\n"), with(main + work + "WDR\nRETI\n");
  without.run_until(400 * ms);
  EXPECT_EQ(without.cpu.state().fatal_code, 3);
  EXPECT_GE(without.records.times(TraceKind::FatalError)[0], 305'100 * us);
  EXPECT_LE(without.records.times(TraceKind::FatalError)[0], 310'100 * us);
  with.run_until(2 * kSecond);
  EXPECT_FALSE(with.stopped());
  EXPECT_EQ(with.cpu.state().scans, 6u);
}

// LD, INCW, LD, END: 40 us instead of 70 us.
TEST(ScanCycle, EndSkipsTheRestOfTheMainProgram) {
  Plc plc("LD SM0.0\nINCW VW0\nLD I0.0\nEND\nLD SM0.0\nINCW VW2\nMEND\n");
  plc.input("I0.0", true);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VW0"), 2);
  EXPECT_EQ(plc.value("VW2"), 0);
  EXPECT_EQ(plc.cpu.time(), 2 * 840 * us);
}

// LD 200–210, =I –220, STOP –230.
TEST(ScanCycle, StopInTheMainProgramTakesEffectAtOnceAndSwitchesTheOutputsOff) {
  Plc plc("LD SM0.0\n=I Q0.0\nSTOP\nINCW VW0\nMEND\n");
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), (Times{220 * us, 230 * us}));
  EXPECT_EQ(plc.records.times(TraceKind::ModeChange), (Times{0, 230 * us}));
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.cpu.state().scans, 0u);
  EXPECT_EQ(plc.cpu.state().fatal_code, 0);
}

// LD 200–210, CALL –220, STOP –230.
TEST(ScanCycle, StopInASubroutineTakesEffectAtOnce) {
  Plc plc("LD SM0.0\nCALL 0\nINCW VW0\nMEND\nSBR 0\nSTOP\nINCW VW2\nRET\n");
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::ModeChange), (Times{0, 230 * us}));
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.value("VW2"), 0);
  EXPECT_EQ(plc.cpu.state().call_depth, 0);
}

// ATCH 10 ends at 240, ATCH 11 at 250, SQRT at 5270: then both events wait. Entry –5310, STOP –5320, INCW –5330, = –5340,
// MEND –5350, scan end 5950.
TEST(ScanCycle, StopInAnInterruptRoutineEndsItDropsWaitingInterruptsAndCompletesTheScan) {
  Plc plc(
      "LD SM0.1\nMOVB 5, SMB34\nMOVB 5, SMB35\nATCH 0, 10\nATCH 1, 11\nENI\nLD SM0.0\nSQRT VD100, VD104\nINCW VW0\n= Q0.0\n"
      "MEND\nINT 0\nSTOP\nINCW VW2\nRETI\nINT 1\nINCW VW4\nRETI\n");
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::ServiceEnd), Times{5320 * us});
  EXPECT_EQ(plc.records.times(TraceKind::ModeChange), (Times{0, 5950 * us}));
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), (Times{5950 * us, 5950 * us})) << "written, then off";
  EXPECT_EQ(plc.value("VW0"), 1) << "the rest of the scan is completed";
  EXPECT_EQ(plc.value("VW2"), 0) << "the routine ends at once";
  EXPECT_EQ(plc.value("VW4"), 0) << "waiting interrupts are dropped";
  EXPECT_EQ(plc.cpu.state().waiting, 0);
}

TEST(ScanCycle, InStopTheProgramDoesNotRunAndInputsAreStillRead) {
  Plc plc("LD SM0.1\nSTOP\nMEND\n");
  plc.run_until(1 * ms);
  plc.input("I0.3", true);
  const std::uint64_t instructions = plc.cpu.state().instructions;
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.cpu.state().instructions, instructions);
  EXPECT_EQ(plc.value("I0.3"), 1);
}

}  // namespace
}  // namespace s7200::test::scan_cycle_test
