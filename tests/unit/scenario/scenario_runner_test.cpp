// Scenarios on our Modbus slave: what passes, that every kind of expectation can fail, transcripts, comparison.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "tests/support/slave_bench.hpp"
#include "tools/scenario/comparison.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/reporting/bytes_diff.hpp"
#include "tools/scenario/reporting/junit.hpp"
#include "tools/scenario/reporting/report_json.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/steps/exchange.hpp"
#include "tools/scenario/steps/random_traffic.hpp"
#include "tools/scenario/transcripts/transcript.hpp"

namespace s7200::tools::scenario_runner_test {
namespace {

using Outcome = ScenarioResult::Outcome;

std::shared_ptr<const Program> slave() {
  static const auto kProgram = test::compile(test::slave_text());
  return kProgram;
}

std::vector<Scenario> scenarios_of(const std::string& text) {
  ScenarioFile file = read_scenarios(text, "file.yaml");
  for (const auto& d : file.diagnostics) ADD_FAILURE() << stl::render(d, *file.source, false);
  return std::move(file.scenarios);
}

Scenario scenario_of(const std::string& steps, const std::string& head = "") {
  const std::string timeout = head.find("timeout:") == std::string::npos ? "timeout: 200ms\n" : "";
  auto all = scenarios_of(timeout + head + "steps:\n" + steps);
  return all.empty() ? Scenario{} : all[0];
}

ScenarioResult run(const Scenario& scenario, std::shared_ptr<const Program> program = slave()) {
  return run_scenario(scenario, {.program = std::move(program)});
}

/// What is found when these steps are run, in one line each.
std::string findings(const std::string& steps, const std::string& head = "",
                     std::shared_ptr<const Program> program = slave()) {
  const Scenario scenario = scenario_of(steps, head);
  std::string text;
  for (const Finding& finding : run(scenario, std::move(program)).findings)
    text += fmt::format("{}: {} / {}\n", finding.what, finding.expected, finding.found);
  return text;
}

TEST(ScenarioRunner, TheFirstRequestIsAnsweredAtEveryRate) {
  std::vector<test::RateSetting> rates(test::kRateSettings.begin(), test::kRateSettings.end());
  rates.push_back(test::k38400);
  for (const test::RateSetting& rate : rates)
    EXPECT_EQ(
        findings("  - {read: holding 0, expect: [0]}\n  - power_cycle: memory kept\n  - {read: holding 0, expect: [0]}\n",
                 "timeout: 1s\n", test::compile(test::at_rate(test::slave_text(), rate))),
        "")
        << rate.baud;
}

TEST(ScenarioRunner, WhatIsForcedIsCheckedAsItIsForcedWhereverTheScanIs) {
  const auto copy = test::compile("LD I0.0\n= Q0.0\nLD SM0.0\nMOVB 1, VB0\nINCW VW10\nINCW VW10\nMEND\n");
  for (int at = 0; at < 8; ++at) {
    const std::string wait = fmt::format("  - wait: {}us\n", 100000 + 13 * at);
    EXPECT_EQ(findings("  - force: {Q0.0: 1, VB0: 7}\n" + wait + "  - memory: {Q0.0: 1, VB0: 7}\n" +
                           "  - wait_until: {Q0.0: 1, VB0: 7}\n",
                       "", copy),
              "");
    EXPECT_EQ(findings("  - force: {Q0.0: 0}\n  - set: {I0.0: 1}\n" + wait + "  - memory: {Q0.0: 1}\n", "", copy),
              "Q0.0: 1 / 0\n");
  }
}

TEST(ScenarioRunner, EveryExpectationThatHoldsPasses) {
  EXPECT_EQ(findings("  - {write: holding 10, value: 16#1234, expect: echo, latency: 6ms..20ms, answer_gap: ..1ms}\n"
                     "  - {read: holding 10, expect: [16#1234]}\n"
                     "  - {read: holding 10, expect: 01 03 02 12 34}\n"
                     "  - {send: 01 03 00 0a 00 01 a4 08, expect: 01 03 02 12 34 .. ..}\n"
                     "  - {read: holding 10, expect: accepted}\n"
                     "  - {read: holding 2000, expect: exception 2}\n"
                     "  - {read: holding 2000, expect: refused}\n"
                     "  - {read: holding 0, station: 2, expect: silence}\n"
                     "  - {read: holding 0, station: 2, expect_one_of: [exception 1, silence]}\n"
                     "  - memory: {VW20: 16#1234, V20.1: 1, 'VB20:2': 12 ..}\n"
                     "  - {read: holding 0, expect: accepted}\n"
                     "  - interrupts: {INT 122: 1, event 8: 8, lost: 0}\n"
                     "  - mode: run\n"
                     "  - fatal: none\n"
                     "  - errors: none\n"),
            "");
}

TEST(ScenarioRunner, EveryKindOfExpectationCanFail) {
  EXPECT_EQ(findings("  - {read: holding 0, expect: silence}\n"), "answer: no answer / 1 register: 16#0000\n");
  EXPECT_EQ(findings("  - {read: holding 0, expect: 01 03 02 00 01}\n"), "answer:  / 1 register: 16#0000\n");
  EXPECT_EQ(findings("  - {send: 01 03 00 00 00 01 84 0a, expect: 01 03 02 00 00}\n"), "answer:  / 1 register: 16#0000\n")
      << "without crc: true the CRC is to be written";
  EXPECT_EQ(findings("  - {read: holding 0, expect: echo}\n"), "answer: the request again / 1 register: 16#0000\n");
  EXPECT_EQ(findings("  - {read: holding 0, expect: exception 2}\n"),
            "answer: exception 2: illegal data address / 1 register: 16#0000\n");
  EXPECT_EQ(findings("  - {read: holding 0, count: 126, expect: exception 2}\n"),
            "answer: exception 2: illegal data address / exception 3: illegal data value\n");
  EXPECT_EQ(findings("  - {read: holding 0, count: 2, expect: [0, 16#1234]}\n"),
            "answer: the values 16#0000 16#1234 / 2 registers: 16#0000 16#0000\n");
  EXPECT_EQ(findings("  - {request: 03 00 00 00 02, expect: [0]}\n"),
            "answer: the value 0 / 2 registers: 16#0000 16#0000\n");
  EXPECT_EQ(findings("  - {read: holding 0, count: 126, expect: accepted}\n"),
            "answer: what was asked for / exception 3: illegal data value\n");
  EXPECT_EQ(findings("  - {read: holding 0, station: 2, expect: accepted}\n"),
            "answer: what was asked for / no answer within 200 ms\n");
  EXPECT_EQ(findings("  - {read: holding 0, expect: refused}\n"), "answer: an exception / 1 register: 16#0000\n");
  EXPECT_EQ(findings("  - {read: holding 0, expect_one_of: [silence, exception 1]}\n"),
            "answer: no answer or exception 1: illegal function / 1 register: 16#0000\n");
  EXPECT_NE(findings("  - {read: holding 0, latency: ..1ms}\n"), "");
  EXPECT_NE(findings("  - {read: holding 0, latency: 1s..}\n"), "");
  EXPECT_EQ(findings("  - {read: holding 0, station: 2, latency: 1ms..}\n"), "latency: 1 ms or more / no answer\n");
  EXPECT_NE(findings("  - {read: holding 0, answer_gap: 1ms..}\n"), "");
  EXPECT_EQ(findings("  - memory: {VW20: 5}\n"), "VW20: 5 / 0\n");
  EXPECT_EQ(findings("  - memory: {Q0.0: 1}\n"), "Q0.0: 1 / 0\n");
  EXPECT_EQ(findings("  - {read: holding 0}\n  - interrupts: {INT 123: 8, event 10: 2.., lost: 1}\n"),
            "INT 123: 8 / 7\nevent 10: 2 or more / 1\nlost events: 1 / 0\n");
  EXPECT_EQ(findings("  - mode: stop\n"), "mode: STOP / RUN\n");
  EXPECT_EQ(findings("  - fatal: 0003\n"), fmt::format("fatal error: 0003, {} / none\n", meaning_of(FatalError::Watchdog)));
  EXPECT_EQ(findings("  - errors: {0092: 1}\n"), "run-time errors: 0092: 1 / none\n");
  EXPECT_NE(findings("  - wait: 1s\n  - {read: holding 0, at: 500ms}\n"), "");
}

TEST(ScenarioRunner, WhatIsExpectedOfTheInsideIsReadAsItIsWritten) {
  EXPECT_EQ(findings("  - interrupts: {INT 123: 7, event 8: 1..2}\n"), "INT 123: 7 / 0\nevent 8: 1 to 2 / 0\n");
  EXPECT_EQ(findings("  - interrupts: {lost: 0}\n  - fatal: none\n  - errors: none\n  - mode: run\n"), "");
  EXPECT_EQ(findings("  - errors: {0092: 3, 0006: 1..}\n"), "run-time errors: 0092: 3, 0006: 1 or more / none\n");
}

TEST(ScenarioRunner, FaultsDisturbTheLineUntilTheyAreTakenAway) {
  EXPECT_EQ(findings("  - fault: flip:character=3,bit=5\n"
                     "  - {read: holding 0, expect: silence}\n"
                     "  - fault: none\n"
                     "  - {read: holding 0, expect: [0]}\n"),
            "");
}

TEST(ScenarioRunner, AnAnswerWithParityErrorsIsNotWhatWasExpected) {
  const std::string found = findings("  - fault: parity:character=2,of=answer\n  - {read: holding 0, expect: accepted}\n");
  EXPECT_NE(found.find("parity errors"), std::string::npos) << found;
  EXPECT_EQ(findings("  - fault: parity:character=2,of=answer\n  - {read: holding 0, expect: accepted, disturbed: true}\n"),
            "");
  EXPECT_NE(findings("  - {read: holding 0, expect: accepted, disturbed: true}\n"), "");
}

TEST(ScenarioRunner, PowerCyclesKeepOrLoseTheMemory) {
  EXPECT_EQ(findings("  - {write: holding 10, value: 5, expect: echo}\n"
                     "  - power_cycle: memory kept\n"
                     "  - memory: {VW20: 5, SM0.1: 0}\n"
                     "  - power_cycle: memory lost\n"
                     "  - memory: {VW20: 0}\n"
                     "  - {read: holding 10, expect: [0]}\n"),
            "");
}

TEST(ScenarioRunner, TheClockGoesOnDuringAPowerCycleUnlessTheMemoryIsLost) {
  const auto clock = test::compile("LD SM0.0\nTODR VB100\nMEND\n");
  EXPECT_EQ(findings("  - power_cycle: memory kept\n"
                     "  - memory: {VB101: 16#11, VB102: 16#21, VB103: 16#10, VB104: 0}\n"
                     "  - {power_cycle: memory kept, power_off: 26h}\n"
                     "  - memory: {VB101: 16#11, VB102: 16#22, VB103: 16#12, VB104: 0}\n"
                     "  - {power_cycle: memory lost, power_off: 26h}\n"
                     "  - memory: {VB100: 16#90, VB101: 1, VB102: 1, VB103: 0}\n",
                     "clock: 2026-11-21 10:00:00\n", clock),
            "");
}

TEST(ScenarioRunner, AnUnexpectedStopIsAFailure) {
  const auto stops = test::compile("LD I0.0\nSTOP\nMEND\n");
  EXPECT_EQ(findings("  - set: {I0.0: 1}\n  - wait: 20ms\n", "after: 0\n", stops),
            "mode at the end: RUN, or a step 'mode: stop' or 'fatal:' / STOP\n");
  EXPECT_EQ(findings("  - set: {I0.0: 1}\n  - wait: 20ms\n  - mode: stop\n", "after: 0\n", stops), "");
  const auto hangs = test::compile("LD I0.0\nLBL 1\nJMP 1\nMEND\n");
  EXPECT_EQ(findings("  - set: {I0.0: 1}\n  - wait: 1s\n  - fatal: 0003\n", "after: 0\n", hangs), "");
  EXPECT_NE(findings("  - set: {I0.0: 1}\n  - wait: 1s\n", "after: 0\n", hangs).find("FATAL error 0003"), std::string::npos);
}

TEST(ScenarioRunner, SetLineClockAndScans) {
  EXPECT_EQ(findings("  - wait: 3 scans\n  - memory: {VW20: 7}\n  - {read: holding 10, expect: [7]}\n",
                     "set: {VW20: 7}\nclock: 2026-11-21 10:00:00\n"),
            "");
  EXPECT_EQ(findings("  - {read: holding 0, expect: silence}\n", "line: {baud: 19200}\n"), "");
  EXPECT_NE(findings("  - {send: 01p, expect: silence}\n", "line: {parity: none}\n").find("needs a format with parity"),
            std::string::npos);
}

TEST(ScenarioRunner, SaysWhereAndShowsWhatTheCpuDid) {
  const Scenario scenario = scenario_of("  - {read: holding 0, count: 2, expect: [0, 16#1234], note: important}\n");
  const std::string text = report_text({&scenario, run(scenario)}, false);
  EXPECT_NE(text.find("file.yaml:3:6: - {read: holding 0, count: 2, expect: [0, 16#1234], note: important}\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("      important\n"), std::string::npos);
  EXPECT_NE(text.find("      expected  01 03 04 00 00 12 34 f7 44\n"
                      "      found     01 03 04 00 00 00 00 fa 33\n"
                      "                               ^^ ^^ ^^ ^^\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("XMT 9 characters"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_NE(report_text({&scenario, run(scenario)}, true).find("\x1b[1;31m"), std::string::npos);
}

TEST(ScenarioReport, DiffsOfLongAnswersShowTheRowsThatDiffer) {
  std::vector<BytePattern> a(100, std::uint8_t{0}), b = a;
  b[50] = 1;
  a[51] = std::nullopt;
  b.pop_back();
  EXPECT_EQ(bytes_diff(a, b, "", false),
            "…\n"
            "expected    48  00 00 00 .. 00 00 00 00 00 00 00 00 00 00 00 00\n"
            "found       48  00 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00\n"
            "                      ^^\n"
            "…\n"
            "expected    96  00 00 00 00\n"
            "found       96  00 00 00\n"
            "                         ^^\n");
}

// --- programs that are not Modbus slaves ---

std::shared_ptr<const Program> text_commands() {
  static const auto kProgram = test::compile(test::text_of(test::source_path("stl_programs/text_commands.stl")));
  return kProgram;
}

std::string text_findings(const std::string& steps, const std::string& head = "") {
  return findings(steps, head, text_commands());
}

TEST(ScenarioRunner, TextIsSentExpectedAndReceived) {
  EXPECT_EQ(text_findings(R"(
  - {receive: {text: 'READY\r\n'}, at: ..5ms, latency: 0..0, answer_gap: ..1us}
  - {send: {text: 'SET 0005\r'}, expect: {text: 'OK\r\n'}, latency: ..5ms}
  - {send: {text: 'GET\r'}, expect: {text: 'VALUE \?\?\?5\r\n'}}
  - {send: {text: 'GET\r'}, expect: any}
  - {send: {text: 'get\r'}, expect_one_of: [silence, {text: 'ERROR\r\n'}]}
  - memory: {VW0: 5, VD4: 0.5}
  - set: {I0.0: 1}
  - {receive: 41 4c .. .. .. 0d 0a, latency: 1us..5ms}
  - {receive: silence}
)"),
            "");
}

TEST(ScenarioRunner, EveryExpectationOfTextCanFail) {
  EXPECT_EQ(text_findings(R"(  - {receive: {text: 'STEADY\r\n'}})"), "transmission: 'STEADY\\r\\n' / 'READY\\r\\n'\n");
  EXPECT_EQ(text_findings("  - {receive: silence}\n"), "transmission: nothing / 'READY\\r\\n'\n");
  EXPECT_EQ(text_findings("  - {receive: any}\n  - {receive: any, timeout: 30ms}\n"),
            "transmission: a transmission / nothing within 30 ms\n");
  EXPECT_TRUE(text_findings("  - {receive: any, at: 1s..}\n").starts_with("begin: 1 s or more / "));
  EXPECT_EQ(text_findings("  - {receive: any, latency: 1us..}\n"), "latency: 1 us or more / 0 ns\n");
  EXPECT_EQ(text_findings("  - {receive: any, crc: true}\n"), "transmission: a transmission / 'READY\\r\\n'\n");
  EXPECT_EQ(text_findings(R"(  - {send: {text: 'HELLO\r'}, expect: {text: 'NO\?\r'}})"),
            "answer: 'NO\\?\\r' / 'OK\\r\\n'\n");
  EXPECT_EQ(text_findings(R"(  - {send: {text: 'HELLO'}, expect: any})"), "answer: an answer / no answer within 200 ms\n");
  EXPECT_EQ(text_findings(R"(  - {send: {text: 'HELLO\r'}, expect: 01 03})"), "answer:  / 'OK\\r\\n'\n")
      << "no word about a CRC";
  EXPECT_EQ(text_findings("  - memory: {VD4: 1.5, VW0: 5..10}\n"), "VD4: 1.5 / 0.0\nVW0: 5..10 / 0\n");
  EXPECT_EQ(text_findings("  - set: {VD20: 2.0}\n  - memory: {VD20: 2}\n"),
            "VD20: 2 / 1073741824, the real 2.0: write 2.0 for it\n");
}

TEST(ScenarioRunner, WhatCameBeforeARequestIsNotReceivedAndTheFindingSaysSo) {
  EXPECT_EQ(
      text_findings("  - {send: {text: 'HELLO\\r'}}\n  - {receive: any, timeout: 30ms}\n"),
      "transmission: a transmission / nothing within 30 ms; the last request ignored what came before the request: 52 45 41 "
      "44 59 0d 0a\n");
}

TEST(ScenarioRunner, ATransmissionIsHeardAsThePortIsSetWhenItBegins) {
  const auto banner = test::compile(
      "LD SM0.1\nMOVB 16#B9, SMB30\nMOVB 2, VB0\nMOVW 'OK', VW1\nXMT VB0, 0\n"  // 7 data bits, even, 1200 baud
      "LD I0.0\nEU\nMOVB 16#09, SMB30\nXMT VB0, 0\nMEND\n");
  EXPECT_EQ(findings("  - {receive: {text: OK}}\n  - set: {I0.0: 1}\n  - {receive: {text: OK}}\n", "", banner), "");
  EXPECT_NE(findings("  - {receive: {text: OK}}\n", "line: {baud: 9600}\n", banner), "") << "unless the scenario says how";
}

TEST(ScenarioRunner, WaitsUntilMemoryIsAsExpected) {
  const auto counts = test::compile("LD SM0.0\nINCW VW0\nLDW>= VW0, 50\nA I0.0\nSTOP\nMEND\n");
  EXPECT_EQ(findings("  - wait_until: {VW0: 20, V1.2: 1}\n  - memory: {VW0: 20}\n"
                     "  - wait_until: {VW0: 10..20}\n  - memory: {VW0: 20}\n"
                     "  - wait_until: {VW0: 30..}\n  - memory: {VW0: 30}\n",
                     "after: 0\n", counts),
            "");
  EXPECT_EQ(findings("  - {wait_until: {VW0: -1, VW2: 0}, timeout: 20ms}\n", "after: 0\n", counts),
            "VW0 after 20 ms: -1 / 22\n");
  EXPECT_EQ(findings("  - {wait_until: {VW0: 5000..}, timeout: 0}\n", "after: 0\n", counts), "VW0 after 0 ns: 5000.. / 0\n");
  EXPECT_EQ(findings("  - set: {I0.0: 1}\n  - wait_until: {VW0: 60}\n  - mode: stop\n", "after: 0\n", counts),
            "VW0 when the CPU went to STOP, after 46.284 ms: 60 / 50, the CPU is in STOP\n");
  EXPECT_EQ(findings("  - set: {I0.0: 1}\n  - wait_until: {VW0: 50}\n  - mode: stop\n", "after: 0\n", counts), "")
      << "the STOP ends the scan in which it comes true";
}

TEST(ScenarioRunner, WhatComesTrueWithinAScanOnlyIsAFindingUnlessTheTimeEndsThere) {
  const auto toggles = test::compile("LD SM0.0\nMOVW 1, VW0\nFOR VW2, 1, 200\nNEXT\nMOVW 0, VW0\nMEND\n");
  std::size_t found = 0, waited = 0;
  for (int us = 30'000; us < 60'000; us += 500) {
    const std::string text =
        findings(fmt::format("  - {{wait_until: {{VW0: 1}}, timeout: {}us}}\n", us), "after: 0\n", toggles);
    text.empty() ? ++waited : ++found;
  }
  EXPECT_GT(found, 0U);
  EXPECT_GT(waited, 0U);
}

TEST(ScenarioRunner, CountsWhatItJudges) {
  const auto checks = [](const std::string& steps) { return run(scenario_of(steps)).checks; };
  EXPECT_EQ(checks("  - {read: holding 0}\n  - wait: 1ms\n"), 0U);
  EXPECT_EQ(checks("  - {read: holding 0, expect: accepted, latency: 1ms..}\n  - memory: {VW0: 0, VW2: 0}\n"), 2U);
  const Scenario nothing = scenario_of("  - {read: holding 0}\n");
  EXPECT_NE(report_text({&nothing, run(nothing)}, false).find("(nothing was expected, so nothing was checked)"),
            std::string::npos);
}

// --- transcripts ---

std::string transcript_of(const std::string& text) {
  const auto scenarios = scenarios_of(text);
  std::vector<Report> reports;
  for (const Scenario& scenario : scenarios) reports.push_back({&scenario, run(scenario)});
  return transcript_text(reports, {"file.yaml", "a slave", 0});
}

constexpr const char* kDriven =
    "timeout: 150ms\nset: {VW20: 16#1234, I0.3: 1}\nclock: 2026-11-21 10:00:00\nscenarios:\n"
    "  - name: 'a \"name\" \\ with marks'\n"
    "    steps:\n"
    "      - {read: holding 10}\n"
    "      - {read: inputs 0, count: 8, gap: 1 character, listen: 5ms, timeout: 100ms}\n"
    "      - {send: 01 03p 00}\n"
    "      - wait: 12.345678ms\n"
    "      - set: {VB20: 5, VD24: -1, Q0.0: 1}\n"
    "      - {read: holding 10, count: 3}\n"
    "      - wait: 2 scans\n"
    "      - fault: flip:character=3,bit=5,of=answer\n"
    "      - {read: holding 10}\n"
    "      - fault: none\n"
    "      - {power_cycle: memory kept, power_off: 8h}\n"
    "      - {read: coils 0, count: 9}\n"
    "  - {name: faster, line: {baud: 19200}, steps: [{read: holding 0}]}\n";

TEST(ScenarioRecord, ReplayedATranscriptGivesItselfAgain) {
  const std::string once = transcript_of(kDriven);
  for (const Scenario& scenario : scenarios_of(once)) {
    const ScenarioResult result = run(scenario);
    EXPECT_EQ(result.outcome, Outcome::Passed) << report_text({&scenario, result}, false) << once;
  }
  const std::string twice = transcript_of(once);
  EXPECT_EQ(twice, once);
}

TEST(ScenarioRecord, TextAndWhatNoOneAskedForComeAgainInAReplay) {
  const auto transcript = [](const std::vector<Scenario>& scenarios) {
    std::vector<Report> reports;
    for (const Scenario& scenario : scenarios) reports.push_back({&scenario, run(scenario, text_commands())});
    return transcript_text(reports, {"file.yaml", "a program", 0});
  };
  const std::string once = transcript(scenarios_of(R"(
timeout: 100ms
steps:
  - {receive: any}
  - {receive: any, timeout: 20ms, listen: 3ms}
  - {send: {text: "SET 0005\r"}, timeout: 0}
  - {wait_until: {VW0: 1..5, VD4: 0.5}, timeout: 50ms}
  - {receive: any}
  - {wait_until: {VW0: 9}, timeout: 30ms}
  - set: {I0.0: 1}
  - wait: 30ms
  - {receive: silence}
  - {send: {text: 'it''s \\ ${1 + 1} \x24{x}\r'}}
  - {send: 01 48 02}
)"));
  for (const char* written :
       {"- receive: {text: 'READY\\r\\n'}\n        at: ",
        "- receive: silence\n        listen: 3 ms\n        timeout: 20 ms\n", "- send: {text: 'SET 0005\\r'}\n",
        "- wait_until: {\"VW0\": \"1..5\", \"VD4\": \"0.5\"}\n        timeout: 50 ms\n",
        "- wait: 30 ms\n      - set: {I0.0: 16#1}\n", "- receive: {text: 'ALARM\\r\\n'}\n",
        "- send: {text: 'it\\x27s \\\\ 2 \\x24{x}\\r'}\n", "expect: {text: 'ERROR\\r\\n'}\n", "- send: 01 48 02\n"})
    EXPECT_NE(once.find(written), std::string::npos) << written << once;
  const auto again = scenarios_of(once);
  for (const Scenario& scenario : again) {
    const ScenarioResult result = run(scenario, text_commands());
    EXPECT_EQ(result.outcome, Outcome::Passed) << report_text({&scenario, result}, false) << once;
  }
  EXPECT_EQ(transcript(again), once);
}

TEST(ScenarioRecord, AWaitThatAStopCutShortIsAsShortInAReplay) {
  const auto stops = test::compile("LD I0.0\nSTOP\nMEND\n");
  const Scenario scenario = scenario_of(
      "  - set: {I0.0: 1}\n  - {wait_until: {VW0: 1}, timeout: 24h}\n  - {read: holding 0}\n  - power_cycle: memory kept\n",
      "after: 0\n");
  const ScenarioResult result = run(scenario, stops);
  ASSERT_TRUE(result.findings.at(0).waited);
  EXPECT_LT(*result.findings[0].waited, kSecond);
  const std::string text = transcript_text({{&scenario, result}}, {"file.yaml", "a program", 0});
  EXPECT_NE(text.find("- wait: " + format_duration(*result.findings[0].waited, 9) + "\n"), std::string::npos) << text;
  const Scenario again = scenarios_of(text).at(0);
  const ScenarioResult replay = run(again, stops);
  EXPECT_EQ(replay.outcome, Outcome::Passed) << report_text({&again, replay}, false) << text;
}

TEST(ScenarioRecord, OfALiveSlaveOnlyWhatReachedItIsWritten) {
  const auto scenarios = scenarios_of(
      "timeout: 100ms\nset: {VW20: 1}\nsteps:\n  - {read: holding 10}\n  - set: {VW20: 5}\n"
      "  - power_cycle: memory kept\n  - wait: 3ms\n  - {read: holding 10}\n");
  const std::vector<Report> reports{{&scenarios[0], run(scenarios[0])}};
  const std::string text = transcript_text(reports, {"file.yaml", "/dev/ttyUSB0", 50 * kMillisecond, true});
  for (const char* inside : {"set:", "power_cycle:", "at:"}) EXPECT_EQ(text.find(inside), std::string::npos) << text;
  for (const char* outside : {"wait: 3 ms", "pause: ", "tolerance: 50 ms"})
    EXPECT_NE(text.find(outside), std::string::npos) << text;
}

TEST(ScenarioRecord, AReplayIsExactToTheNanosecondAndToTheBit) {
  const std::string transcript = transcript_of("steps: [{read: holding 10}]\n");
  const auto outcome = [](const std::string& text) { return run(scenarios_of(text)[0]).outcome; };
  EXPECT_EQ(outcome(transcript), Outcome::Passed);
  const Time latency = dynamic_cast<const ExchangeStep&>(*scenarios_of(transcript)[0].steps[0].action).latency->from.fixed;
  const std::string written = format_duration(latency, 9);
  EXPECT_EQ(outcome(test::changed(transcript, written, format_duration(latency + 1, 9))), Outcome::Failed);
  EXPECT_EQ(outcome(test::changed(transcript, "expect: 01 03 02 00 00", "expect: 01 03 02 00 01")), Outcome::Failed);
  EXPECT_EQ(outcome(test::changed(test::changed(transcript, written, format_duration(latency + 1, 9)),
                                  "    steps:", "    tolerance: 1ns\n    steps:")),
            Outcome::Passed);
}

TEST(ScenarioRecord, AProgramThatAnswersLaterIsNoticed) {
  const std::string transcript = transcript_of("steps: [{read: holding 10}]\n");
  const auto slower = test::compile(test::changed(test::slave_text(), "MOVB    6, SMB34", "MOVB 7, SMB34"));
  const auto scenario = scenarios_of(transcript)[0];
  const ScenarioResult result = run(scenario, slower);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_TRUE(result.findings[0].what == "latency" || result.findings[0].what == "begin") << result.findings[0].what;
}

// --- comparison ---

/// Of two results that are there already.
Difference compare(const Scenario& scenario, const ScenarioResult& one, const ScenarioResult& other,
                   const Comparison& comparison = {}) {
  const auto side = [](const char* name, const ScenarioResult& result) {
    return Side{name, [&result](const ExchangeListener& listener) {
                  for (const Seen& seen : result.seen) listener(seen);
                  return result;
                }};
  };
  return tools::compare(scenario, side("a", one), side("b", other), comparison).difference;
}

TEST(ScenarioCompare, FindsTheFirstDifference) {
  const Scenario scenario =
      scenario_of("  - {read: holding 0}\n  - {write: coils 5, value: 1}\n  - {read: coils 0, count: 3}\n");
  const auto other = test::compile(test::changed(test::slave_text(), "MOVW    65, VW3290", "MOVW 5, VW3290"));
  const ScenarioResult a = run(scenario), b = run(scenario, other);
  EXPECT_FALSE(compare(scenario, a, a).found);
  const Difference difference = compare(scenario, a, b, {.timing = false});
  ASSERT_TRUE(difference.found);
  EXPECT_NE(difference.text.find("exchange 2, file.yaml:4\n"), std::string::npos) << difference.text;
  EXPECT_NE(difference.text.find("a         coil 5 written: 1 after"), std::string::npos) << difference.text;
  EXPECT_NE(difference.text.find("b         exception 2: illegal data address after"), std::string::npos) << difference.text;
}

TEST(ScenarioCompare, TimesCountUnlessTheyAreIgnoredOrTolerated) {
  const Scenario scenario = scenario_of("  - {read: holding 0}\n");
  const auto slower = test::compile(test::changed(test::slave_text(), "MOVB    6, SMB34", "MOVB 9, SMB34"));
  const ScenarioResult a = run(scenario), b = run(scenario, slower);
  EXPECT_TRUE(compare(scenario, a, b).found);
  EXPECT_FALSE(compare(scenario, a, b, {.timing = false}).found);
  EXPECT_FALSE(compare(scenario, a, b, {.tolerance = 5 * kMillisecond}).found);
}

TEST(ScenarioCompare, RandomTrafficIsTheSameForTheSameSeed) {
  const auto requests = [](std::uint32_t seed) {
    std::vector<serial::Frame> all;
    for (const Seen& seen : run(random_traffic(100, seed, 1)).seen) all.push_back(seen.exchange.request);
    return all;
  };
  EXPECT_EQ(requests(7), requests(7));
  EXPECT_NE(requests(7), requests(8));
  const Scenario scenario = random_traffic(300, 7, 1);
  const ScenarioResult result = run(scenario);
  std::size_t answered = 0;
  for (const Seen& seen : result.seen) answered += seen.exchange.response.empty() ? 0U : 1U;
  EXPECT_EQ(result.seen.size(), 300U);
  EXPECT_GT(answered, 200U);
  EXPECT_LT(answered, 300U);
}

TEST(ScenarioCompare, ExchangesOfTheSameStepAreCompared) {
  const Scenario scenario = scenario_of("  - {read: holding 0}\n  - {read: holding 1}\n");
  const auto seen = [](std::size_t step, std::uint8_t byte) {
    Seen one{.step = step};
    one.exchange.response.push_back({.byte = byte});
    return one;
  };
  const ScenarioResult both{.seen = {seen(0, 1), seen(1, 2)}};
  const ScenarioResult second{.seen = {seen(1, 2)}, .skipped_steps = 1};
  EXPECT_FALSE(compare(scenario, both, second).found);
  EXPECT_FALSE(compare(scenario, second, both).found);
  const ScenarioResult other{.seen = {seen(1, 3)}, .skipped_steps = 1};
  EXPECT_NE(compare(scenario, both, other).text.find("exchange 2,"), std::string::npos);
}

TEST(ScenarioCompare, ASideThatIsFasterWaitsForTheOtherAndOneThatLosesItsSlaveEndsBoth) {
  const Scenario scenario = scenario_of("  - {read: holding 0}\n");
  constexpr std::size_t kMany = 5000;
  std::atomic<std::int64_t> ahead = 0;
  std::int64_t most_ahead = 0;
  const auto many = [](const std::function<void()>& told, const ExchangeListener& listener) {
    for (std::size_t turn = 0; turn < kMany; ++turn) listener({.turn = turn}), told();
    return ScenarioResult{};
  };
  const Side slow{"slow", [&](const ExchangeListener& listener) { return many([&] { --ahead; }, listener); }};
  const Side fast{"fast", [&](const ExchangeListener& listener) {
                    return many([&] { most_ahead = std::max<std::int64_t>(most_ahead, ++ahead); }, listener);
                  }};
  const Side lost{"lost", [](const ExchangeListener&) -> ScenarioResult { throw SlaveUnreachable("gone"); }};
  const Compared compared = tools::compare(scenario, slow, fast, {});
  EXPECT_EQ(compared.exchanges, kMany);
  EXPECT_FALSE(compared.difference.found) << compared.difference.text;
  EXPECT_LT(most_ahead, 1000);
  EXPECT_THROW(tools::compare(scenario, slow, lost, {}), SlaveUnreachable);
  EXPECT_THROW(tools::compare(scenario, lost, fast, {}), SlaveUnreachable);
  EXPECT_EQ(tools::compare(scenario, slow, fast, {.one_after_other = true}).exchanges, kMany);
}

TEST(ScenarioCompare, ASideThatCouldNotBeAskedIsADifferenceEvenIfBothCouldNot) {
  const Scenario scenario = scenario_of("  - {read: holding 0}\n");
  const ScenarioResult lost{
      .findings = {{.what = "slave", .expected = "that it stays there", .found = "it is gone", .of_run = true}}};
  const Difference difference = compare(scenario, lost, lost);
  EXPECT_TRUE(difference.found);
  EXPECT_NE(difference.text.find("b could not be asked"), std::string::npos) << difference.text;
  EXPECT_NE(difference.text.find("it is gone"), std::string::npos) << difference.text;
}

TEST(ScenarioCompare, TransmissionsAreComparedAndAProgramThatNeverGetsThereDiffers) {
  const Scenario scenario =
      scenario_of("  - {receive: any}\n  - {send: {text: 'SET 0005\\r'}}\n  - {wait_until: {VW0: 5}, timeout: 50ms}\n");
  const std::string text = test::text_of(test::source_path("stl_programs/text_commands.stl"));
  const auto other = test::compile(test::changed(text, "'READ'", "'HEAD'"));
  const auto forgetful = test::compile(test::changed(text, "MOVW    VW12, VW0", "MOVW    VW12, VW2"));
  const auto difference = [&](const std::shared_ptr<const Program>& program) {
    return compare(scenario, run(scenario, text_commands()), run(scenario, program)).text;
  };
  EXPECT_EQ(difference(text_commands()), "");
  EXPECT_NE(difference(other).find("request   none: a transmission that no one asked for\n"), std::string::npos)
      << difference(other);
  EXPECT_NE(difference(other).find("b         'HEADY\\r\\n' "), std::string::npos) << difference(other);
  EXPECT_NE(difference(other).find(" ms before it was waited for\n"), std::string::npos) << difference(other);
  EXPECT_NE(
      difference(forgetful).find(
          "b could not be asked, file.yaml:5: VW0 after 50 ms is 0, expected 5; nothing has written it since power-up; "),
      std::string::npos)
      << difference(forgetful);
}

// --- machines ---

TEST(ScenarioReport, AMachineIsToldOfTextAsText) {
  const Scenario scenario = scenario_of("  - {receive: any}\n  - {send: {text: 'HELLO\\r'}}\n  - {send: 01}\n");
  const auto exchanges = to_json({{&scenario, run(scenario, text_commands())}})["scenarios"][0]["exchanges"];
  EXPECT_TRUE(exchanges[0]["request"].is_null());
  EXPECT_EQ(exchanges[0]["response_text"], "READY\r\n");
  EXPECT_EQ(exchanges[0]["latency_us"], 0.0);
  EXPECT_EQ(exchanges[1]["request_text"], "HELLO\r");
  EXPECT_EQ(exchanges[1]["response_text"], "OK\r\n");
  EXPECT_FALSE(exchanges[2].contains("request_text") || exchanges[2].contains("response_text"));
}

TEST(ScenarioReport, AFindingIsOneLineForMachines) {
  const auto line = [](const std::string& steps, const std::shared_ptr<const Program>& program) {
    const Scenario scenario = scenario_of(steps);
    return finding_line(scenario, run(scenario, program).findings.at(0));
  };
  EXPECT_EQ(line("  - {read: holding 0, expect: silence}\n", slave()),
            "01 03 00 00 00 01 84 0a: expected no answer, found 1 register: 16#0000");
  EXPECT_EQ(line("  - {read: holding 0, latency: ..1ms}\n", slave()).substr(0, 62),
            "latency, 01 03 00 00 00 01 84 0a: expected 1 ms or less, found");
  EXPECT_EQ(line("  - memory: {VW20: 5}\n", slave()),
            "VW20 is 0, expected 5; nothing has written it since power-up; no instruction names it; one that writes through "
            "a pointer could");
  EXPECT_EQ(line("  - repeat: 2\n    steps: [memory: {VD0: 1.5}]\n", slave()),
            "VD0 is 0.0, expected 1.5; nothing has written it since power-up; no instruction names it; one that writes "
            "through a pointer could (turn 1 of 2)");
  EXPECT_EQ(line("  - {receive: silence}\n", text_commands()), "transmission: expected nothing, found 'READY\\r\\n'");
}

// --- known gaps ---

/// Outcome and report of a scenario with this mark.
std::pair<Outcome, std::string> marked(const std::string& steps, const std::string& head = "") {
  static Scenario scenario;
  scenario = scenario_of(steps, "expected_failure: it cannot do that yet\n" + head);
  const ScenarioResult result = run(scenario);
  return {result.outcome, report_text({&scenario, result}, false)};
}

TEST(ExpectedFailure, AScenarioThatIsAKnownGapMustFail) {
  const auto [outcome, text] = marked("  - {read: holding 0, expect: refused}\n");
  EXPECT_EQ(outcome, Outcome::ExpectedFailure);
  EXPECT_TRUE(text.starts_with("  gap ")) << text;
  EXPECT_TRUE(text.ends_with("  file   (expected failure: it cannot do that yet)\n")) << text;
}

TEST(ExpectedFailure, OneThatPassesIsAFailureEvenIfItsRuleOnlySaysShould) {
  const auto [outcome, text] = marked("  - {read: holding 0, expect: accepted}\n");
  EXPECT_EQ(outcome, Outcome::Failed);
  EXPECT_NE(text.find("expected  a failure: it cannot do that yet\n"
                      "      found     it passes although it is an expected failure: remove the mark\n"),
            std::string::npos)
      << text;
  const Scenario rule =
      scenario_of("  - {read: holding 0, expect: accepted}\n", "rule: R\nseverity: should\nexpected_failure: it cannot\n");
  EXPECT_TRUE(counts_as_failed({&rule, run(rule)}));
}

TEST(ExpectedFailure, OneThatIsSkippedStaysSkipped) {
  EXPECT_EQ(marked("  - wait: 1ms\n", "skip_without: no/such/file\n").first, Outcome::Skipped);
}

TEST(ExpectedFailure, IsCountedApart) {
  const Scenario gap = scenario_of("  - {read: holding 0, expect: refused}\n", "expected_failure: it cannot\n");
  const Scenario good = scenario_of("  - {read: holding 0, expect: accepted}\n");
  const std::vector<Report> reports{{&gap, run(gap)}, {&good, run(good)}};
  EXPECT_EQ(summary_text(reports), "2 scenarios: 1 passed, 1 expected failure\n");
  const auto json = to_json(reports);
  EXPECT_EQ(json["expected_failures"], 1);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_EQ(json["scenarios"][0]["outcome"], "expected_failure");
  EXPECT_EQ(json["scenarios"][0]["expected_failure"], "it cannot");
  EXPECT_FALSE(json["scenarios"][1].contains("expected_failure"));
  const std::string junit = to_junit(reports);
  EXPECT_NE(junit.find("failures=\"0\" errors=\"0\" skipped=\"1\""), std::string::npos) << junit;
  EXPECT_NE(junit.find("<skipped message=\"expected failure: it cannot\"/>"), std::string::npos) << junit;
  EXPECT_FALSE(counts_as_failed(reports[0]));
}

// --- other slaves ---

/// Answers every request with itself, so often.
class EchoSlave final : public Slave {
 public:
  explicit EchoSlave(int answers = 1000) : answers_(answers) {}
  serial::Exchange exchange(const serial::Request& request) override {
    if (answers_-- == 0) throw SlaveLost("echo is gone");
    if (request.gap != 0) throw std::invalid_argument("echo knows no pauses");
    serial::Exchange exchange;
    exchange.request = request.frame;
    exchange.request_start = exchange.request_end = time_;
    for (const auto& character : request.frame)
      exchange.response.push_back({.byte = character.byte, .start = time_, .end = time_});
    exchange.response_start = exchange.response_end = time_;
    return exchange;
  }
  serial::Exchange receive(const serial::Listening&) override { throw std::invalid_argument("echo only answers"); }
  void wait(Time duration) override { time_ += duration; }
  Time now() const override { return time_; }
  Time pause() const override { return 0; }
  std::string name() const override { return "echo"; }

 private:
  Time time_ = 0;
  int answers_;
};

TEST(ScenarioRunner, StepsThatNeedTheInsideAreSkippedOnOtherSlaves) {
  EchoSlave echo;
  const Scenario mixed =
      scenario_of("  - {write: holding 0, value: 1, expect: echo, latency: 1s..2s}\n  - memory: {VW0: 1}\n  - wait: 20ms\n");
  const ScenarioResult result = run_scenario(mixed, {.slave = &echo});
  EXPECT_EQ(result.outcome, Outcome::Passed) << "of a computer's times only the upper limit counts";
  EXPECT_EQ(result.skipped_steps, 1U);
  const Scenario inside = scenario_of("  - memory: {VW0: 1}\n  - mode: run\n");
  EXPECT_EQ(run_scenario(inside, {.slave = &echo}).outcome, Outcome::Skipped);
}

TEST(ScenarioRunner, ScenariosThatActInsideAreSkippedAsAWholeOnOtherSlaves) {
  for (const char* step :
       {"set: {VW0: 1}", "fault: echo", "power_cycle: memory kept", "wait: 2 scans", "wait_until: {VW0: 1}"}) {
    EchoSlave echo;
    const Scenario acting = scenario_of(fmt::format("  - {{read: holding 0, expect: silence}}\n  - {}\n", step));
    const ScenarioResult result = run_scenario(acting, {.slave = &echo});
    EXPECT_EQ(result.outcome, Outcome::Skipped) << step;
    EXPECT_TRUE(result.seen.empty()) << step << ": a scenario is not begun and left half done";
    EXPECT_EQ(result.reason, fmt::format("needs a program in simulation: line {}, '{}'", acting.steps[1].position.line,
                                         acting.steps[1].key));
  }
}

TEST(ScenarioRunner, OfASlaveThatOnlyAnswersNothingIsReceived) {
  EchoSlave echo;
  const ScenarioResult result =
      run_scenario(scenario_of("  - {send: 41, expect: echo}\n  - {receive: any}\n"), {.slave = &echo});
  EXPECT_EQ(result.outcome, Outcome::Passed);
  EXPECT_EQ(result.skipped_steps, 1U);
}

TEST(ScenarioRunner, InstantsCountFromTheBeginOfTheScenarioOnOtherSlaves) {
  EchoSlave echo;
  echo.wait(10 * kSecond);
  const ScenarioResult result =
      run_scenario(scenario_of("  - {write: holding 0, value: 1, expect: echo, at: 500ms}\n"), {.slave = &echo});
  ASSERT_EQ(result.seen.size(), 1U);
  EXPECT_EQ(result.seen[0].exchange.request_start, 10 * kSecond + 500 * kMillisecond);
}

TEST(ScenarioRunner, ASlaveThatIsLostIsAFindingAndEndsTheScenario) {
  EchoSlave echo(1);
  const Scenario twice =
      scenario_of("  - {write: holding 0, value: 1, expect: echo}\n  - {read: holding 0}\n  - {read: holding 0}\n");
  const ScenarioResult result = run_scenario(twice, {.slave = &echo});
  EXPECT_EQ(result.outcome, Outcome::Failed);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].step, 1U);
  EXPECT_EQ(result.findings[0].found, "echo is gone");
}

TEST(ScenarioRunner, ARuleThatCannotBeJudgedAsAWholeIsNotKept) {
  EchoSlave echo;
  const auto outcome = [&echo](const std::string& step) {
    Scenario scenario = scenario_of("  - {write: holding 0, value: 1, expect: echo}\n" + step);
    scenario.rule.id = "rule";
    return run_scenario(scenario, {.slave = &echo}).outcome;
  };
  EXPECT_EQ(outcome(""), Outcome::Passed);
  EXPECT_EQ(outcome("  - {write: holding 0, value: 1, latency: ..2s}\n"), Outcome::Passed);
  EXPECT_EQ(outcome("  - {write: holding 0, value: 1, latency: 1ms..2s}\n"), Outcome::Skipped);
  EXPECT_EQ(outcome("  - {write: holding 0, value: 1, answer_gap: ..1 characters}\n"), Outcome::Skipped);
  EXPECT_EQ(outcome("  - {write: holding 0, value: 1, gap: 1 characters}\n"), Outcome::Skipped);
  EXPECT_EQ(outcome("  - {write: holding 0, value: 1, gap: 0 characters}\n"), Outcome::Passed);
  EXPECT_EQ(outcome("  - {write: holding 0, value: 1, gap: 1 characters}\n  - {read: holding 0, expect: refused}\n"),
            Outcome::Failed);
}

}  // namespace
}  // namespace s7200::tools::scenario_runner_test
