// Programs changed in one thing at a time, and which scenarios notice.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "tests/support/plc.hpp"
#include "tests/support/slave_bench.hpp"
#include "tools/mutants/mutants_report.hpp"
#include "tools/scenario/reading/reader.hpp"

namespace s7200::tools::mutants_test {
namespace {

/// The changes of a program that make another one: `1: LDN for LD`, by instruction.
std::vector<std::string> changes_of(std::string_view stl) {
  const auto program = test::program_of(stl);
  std::vector<std::string> changes;
  for (const Mutation& mutation : mutations_of(*program))
    if (mutated(*program, mutation).kind == Mutant::Kind::Program)
      changes.push_back(fmt::format("{}: {}", mutation.op, mutation.what));
  return changes;
}

bool has(const std::vector<std::string>& changes, const std::string& change) {
  return std::ranges::find(changes, change) != changes.end();
}

TEST(Mutants, ContactsEdgesCoilsAndOperandsAreChanged) {
  const auto changes = changes_of("LD I0.0\nA I0.1\nEU\n= Q0.0\nLDW>= VW0, 5\nMOVW VW0, VW10\n-I VW0, VW10\nMEND\n");
  for (const char* const each :
       {"0: LDN for LD", "0: I0.1 for I0.0", "1: AN for A", "1: I0.2 for I0.1", "1: deleted", "2: ED for EU", "2: deleted",
        "3: deleted", "3: Q0.1 for Q0.0", "4: operands swapped", "4: 4 for 5", "4: 6 for 5", "4: VW1 for VW0",
        "5: VW9 for VW10", "6: operands swapped", "6: deleted"})
    EXPECT_TRUE(has(changes, each)) << each;
  EXPECT_FALSE(has(changes, "0: deleted")) << "without LD the stack is empty";
  EXPECT_FALSE(has(changes, "5: operands swapped"));
}

TEST(Mutants, JumpsAreInvertedAndTimersGetAnotherBase) {
  const auto changes = changes_of("LD I0.0\nJMP 1\nLD I0.1\nTON T33, 10\nLBL 1\nLD T33\n= Q0.0\nMEND\n");
  EXPECT_TRUE(has(changes, "1: sense inverted"));
  EXPECT_TRUE(std::ranges::any_of(changes, [](const std::string& each) {
    return each.ends_with("for T33, which has another time base") && each.starts_with("3: ");
  }));
}

TEST(Mutants, WhatMakesNoOtherProgramIsLeftOut) {
  EXPECT_FALSE(has(changes_of("LDW= VW0, 5\n= Q0.0\nMEND\n"), "0: operands swapped")) << "equal is equal both ways";
  EXPECT_FALSE(has(changes_of("LDB>= VB0, VB0\n= Q0.0\nMEND\n"), "0: operands swapped")) << "the same operations";
  const auto changes = changes_of("MEND\nSBR 5\nLD I0.0\n= Q0.0\nRET\n");
  EXPECT_TRUE(changes.empty()) << "nothing leads there";
}

TEST(Mutants, AnInvertedJumpTakesTheOtherWay) {
  const auto program = test::program_of("LD I0.0\nJMP 1\nLD SM0.0\nMOVB 7, VB0\nLBL 1\nMEND\n");
  const auto mutations = mutations_of(*program);
  const auto inverted = std::ranges::find(mutations, "sense inverted", &Mutation::what);
  ASSERT_NE(inverted, mutations.end());
  test::Plc plc(mutated(*program, *inverted).program);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 0);
  plc.input("I0.0", true);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VB0"), 7);
}

MutantsOfProgram hunt(const std::string& program, const std::string& yaml) {
  const ScenarioFile file = read_scenarios(yaml, "file.yaml");
  EXPECT_FALSE(file.scenarios.empty());
  Benches benches;
  for (std::size_t i = 0; i < file.scenarios.size(); ++i) benches.of.push_back({.program = test::compile(program)});
  MutantsResult result = hunt_mutants(file.scenarios, benches, {});
  EXPECT_EQ(result.programs.size(), 1U);
  EXPECT_EQ(result.failing, 0U);
  return result.programs.empty() ? MutantsOfProgram{} : std::move(result.programs.front());
}

TEST(Mutants, WhatNoScenarioNoticesIsListedWithItsLine) {
  const MutantsOfProgram mutants =
      hunt("LD I0.0\nA I0.1\n= Q0.0\nLD I0.7\nCALL 0\nMEND\nSBR 0\nLD SM0.0\nINCW VW0\nRET\n",
           "after: 0s\nsteps:\n  - set: {I0.0: 1, I0.1: 1}\n  - wait: 2 scans\n  - memory: {Q0.0: 1, Q0.1: 0, VW0: 0}\n");
  const std::string text = mutants_text(mutants);
  EXPECT_NE(text.find("LD I0.7"), std::string::npos) << text;
  EXPECT_EQ(text.find("LD I0.7\n        LDN for LD"), std::string::npos) << "then VW0 counts\n" << text;
  EXPECT_NE(text.find("A I0.1"), std::string::npos) << "without it Q0.0 is the same\n" << text;
  EXPECT_NE(text.find("no scenario comes to it"), std::string::npos) << text;
  EXPECT_EQ(mutants.noticed + mutants.survivors.size(), mutants.mutants);
  EXPECT_TRUE(std::ranges::is_sorted(mutants.survivors, {}, [](const Survivor& each) { return each.mutation.op; }));
}

TEST(Mutants, AProgramThatLoopsForEverIsNoticed) {
  const MutantsOfProgram mutants = hunt("LD SM0.0\nMOVW 3, VW0\nLBL 1\nLD SM0.0\nWDR\nDECW VW0\nLDN SM1.0\nJMP 1\nMEND\n",
                                        "after: 0s\nsteps:\n  - wait: 3 scans\n  - memory: {VW0: 0}\n");
  for (const Survivor& each : mutants.survivors) EXPECT_NE(each.mutation.what, "LD for LDN");
  EXPECT_GT(mutants.noticed, 3U);
}

TEST(Mutants, AnInterruptionBeforeTheFirstChangeSaysSoAndWhatWasLeftOut) {
  const Scenario waits = read_scenarios("after: 0s\nsteps:\n  - wait: 3 scans\n", "file.yaml").scenarios.front();
  Benches benches;
  for (const char* const program : {"LD I0.0\n= Q0.0\nMEND\n", "LD I0.1\n= Q0.1\nMEND\n"})
    benches.of.push_back({.program = test::compile(program)});
  const std::atomic<bool> stop = true;
  const MutantsResult result = hunt_mutants({waits, waits}, benches, {.stop = StopToken(stop)});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.left_out, 0U) << "they can be run";
  ASSERT_EQ(result.programs.size(), 2U);
  for (const MutantsOfProgram& each : result.programs) {
    EXPECT_GT(each.not_tried, 3U);
    const std::string text = mutants_text(each);
    EXPECT_NE(text.find("interrupted before the first change was tried"), std::string::npos) << text;
    EXPECT_EQ(text.find('%'), std::string::npos) << text;
  }
  EXPECT_EQ(result.not_tried, result.programs[0].not_tried + result.programs[1].not_tried);
}

}  // namespace
}  // namespace s7200::tools::mutants_test
