// Interrupts: latency, order, queues, what is saved, ATCH and DTCH, timed interrupts. Times: plc.hpp.
#include "interpreter/cpu/interrupts.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::interrupt_test {
namespace {

using enum TraceKind;

constexpr std::string_view kCount0 = "INT 0\nINCW VW0\nRETI\n";

std::string with_routine(std::string_view main) { return std::string(main).append(kCount0); }

// Program 200–240, then idle. Entry 40 us, INCW, RETI.
TEST(Interrupt, InTheSystemsPartOfTheScanARoutineStartsAtOnce) {
  Plc plc(with_routine("LD SM0.1\nATCH 0, 0\nENI\nMEND\n"));
  plc.input_at(300 * us, "I0.0", true);
  plc.run_until(1 * ms);
  EXPECT_EQ(plc.records.times(ServiceBegin), Times{300 * us});
  EXPECT_EQ(plc.records.times(ServiceEnd), Times{360 * us});
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Interrupt, AnInterruptLengthensThePartOfTheScanThatItInterrupts) {
  Plc plc(with_routine("LD SM0.1\nATCH 0, 0\nENI\nMEND\n"));
  plc.input_at(300 * us, "I0.0", true);
  plc.run_scans(1);
  EXPECT_EQ(plc.cpu.time(), 840 * us + 60 * us);
}

// LD, ATCH, ENI, LD: –240; SQRT 240–5240.
TEST(Interrupt, ARunningInstructionIsFinishedFirst) {
  Plc plc(with_routine("LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nSQRT VD100, VD104\nMEND\n"));
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred), Times{1 * ms});
  EXPECT_EQ(plc.records.times(ServiceBegin), Times{5240 * us});
}

// INT 0: entry 300–340, SQRT –5340, RETI –5350.
TEST(Interrupt, ARunningRoutineIsFinishedFirstWhateverComes) {
  Plc plc("LD SM0.1\nATCH 0, 0\nATCH 1, 8\nENI\nMEND\nINT 0\nSQRT VD100, VD104\nRETI\nINT 1\nRETI\n");
  plc.input_at(300 * us, "I0.0", true);
  plc.character_at(1 * ms, 0x41);
  plc.set("SMB30", 0x09);
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.records.times(ServiceBegin), (Times{300 * us, 5350 * us}));
  EXPECT_EQ(plc.records.events(ServiceBegin), (Ints{0, 8}));
}

// LD, ATCH, ENI, LD, DISI: –250; SQRT –5250, NOP –5260, ENI –5270.
TEST(Interrupt, DisiHoldsEventsBackUntilTheEndOfEni) {
  Plc plc(with_routine("LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nDISI\nSQRT VD100, VD104\nNOP 0\nENI\nMEND\n"));
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.records.times(ServiceBegin), Times{5270 * us});
}

TEST(Interrupt, RunStartsWithInterruptsDisabled) {
  Plc plc(with_routine("LD SM0.1\nATCH 0, 0\nMEND\n"));
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred).size(), 1u);
  EXPECT_TRUE(plc.records.times(ServiceBegin).empty());
  EXPECT_EQ(plc.value("SM4.4"), 0);
}

// ATCH 10 ends at 240: its events come at 5.24 and 10.24 ms. The two SQRT last until 10.26 ms.
TEST(Interrupt, CommunicationIsServedBeforeInputsAndInputsBeforeTime) {
  Plc plc(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 5, SMB34\nATCH 0, 10\nATCH 0, 0\nATCH 0, 8\nSQRT VD100, VD104\n"
      "SQRT VD100, VD104\nENI\nMEND\nINT 0\nRETI\n");
  plc.input_at(6 * ms, "I0.0", true);
  plc.character_at(7 * ms, 0x41);
  plc.run_until(12 * ms);
  EXPECT_EQ(plc.records.events(EventOccurred), (Ints{10, 0, 8, 10}));
  EXPECT_EQ(plc.records.events(ServiceBegin), (Ints{8, 0, 10, 10}));
}

TEST(Interrupt, FirstComeFirstServedWithinAQueue) {
  Plc plc("LD SM0.1\nATCH 0, 0\nATCH 0, 2\nLD SM0.0\nSQRT VD100, VD104\nENI\nMEND\nINT 0\nRETI\n");
  plc.input_at(1 * ms, "I0.1", true);
  plc.input_at(2 * ms, "I0.0", true);
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.records.events(ServiceBegin), (Ints{2, 0}));
}

TEST(Interrupt, EdgesAtTheSameInstantAreServedInTheOrderOfTheList) {
  std::string main = "LD SM0.1\n";
  for (int event = 0; event < 8; ++event) main += fmt::format("ATCH 0, {}\n", event);
  Plc plc(main + "ENI\nMEND\nINT 0\nRETI\n");
  plc.run_scans(1);
  plc.cpu.set_input(0, 0x0A, plc.cpu.time());  // I0.1 and I0.3 rise
  plc.run_scans(3);
  plc.cpu.set_input(0, 0x05, plc.cpu.time());  // they fall while I0.0 and I0.2 rise
  plc.run_scans(6);
  plc.cpu.set_input(0, 0x00, plc.cpu.time());
  plc.run_scans(9);
  EXPECT_EQ(plc.records.events(ServiceBegin), (Ints{2, 6, 0, 4, 3, 7, 1, 5}));
}

