// What `s7200 fuzz` finds.
#include "tools/fuzzing/fuzz.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools {
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

struct Fuzzed {
  explicit Fuzzed(std::string_view text, FuzzSettings settings = {.runs = 20'000, .seconds = 60})
      : inspection(inspected(text, {}, *find_cpu("214"))), result(fuzz(inspection, settings)) {}
  Inspection inspection;
  FuzzResult result;

  const FuzzFinding* of(Kind kind, std::uint16_t code = 0) const {
    for (const FuzzFinding& finding : result.findings)
      if (finding.kind == kind && (code == 0 || finding.code == code)) return &finding;
    return nullptr;
  }
  /// Whether the scenario of a finding fails as `s7200 test` runs it.
  bool is_shown(const FuzzFinding& finding) const {
    std::string why;
    return !finding_scenario(inspection, result, finding, "finding.yaml", {.program = "program.stl"}, why).empty();
  }
};

FuzzSettings with_rule(std::string_view program, std::string_view rule) {
  FuzzSettings settings{.runs = 5000, .seconds = 60};
  std::string why;
  settings.never.push_back(*Expression::parse(rule, *inspected(program, {}, *find_cpu("214")).program, why));
  return settings;
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
  std::string why;
  settings.writes.push_back(*parse_range("VB0:100", *find_cpu("214"), why));
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

}  // namespace
}  // namespace s7200::tools
