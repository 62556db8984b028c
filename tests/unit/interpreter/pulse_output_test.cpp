// PLS: pulse trains and PWM on Q0.0 and Q0.1. Times: plc.hpp.
#include "interpreter/cpu/units/pulse_outputs.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::pulse_output_test {
namespace {

using enum TraceKind;

/// LD –210, control –220, cycle –230, width –240, count –250, ATCH –260, ENI –270, PLS ends at 280.
std::string pulses(int control, int cycle, int width, int count) {
  return fmt::format("LD SM0.1\nMOVB {}, SMB67\nMOVW {}, SMW68\nMOVW {}, SMW70\nMOVD {}, SMD72\nATCH 0, 19\nENI\nPLS 0\n",
                     control, cycle, width, count);
}
constexpr std::string_view kEnd = "MEND\nINT 0\nINCW VW0\nRETI\n";
constexpr Time kStart = 280 * us;
constexpr int kTrain = 0x85, kTrainInMs = 0x8D, kPwm = 0xC3;

std::string program(int control, int cycle, int width, int count, std::string_view more = "") {
  return pulses(control, cycle, width, count).append(more).append(kEnd);
}

Times edges(const Plc& plc) { return plc.records.times(OutputChanged); }

TEST(PulseOutput, ATrainOfThreePulsesAndItsEvent) {
  Plc plc(program(kTrain, 1000, 0, 3));
  plc.run_until(1 * ms);
  EXPECT_EQ(plc.value("SM66.7"), 0);
  plc.run_until(10 * ms);
  EXPECT_EQ(edges(plc), (Times{kStart, kStart + 500 * us, kStart + 1000 * us, kStart + 1500 * us, kStart + 2000 * us,
                               kStart + 2500 * us}));
  EXPECT_EQ(plc.records.times(EventOccurred), Times{kStart + 3000 * us});
  EXPECT_EQ(plc.value("SM66.7"), 1) << "idle";
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(PulseOutput, MillisecondsAsUnit) {
  Plc plc(program(kTrainInMs, 20, 0, 2));
  plc.run_until(50 * ms);
  EXPECT_EQ(edges(plc), (Times{kStart, kStart + 10 * ms, kStart + 20 * ms, kStart + 30 * ms}));
}

TEST(PulseOutput, AnOddCycleHasItsShorterHalfFirst) {
  Plc plc(program(kTrainInMs, 5, 0, 1));
  plc.run_until(20 * ms);
  EXPECT_EQ(edges(plc), (Times{kStart, kStart + 2 * ms}));
  EXPECT_EQ(plc.records.times(EventOccurred), Times{kStart + 5 * ms});
}

TEST(PulseOutput, ACycleBelow2UnitsIs2AndACountOf0Is1) {
  Plc plc(program(kTrainInMs, 1, 0, 0));
  plc.run_until(20 * ms);
  EXPECT_EQ(edges(plc), (Times{kStart, kStart + 1 * ms}));
  EXPECT_EQ(plc.records.times(EventOccurred), Times{kStart + 2 * ms});
}

// The second PLS at 310 (MOVW –290, MOVD –300) waits for the end of the first train; the third is one too many, at 320.
TEST(PulseOutput, OneMoreTrainWaitsAndAFurtherOneSetsTheOverflowBit) {
  Plc plc(program(kTrainInMs, 2, 0, 2, "MOVW 4, SMW68\nMOVD 1, SMD72\nPLS 0\nPLS 0\n"));
  plc.run_until(310 * us);
  EXPECT_EQ(plc.value("SM66.6"), 0);
  plc.run_until(1 * ms);
  EXPECT_EQ(plc.value("SM66.6"), 1);
  plc.run_until(20 * ms);
  EXPECT_EQ(edges(plc),
            (Times{kStart, kStart + 1 * ms, kStart + 2 * ms, kStart + 3 * ms, kStart + 4 * ms, kStart + 6 * ms}));
  EXPECT_EQ(plc.records.times(EventOccurred), (Times{kStart + 4 * ms, kStart + 8 * ms}));
  EXPECT_EQ(plc.value("SM66.7"), 1);
}

// The refused PLS asked for 50 ms; the next one leaves the cycle as it is (control 16#8C): 2 ms.
TEST(PulseOutput, ARefusedTrainLeavesNothingBehind) {
  Plc plc(program(kTrainInMs, 2, 0, 1, "PLS 0\nMOVW 50, SMW68\nPLS 0\n"));
  plc.run_until(10 * ms);
  ASSERT_EQ(plc.records.times(EventOccurred).size(), 2u);
  plc.set("SMB67", 0x8C);
  pulse_outputs::program(plc.cpu.core(), 0);
  const Time at = plc.cpu.time();
  plc.run_until(at + 10 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred).back(), at + 2 * ms);
}

TEST(PulseOutput, PwmHoldsTheWidth) {
  Plc plc(program(kPwm | 0x08, 10, 3, 0));
  plc.run_until(25 * ms);
  EXPECT_EQ(edges(plc),
            (Times{kStart, kStart + 3 * ms, kStart + 10 * ms, kStart + 13 * ms, kStart + 20 * ms, kStart + 23 * ms}));
  EXPECT_TRUE(plc.records.times(EventOccurred).empty());
}

TEST(PulseOutput, PlsDuringPwmStartsANewCycleAtOnce) {
  Plc low(program(kPwm | 0x08, 10, 3, 0)), high(program(kPwm | 0x08, 10, 7, 0));
  for (Plc* plc : {&low, &high}) {
    plc->run_until(5 * ms);
    plc->set("SMW70", 4);
    pulse_outputs::program(plc->cpu.core(), 0);
  }
  const Time at = low.cpu.time();
  ASSERT_EQ(high.cpu.time(), at);
  for (Plc* plc : {&low, &high}) plc->run_until(at + 11 * ms);
  EXPECT_EQ(edges(low), (Times{kStart, kStart + 3 * ms, at, at + 4 * ms, at + 10 * ms})) << "in the 0 half of its cycle";
  EXPECT_EQ(edges(high), (Times{kStart, at + 4 * ms, at + 10 * ms})) << "in the 1 half";
  for (Plc* plc : {&low, &high}) EXPECT_TRUE(plc->records.times(EventOccurred).empty());
}

TEST(PulseOutput, APulseTrainAfterPwmStartsAtOnceAndAPwmAfterATrainWaitsForItsEnd) {
  Plc plc(program(kPwm | 0x08, 10, 3, 2));
  plc.run_until(5 * ms);
  plc.set("SMB67", kTrainInMs | 0x04);
  plc.set("SMW68", 2);
  pulse_outputs::program(plc.cpu.core(), 0);
  const Time at = plc.cpu.time();
  plc.set("SMB67", kPwm | 0x08);
  plc.set("SMW70", 1);
  pulse_outputs::program(plc.cpu.core(), 0);
  plc.run_until(at + 6500 * us);
  EXPECT_EQ(edges(plc), (Times{kStart, kStart + 3 * ms, at, at + 1 * ms, at + 2 * ms, at + 3 * ms, at + 4 * ms, at + 5 * ms,
                               at + 6 * ms}));
  EXPECT_EQ(plc.records.times(EventOccurred), Times{at + 4 * ms}) << "the end of the train";
}

TEST(PulseOutput, PwmOfZeroWidthIsOffAndOfTheWholeCycleIsOn) {
  Plc none(program(kPwm, 500, 0, 0)), all(program(kPwm, 500, 500, 0)), more(program(kPwm, 500, 900, 0));
  for (Plc* plc : {&none, &all, &more}) plc->run_until(10 * ms);
  EXPECT_TRUE(edges(none).empty());
  EXPECT_EQ(edges(all), Times{kStart});
  EXPECT_EQ(edges(more), Times{kStart});
}

TEST(PulseOutput, PlsWithoutEnableEndsPulsesAtOnceAndThePointFollowsItsImageAgain) {
  Plc plc(program(kPwm, 500, 500, 0, "LD I0.0\nMOVB 0, SMB67\nPLS 0\n"));
  plc.run_until(5 * ms);
  EXPECT_EQ(edges(plc), Times{kStart});
  plc.input("I0.0", true);
  plc.run_until(10 * ms);
  EXPECT_EQ(edges(plc).size(), 2u);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0);
  EXPECT_EQ(plc.value("SM66.7"), 1);
}