// HSC1 in mode 0 reaches 1 with the same change of IB0 in which I0.0 rises.
TEST(Interrupt, AnEdgeComesBeforeTheCounterThatReachesItsPresetAtTheSameInstant) {
  Plc plc("LD SM0.1\nMOVB 16#F8, SMB47\nMOVD 1, SMD52\nHDEF 1, 0\nHSC 1\nATCH 0, 13\nATCH 0, 0\nENI\nMEND\nINT 0\nRETI\n");
  plc.run_scans(1);
  plc.cpu.set_input(0, 0x41, plc.cpu.time());
  plc.run_scans(2);
  EXPECT_EQ(plc.records.events(ServiceBegin), (Ints{0, 13}));
}

/// DISI, time for events, ENI; the routine, and then the main program, look at SMB4.
std::string overflow_program(std::string_view attach) {
  return fmt::format("LD SM0.1\nMOVB 9, SMB30\nMOVB 5, SMB34\n{}LD SM0.1\nSQRT VD100, VD104\nSQRT VD100, VD104\n"
                     "SQRT VD100, VD104\nSQRT VD100, VD104\nSQRT VD100, VD104\nSQRT VD100, VD104\nDTCH 10\nENI\nNOP 0\n"
                     "MOVB SMB4, VB10\nMEND\nINT 0\nINCW VW0\nMOVB SMB4, VB2\nRETI\n", attach);
}

TEST(Interrupt, FourCharactersWaitAndTheFifthIsLost) {
  Plc plc(overflow_program("ATCH 0, 8\n"));
  for (int i = 1; i <= 5; ++i) plc.character_at(i * ms, static_cast<std::uint8_t>(i));
  plc.run_until(40 * ms);
  EXPECT_EQ(plc.records.events(EventLost), Ints{8});
  EXPECT_EQ(plc.records.of(EventLost)[0].byte, 5);
  EXPECT_EQ(plc.value("VW0"), 4);
  EXPECT_EQ(plc.value("VB2") & 7, 1) << "SM4.0 in the last routine still";
  EXPECT_EQ(plc.value("VB10") & 7, 0) << "gone in the main program";
}

TEST(Interrupt, SixteenEdgesWaitAndTheSeventeenthIsLost) {
  Plc plc(overflow_program("ATCH 0, 0\nATCH 0, 1\n"));
  for (int i = 1; i <= 17; ++i) plc.input_at(i * ms, "I0.0", i % 2 == 1);
  plc.run_until(40 * ms);
  EXPECT_EQ(plc.records.times(EventLost), Times{17 * ms});
  EXPECT_EQ(plc.value("VW0"), 16);
  EXPECT_EQ(plc.value("VB2") & 7, 2) << "SM4.1";
  EXPECT_EQ(plc.value("VB10") & 7, 0);
}

// ATCH ends at 240: events at 5.24, 10.24, … 30.24 ms; LD –250, six SQRT –30.25 ms, DTCH 10 drops the four that wait.
TEST(Interrupt, FourTimedEventsWaitAndTheFifthIsLost) {
  Plc plc(overflow_program("ATCH 0, 10\n"));
  plc.run_until(30'250 * us);
  EXPECT_EQ(plc.records.times(EventLost), (Times{25'240 * us, 30'240 * us}));
  EXPECT_EQ(plc.value("SM4.2"), 1);
  plc.run_until(40 * ms);
  EXPECT_EQ(plc.records.events(EventDropped), (Ints{10, 10, 10, 10}));
  EXPECT_EQ(plc.value("SM4.2"), 0) << "the queue is empty and the main program goes on";
  EXPECT_EQ(plc.value("VW0"), 0);
}

// The interrupt comes during SQRT, which leaves SM1.0 (zero). DECW in the routine would leave SM1.2 (negative).
TEST(Interrupt, LogicStackAccumulatorsAndStatusBitsAreSaved) {
  Plc plc("LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nMOVD 16#11223344, AC0\nMOVD 16#55667788, AC3\nSQRT VD100, VD104\nMOVB SMB1, VB8\n"
          "MOVD AC0, VD0\nMOVD AC3, VD4\n= M0.0\nMEND\n"
          "INT 0\nMOVD 0, AC0\nMOVD 0, AC3\nDECW VW200\nMOVB SMB1, VB9\nLDN SM0.0\nLDN SM0.0\nLDN SM0.0\nRETI\n");
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB9"), 4);
  EXPECT_EQ(plc.value("VB8"), 1);
  EXPECT_EQ(plc.value("VD0"), 0x11223344);
  EXPECT_EQ(plc.value("VD4"), 0x55667788);
  EXPECT_EQ(plc.value("M0.0"), 1);
}

TEST(Interrupt, DtchDropsWhatItsEventHasQueuedAndNothingElse) {
  Plc plc("LD SM0.1\nATCH 0, 0\nATCH 1, 2\nSQRT VD100, VD104\nDTCH 0\nENI\nMEND\nINT 0\nINCW VW0\nRETI\nINT 1\nINCW VW2\nRETI\n");
  plc.input_at(1 * ms, "I0.0", true);
  plc.input_at(2 * ms, "I0.1", true);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.records.events(EventDropped), Ints{0});
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.value("VW2"), 1);
}

