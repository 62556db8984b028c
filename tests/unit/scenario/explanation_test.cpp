// What a report says of why a scenario failed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "interpreter/analysis/warnings/check.hpp"
#include "tests/support/slave_bench.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/reporting/junit.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/scenario/reporting/report_json.hpp"
#include "tools/scenario/runner.hpp"

namespace s7200::tools::explanation_test {
namespace {

std::shared_ptr<const Program> program_of(const std::string& text) {
  return check_text(text, "test.stl", cpu214(), default_times(cpu214())).program;
}

Scenario scenario_of(const std::string& steps) {
  ScenarioFile file = read_scenarios("timeout: 200ms\nname: it's one\nsteps:\n" + steps, "file.yaml");
  for (const auto& d : file.diagnostics) ADD_FAILURE() << stl::render(d, *file.source, false);
  return file.scenarios.empty() ? Scenario{} : file.scenarios[0];
}

struct Failed {
  Scenario scenario;
  Report report;

  Failed(const std::string& steps, std::shared_ptr<const Program> program) : scenario(scenario_of(steps)) {
    report = {&scenario, run_scenario(scenario, {.program = std::move(program)})};
  }
  std::string text() const { return report_text(report, false); }

  /// What was found and why, a line each, however wide a report is.
  std::string lines() const {
    std::string lines;
    for (const Finding& finding : report.result.findings) {
      lines += finding_line(scenario, finding) + '\n';
      for (const std::string& why : finding.why) lines += why + '\n';
    }
    return lines;
  }
};

testing::AssertionResult has(const std::string& text, std::string_view part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in:\n" << text;
}

std::shared_ptr<const Program> slave() { return test::compile(test::slave_text()); }

TEST(Explanation, AMissingAnswerHasItsCauseInReportJsonAndJunit) {
  const Failed failed("  - {send: 01 03 00 0a 00 01 00 00, expect: [0]}\n", slave());
  EXPECT_TRUE(has(failed.text(), "why       "));
  EXPECT_TRUE(has(failed.lines(), "JMP 255 in line 141 (LDW= AC0, 0: "));
  const auto json = to_json({failed.report});
  const std::string why = json["scenarios"][0]["findings"][0]["why"][0];
  EXPECT_TRUE(has(why, "JMP 255 in line 141"));
  EXPECT_TRUE(has(to_junit({failed.report}), "JMP 255 in line 141"));
}

TEST(Explanation, OfMemoryItSaysWhatIsForced) {
  const auto program = program_of("LD I0.0\n= Q0.0\nMEND\n");
  const Failed input("  - force: {I0.0: 0}\n  - set: {I0.0: 1}\n  - wait: 20ms\n  - memory: {Q0.0: 1}\n", program);
  EXPECT_TRUE(has(input.lines(), "LD I0.0: I0.0=0); I0.0 was forced"));
  const Failed output("  - force: {Q0.0: 0}\n  - set: {I0.0: 1}\n  - wait: 20ms\n  - memory: {Q0.0: 1}\n", program);
  EXPECT_TRUE(has(output.lines(), "Q0.0 is forced to 0"));
}

TEST(Explanation, TheCommandThatOpensItIsPrinted) {
  const Failed failed("  - {send: 01 03 00 0a 00 01 00 00, expect: [0]}\n", slave());
  const std::string command = R"(s7200 debug file.yaml --only 'it'\''s one')";
  EXPECT_EQ(debug_command(failed.report), command);
  EXPECT_TRUE(has(failed.text(), command));
  EXPECT_TRUE(has(to_junit({failed.report}), "s7200 debug file.yaml --only"));
  EXPECT_EQ(to_json({failed.report})["scenarios"][0]["debug"], command);
}

TEST(Explanation, MemoryIsSaidInOneSentenceWithItsLastWriter) {
  const auto program = program_of("LD SM0.0\nMOVW 7, VW0\n= Q0.1\nLD I0.0\nMOVB 3, VB9\nMEND\n");
  const Failed failed("  - wait: 20ms\n  - memory: {VW0: 5, Q0.1: 0, VB9: 16#03}\n", program);
  EXPECT_TRUE(has(failed.lines(), "VW0 is 7, expected 5; last written at "));
  EXPECT_TRUE(has(failed.lines(), " by MOVW 7, VW0 in line 2\n"));
  EXPECT_TRUE(has(failed.lines(), "Q0.1 is 1, expected 0; last written at "));
  EXPECT_TRUE(has(failed.lines(),
                  "VB9 is 16#00 (0), expected 16#03; nothing has written it since power-up; MOVB 3, VB9 in line 5 could, "
                  "which had no power flow at "));
  EXPECT_TRUE(has(failed.lines(), " (LD I0.0: I0.0=0)\n"));
  EXPECT_TRUE(
      has(finding_line(failed.scenario, failed.report.result.findings[0]), "VW0 is 7, expected 5; last written at "));
}

TEST(Explanation, MemoryGoesBackToTheInputThatDecidedIt) {
  const auto program = program_of("LD I0.3\n= M0.0\nLD M0.0\nA SM0.0\n= Q0.1\nMEND\n");
  const Failed failed("  - wait: 20ms\n  - memory: {Q0.1: 1}\n", program);
  EXPECT_TRUE(has(failed.lines(), " by = Q0.1 in line 5 (LD M0.0: M0.0=0; A SM0.0: SM0.0=1); M0.0 was 0: last written at "));
  EXPECT_TRUE(has(failed.lines(), " by = M0.0 in line 2 (LD I0.3: I0.3=0)\n"));
}

TEST(Explanation, MemoryGoesBackToEachContactThatHoldsItOff) {
  const auto program = program_of(
      "LD I0.1\n= M0.0\nLD I0.2\n= M0.1\nLD SM0.0\n= M0.2\nLD I0.3\n= M0.3\n"
      "LD M0.0\nO M0.1\nA M0.2\n= Q0.1\n"           // neither M0.0 nor M0.1
      "LD M0.0\nO M0.2\nAN M0.1\nA M0.3\n= Q0.2\n"  // M0.3 alone, whatever M0.0 is
      "LD M0.0\nA M0.2\nLD M0.1\nA M0.2\nOLD\n= Q0.3\nMEND\n");
  const auto lines = [&](const std::string& bit) {
    return Failed("  - wait: 20ms\n  - memory: {" + bit + ": 1}\n", program).lines();
  };
  EXPECT_TRUE(has(lines("Q0.1"), "M0.0 was 0: ") && has(lines("Q0.1"), "M0.1 was 0: ")) << lines("Q0.1");
  EXPECT_FALSE(has(lines("Q0.1"), "M0.2 was ")) << lines("Q0.1");
  EXPECT_TRUE(has(lines("Q0.2"), "M0.3 was 0: ")) << lines("Q0.2");
  EXPECT_FALSE(has(lines("Q0.2"), "M0.0 was ") || has(lines("Q0.2"), "M0.1 was ")) << lines("Q0.2");
  EXPECT_TRUE(has(lines("Q0.3"), "M0.0 was 0: ") && has(lines("Q0.3"), "M0.1 was 0: ")) << lines("Q0.3");
  EXPECT_FALSE(has(lines("Q0.3"), "M0.2 was ")) << lines("Q0.3");
}

TEST(Explanation, MemoryThatIsOnGoesBackToTheBranchWithPower) {
  const auto program = program_of("LD SM0.0\n= M0.1\nLD I0.0\n= M0.0\nLD M0.0\nO M0.1\n= Q0.1\nMEND\n");
  const Failed failed("  - wait: 20ms\n  - memory: {Q0.1: 0}\n", program);
  EXPECT_TRUE(has(failed.lines(), "M0.1 was 1: ")) << failed.lines();
  EXPECT_FALSE(has(failed.lines(), "M0.0 was ")) << failed.lines();
}

TEST(Explanation, WhatCameAfterTheJournalIsSaidToHaveNoKnownCause) {
  std::string steps = "  - repeat: 1001\n    steps:\n      - set: {VB0: 1}\n";
  const Failed failed(steps + "  - memory: {VB9: 1}\n", program_of("LD SM0.0\nMEND\n"));
  EXPECT_TRUE(has(failed.lines(), "VB9 is 0, expected 1; the cause is not known: it came after the first 1000 requests"))
      << failed.lines();
}

TEST(Explanation, MemoryThatNoInstructionWritesIsSaidToBeSo) {
  const auto program = program_of("LD SM0.0\nMEND\n");
  const Failed failed("  - wait: 20ms\n  - memory: {VB9: 1}\n", program);
  EXPECT_TRUE(has(failed.lines(), "nothing has written it since power-up; no instruction of the program writes it\n"));
}

/// Answers a character with an XMT in the main program, when INT 0 has noted it; I0.0 makes the scan long.
constexpr std::string_view kInMain =
    "LD SM0.1\n"
    "MOVB 9, SMB30\n"
    "ATCH 0, 8\n"
    "ENI\n"
    "MOVB 1, VB0\n"
    "LD M0.0\n"  // 6
    "XMT VB0, 0\n"
    "R M0.0, 1\n"
    "LD SM0.0\n"
    "FOR VW10, 1, 300\n"
    "NEXT\n"
    "MEND\n"
    "INT 0\n"
    "LD SM0.0\n"
    "S M0.0, 1\n"
    "RETI\n";

TEST(Explanation, AWrongLatencySaysThatItWaitedForTheScan) {
  const Failed failed("  - {send: 41, expect: any, latency: ..1us}\n", program_of(std::string(kInMain)));
  const std::string text = failed.lines();
  EXPECT_TRUE(has(text, "the last character waited in the interrupt queue for INT 0"));
  EXPECT_TRUE(
      has(text, " ms: until the main program came to XMT VB0, 0 in line 7 (LD M0.0: M0.0=1), in the scan that began at "));
  const auto json = to_json({failed.report});
  EXPECT_GE(json["scenarios"][0]["findings"][0]["why"].size(), 2U);
}

TEST(Explanation, AWrongLatencySaysThatItWaitedForSilence) {
  const Failed failed("  - {read: holding 0, latency: ..1us}\n", slave());
  EXPECT_TRUE(has(failed.lines(), "a timed interrupt of "));
}

TEST(Explanation, WhatAStepHasSetIsItsWriter) {
  const auto program = program_of("LD SM0.0\nMEND\n");
  const Failed failed("  - wait: 20ms\n  - set: {VW0: 7}\n  - wait: 20ms\n  - memory: {VW0: 5}\n", program);
  EXPECT_TRUE(has(failed.text(), "VW0 is 7, expected 5; last written at "));
  EXPECT_TRUE(has(failed.text(), " by 'set VW0'"));
}

TEST(Explanation, FindingsBeforeAndAfterAPowerCycleHaveTheirOwnPasts) {
  const auto program = program_of("LD SM0.0\nMOVW 7, VW0\nMEND\n");
  const Failed failed("  - memory: {VW0: 5}\n  - power_cycle: memory lost\n  - memory: {VW0: 6}\n", program);
  ASSERT_EQ(failed.report.result.findings.size(), 2U);
  for (const Finding& finding : failed.report.result.findings) {
    ASSERT_EQ(finding.why.size(), 1U);
    EXPECT_TRUE(has(finding.why[0], "by MOVW 7, VW0 in line 2"));
  }
  EXPECT_EQ(failed.report.result.recordings.size(), 2U);
}

TEST(Explanation, WaitsForScansAndFaultsOfTheLineRunTheSameWayAgain) {
  const Failed failed(
      "  - wait: 3 scans\n  - fault: \"missing:of=answer,character=each\"\n  - {read: holding 0, expect: [0]}\n  - "
      "wait_until: {VW20: 1}\n",
      slave());
  EXPECT_TRUE(has(failed.text(), "fault missing:character=each,of=answer"));
}

TEST(Explanation, WhatPassesHasNoRecording) {
  const Failed passed("  - {read: holding 0, expect: [0]}\n", slave());
  EXPECT_TRUE(passed.report.result.recordings.empty());
  EXPECT_EQ(debug_command(passed.report), "");
}

TEST(Explanation, AMistakeInAFileIsAnErrorInJunit) {
  ScenarioFile file = read_scenarios("steps:\n  - reed: holding 0\n", "typo.yaml");
  const Messages messages{{.kind = Message::Kind::Diagnostics, .diagnostics = file.diagnostics, .source = file.source}};
  const std::string junit = to_junit(messages);
  EXPECT_TRUE(has(junit, "errors=\"1\""));
  EXPECT_TRUE(has(junit, "file=\"typo.yaml\" line=\"2\""));
  EXPECT_TRUE(has(junit, "<error message=\""));
  EXPECT_TRUE(has(to_junit(Messages{{.text = "cannot read x"}}), "cannot read x"));
}

}  // namespace
}  // namespace s7200::tools::explanation_test
