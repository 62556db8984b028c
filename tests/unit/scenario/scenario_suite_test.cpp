// The engine of `s7200 test`: what is collected, what it is run on, and that one scenario does not spoil the others.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/scratch_folder.hpp"
#include "tests/support/source_path.hpp"
#include "tools/scenario/reporting/junit.hpp"
#include "tools/scenario/reporting/report_json.hpp"
#include "tools/scenario/suite.hpp"

namespace s7200::tools::scenario_suite_test {
namespace {

using Outcome = ScenarioResult::Outcome;

const std::string kSlave = test::source_path("stl_programs/modbus_slave.stl");

std::string text_of(const Messages& messages) {
  std::string text;
  for (const Message& message : messages) {
    if (!message.text.empty()) text += message.text + "\n";
    for (const stl::Diagnostic& diagnostic : message.diagnostics) text += diagnostic.message + "\n";
  }
  return text;
}

class ScenarioSuite : public testing::Test {
 protected:
  ScenarioSuite() { std::filesystem::create_directories(folder_); }
  ~ScenarioSuite() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }

  /// A scenario that reads register 0 and expects `value`.
  std::string scenario(const std::string& name, const std::string& value = "0", const std::string& program = kSlave) {
    return file(name + ".yaml", fmt::format("name: {}\nprogram: {}\ntimeout: 200ms\nsteps:\n  - {{read: holding 0, expect: "
                                            "[{}]}}\n",
                                            name, program, value));
  }

  Suite collected(const SuiteSettings& settings) {
    Messages messages;
    auto suite = Suite::collect(settings, messages);
    EXPECT_EQ(text_of(messages), "");
    return std::move(suite.value());
  }

  /// What keeps it from being run.
  static std::string refusal(const SuiteSettings& settings) {
    Messages messages;
    auto suite = Suite::collect(settings, messages);
    EXPECT_FALSE(suite && suite->run({}, messages)) << "it was run";
    return text_of(messages);
  }

  /// Names and outcomes, in the order they were heard of.
  static std::string outcomes(Suite& suite) {
    std::string text;
    Messages messages;
    const auto result = suite.run({.finished =
                                       [&](const Report& report) {
                                         static constexpr const char* kWords[] = {"passed", "failed", "skipped"};
                                         text += fmt::format("{}: {}\n", report.scenario->name,
                                                             kWords[static_cast<int>(report.result.outcome)]);
                                       }},
                                  messages);
    EXPECT_TRUE(result) << text_of(messages);
    return text;
  }

  /// A scenario of a line with the slaves a and b, stations 1 and 2.
  std::string scenario_of_two(const std::string& name, const std::string& steps) {
    file("two.yaml", fmt::format("plcs: {{a: {{program: {0}}}, b: {{program: {0}, station: 2}}}}\n"
                                 "lines: {{bus: {{stations: [a, b]}}}}\n",
                                 kSlave));
    return file(name + ".yaml", fmt::format("name: {}\nsystem: two.yaml\ntimeout: 200ms\n{}", name, steps));
  }

  /// What the first finding has found; empty if all passed.
  std::string found_in(const std::string& scenario) {
    Suite suite = collected({.files = {scenario}});
    Messages messages;
    const auto result = suite.run({}, messages);
    EXPECT_TRUE(result) << text_of(messages);
    const auto& findings = result->reports.at(0).result.findings;
    return findings.empty() ? "" : findings[0].found;
  }