TEST(Interrupt, AnEventNotAttachedOrDetachedIsIgnored) {
  Plc plc(with_routine("LD SM0.1\nATCH 0, 0\nENI\nDTCH 0\nMEND\n"));
  plc.input_at(1 * ms, "I0.0", true);
  plc.input_at(2 * ms, "I0.1", true);
  plc.run_until(10 * ms);
  EXPECT_TRUE(plc.records.of(EventOccurred).empty());
}

TEST(Interrupt, TheRoutineAttachedLastServesWhatWaits) {
  Plc plc("LD SM0.1\nATCH 0, 0\nSQRT VD100, VD104\nATCH 1, 0\nENI\nMEND\nINT 0\nINCW VW0\nRETI\nINT 1\nINCW VW2\nRETI\n");
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.value("VW2"), 1);
}

TEST(Interrupt, AnInputThatCounter0CountsCannotHaveAnInterrupt) {
  Plc plc(with_routine("LD SM0.1\nHDEF 0, 0\nATCH 0, 0\nATCH 0, 1\nATCH 0, 2\nENI\nMEND\n"));
  plc.run_scans(1);
  EXPECT_EQ(plc.records.errors(), (Ints{2, 2}));
  EXPECT_EQ(plc.value("SM4.3"), 1);
}

// LD –210, MOVB –220, ATCH –230.
TEST(TimedInterrupt, ThePeriodIsCapturedByAtch) {
  Plc plc(with_routine("LD SM0.1\nMOVB 10, SMB34\nATCH 0, 10\nENI\nMOVB 50, SMB34\nMEND\n"));
  plc.run_until(31 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred), (Times{10'230 * us, 20'230 * us, 30'230 * us}));
}

// The first period began at 230 us; the second ATCH is executed by hand.
TEST(TimedInterrupt, AnotherAtchStartsAgainWithTheNewPeriod) {
  Plc plc(with_routine("LD SM0.1\nMOVB 10, SMB34\nATCH 0, 10\nENI\nMEND\n"));
  plc.run_until(12 * ms);
  plc.set("SMB34", 7);
  interrupts::attach(plc.cpu.core(), 10, 0);
  const Time at = plc.cpu.time();
  plc.run_until(at + 15 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred), (Times{10'230 * us, at + 7 * ms, at + 14 * ms}));
}

TEST(TimedInterrupt, ShorterThan5MillisecondsAndZeroAre5) {
  for (const int period : {0, 1, 4, 5}) {
    Plc plc(with_routine(fmt::format("LD SM0.1\nMOVB {}, SMB35\nATCH 0, 11\nENI\nMEND\n", period)));
    plc.run_until(11 * ms);
    EXPECT_EQ(plc.records.times(EventOccurred), (Times{5230 * us, 10'230 * us})) << period;
    EXPECT_EQ(plc.records.events(EventOccurred), (Ints{11, 11}));
  }
}

TEST(TimedInterrupt, TheLongestPeriodIs255Milliseconds) {
  Plc plc(with_routine("LD SM0.1\nMOVB 255, SMB34\nATCH 0, 10\nENI\nMEND\n"));
  plc.run_until(300 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred), Times{255'230 * us});
}

// Scans of about 101 ms; the services come late, the events do not.
TEST(TimedInterrupt, LongScansDoNotShiftThePhase) {
  Plc plc(with_routine("LD SM0.1\nMOVB 70, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nDIV VW100, VD104\nMEND\n"));
  plc.set("VW100", 1);
  plc.run_until(7'001 * ms);
  const Times times = plc.records.times(EventOccurred);
  ASSERT_EQ(times.size(), 100u);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], 230 * us + static_cast<Time>(i + 1) * 70 * ms);
  EXPECT_EQ(plc.value("VW0") + plc.cpu.state().waiting, 100);
}

TEST(TimedInterrupt, DtchStopsIt) {
  Plc plc(with_routine("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\n"));
  plc.run_until(6 * ms);
  interrupts::detach(plc.cpu.core(), 10);
  plc.run_until(50 * ms);
  EXPECT_EQ(plc.records.events(EventOccurred), Ints{10});
}

}  // namespace
}  // namespace s7200::test::interrupt_test