// The image says 1 for Q0.0–Q0.2 from the first scan on; =I and SI write at once.
TEST(PulseOutput, NeitherTheImageNorImmediateInstructionsReachAPointThatHasPulses) {
  Plc plc(program(kPwm, 60'000, 1, 0, "LD SM0.0\n= Q0.0\n= Q0.2\n=I Q0.0\nSI Q0.0, 2\n"));
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.value("Q0.0"), 1) << "the image has it";
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0x06) << "the point has the pulses";
}

TEST(PulseOutput, Output1HasItsOwnBytesAndEvent20) {
  Plc plc("LD SM0.1\nMOVB 16#8D, SMB77\nMOVW 2, SMW78\nMOVD 2, SMD82\nATCH 0, 20\nENI\nPLS 1\nMEND\nINT 0\nRETI\n");
  plc.run_until(10 * ms);
  ASSERT_EQ(plc.records.of(OutputChanged).size(), 4u);
  EXPECT_EQ(plc.records.of(OutputChanged)[0].byte, 0x02);
  EXPECT_EQ(plc.records.events(EventOccurred), Ints{20});
}

TEST(PulseOutput, StopEndsThePulses) {
  Plc plc(program(kTrainInMs, 2, 0, 100, "LD I0.0\nSTOP\n"));
  plc.input_at(4 * ms, "I0.0", true);
  plc.run_until(20 * ms);
  EXPECT_TRUE(plc.stopped());
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0);
  EXPECT_LT(edges(plc).back(), 6 * ms);
  EXPECT_TRUE(plc.records.times(EventOccurred).empty());
}

