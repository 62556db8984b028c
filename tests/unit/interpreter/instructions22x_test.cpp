// What the instructions of the CPUs 22x do beyond the vectors: ENO, PID, strings as constants, ports, interval time. Times:
// plc.hpp.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tests/support/plc.hpp"

namespace s7200::test::instructions22x_test {
namespace {

std::string refusal(const std::string& text, const CpuModel& model = cpu224()) {
  const CheckResult result = check_text(text, "test", model, default_times(model));
  for (const auto& diagnostic : result.diagnostics)
    if (diagnostic.severity == stl::Severity::Error) return diagnostic.message;
  return "";
}

std::string refusal_of(const std::string& statement) { return refusal("LD SM0.0\n" + statement + "\nMEND\n"); }

// --- ENO ---

TEST(Eno, IsOneAtTheStartOfAScanAndOfARoutineAndAfterTheReturn) {
  Plc plc(
      "LD SM0.0\nAENO\n= V0.0\nLD SM0.0\nITB VW10, VB20\nCALL 0\nAENO\n= V0.2\nLD SM0.0\nITB VW10, VB20\nMEND\n"
      "SBR 0\nLD SM0.0\nAENO\n= V0.1\nITB VW10, VB20\nRET\n",
      cpu224());
  plc.set("VW10", 256);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VB0"), 7);
}

/// The edge comes in the middle of SQRT (5 ms), so the routine runs between SQRT and AENO.
std::int64_t eno_around_an_interrupt(float root, std::string_view in_routine) {
  Plc plc(fmt::format("LD SM0.1\nATCH 0, 0\nENI\nLD SM0.0\nSQRT VD100, VD104\nAENO\n= V0.0\nMEND\nINT 0\nLD SM0.0\n{}\n"
                      "INCB VB1\nRETI\n",
                      in_routine),
          cpu224());
  plc.set("VD100", std::bit_cast<std::uint32_t>(root));
  plc.set("VW10", 256);
  plc.input_at(1 * ms, "I0.0", true);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB1"), 1);
  return plc.value("V0.0");
}

TEST(Eno, AnInterruptRoutineLeavesItAlone) {
  EXPECT_EQ(eno_around_an_interrupt(4.0f, "DECB VB2"), 1) << "DECB overflows";
  EXPECT_EQ(eno_around_an_interrupt(-4.0f, "MOVB 1, VB2"), 0);
}

/// The top of the stack after AENO, after one box that has found words of `words` from VW10 on.
std::int64_t eno_after(std::string_view box, std::vector<std::uint32_t> words = {}) {
  Plc plc(fmt::format("LD SM0.0\n{}\nAENO\n= V0.0\nMEND\n", box), cpu224());
  for (std::size_t i = 0; i < words.size(); ++i) plc.set(fmt::format("VW{}", 10 + 2 * i), words[i]);
  plc.run_scans(1);
  return plc.value("V0.0");
}

TEST(Eno, FlagsThatSayFailureMakeItZero) {
  EXPECT_EQ(eno_after("+I 1, VW10", {0x7FFF}), 0) << "SM1.1";
  EXPECT_EQ(eno_after("INCB VB11", {0x00FF}), 0) << "SM1.1";
  EXPECT_EQ(eno_after("/I VW10, VW12", {0, 5}), 0) << "SM1.3";
  EXPECT_EQ(eno_after("ATT VW20, VW10", {1, 1}), 0) << "SM1.4";
  EXPECT_EQ(eno_after("FIFO VW10, VW20", {1, 0}), 0) << "SM1.5";
  EXPECT_EQ(eno_after("BCDI VW10", {0xA000}), 0) << "SM1.6";
  EXPECT_EQ(eno_after("ATH VB10, VB20, 1", {0x4700}), 0) << "SM1.7";
  EXPECT_EQ(eno_after("+I -1, VW10", {1}), 1) << "SM1.0 says nothing about failure";
  EXPECT_EQ(eno_after("-I 1, VW10", {0}), 1) << "nor does SM1.2";
  EXPECT_EQ(eno_after("SLW VW10, 1", {0x8000}), 1) << "SM1.1 is the bit shifted out";
}

TEST(Eno, AFormatThatIsNotPossibleMakesItZero) {
  EXPECT_EQ(eno_after("ITA VW10, VB20, 6"), 0);
  EXPECT_EQ(eno_after("ITA VW10, VB20, 5"), 1);
  EXPECT_EQ(eno_after("RTA 1234.5, VB20, 16#41"), 0) << "no room";
  EXPECT_EQ(eno_after("RTS 1.5, VB20, 16#41"), 1);
}

TEST(Eno, WriteToSpecialMemoryAndPointersKeepTheirStepsInAProgramWithAeno) {
  Plc plc("LD SM0.1\nMOVB 16#09, SMB30\nMOVD &VB100, VD10\nMOVB 7, *VD10\nAENO\n= V0.0\nMEND\n", cpu224());
  plc.run_scans(1);
  EXPECT_TRUE(plc.cpu.state().port[0].active);
  EXPECT_EQ(plc.value("VB100"), 7);
  EXPECT_EQ(plc.value("V0.0"), 1);
}

// --- what the checker says ---

TEST(Check22x, ATimerIsATonOrATofNotBoth) {
  EXPECT_EQ(refusal("LD SM0.0\nTON T37, 5\nLD SM0.0\nTOF T37, 5\nMEND\n"), "T37 is a TON in line 2; it cannot be a TOF too");
  EXPECT_EQ(refusal("LD SM0.0\nTOF T32, 5\nLD SM0.0\nTON T32, 5\nMEND\n"), "T32 is a TOF in line 2; it cannot be a TON too");
  EXPECT_EQ(refusal("LD SM0.0\nTON T33, 5\nLD SM0.0\nTOF T34, 5\nMEND\n"), "");
  EXPECT_EQ(refusal_of("TOF T5, 5"), "T5 is a retentive timer, TOF takes off-delay timers");
}

TEST(Check22x, LdsNeedsTheLevelThatItCopies) {
  EXPECT_EQ(refusal("LD SM0.0\nLDS 0\nALD\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(refusal("LD SM0.0\nLD SM0.1\nLD SM0.2\nLDS 3\nALD\nALD\nALD\n= Q0.0\nMEND\n"),
            "LDS needs 4 values on the logic stack and finds 3 (compile rule 0081)");
  EXPECT_EQ(refusal("LD SM0.0\nLDS 9\nMEND\n"), "level 9 does not exist on CPU 224");
}

TEST(Check22x, CscreBelongsIntoASegment) { EXPECT_EQ(refusal_of("CSCRE"), "CSCRE outside a segment (compile rule 0095)"); }

TEST(Check22x, AStringConstantStandsInDoubleQuotes) {
  EXPECT_EQ(refusal_of("SLEN \"HALLO\", VB0"), "");
  EXPECT_EQ(refusal_of("SLEN 'AB', VB0"), "IN of SLEN is a string, 'AB' is a number");
  EXPECT_EQ(refusal_of("SLEN \"$L\", VB0"), "");
  EXPECT_EQ(refusal_of("SLEN \"$q\", VB0"),
            "'$' is not allowed in a text; escapes are $$ $' $\" $L $N $P $R $T and $hh with two hexadecimal digits");
  EXPECT_EQ(refusal_of(fmt::format("SLEN \"{}\", VB0", std::string(126, 'x'))), "");
  EXPECT_NE(refusal_of(fmt::format("SLEN \"{}\", VB0", std::string(127, 'x'))), "");
  EXPECT_EQ(refusal_of("SCPY \"A\", \"B\""), "OUT of SCPY cannot be the constant \"B\"");
  EXPECT_EQ(refusal_of("MOVB \"A\", VB0"), "'\"A\"' is neither an address nor a defined symbol");
}

TEST(Check22x, WhatIsNotModelledIsRefusedByName) {
  EXPECT_EQ(refusal_of("SSCPY VB0, 1, 2, VB10"), "SSCPY is not modelled");
  EXPECT_EQ(refusal_of("TODRX VB0"), "TODRX is not modelled");
  EXPECT_EQ(refusal_of("TODWX VB0"), "TODWX is not modelled");
  const auto rows = all_instructions();
  EXPECT_TRUE(std::ranges::none_of(rows, [](const Instruction& row) { return !row.modelled() && row.not_modelled.empty(); }))
      << "each says why";
  EXPECT_EQ(refusal("LD SM0.0\nBITIM VD0\nMEND\n", cpu224r1()), "CPU 224r1 has no BITIM");
}

// --- strings ---

TEST(Strings, ConstantsAreCopiedJoinedAndCompared) {
  Plc plc(
      "LD SM0.0\nSCPY \"Pump \", VB10\nSCAT \"1\", VB10\nLDS= VB10, \"Pump 1\"\n= V0.0\nLDS<> VB10, \"Pump 1\"\n= "
      "V0.1\nMEND\n",
      cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB10"), 6);
  EXPECT_EQ(plc.value("VD11"), 0x50756D70);  // "Pump"
  EXPECT_EQ(plc.value("VW15"), 0x2031);      // " 1"
  EXPECT_EQ(plc.value("VB0"), 1);
}

TEST(Strings, OneInLocalMemoryIsAStringToo) {
  Plc plc("LD SM0.0\nSCPY \"AB\", LB0\nSLEN LB0, VB0\nBMB LB0, VB10, 3\nMEND\n", cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 2);
  EXPECT_EQ(plc.value("VW11"), 0x4142);
}

// --- ports, interval time, LED ---

TEST(PortAddress, IsTwoAfterPowerUp) {
  Plc plc("LD SM0.0\nGPA VB0, 0\nMEND\n", cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 2);
}

TEST(PortAddress, SpaSetsWhatGpaReads) {
  Plc plc("LD SM0.0\nSPA 17, 0\nGPA VB0, 0\nMEND\n", cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 17);
}

TEST(PortAddress, IsOneOfEachPort) {
  Plc plc("LD SM0.0\nSPA 17, 1\nGPA VB0, 0\nGPA VB1, 1\nMEND\n", cpu226());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 2);
  EXPECT_EQ(plc.value("VB1"), 17);
}

TEST(PortAddress, SpaInAnInterruptRoutineIsError0004) {
  Plc plc("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nLD SM0.0\nSPA 17, 0\nGPA VB0, 0\nRETI\n", cpu224());
  plc.input_at(2 * ms, "I0.0", true);
  plc.run_scans(4);
  EXPECT_EQ(plc.records.errors(), std::vector{0x04});
  EXPECT_EQ(plc.value("VB0"), 2);
}

TEST(IntervalTime, CountsMillisecondsFromPowerUp) {
  Plc plc("LD SM0.1\nBITIM VD0\nLD SM0.0\nSQRT VD100, VD104\nCITIM VD0, VD4\nBITIM VD8\nMEND\n", cpu224());
  plc.run_scans(3);
  EXPECT_EQ(plc.value("VD0"), 0);
  EXPECT_EQ(plc.value("VD4"), 16);
  EXPECT_EQ(plc.value("VD8"), 16);
}

TEST(DiagnosticLed, IsOnWhileTheOperandIsNotZero) {
  Plc plc("LD SM0.0\nDLED VB0\nMEND\n", cpu224());
  for (const std::uint32_t value : {0u, 5u, 0u}) {
    plc.set("VB0", value);
    plc.run_scans(plc.cpu.state().scans + 1);
    EXPECT_EQ(plc.cpu.state().diagnostic_led, value != 0);
  }
}

TEST(PointsAtOnce, BiwIsSeenBeforeTheScanEndsAndBirDoesNotChangeTheImage) {
  Plc plc("LD SM0.0\nBIW 16#5A, QB1\nBIR IB0, VB0\nMOVB IB0, VB1\nSQRT VD100, VD104\nMEND\n", cpu224());
  plc.input_at(205 * us, "I0.3", true);  // after the inputs have been read
  plc.run_until(1 * ms);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs + 1], 0x5A);
  EXPECT_EQ(plc.value("QB1"), 0x5A);
  EXPECT_EQ(plc.value("VB0"), 8);
  EXPECT_EQ(plc.value("VB1"), 0);
}

TEST(PointsAtOnce, NextToTheInputsAreNoInputsAndNextToTheOutputsNoOutputs) {
  for (const std::string program : {"MOVD &QB0, VD0\nBIR *VD0, VB10\n", "MOVD &MB0, VD0\nBIW 1, *VD0\n"}) {
    Plc plc("LD SM0.0\n" + program + "MEND\n", cpu224());
    plc.run_scans(1);
    EXPECT_EQ(plc.records.errors(), std::vector{0x91}) << program;
  }
}

// Facts 3.4: current value = preset, which a TOF reaches after its input has gone off.
TEST(Timer22x, ATofRaisesTheEventOfT32AtItsPreset) {
  Plc plc("LD SM0.1\nATCH 0, 21\nENI\nLD SM0.1\nTOF T32, 5\nMEND\nINT 0\nLD SM0.0\nINCB VB0\nRETI\n", cpu224());
  plc.run_until(30 * ms);
  EXPECT_EQ(plc.value("VB0"), 1);
  EXPECT_EQ(plc.value("T32"), 5);
}

TEST(Timer22x, ATofWritesItsBitAtEveryExecution) {
  Plc plc(
      "LD SM0.0\nS T37, 1\nLD I0.0\nTOF T37, 5\nLD T37\n= Q0.0\nLD SM0.0\nR T38, 1\nLD SM0.0\nTOF T38, 5\nLD T38\n= Q0.1\n"
      "MEND\n",
      cpu224());
  plc.run_scans(2);
  EXPECT_EQ(plc.value("Q0.0"), 0) << "its input has never been on";
  EXPECT_EQ(plc.value("Q0.1"), 1) << "its input is on";
}

TEST(Timer22x, ATofThatHasEndedDoesNotCountFromAValueWrittenToIt) {
  Plc plc("LD SM0.1\nTOF T37, 5\nTOF T33, 5\nMEND\n", cpu224());
  plc.run_until(2000 * ms);
  EXPECT_EQ(plc.value("T37"), 5);
  EXPECT_EQ(plc.value("T33"), 5);
  plc.set("T37", 0);
  plc.set("T33", 0);
  plc.run_until(4000 * ms);
  EXPECT_EQ(plc.value("T37"), 0);
  EXPECT_EQ(plc.value("T33"), 0);
}

// A scan takes 106 ms.
TEST(Timer22x, TheExecutionThatStartsATofAddsNoTicks) {
  std::string text = "LD SM0.0\n";
  for (int i = 0; i < 21; ++i) text += "SQRT VD100, VD104\n";
  Plc plc(text + "LD I0.0\nTOF T37, 100\nMEND\n", cpu224());
  plc.input("I0.0", true);
  plc.run_scans(3);
  plc.input("I0.0", false);
  plc.run_scans(4);
  EXPECT_EQ(plc.value("T37"), 0);
  plc.run_scans(5);
  EXPECT_EQ(plc.value("T37"), 1);
}

// A scan takes 106 ms.
TEST(Timer22x, ATofWhoseInputComesBackStandsAtZeroWithItsBitOn) {
  std::string text = "LD SM0.0\n";
  for (int i = 0; i < 21; ++i) text += "SQRT VD100, VD104\n";
  Plc plc(text + "LD I0.0\nTOF T37, 100\nLD T37\n= M0.0\nMEND\n", cpu224());
  plc.input("I0.0", true);
  plc.run_scans(3);
  plc.input("I0.0", false);
  plc.run_scans(8);
  EXPECT_GT(plc.value("T37"), 1);
  plc.input("I0.0", true);
  plc.run_scans(9);
  for (std::uint64_t scans = 10; scans < 15; ++scans) {
    plc.run_scans(scans);
    EXPECT_EQ(plc.value("T37"), 0) << scans;
    EXPECT_EQ(plc.value("MB0"), 1) << scans;
  }
}

TEST(Timer22x, ATofCountsTheMillisecondsAfterTheExecutionThatStartsIt) {
  for (Time offset = 0; offset < 2 * ms; offset += 50 * kMicrosecond) {
    Plc plc("LD I0.0\nTOF T32, 100\nMEND\n", cpu224());
    plc.input("I0.0", true);
    plc.run_until(5 * ms);
    plc.input_at(5 * ms + offset, "I0.0", false);
    plc.run_until(20 * ms);
    const Time started = plc.cpu.state().timer[32].since;
    EXPECT_GT(started, 5 * ms + offset);
    EXPECT_EQ(plc.value("T32"), plc.cpu.time() / ms - started / ms) << offset;
  }
}

// --- PID ---

/// A loop at VB100: PV SP M KC TS TI TD MX PV-1; TS / TI = 1/4.
class Loop : public Plc {
 public:
  explicit Loop(std::string_view stl, const CpuModel& model = cpu224()) : Plc(stl, model) {
    const float start[] = {0.5f, 0.5f, 0.25f, 2, 60, 4, 0, 0.25f, 0.5f};
    for (std::uint32_t i = 0; i < std::size(start); ++i) put(4 * i, start[i]);
  }
  void put(std::uint32_t offset, float to) { set(fmt::format("VD{}", 100 + offset), std::bit_cast<std::uint32_t>(to)); }
  float real(std::uint32_t offset) const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(value(fmt::format("VD{}", 100 + offset))));
  }
  void scan() { run_scans(cpu.state().scans + 1); }
};