  std::filesystem::path folder_ = std::filesystem::path(test::scratch_folder()) / fmt::format("suite_{}", next_folder_++);
  static inline int next_folder_ = 0;
};

TEST_F(ScenarioSuite, TakesFilesAndAllOfAFolderInOrder) {
  const std::string single = scenario("z");
  scenario("in/b");
  scenario("in/deep/a");
  file("in/notes.txt", "no scenario");
  Suite suite = collected({.files = {single, (folder_ / "in").string()}});
  EXPECT_EQ(outcomes(suite), "z: passed\nin/b: passed\nin/deep/a: passed\n");
}

TEST_F(ScenarioSuite, ChoosesByNameFileOrRule) {
  const std::vector<std::string> files{scenario("one"), scenario("two")};
  EXPECT_EQ(collected({.files = files, .only = "TW*"}).scenarios().size(), 1U);
  EXPECT_EQ(collected({.files = files, .only = "one.yaml"}).scenarios().size(), 1U);
  EXPECT_EQ(refusal({.files = files, .only = "three"}), "no scenario has 'three' in its name or file; --list shows them\n");
}

TEST_F(ScenarioSuite, AllMistakesOfAllFilesAreToldAndNothingIsRun) {
  const std::string told = refusal({.files = {file("a.yaml", "steps:\n  - wait: 5\n"), (folder_ / "none.yaml").string(),
                                              file("b.yaml", "frob: 1\nsteps: [wait: 1ms]\n")}});
  EXPECT_NE(told.find("'5' is not a duration"), std::string::npos) << told;
  EXPECT_NE(told.find("cannot read "), std::string::npos) << told;
  EXPECT_NE(told.find("'frob' has no place here"), std::string::npos) << told;
}

TEST_F(ScenarioSuite, APlcThatWasWaitedForHoldsNobodyUpWhenItsPowerGoesOff) {
  for (const char* wait : {"{wait: 1 scan, on: a}", "{wait_until: {VW0: 0}, on: a}"})
    EXPECT_EQ(found_in(scenario_of_two("paused", fmt::format("on: b\nsteps:\n  - {}\n  - {{power_off: a}}\n"
                                                             "  - {{read: holding 0, station: 2, expect: [0]}}\n"
                                                             "  - {{read: holding 0, station: 2, expect: [0]}}\n",
                                                             wait))),
              "")
        << wait;
}

TEST_F(ScenarioSuite, ScansOfAPlcWithoutPowerAreNotWaitedFor) {
  Suite suite = collected({.files = {scenario_of_two("dark", "on: a\nsteps:\n  - {power_off: a}\n  - wait: 2 scans\n")}});
  Messages messages;
  const auto result = suite.run({}, messages);
  ASSERT_TRUE(result);
  const ScenarioResult& dark = result->reports.at(0).result;
  ASSERT_EQ(dark.findings.size(), 1U);
  EXPECT_EQ(dark.findings[0].found, "the PLC has no power: nothing was waited for");
  EXPECT_LT(dark.time, kSecond);
}

TEST_F(ScenarioSuite, AProgramThatIsMissingOrBrokenFailsItsScenarioAndTheOthersRun) {
  const std::string broken = file("broken.stl", "FROB\nFROB\nFROB\nFROB\nMEND\n");
  Suite suite =
      collected({.files = {scenario("good"), scenario("missing", "0", "no_such.stl"), scenario("broken", "0", broken),
                           scenario("last", "1"), file("unnamed.yaml", "steps:\n  - {read: holding 0}\n")}});
  Messages messages;
  const auto result = suite.run({}, messages);
  ASSERT_TRUE(result);
  EXPECT_EQ(text_of(messages), "");
  ASSERT_EQ(result->reports.size(), 5U);
  EXPECT_EQ(result->reports[0].result.outcome, Outcome::Passed);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_TRUE(counts_as_failed(result->reports[i])) << i;
  const auto found = [&](std::size_t i) { return result->reports[i].result.findings.at(0).found; };
  EXPECT_EQ(found(1), fmt::format("cannot read {}: No such file or directory", (folder_ / "no_such.stl").string()));
  EXPECT_NE(found(2).find(broken + ":1:1: "), std::string::npos) << found(2);
  EXPECT_NE(found(2).find("'s7200 check " + broken + "' shows them"), std::string::npos) << found(2);
  EXPECT_EQ(found(3), "1 register: 16#0000");
  EXPECT_EQ(found(4), "it names no program, and there is no --target");
  const std::string text = report_text(result->reports[1], false);
  EXPECT_NE(text.find("missing.yaml:1:1: name: missing\n      program is not what was expected\n"), std::string::npos)
      << text;
  const std::string junit = to_junit(result->reports);
  EXPECT_NE(junit.find("message=\"line 1: program: expected a program that can be run, found cannot read "),
            std::string::npos)
      << junit;
  EXPECT_NE(junit.find("type=\"run\""), std::string::npos) << junit;
  EXPECT_EQ(to_json(result->reports)["failed"], 4);
}

TEST_F(ScenarioSuite, ATableOfTimesThatIsMissingIsAMistakeOfItsFile) {
  const std::string times =
      file("times.yaml", fmt::format("name: times\nprogram: {}\ntimes: no.csv\nsteps: [wait: 1ms]\n", kSlave));
  EXPECT_NE(refusal({.files = {scenario("good"), times}}).find("no.csv"), std::string::npos);
}

TEST_F(ScenarioSuite, ATargetThatCannotBeHadRunsNothing) {
  EXPECT_NE(refusal({.files = {scenario("a")}, .target = "no_such.stl"}).find("cannot read no_such.stl"), std::string::npos);
  const std::string description = file("slave.yaml", "program: no_such.stl\nfunctions: [3]\n");
  EXPECT_NE(refusal({.conformance = description}).find("cannot read "), std::string::npos);
  EXPECT_NE(refusal({.files = {file("a.yaml", "steps: [wait: 1ms]\n")}}).find("names no program"), std::string::npos);
}

TEST_F(ScenarioSuite, NoScanOfASystemIsPassedOverIfEveryOneIsWanted) {
  const std::string two = scenario_of_two("scans", "steps: [wait: 1ms]\n");
  const auto every_scan = [&](bool wanted) {
    const Suite suite = collected({.files = {two}, .every_scan = wanted});
    return std::ranges::all_of(suite.scenarios().at(0).plan->plcs,
                               [](const PlcPlan& plc) { return plc.program->looks.every_scan; });
  };
  EXPECT_TRUE(every_scan(true));
  EXPECT_FALSE(every_scan(false));
}

TEST_F(ScenarioSuite, ResultsComeInOrderHoweverManyAreRunAtATime) {
  std::vector<std::string> files;
  for (int i = 0; i < 6; ++i) files.push_back(scenario(fmt::format("s{}", i), i % 2 ? "1" : "0"));
  Suite one = collected({.files = files}), three = collected({.files = files, .jobs = 3});
  EXPECT_EQ(outcomes(one), outcomes(three));
}

TEST_F(ScenarioSuite, EndsAtTheFirstFailureIfAsked) {
  Suite suite = collected({.files = {scenario("a", "1"), scenario("b")}, .fail_fast = true});
  Messages messages;
  const auto result = suite.run({}, messages);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->reports.size(), 1U);
  EXPECT_EQ(result->not_run, 1U);
  EXPECT_FALSE(result->passed());
}