// --- CPUs 22x: profiles and synchronous PWM (facts 10.4) ---

/// A profile at VB500, in microseconds; it starts at 240 us.
struct ProfilePlc : Plc {
  struct Segment {
    int cycle, delta, count;
  };
  explicit ProfilePlc(const std::vector<Segment>& segments, const CpuModel& model = cpu224(), int offset = 500)
      : Plc(fmt::format("LD SM0.1\nMOVW {}, SMW168\nATCH 0, 19\nENI\nMOVB 16#A0, SMB67\nPLS 0\nLD I0.0\nEU\nMOVB 0, "
                        "SMB67\nPLS 0\n{}",
                        offset, kEnd),
            model) {
    set("VB500", static_cast<std::uint32_t>(segments.size()));
    for (std::size_t i = 0; i < segments.size(); ++i) put(i, segments[i]);
  }
  void put(std::size_t number, const Segment& s) {
    const std::size_t at = 501 + 8 * number;
    set(fmt::format("VW{}", at), static_cast<std::uint32_t>(s.cycle));
    set(fmt::format("VW{}", at + 2), static_cast<std::uint32_t>(s.delta));
    set(fmt::format("VD{}", at + 4), static_cast<std::uint32_t>(s.count));
  }
  /// From the start of one pulse to that of the next.
  Times cycles() const {
    const Times all = edges(*this);
    Times cycles;
    for (std::size_t i = 2; i < all.size(); i += 2) cycles.push_back(all[i] - all[i - 2]);
    return cycles;
  }
};

TEST(PulseOutput, AProfileRampsUpRunsAndRampsDown) {
  ProfilePlc plc({{500, -100, 4}, {200, 0, 3}, {200, 150, 3}});
  plc.run_until(1 * ms);
  EXPECT_EQ(plc.value("SMB166"), 1);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.cycles(), (Times{500 * us, 400 * us, 300 * us, 200 * us, 200 * us, 200 * us, 200 * us, 200 * us, 350 * us}));
  EXPECT_EQ(plc.value("SMB166"), 3);
  EXPECT_EQ(plc.value("SM66.7"), 1);
  EXPECT_EQ(plc.value("VW0"), 1) << "one event, at the end";
}

TEST(PulseOutput, ASegmentIsReadWhenItBegins) {
  ProfilePlc plc({{500, 0, 2}, {500, 0, 2}});
  plc.run_until(1 * ms);
  plc.put(0, {900, 0, 9});
  plc.put(1, {800, 0, 2});
  plc.set("VB500", 9);
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.cycles(), (Times{500 * us, 500 * us, 800 * us}));
}

TEST(PulseOutput, ACycleTimeOutOfRangeEndsTheProfile) {
  ProfilePlc plc({{500, -300, 5}});
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.cycles(), Times{500 * us});
  EXPECT_EQ(plc.value("SMB66"), 0x90) << "delta error, idle";
  EXPECT_EQ(plc.value("VW0"), 0);
}

TEST(PulseOutput, AProfileWithoutSegmentsIs000E) {
  ProfilePlc plc({});
  plc.run_until(10 * ms);
  EXPECT_EQ(plc.records.errors(), Ints{0x0E});
  EXPECT_TRUE(edges(plc).empty());
}

TEST(PulseOutput, AProfileOutsideVIs0091) {
  constexpr int kLocalMemory = image::kL - image::kV;
  for (const int offset : {8192, kLocalMemory, 0xFFFF}) {
    ProfilePlc plc({{500, 0, 2}}, cpu224(), offset);
    plc.run_until(10 * ms);
    EXPECT_EQ(plc.records.errors(), Ints{0x91}) << offset;
    EXPECT_TRUE(edges(plc).empty());
  }
}

TEST(PulseOutput, PlsWithoutEnableAbortsAProfileAndSaysSo) {
  ProfilePlc plc({{500, 0, 200}});
  plc.input_at(5 * ms, "I0.0", true);
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.value("SMB66"), 0xA0) << "user abort, idle";
  EXPECT_LT(plc.cycles().size(), 20u);
  EXPECT_EQ(plc.value("VW0"), 0);
}

TEST(PulseOutput, ACpu21xHasNoProfiles) {
  Plc plc(pulses(0xA5, 1000, 0, 2).append(kEnd));
  plc.run_until(10 * ms);
  EXPECT_EQ(edges(plc).size(), 4u) << "bit 5 of the control byte means nothing";
}

TEST(PulseOutput, ASynchronousChangeOfPwmWaitsForTheEndOfTheCycle) {
  Plc plc(program(kPwm | 0x10, 1000, 300, 0, "MOVW 600, SMW70\nPLS 0\n"), cpu224());
  plc.run_until(2 * ms);
  EXPECT_EQ(edges(plc), (Times{kStart, kStart + 300 * us, kStart + 1000 * us, kStart + 1600 * us}));
}

}  // namespace
}  // namespace s7200::test::pulse_output_test