constexpr std::uint32_t kPv = 0, kSp = 4, kM = 8, kKc = 12, kTs = 16, kTi = 20, kTd = 24, kMx = 28, kLastPv = 32;
constexpr std::string_view kAlways = "LD SM0.0\nPID VB100, 0\nMEND\n";

TEST(Pid, PowerFlowAtTheFirstExecutionAfterAChangeToRunIsNoTransition) {
  Loop loop(kAlways);
  loop.put(kSp, 0.75f);
  loop.put(kMx, 0.0f);
  loop.scan();
  EXPECT_EQ(loop.real(kSp), 0.75f);
  EXPECT_EQ(loop.real(kM), 0.5f + 0.125f);
}

TEST(Pid, PowerFlowThatComesLaterIsBumpless) {
  Loop loop("LD V0.0\nPID VB100, 0\nMEND\n");
  loop.put(kSp, 0.75f);
  loop.scan();
  EXPECT_EQ(loop.real(kSp), 0.75f) << "manual: untouched";
  loop.set("V0.0", 1);
  loop.scan();
  EXPECT_EQ(loop.real(kSp), 0.5f) << "SP := PV";
  EXPECT_EQ(loop.real(kM), 0.25f);
  EXPECT_EQ(loop.real(kMx), 0.25f);
  EXPECT_EQ(loop.real(kLastPv), 0.5f);
}

