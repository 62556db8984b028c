// What `s7200 fuzz` finds.
#include "tools/fuzzing/fuzz.hpp"

#include <set>

#include "serial_sim/modbus/crc.hpp"
#include "tests/support/inspected.hpp"
#include "tests/support/tip41.hpp"

namespace s7200::tools::fuzz_test {
namespace {

using test::inspected;
using Kind = FuzzFinding::Kind;

/// Takes frames of four characters: 1, how far behind VB4000, how many words, anything. Believes both.
const std::string kTrusting =
    "LD SM0.1\nMOVB 9, SMB30\nMOVD &VB100, VD0\nATCH 0, 8\nENI\n"
    "LD M0.0\nR M0.0, 1\nCALL 1\nMEND\n"
    "SBR 1\nLDB= VB100, 1\nMOVD &VB4000, VD20\nMOVD 0, AC1\nMOVB VB101, AC1\n+D AC1, VD20\nBMW VW200, *VD20, VB102\n"
    "MOVB 2, VB300\nMOVB 1, VB301\nMOVB 6, VB302\nXMT VB300, 0\nRET\n"
    "INT 0\nLD SM0.0\nMOVB SMB2, *VD0\nINCD VD0\nINCW VW10\nLDW= VW10, 4\nMOVW 0, VW10\nMOVD &VB100, VD0\nS M0.0, 1\nRETI\n";

const std::string kEcho =
    "LD SM0.1\nMOVB 9, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM0.0\nMOVB SMB2, VB1\nXMT VB0, 0\n";

/// Receives characters at a port of a CPU 226; what each of the two routines does is left open.
std::string at_both_ports(const std::string& at_first, const std::string& at_second) {
  return "LD SM0.1\nMOVB 9, SMB30\nMOVB 9, SMB130\nATCH 0, 8\nATCH 1, 25\nENI\nMEND\nINT 0\n" + at_first + "RETI\nINT 1\n" +
         at_second + "RETI\n";
}

/// Our slave, with registers in all of V memory, as one would write it who copies as many bytes as the request says.
std::string believes_its_byte_count() {
  const std::string all = test::changed(test::slave_text(), "MOVW    1001, VW3292", "MOVW    2049, VW3292");
  const std::string unchecked = test::changed(
      all, "LDB=    VB3334, AC0             // are promised\nAW=     VW3300, AC1             // and have come\nNOT\nCRET\n",
      "");
  return test::changed(unchecked, "BMW     VW3335, *AC1, AC2 ",
                       "MOVB    VB3334, AC2\nANDW 255, AC2\nSRW AC2, 1\nBMW VW3335, *AC1, AC2 ");
}

struct Fuzzed {
  explicit Fuzzed(std::string_view text, FuzzSettings settings = {.runs = 20'000, .seconds = 60},
                  std::string_view cpu = "214")
      : inspection(inspected(text, {}, *find_cpu(cpu))), result(fuzz(inspection, settings)) {}
  Inspection inspection;
  FuzzResult result;

  const FuzzFinding* of(Kind kind, std::uint16_t code = 0) const {
    for (const FuzzFinding& finding : result.findings)
      if (finding.kind == kind && (code == 0 || finding.code == code)) return &finding;
    return nullptr;
  }
  /// Whether the scenario of a finding fails as `s7200 test` runs it.
  bool is_shown(const FuzzFinding& finding) const {
    return bool(finding_scenario(inspection, result, finding, "finding.yaml", {.program = "program.stl"}));
  }
};

FuzzSettings with_rule(std::string_view program, std::string_view rule) {
  FuzzSettings settings{.runs = 5000, .seconds = 60};
  settings.never.push_back(*Expression::parse(rule, *inspected(program, {}, *find_cpu("214")).program));
  return settings;
}

/// The watchdog strikes at one of the instructions of a loop or of the interrupt that comes in it: which one depends on each
/// nanosecond of the run. FILL takes so long that a run hardly ever ends when it is meant to.
const std::string kLoopsTooLong =
    "LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nENI\nLD SM0.0\nFILL 0, VW200, 250\nLDB= VB10, 16#77\n"
    "FOR VW20, 1, 32000\nINCW VW22\nNEXT\nMEND\n"
    "INT 0\nLD SM0.0\nMOVB VB10, VB11\nMOVB SMB2, VB10\nMOVB VB11, VB12\nRETI\n";

TEST(Fuzz, WhatIsFoundComesAgainWhenItsInputsAreGivenFromPowerUp) {
  const Fuzzed fuzzed(kLoopsTooLong, {.seed = 2, .runs = 2000, .seconds = 60});
  ASSERT_GE(fuzzed.result.findings.size(), 3U);
  for (const FuzzFinding& finding : fuzzed.result.findings) {
    EXPECT_TRUE(finding.comes_again) << finding.op.value_or(0);
    EXPECT_EQ(finding.begun.size(), finding.trial.size());
  }
  EXPECT_NE(fuzz_text(fuzzed.inspection, fuzzed.result).find("fatal error 0003"), std::string::npos);
}

TEST(Fuzz, WhatDoesNotComeAgainIsToldWithItsInputs) {
  Fuzzed fuzzed("LD I0.0\n= Q0.0\nMEND\n", {.runs = 1, .seconds = 60});
  fuzzed.result.findings.push_back({.what = "found",
                                    .at = kSecond,
                                    .trial = {{.what = Stimulus::What::Input, .bytes = {1}}},
                                    .begun = {kSecond},
                                    .comes_again = false});
  EXPECT_NE(fuzz_text(fuzzed.inspection, fuzzed.result).find("I0.0 = 1\n   it did not come again"), std::string::npos);
  EXPECT_FALSE(fuzzed.is_shown(fuzzed.result.findings[0]));
}

TEST(Fuzz, ASlaveThatBelievesLengthsAndPointersIsFoundOutByItsFrames) {
  const Fuzzed fuzzed(kTrusting);
  const FuzzFinding* const pointer = fuzzed.of(Kind::Error, 0x0006);
  const FuzzFinding* const count = fuzzed.of(Kind::Error, 0x0091);
  ASSERT_TRUE(pointer && count) << fuzz_text(fuzzed.inspection, fuzzed.result);
  EXPECT_EQ(fuzzed.inspection.program->statement(*pointer->op).mnemonic, "BMW");
  EXPECT_EQ(fuzzed.inspection.program->statement(*count->op).mnemonic, "BMW");
  EXPECT_EQ(pointer->trial.size(), 1U);
  EXPECT_EQ(pointer->trial.front().bytes.size(), 4U);
  EXPECT_TRUE(fuzzed.is_shown(*pointer));
  EXPECT_TRUE(fuzzed.is_shown(*count));
}

TEST(Fuzz, AStopOfTheProgramIsFoundWithItsInputs) {
  const Fuzzed fuzzed("LD I0.0\nA I0.1\nAN I0.2\nSTOP\nMEND\n");
  ASSERT_TRUE(fuzzed.of(Kind::Stop));
  EXPECT_EQ(fuzzed.of(Kind::Stop)->trial, (Trial{{.what = Stimulus::What::Input, .place = 0, .bytes = {3}}}));
  EXPECT_TRUE(fuzzed.is_shown(*fuzzed.of(Kind::Stop)));
}

TEST(Fuzz, AnEndlessLoopEndsInTheWatchdog) {
  const Fuzzed fuzzed("LBL 1\nLD I0.4\nJMP 1\nLD I0.0\n= Q0.0\nMEND\n", {.runs = 500, .seconds = 60});
  const FuzzFinding* const watchdog = fuzzed.of(Kind::Fatal);
  ASSERT_TRUE(watchdog);
  EXPECT_EQ(watchdog->code, 3);
  EXPECT_EQ(watchdog->trial.size(), 1U);
  EXPECT_TRUE(fuzzed.is_shown(*watchdog));
}

TEST(Fuzz, AWriteOutsideOfWhatIsAllowedNamesItsInstruction) {
  const std::string program = "LD I0.3\nMOVW 1, VW20\nLD I0.4\nMOVW 2, VW2000\nMEND\n";
  FuzzSettings settings{.runs = 2000, .seconds = 60};
  settings.writes.push_back(*parse_range("VB0:100", *find_cpu("214")));
  const Fuzzed fuzzed(program, settings);
  ASSERT_EQ(fuzzed.result.findings.size(), 1U) << fuzz_text(fuzzed.inspection, fuzzed.result);
  EXPECT_EQ(fuzzed.result.findings[0].kind, Kind::Write);
  EXPECT_EQ(fuzzed.result.findings[0].op, 3U);
  EXPECT_TRUE(fuzzed.is_shown(fuzzed.result.findings[0]));
}

TEST(Fuzz, ASlaveThatNeverAnswersAgainIsFoundWithTheCharacterThatSilencesIt) {
  const Fuzzed fuzzed(kEcho + "LDB= SMB2, 16#7F\nDTCH 8\nRETI\n", {.runs = 2000, .seconds = 60});
  const FuzzFinding* const silent = fuzzed.of(Kind::Unanswered);
  ASSERT_TRUE(silent) << fuzz_text(fuzzed.inspection, fuzzed.result);
  ASSERT_EQ(silent->trial.size(), 1U);
  EXPECT_EQ(silent->trial.front().bytes, std::vector<std::uint8_t>{0x7F});
  EXPECT_TRUE(fuzzed.is_shown(*silent));
}

TEST(Fuzz, ARuleOfTheUserIsBrokenByTheFewestInputs) {
  const std::string program = "LD I0.0\n= Q0.0\nLD I0.1\nO I0.2\n= Q0.1\nMEND\n";
  const Fuzzed fuzzed(program, with_rule(program, "Q0.0 and Q0.1"));
  const FuzzFinding* const rule = fuzzed.of(Kind::Rule);
  ASSERT_TRUE(rule);
  EXPECT_EQ(rule->trial.size(), 1U);
  EXPECT_TRUE(fuzzed.is_shown(*rule));
}

TEST(Fuzz, WhatIsWrongWithoutAnyInputIsFoundToo) {
  const Fuzzed fuzzed("LD SM0.1\nMOVD 16#7F000000, VD0\nMOVB 1, *VD0\nLD I0.0\n= Q0.0\nMEND\n",
                      {.runs = 100, .seconds = 60});
  const FuzzFinding* const error = fuzzed.of(Kind::Error, 0x0006);
  ASSERT_TRUE(error);
  EXPECT_TRUE(error->trial.empty());
  EXPECT_TRUE(fuzzed.is_shown(*error));
}

TEST(Fuzz, AProgramThatDoesNothingWrongHasAllItsContactsSeen) {
  const Fuzzed fuzzed("LD I0.0\nA I0.1\n= Q0.0\nLDW>= AIW2, 16000\n= Q0.1\nMEND\n", {.runs = 2000, .seconds = 60});
  EXPECT_TRUE(fuzzed.result.findings.empty());
  EXPECT_EQ(fuzzed.result.both_ways, 3U) << fuzz_text(fuzzed.inspection, fuzzed.result);
}

TEST(Fuzz, TheSameSeedFindsTheSame) {
  const FuzzSettings settings{.runs = 3000, .seconds = 60};
  const Fuzzed once(kTrusting, settings), again(kTrusting, settings);
  ASSERT_EQ(once.result.findings.size(), again.result.findings.size());
  for (std::size_t i = 0; i < once.result.findings.size(); ++i)
    EXPECT_EQ(once.result.findings[i].trial, again.result.findings[i].trial);
}

TEST(Fuzz, AByteCountThatLiesIsFoundThoughTheFrameIsWhole) {
  const Fuzzed fuzzed(believes_its_byte_count(), {.runs = 30'000, .seconds = 60});
  const FuzzFinding* const count = fuzzed.of(Kind::Error, 0x0091);
  ASSERT_TRUE(count) << fuzz_text(fuzzed.inspection, fuzzed.result);
  EXPECT_TRUE(modbus::crc_ok(count->trial.back().bytes));
  EXPECT_TRUE(fuzzed.is_shown(*count));
}

TEST(Fuzz, ACharacterWithWrongParityIsTriedAndWritten) {
  const Fuzzed fuzzed("LD SM0.1\nMOVB 16#49, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM3.0\nSTOP\nRETI\n",
                      {.runs = 1000, .seconds = 60});
  const FuzzFinding* const stop = fuzzed.of(Kind::Stop);
  ASSERT_TRUE(stop) << fuzz_text(fuzzed.inspection, fuzzed.result);
  ASSERT_EQ(stop->trial.size(), 1U);
  EXPECT_EQ(stop->trial[0].damaged, 1U);
  EXPECT_NE(fuzz_text(fuzzed.inspection, fuzzed.result).find("p\n"), std::string::npos);
  EXPECT_TRUE(fuzzed.is_shown(*stop));
}

TEST(Fuzz, AWrongStopBitIsTriedAndWritten) {
  const std::string takes_bad_messages =
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#94, SMB87\nMOVW 1, SMW90\nMOVW 20, SMW92\nMOVB 50, SMB94\nATCH 0, 23\nENI\n"
      "RCV VB100, 0\nMEND\nINT 0\nLDB= SMB86, 1\nAB>= VB100, 1\nSTOP\nLD SM0.0\nRCV VB100, 0\nRETI\n";
  const Fuzzed fuzzed(takes_bad_messages, {.runs = 10'000, .seconds = 60}, "224");
  const FuzzFinding* const stop = fuzzed.of(Kind::Stop);
  ASSERT_TRUE(stop) << fuzz_text(fuzzed.inspection, fuzzed.result);
  EXPECT_TRUE(stop->trial.back().bad_stop);
  EXPECT_NE(fuzz_text(fuzzed.inspection, fuzzed.result).find(" with a wrong stop bit\n"), std::string::npos);
  EXPECT_TRUE(fuzzed.is_shown(*stop));
}

TEST(Fuzz, ABreakIsTriedAndWritten) {
  const std::string waits_for_a_break =
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#86, SMB87\nMOVB 3, SMB94\nMOVW 50, SMW92\nATCH 0, 23\nENI\nRCV VB100, 0\nMEND\n"
      "INT 0\nLDB>= VB100, 1\nSTOP\nLD SM0.0\nRCV VB100, 0\nRETI\n";
  const Fuzzed fuzzed(waits_for_a_break, {.runs = 5000, .seconds = 60}, "224");
  const FuzzFinding* const stop = fuzzed.of(Kind::Stop);
  ASSERT_TRUE(stop) << fuzz_text(fuzzed.inspection, fuzzed.result);
  EXPECT_EQ(stop->trial.front().what, Stimulus::What::Break);
  EXPECT_TRUE(fuzzed.is_shown(*stop));
}

TEST(Fuzz, APowerFailureIsTriedAndWritten) {
  const Fuzzed fuzzed("LD SM0.1\nA M20.0\nSTOP\nLD I0.0\nS M20.0, 1\nMEND\n", {.runs = 10'000, .seconds = 60});
  const FuzzFinding* const stop = fuzzed.of(Kind::Stop);
  ASSERT_TRUE(stop) << fuzz_text(fuzzed.inspection, fuzzed.result);
  ASSERT_EQ(stop->trial.size(), 2U);
  EXPECT_EQ(stop->trial[1].what, Stimulus::What::Power);
  EXPECT_TRUE(fuzzed.is_shown(*stop));
}

TEST(Fuzz, TheSecondPortIsTriedAndWritten) {
  const Fuzzed fuzzed(at_both_ports("LDB= SMB2, 16#21\nS Q0.0, 1\n", "LDB= SMB2, 16#3F\nSTOP\n"),
                      {.runs = 2000, .seconds = 60}, "226");
  const FuzzFinding* const stop = fuzzed.of(Kind::Stop);
  ASSERT_TRUE(stop) << fuzz_text(fuzzed.inspection, fuzzed.result);
  ASSERT_EQ(stop->trial.size(), 1U);
  EXPECT_TRUE(stop->trial[0].other_port);
  EXPECT_TRUE(fuzzed.is_shown(*stop));
}

TEST(Fuzz, AFindingThatNeedsBothPortsIsNotWritten) {
  const Fuzzed fuzzed(at_both_ports("LDB= SMB2, 16#21\nS M0.0, 1\n", "LDB= SMB2, 16#3F\nA M0.0\nSTOP\n"),
                      {.runs = 10'000, .seconds = 60}, "226");
  const FuzzFinding* const stop = fuzzed.of(Kind::Stop);
  ASSERT_TRUE(stop) << fuzz_text(fuzzed.inspection, fuzzed.result);
  EXPECT_FALSE(fuzzed.is_shown(*stop));
}

TEST(Fuzz, TheTipIsFoundOutByBlocksOfNothingAndByAPointerBeyondItsOutputs) {
  if (!test::tip41::available()) GTEST_SKIP() << "Application Tip 41 is not here";
  const Fuzzed fuzzed(test::tip41::text(), {.runs = 30'000, .seconds = 60});
  std::set<std::string> blocks;
  for (const FuzzFinding& finding : fuzzed.result.findings)
    if (finding.code == 0x0092) blocks.insert(fuzzed.inspection.program->statement(*finding.op).mnemonic);
  EXPECT_EQ(blocks, (std::set<std::string>{"BMB", "BMW"})) << fuzz_text(fuzzed.inspection, fuzzed.result);
  ASSERT_TRUE(fuzzed.of(Kind::Error, 0x0006));
  EXPECT_TRUE(fuzzed.is_shown(*fuzzed.of(Kind::Error, 0x0006)));
}

}  // namespace
}  // namespace s7200::tools::fuzz_test
