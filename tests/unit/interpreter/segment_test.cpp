// Segments of sequence control relays: LSCR, SCRT, SCRE (facts 9.1).
#include "tests/support/plc.hpp"

namespace s7200::test::segment_test {
namespace {

// Three steps in a ring, as in the manual's cyclic example: each holds its own outputs with `=` and a timer starts the next.
constexpr std::string_view kRing =
    "NETWORK 1\nLD SM0.1\nS S0.0, 1\n"
    "LSCR S0.0\nLD SM0.0\n= Q0.0\nTON T37, 2\nLD T37\nSCRT S0.1\nSCRE\n"
    "LSCR S0.1\nLD SM0.0\n= Q0.1\nTON T38, 3\nLD T38\nSCRT S0.2\nSCRE\n"
    "LSCR S0.2\nLD SM0.0\n= Q0.2\nTON T39, 4\nLD T39\nSCRT S0.0\nSCRE\nMEND\n";

TEST(Segment, ThreeStepsWithOutputsAndTimersTakeTurnsForEver) {
  Plc plc(kRing);
  std::string sequence;
  std::int64_t before = 0;
  for (Time t = 10 * ms; t <= 20 * kSecond; t += 10 * ms) {
    plc.run_until(t);
    const std::int64_t outputs = plc.value("QB0");
    if (outputs == before) continue;
    before = outputs;
    ASSERT_TRUE(outputs == 1 || outputs == 2 || outputs == 4) << outputs << " at " << t << ": one step is on at a time";
    sequence += outputs == 1 ? 'a' : outputs == 2 ? 'b' : 'c';
  }
  EXPECT_GE(sequence.size(), 60u);
  for (std::size_t i = 0; i < sequence.size(); ++i) EXPECT_EQ(sequence[i], "abc"[i % 3]) << i;
}

TEST(Segment, AStepThatIsLeftSwitchesItsCoilsOffAndResetsItsTimer) {
  Plc plc("LSCR S0.0\nLD SM0.0\n= Q0.0\nTON T37, 100\nSCRE\nMEND\n");
  plc.set("SB0", 1);
  plc.run_until(500 * ms);
  EXPECT_EQ(plc.value("QB0"), 1);
  EXPECT_GE(plc.value("T37"), 4);
  plc.set("SB0", 0);
  plc.run_until(502 * ms);
  EXPECT_EQ(plc.value("QB0"), 0);
  EXPECT_EQ(plc.value("T37"), 0);
}

TEST(Segment, EveryContactInASegmentThatIsOffIsWithoutPower) {
  for (const std::string contact : {"LD SM0.0", "LDN M0.0", "LDI I0.0", "LDNI I0.1", "LDB= 0, 0", "LDW>= 1, 0", "LDD<= 0, 1",
                                    "LDR= 1.0, 1.0", "LDW= *VD100, VW0"}) {
    Plc plc("LSCR S0.0\n" + contact + "\n= M1.0\nSCRE\n" + contact + "\n= M1.1\nMEND\n");
    plc.input("I0.0", true);
    plc.set("VD100", 0x0800'0000);
    plc.set("MB1", 1);
    plc.run_scans(1);
    EXPECT_EQ(plc.value("M1.0"), 0) << contact << " in the segment";
    EXPECT_EQ(plc.value("M1.1"), 1) << contact << " after SCRE";
    plc.set("SB0", 1);
    plc.run_scans(2);
    EXPECT_EQ(plc.value("M1.0"), 1) << contact << " once the segment is on";
  }
}

TEST(Segment, ContactsInParallelAreFedByTheRailAndContactsInSeriesByWhatIsBeforeThem) {
  Plc plc(
      "LSCR S0.0\nLD M0.0\nO SM0.0\nON M0.0\nOB= 1, 1\n= M1.0\nLD M0.0\nNOT\nA SM0.0\nAN M0.0\nAB= 1, 1\n= "
      "M1.1\nSCRE\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.value("M1.0"), 0);
  EXPECT_EQ(plc.value("M1.1"), 1);
}

TEST(Segment, NotInASegmentThatIsOffGivesPowerFlow) {
  Plc plc("LSCR S0.0\nLD SM0.0\nNOT\nINCW VW0\nSCRE\nMEND\n");
  plc.run_scans(3);
  EXPECT_EQ(plc.value("VW0"), 3);
}

TEST(Segment, EdSeesThatTheSegmentWentOff) {
  Plc plc("LSCR S0.0\nLD SM0.0\nED\nINCW VW0\nSCRE\nMEND\n");
  plc.set("SB0", 1);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VW0"), 0);
  plc.set("SB0", 0);
  plc.run_scans(5);
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Segment, ACompareContactInASegmentThatIsOffStillFollowsItsPointers) {
  Plc plc("LSCR S0.0\nLDW= *VD100, 0\n= M0.0\nSCRE\nMEND\n");
  plc.set("VD100", 0x0300'0000);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.cpu.state().fatal_code, 0x11);
}

TEST(Segment, ASubroutineHasItsOwnRail) {
  Plc plc(
      "LSCR S0.0\nLD SM0.0\nNOT\nCALL 0\nLD SM0.0\nINCW VW0\nSCRE\nMEND\nSBR 0\nLSCR S1.0\nLD SM0.0\nINCW VW2\nSCRE\n"
      "LD SM0.0\nINCW VW4\nRET\n");
  plc.set("SB1", 1);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 0) << "the caller's segment is off after the return too";
  EXPECT_EQ(plc.value("VW2"), 1);
  EXPECT_EQ(plc.value("VW4"), 1);
}

TEST(Segment, ASegmentOfASubroutineThatIsLeftByCretDoesNotReachItsCaller) {
  Plc plc("LSCR S0.0\nLD SM0.0\nCALL 0\nLD SM0.0\nINCW VW0\nSCRE\nMEND\nSBR 0\nLSCR S1.0\nLD SM0.0\nNOT\nCRET\nSCRE\nRET\n");
  plc.set("SB0", 1);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 1);
}

// LSCR ends at 210 us, and so on in steps of 10 us: the edge at 215 us is served after LD, while the segment is off.
TEST(Segment, AnInterruptRoutineHasPowerWhileTheSegmentItInterruptsIsOff) {
  Plc plc(
      "LD SM0.1\nATCH 0, 0\nENI\nLSCR S0.0\nLD SM0.0\nLD SM0.0\nLD SM0.0\n= M0.0\nSCRE\nMEND\nINT 0\nLD SM0.0\nINCW "
      "VW0\nRETI\n");
  plc.input_at(245 * us, "I0.0", true);
  plc.set("MB0", 1);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 1);
  EXPECT_EQ(plc.value("M0.0"), 0) << "the segment is still off";
}

TEST(Segment, ATransitionTakesEffectAtTheNextLscr) {
  Plc plc("LSCR S0.0\nLD SM0.0\nSCRT S0.1\nLD SM0.0\nINCW VW0\nSCRE\nLSCR S0.1\nLD SM0.0\nINCW VW2\nSCRE\nMEND\n");
  plc.set("SB0", 1);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 1) << "the segment that is left runs to its SCRE";
  EXPECT_EQ(plc.value("VW2"), 1) << "the next one is on in the same scan";
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Segment, AScanThatBeginsAfterAStopInASegmentHasPower) {
  Plc plc("LD SM0.0\n= M0.0\nLSCR S0.0\nLD SM0.0\nNOT\nSTOP\nSCRE\nMEND\n");
  plc.run_until(5 * ms);
  ASSERT_TRUE(plc.stopped());
  plc.cpu.power_up();
  plc.run_until(plc.cpu.time() + 1 * ms);
  EXPECT_EQ(plc.value("M0.0"), 1);
}

}  // namespace
}  // namespace s7200::test::segment_test