TEST(Pid, ASampleIsTheSumOfItsThreeTerms) {
  for (const CpuModel* model : {&cpu215(), &cpu224r1(), &cpu224()}) {
    Loop loop(kAlways, *model);
    loop.put(kTd, 0.5f);
    loop.scan();
    loop.put(kSp, 0.625f);
    loop.put(kPv, 0.5625f);
    loop.scan();
    // e = 1/16: 2/16 + (2 / 4 / 16 + 1/4) + 2 * 30/60 * -1/16
    EXPECT_EQ(loop.real(kM), 0.125f + 0.03125f + 0.25f - 0.0625f) << model->name;
    EXPECT_EQ(loop.real(kMx), 0.28125f) << model->name;
    EXPECT_EQ(loop.real(kLastPv), 0.5625f) << model->name;
  }
}

TEST(Pid, TheOutputAndTheBiasStayBetween0And1) {
  Loop loop(kAlways);
  loop.scan();
  loop.put(kSp, 0.875f);
  loop.scan();  // 0.75 + 0.1875 + 0.25 = 1.1875
  EXPECT_EQ(loop.real(kM), 1.0f);
  EXPECT_EQ(loop.real(kMx), 0.25f) << "1 - (MP + MD)";
  loop.put(kSp, 0.0f);
  loop.scan();  // -1 - 0.25 + 0.25
  EXPECT_EQ(loop.real(kM), 0.0f);
  EXPECT_EQ(loop.real(kMx), 1.0f) << "-(MP + MD)";
}