TEST_F(ScenarioSuite, SaysWhyNothingWasChecked) {
  const auto why = [&](const std::string& text) {
    Suite suite = collected({.files = {file("a.yaml", fmt::format("program: {}\n{}", kSlave, text))}});
    Messages messages;
    return suite.run({}, messages)->why_nothing_was_checked();
  };
  EXPECT_EQ(why("steps: [wait: 1ms]\n"), "no step that was done expects anything");
  EXPECT_EQ(why("skip_without: no/such/file\nsteps: [wait: 1ms]\n"), "every scenario was skipped");
  EXPECT_EQ(why("steps: [mode: run]\n"), "");
}

TEST_F(ScenarioSuite, ComparesTwoProgramsAndOneThatIsBrokenIsADifference) {
  const auto differs = [&](const std::string& program, const std::string& other) {
    SuiteSettings settings{.files = {scenario("a", "0", program)}};
    settings.exchanges_wanted = true;
    Suite suite = collected(settings);
    Messages messages;
    const auto result = suite.compare(other, kNever, false, false, {}, messages);
    EXPECT_TRUE(result) << text_of(messages);
    return result ? result->scenarios.at(0).difference.text : "";
  };
  EXPECT_EQ(differs(kSlave, kSlave), "");
  const std::string text = differs("no_such.stl", kSlave);
  EXPECT_NE(text.find("no_such.stl could not be asked"), std::string::npos) << text;
}

}  // namespace
}  // namespace s7200::tools::scenario_suite_test