TEST(Pid, TheBiasOfAnOutputAtItsLimitHasTheDerivativeTerm) {
  Loop loop(kAlways);
  const auto sample = [&](float setpoint, float variable, float previous, float bias) {
    loop.put(kKc, 1.0f);
    loop.put(kTd, 1.0f);
    loop.put(kSp, setpoint);
    loop.put(kPv, variable);
    loop.put(kLastPv, previous);
    loop.put(kMx, bias);
    loop.scan();
  };
  sample(0.75f, 0.25f, 0.5f, 0.375f);  // 0.5 + (0.125 + 0.375) + 0.25
  EXPECT_EQ(loop.real(kM), 1.0f);
  EXPECT_EQ(loop.real(kMx), 0.25f) << "1 - (MP + MD)";
  sample(0.25f, 0.75f, 0.5f, 0.25f);  // -0.5 + (-0.125 + 0.25) - 0.25
  EXPECT_EQ(loop.real(kM), 0.0f);
  EXPECT_EQ(loop.real(kMx), 0.75f) << "-(MP + MD)";
}

TEST(Pid, WithoutPowerFlowItLeavesNoEno) {
  Loop loop("LD SM0.0\n+I VW10, VW12\nLD V0.0\nPID VB100, 0\nLD SM0.0\nAENO\n= V0.1\nMEND\n");
  loop.set("VB0", 2);
  loop.scan();
  EXPECT_EQ(loop.value("V0.1"), 0);
  loop.set("VB0", 1);
  loop.scan();
  EXPECT_EQ(loop.value("V0.1"), 1);
}

TEST(Pid, AGainOf0LeavesTheIntegralTermWithAGainOf1) {
  Loop loop(kAlways);
  loop.put(kKc, 0);
  loop.scan();
  loop.put(kSp, 0.75f);
  loop.scan();
  EXPECT_EQ(loop.real(kM), 0.25f + 0.0625f);
}

TEST(Pid, AnInfiniteIntegralTimeSwitchesTheIntegralTermOff) {
  Loop loop(kAlways);
  loop.put(kTi, std::numeric_limits<float>::infinity());
  loop.scan();
  loop.put(kSp, 0.625f);
  loop.scan();
  EXPECT_EQ(loop.real(kM), 0.5f);
  EXPECT_EQ(loop.real(kMx), 0.25f);
  EXPECT_EQ(loop.value("SM1.1"), 0);
}

TEST(Pid, AResultThatIsNotANumberSetsSM11) {
  Loop loop(kAlways);
  loop.scan();
  loop.put(kTi, 0.0f);
  loop.put(kSp, 0.625f);
  loop.scan();
  EXPECT_EQ(loop.value("SM1.1"), 1);
  EXPECT_EQ(loop.real(kM), 0.25f);
  loop.put(kTi, 4.0f);
  loop.scan();
  EXPECT_EQ(loop.value("SM1.1"), 0);
}

TEST(Pid, PowerFlowThatReturnsMakesItBumplessAgain) {
  Loop loop("LD V0.0\nPID VB100, 0\nAENO\n= V0.1\nMEND\n");
  loop.set("VB0", 1);
  loop.scan();
  EXPECT_EQ(loop.value("V0.1"), 1);
  loop.set("V0.0", 0);
  loop.put(kSp, 1.0f);
  loop.put(kM, 0.75f);
  loop.scan();
  EXPECT_EQ(loop.real(kM), 0.75f) << "manual: untouched";
  EXPECT_EQ(loop.value("V0.1"), 0);
  loop.set("V0.0", 1);
  loop.scan();
  EXPECT_EQ(loop.real(kSp), 0.5f);
  EXPECT_EQ(loop.real(kMx), 0.75f);
}

TEST(Pid, WithoutPowerFlowItTakesTheTimeOfASkippedBox) {
  const std::string text = "LD V0.0\nPID VB100, 0\nMEND\n";
  const TimeTable times = default_times(cpu224());
  const CheckResult result = check_text(text, "test", cpu224(), times);
  ASSERT_TRUE(result.program);
  EventQueue queue;
  Port port(queue);
  Cpu cpu(result.program, queue, kCpu, {&port});
  cpu.power_up();
  cpu.run(56 * us);
  EXPECT_EQ(cpu.time(), 55 * us + 800 + 1 * us) << "input read, LD, PID";
}

TEST(Pid, AutoTuningIsRefused) {
  Loop loop(kAlways);
  loop.set("VD136", 0x50494441);  // PIDA
  loop.scan();
  EXPECT_TRUE(loop.records.errors().empty());
  loop.set("VB140", 1);
  loop.scan();
  EXPECT_EQ(loop.records.errors(), std::vector{0x13});
  Loop at_the_end("LD SM0.0\nPID VB8151, 0\nMEND\n");
  at_the_end.set("VD8187", 0x50494441);
  at_the_end.set("VB8191", 1);
  at_the_end.scan();
  EXPECT_EQ(at_the_end.records.errors(), std::vector{0x13});
  Loop first_edition(kAlways, cpu224r1());
  first_edition.set("VD136", 0x50494441);
  first_edition.set("VB140", 1);
  first_edition.scan();
  EXPECT_TRUE(first_edition.records.errors().empty()) << "its table ends at 36 bytes";
}

TEST(Pid, ATableBeyondTheEndOfVIsRefused) {
  EXPECT_EQ(refusal_of("PID VB8157, 0"), "36 bytes from VB8157 run past the end of V memory (range error 0091)");
  EXPECT_EQ(refusal_of("PID VB8156, 7"), "");
  EXPECT_EQ(refusal_of("PID VB0, 8"), "LOOP of PID must be 0 to 7, not 8");
}

}  // namespace
}  // namespace s7200::test::instructions22x_test
