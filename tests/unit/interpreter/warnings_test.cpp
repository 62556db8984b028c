// Warnings: each appears where it should, and not in a program that is right.
#include "interpreter/program/checking/warnings.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <set>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/analysis/warnings/lint.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/program/load.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::warnings_test {
namespace {

std::string shown(const CheckResult& result) {
  std::string text;
  for (const stl::Diagnostic& d : result.diagnostics)
    text += std::to_string(d.position.line) + (d.severity == stl::Severity::Error ? " error: " + d.message : " " + d.name) +
            "\n";
  return text;
}

/// `LINE name`, each on a line of its own.
std::string warnings_of(std::string_view stl, const CpuModel& model = cpu214()) {
  return shown(check_text(stl, "test", model, default_times(model)));
}

TEST(Warnings, AreListedInTheOrderOfTheirNamesAndEachNameOnce) {
  std::set<std::string_view> names;
  std::set<Warning> warnings;
  for (const WarningInfo& info : all_warnings()) {
    EXPECT_TRUE(names.empty() || *names.rbegin() < info.name) << info.name;
    EXPECT_TRUE(names.insert(info.name).second && warnings.insert(info.warning).second) << info.name;
    EXPECT_FALSE(info.meaning.empty()) << info.name;
    EXPECT_EQ(warn(info.warning, {}, "x").name, info.name);
  }
}

TEST(Warnings, ProgramsThatWorkWellHaveNone) {
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("stl_programs"))) {
    if (entry.path().extension() != ".stl") continue;
    const auto bytes = tools::read_file(entry.path().string());
    ASSERT_TRUE(bytes) << bytes.why();
    EXPECT_EQ(warnings_of(*bytes, *find_cpu(test::cpu_named_in(*bytes))), "") << entry.path();
  }
}

TEST(Warnings, ApplicationTip41HasNone) {
  const std::string path = test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto bytes = tools::read_file(path);
  ASSERT_TRUE(bytes) << bytes.why();
  auto text = read_source(*bytes, path);
  ASSERT_TRUE(text) << text.why();
  EXPECT_EQ(shown(check(std::move(text->parsed), cpu214(), default_times(cpu214()))), "");
}

// --- double-coil ---

TEST(DoubleCoil, IsAnOutputThatASecondCoilAlwaysOverwrites) {
  EXPECT_EQ(warnings_of("LD I0.0\n= Q0.0\nLD I0.1\n= Q0.0\nMEND\n"), "4 double-coil\n");
  EXPECT_EQ(warnings_of("LD I0.0\n= Q0.0\nLD Q0.0\n= Q0.1\nLD I0.1\n= Q0.0\nLD I0.2\n= Q0.0\nMEND\n"),
            "6 double-coil\n8 double-coil\n");
}

TEST(DoubleCoil, IsMemoryThatNothingReadsInBetween) {
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nLD I0.1\n= M0.0\nMEND\n"), "4 double-coil\n");
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nLD M0.0\n= Q0.0\nLD I0.1\n= M0.0\nLD M0.0\n= Q0.1\nMEND\n"), "") << "used twice";
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nMOVB MB0, QB1\nLD I0.1\n= M0.0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nMOVB *VD0, QB1\nLD I0.1\n= M0.0\nMEND\n"), "") << "a pointer may lead there";
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nMOVD &VB9, AC1\nMOVB *AC1, QB1\nLD I0.1\n= M0.0\nMEND\n"), "6 double-coil\n")
      << "this one leads to VB9";
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nCALL 0\nLD I0.1\n= M0.0\nMEND\nSBR 0\nLD M0.0\n= Q0.0\nRET\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nATCH 0, 10\nENI\nLD I0.1\n= M0.0\nMEND\nINT 0\nLD M0.0\n= Q0.0\nRETI\n"), "");
}

TEST(DoubleCoil, IsNotACoilOnEachOfTwoWaysThroughTheProgram) {
  EXPECT_EQ(warnings_of("LD I0.0\nJMP 1\nLD I0.1\n= Q0.0\nLD SM0.0\nJMP 2\nLBL 1\nLD I0.2\n= Q0.0\nLBL 2\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.1\n= Q0.0\nLD I0.0\nJMP 1\nLD I0.2\n= Q0.0\nLBL 1\nMEND\n"), "") << "a value by default";
  EXPECT_EQ(warnings_of("LSCR S0.0\nLD I0.0\n= Q0.0\nLD I0.1\nCSCRE\nLD I0.2\n= Q0.0\nSCRE\nMEND\n", *find_cpu("224")), "")
      << "the segment may be left in between";
  EXPECT_EQ(warnings_of("LD I0.1\n= Q0.0\nLD I0.0\nEND\nLD I0.2\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.1\n= Q0.0\nLD I0.0\nFOR VW0, 1, VW2\nLD I0.2\n= Q0.0\nNEXT\nMEND\n"), "");
}

TEST(DoubleCoil, IsOneOfAnInterruptThatTheScanOverwrites) {
  const std::string interrupt = "MEND\nINT 0\nLD I0.1\n= Q0.0\nRETI\n", attached = "LD SM0.1\nATCH 0, 10\nENI\n";
  EXPECT_EQ(warnings_of(attached + "LD I0.0\n= Q0.0\n" + interrupt), "9 double-coil\n");
  EXPECT_EQ(warnings_of(attached + "LD I0.0\nJMP 1\nLD I0.2\n= Q0.0\nLBL 1\n" + interrupt), "") << "at times";
  EXPECT_EQ(warnings_of(attached + "LD I0.0\n= Q0.1\n" + interrupt), "");
}

TEST(DoubleCoil, IsAlsoFoundInsideARoutine) {
  EXPECT_EQ(warnings_of("LD I0.7\nCALL 0\nMEND\nSBR 0\nLD I0.0\n= Q0.0\nLD I0.1\n= Q0.0\nRET\n"), "8 double-coil\n");
  EXPECT_EQ(warnings_of("LD I0.7\nCALL 0\nMEND\nSBR 0\nLD I0.0\n= Q0.0\nCRET\nLD I0.1\n= Q0.0\nRET\n"), "");
}

TEST(DoubleCoil, AcrossRoutinesIsOneOnlyIfEveryScanExecutesBoth) {
  const std::string routines = "MEND\nSBR 0\nLD I0.0\n= Q0.0\nRET\nSBR 1\nLD I0.1\n= Q0.0\nRET\n";
  EXPECT_EQ(warnings_of("LD SM0.0\nCALL 0\nCALL 1\n" + routines), "11 double-coil\n");
  EXPECT_EQ(warnings_of("LD I0.7\nCALL 0\nNOT\nCALL 1\n" + routines), "") << "either of them";
  EXPECT_EQ(warnings_of("LD SM0.0\nCALL 0\nLD I0.7\nCALL 1\n" + routines), "") << "overridden at times";
  EXPECT_EQ(
      warnings_of("LD SM0.0\nCALL 0\nLD I0.7\n= Q0.0\nMEND\nSBR 0\nLD I0.0\nCALL 1\nRET\nSBR 1\nLD I0.1\n= Q0.0\nRET\n"),
      "");
  EXPECT_EQ(warnings_of("LD SM0.0\nCALL 0\nLD I0.7\n= Q0.0\nMEND\nSBR 0\nCALL 1\nRET\nSBR 1\nLD I0.1\n= Q0.0\nRET\n"),
            "11 double-coil\n");
}

/// The coils of a segment that is off write 0: the later segment decides, whichever one is on.
TEST(DoubleCoil, IsTheSameOutputInTwoSegments) {
  EXPECT_EQ(warnings_of("LSCR S0.0\nLD I0.0\n= Q0.0\nSCRT S0.1\nSCRE\nLSCR S0.1\nLD I0.1\n= Q0.0\nSCRT S0.0\nSCRE\nMEND\n"),
            "8 double-coil\n");
}

// --- overwritten ---

TEST(Overwritten, IsABitThatIsSetAndAlwaysWrittenAgainBeforeItIsUsed) {
  EXPECT_EQ(warnings_of("LD I0.0\nS Q0.0, 1\nLD I0.1\n= Q0.0\nMEND\n"), "2 overwritten\n");
  EXPECT_EQ(warnings_of("LD I0.0\nR M0.0, 1\nLD I0.1\n= M0.0\nLD M0.0\n= Q0.0\nMEND\n"), "2 overwritten\n");
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.3\nLD SM0.0\nMOVB 5, MB0\nMEND\n"), "2 overwritten\n") << "with the whole byte";
}

TEST(Overwritten, IsNotOneThatAnythingUsesOrThatIsWrittenAtTimesOnly) {
  EXPECT_EQ(warnings_of("LD I0.0\nS Q0.0, 1\nLD Q0.0\nA I0.1\n= Q0.0\nMEND\n"), "") << "it holds itself";
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.3\nLD I0.1\nMOVB 5, MB0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nS M0.0, 1\nLD I0.1\nR M0.0, 1\nMEND\n"), "") << "set and reset";
  EXPECT_EQ(warnings_of("LD I0.0\nS M0.0, 1\nCALL 0\nLD I0.1\n= M0.0\nMEND\nSBR 0\nLD M0.0\n= Q0.0\nRET\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nS M0.0, 1\nLD I0.2\nEND\nLD I0.1\n= M0.0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nS M0.0, 1\nLD I0.1\nJMP 1\nLD I0.1\n= M0.0\nLBL 1\nMEND\n"), "");
}

// --- unreachable, skipped-timer, repeated-edge, constant-contact ---

TEST(Unreachable, IsWhatStandsAfterASureJumpOrEndWithoutALabel) {
  EXPECT_EQ(warnings_of("LD SM0.0\nJMP 1\nLD I0.0\n= Q0.0\nLBL 1\nMEND\n"), "3 unreachable\n");
  EXPECT_EQ(warnings_of("LD SM0.0\nEND\nLD I0.0\n= Q0.0\nMEND\n"), "3 unreachable\n");
  EXPECT_EQ(warnings_of("LD I0.7\nCALL 0\nMEND\nSBR 0\nCRET\nLD I0.0\n= Q0.0\nRET\n"), "6 unreachable\n");
  EXPECT_EQ(warnings_of("LD I0.0\nJMP 1\nLD I0.0\n= Q0.0\nLBL 1\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD SM0.0\nJMP 1\nLBL 1\nMEND\n"), "") << "nothing is left out";
}

TEST(SkippedTimer, IsA100MillisecondTimerThatAJumpLeavesOut) {
  EXPECT_EQ(warnings_of("LD I0.0\nJMP 1\nLD I0.1\nTON T37, 10\nLBL 1\nMEND\n"), "4 skipped-timer\n");
  EXPECT_EQ(warnings_of("LD I0.0\nJMP 1\nLD I0.1\nTON T33, 10\nLBL 1\nMEND\n"), "")
      << "the CPU counts 10 ms timers by itself";
  EXPECT_EQ(warnings_of("LD I0.0\nJMP 1\nLD I0.1\n= Q0.0\nLBL 1\nLD I0.1\nTON T37, 10\nMEND\n"), "");
}

TEST(SkippedTimer, IsOneInASubroutineThatIsCalledUnderACondition) {
  const std::string timer = "MEND\nSBR 0\nLD I0.1\nTON T37, 10\nRET\n";
  EXPECT_EQ(warnings_of("LD I0.0\nCALL 0\n" + timer), "6 skipped-timer\n");
  EXPECT_EQ(warnings_of("LD SM0.0\nCALL 0\n" + timer), "");
  EXPECT_EQ(warnings_of("LD I0.0\nCALL 0\nLDN I0.0\nCALL 0\n" + timer), "") << "one of both calls it";
  EXPECT_EQ(warnings_of("LD I0.0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nTON T33, 10\nRET\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nCALL 0\nMEND\nSBR 0\nLD SM0.0\nCALL 1\nRET\nSBR 1\nLD I0.1\nTON T37, 10\nRET\n"), "")
      << "only the CALL of its own routine is looked at";
  EXPECT_EQ(warnings_of("LD I0.0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nTONR T5, 10\nRET\n"), "") << "it may count hours";
  EXPECT_EQ(warnings_of("LSCR S0.0\nLD SM0.0\nCALL 0\nSCRE\n" + timer), "") << "while the step is on";
}

TEST(SkippedTimer, IsOneInALoop) {
  EXPECT_EQ(warnings_of("LD SM0.0\nFOR VW0, 1, 3\nLD I0.1\nTON T37, 10\nNEXT\nMEND\n"), "4 skipped-timer\n");
  EXPECT_EQ(warnings_of("LD SM0.0\nFOR VW0, 1, 3\nINCW VW2\nNEXT\nLD I0.1\nTON T37, 10\nMEND\n"), "");
}

TEST(RepeatedEdge, IsAnEdgeThatAScanExecutesMoreThanOnce) {
  EXPECT_EQ(warnings_of("LD I0.0\nFOR VW0, 1, 3\nLD I0.1\nEU\nINCW VW2\nNEXT\nMEND\n"), "4 repeated-edge\n");
  EXPECT_EQ(warnings_of("LD SM0.0\nCALL 0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nED\nINCW VW2\nRET\n"), "7 repeated-edge\n");
  EXPECT_EQ(warnings_of("LD SM0.0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nED\nINCW VW2\nRET\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nFOR VW0, 1, 3\nINCW VW2\nNEXT\nLD I0.1\nEU\nINCW VW4\nMEND\n"), "");
}

TEST(ConstantContact, IsOneOfSm00ThatDoesNothingOrNeverCloses) {
  EXPECT_EQ(warnings_of("LD I0.0\nAN SM0.0\n= Q0.0\nLD I0.1\nO SM0.0\n= Q0.1\nMEND\n"),
            "2 constant-contact\n5 constant-contact\n");
  EXPECT_EQ(warnings_of("LD I0.0\nA SM0.0\n= Q0.0\nLDN SM0.0\n= Q0.1\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LDN SM0.0\nO I0.1\n= Q0.0\nLDN SM0.0\nA I0.1\n= Q0.1\nLD SM0.0\nO I0.1\n= Q0.2\nMEND\n"),
            "1 constant-contact\n4 constant-contact\n7 constant-contact\n");
  EXPECT_EQ(warnings_of("LD SM0.0\nA I0.1\n= Q0.0\nLDN SM0.0\nNOT\n= Q0.1\nMEND\n"), "");
}

TEST(ConstantContact, IsAComparisonThatNoNumberChanges) {
  const auto of_contact = [](const std::string& contact) { return warnings_of(contact + "\n= Q0.0\nMEND\n", cpu224()); };
  for (const char* contact :
       {"LDB>= VB0, 0", "LDB< VB0, 0", "LDB<= VB0, 255", "LDB> VB0, 255", "LDW> VW0, 32767", "LDW>= VW0, -32768",
        "LDW<= *VD4, 32767", "LDD> VD0, 2147483647", "LDW>= 5, 3", "LDW= 5, 3", "LDB<> 5, 5", "LDB>= 255, VB0"})
    EXPECT_EQ(of_contact(contact), "1 constant-contact\n") << contact;
  for (const char* contact : {"LDB> VB0, 0", "LDB= VB0, 0", "LDB<> VB0, 255", "LDB< VB0, 255", "LDW> VW0, 32766",
                              "LDW>= VW0, 0", "LDW> VW0, -32768", "LDW= VW0, 32767", "LDW>= VW0, VW0", "LDR>= VD0, 0.0"})
    EXPECT_EQ(of_contact(contact), "") << contact;
}

// --- never-true, unreached-preset, restarted-timer ---

std::string of_cpu224(std::string_view stl) { return warnings_of(stl, cpu224()); }

TEST(NeverTrue, IsARungThatNeedsWhatExcludesEachOther) {
  EXPECT_EQ(of_cpu224("LDW>= VW2, 950\nAW<= VW2, 90\n= Q0.0\nMEND\n"), "2 never-true\n");
  EXPECT_EQ(of_cpu224("LDB= VB2, 5\nAB= VB2, 6\n= Q0.0\nMEND\n"), "2 never-true\n");
  EXPECT_EQ(of_cpu224("LDR> VD4, 1.5\nAR< VD4, -1.5\n= Q0.0\nMEND\n"), "2 never-true\n");
  EXPECT_EQ(of_cpu224("LD I0.0\nA M0.0\nAN I0.0\n= Q0.0\nMEND\n"), "3 never-true\n");
  EXPECT_EQ(of_cpu224("LD I0.0\nLDW> VW2, 9\nO M0.1\nALD\nAN M0.1\nAW< VW2, 9\nS Q0.0, 1\nMEND\n"), "6 never-true\n");
  EXPECT_EQ(of_cpu224("LD SM0.0\nCALL 0\nMEND\nSBR 0\nLDN M0.0\nA I0.0\nA M0.0\nTON T37, 10\nRET\n"), "7 never-true\n");
  EXPECT_EQ(of_cpu224("LD I1.2\nAN I1.2\n= Q0.5\nMEND\n"), "2 never-true\n") << "nobody makes a 0 of an input";
}

TEST(NeverTrue, IsNoneWhereBothMayBe) {
  EXPECT_EQ(of_cpu224("LDW>= VW2, 90\nAW<= VW2, 90\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(of_cpu224("LDW>= VW2, 950\nOW<= VW2, 90\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(of_cpu224("LDW>= VW2, 950\nNOT\nAW<= VW2, 90\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(of_cpu224("LDW> VW2, 5\nAW< VW2, 7\nAW<> VW2, 8\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(of_cpu224("LD M0.0\nR M0.0, 1\nAN M0.0\n= Q0.0\nMEND\n"), "") << "it is written between";
  EXPECT_EQ(of_cpu224("LD M0.0\n= Q0.0\nLDN M0.0\n= Q0.1\nMEND\n"), "");
  EXPECT_EQ(of_cpu224("LD M0.0\nA I0.0\nLDN M0.0\nAN I0.0\nOLD\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(of_cpu224("LDI I0.0\nANI I0.0\n= Q0.0\nMEND\n"), "") << "the input may change between";
  EXPECT_EQ(of_cpu224("LD M0.0\nED\nAN M0.0\n= Q0.0\nMEND\n"), "") << "it was on in the scan before";
  EXPECT_EQ(of_cpu224("LDN SM0.0\n= Q0.0\nLD M0.0\nAN M0.0\n= M0.7\nMEND\n"), "") << "it makes a 0";
}

TEST(NeverTrue, RungsOfATextWithoutNetworksAreLookedAtOneByOne) {
  std::string text;
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("LD{} M{}.0\nA I0.{}\nS V{}.0, 1\n", i % 2 == 0 ? "" : "N", i / 2 % 32, i % 8, i);
  EXPECT_EQ(of_cpu224(text + "LD I0.0\nAN I0.0\nA I0.1\n= Q0.0\nMEND\n"), "6002 never-true\n") << "and that at once";
}

TEST(UnreachedPreset, IsNoneOfACounterThatIsSetToMore) {
  const std::string counter = "LD I0.2\nLD I0.3\nLDW= C7, 5\nCTUD C7, 10\nLD C7\n= Q0.2\n";
  EXPECT_NE(of_cpu224(counter + "MEND\n").find("unreached-preset"), std::string::npos);
  EXPECT_EQ(of_cpu224(counter + "LD SM0.1\nMOVW 25, C7\nMEND\n").find("unreached-preset"), std::string::npos);
}

TEST(UnreachedPreset, IsThatOfACounterThatAComparisonResetsBelowIt) {
  EXPECT_EQ(warnings_of("LD I0.0\nLDW>= C5, 20\nO I0.1\nCTU C5, 24\nLD C5\n= Q0.0\nMEND\n"), "4 unreached-preset\n");
  EXPECT_EQ(warnings_of("LD I0.0\nLDW= C5, 20\nCTU C5, 24\nLD C5\n= Q0.0\nMEND\n"), "3 unreached-preset\n");
  EXPECT_EQ(warnings_of("LD I0.0\nLDW>= C5, 24\nCTU C5, 24\nLD C5\n= Q0.0\nMEND\n"), "") << "for one scan it is on";
  EXPECT_EQ(warnings_of("LD I0.0\nLDW>= C5, 20\nA I0.1\nCTU C5, 24\nLD C5\n= Q0.0\nMEND\n"), "") << "a condition more";
  EXPECT_EQ(warnings_of("LD I0.0\nLDW>= C5, 20\nCTU C5, 32000\nLDW>= C5, 10\n= Q0.0\nMEND\n"), "")
      << "nothing looks at its bit";
  EXPECT_EQ(warnings_of("LD I0.0\nLDW>= C6, 20\nCTU C5, 24\nLD C5\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nLDW>= C5, 20\nCTU C5, VW0\nLD C5\n= Q0.0\nMEND\n"), "");
}

TEST(RestartedTimer, IsAnAtchOfATimedInterruptThatEveryScanExecutes) {
  constexpr std::string_view kRest = "MEND\nSBR 0\nLD SM0.0\nMOVB 50, SMB34\nATCH 0, 10\nRET\nINT 0\nINCW VW0\nRETI\n";
  const auto with = [&](std::string_view main) { return warnings_of(fmt::format("LD SM0.1\nENI\n{}{}", main, kRest)); };
  EXPECT_EQ(with("LD SM0.0\nCALL 0\n"), "9 restarted-timer\n");
  EXPECT_EQ(with("LD SM0.1\nCALL 0\n"), "");
  EXPECT_EQ(with("LD I0.0\nCALL 0\n"), "") << "when it goes off, the period runs";
  EXPECT_EQ(with("LD I0.0\nEU\nCALL 0\n"), "");
}

// --- long-interrupt ---

TEST(LongInterrupt, IsATimedOneThatTakesLongerThanItsPeriod) {
  const auto of = [](std::string_view period, std::string_view passes) {
    return warnings_of(fmt::format("LD SM0.1\nMOVB {}, SMB34\nATCH 0, 10\nENI\nMEND\n"
                                   "INT 0\nLD SM0.0\nFOR VW910, 1, {}\nLD SM0.0\n*R 1.0, VD912\nNEXT\nRETI\n",
                                   period, passes),
                       *find_cpu("224"));
  };
  EXPECT_EQ(of("5", "500"), "3 long-interrupt\n");
  EXPECT_EQ(of("5", "5"), "");
  EXPECT_EQ(of("255", "500"), "");
  EXPECT_EQ(of("VB0", "500"), "") << "nobody knows the period";
}

TEST(LongInterrupt, IsNotLookedForAnyMoreIfSomebodyStopsIt) {
  const auto decoded = decode_program(read_text("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\n"
                                                "INT 0\nLD SM0.0\nFOR VW910, 1, 500\nLD SM0.0\n*R 1.0, VD912\nNEXT\nRETI\n",
                                                "test"),
                                      *find_cpu("224"), default_times(*find_cpu("224")));
  const Facts facts = facts_of(*decoded.known);
  const auto found = [&facts](bool stops) {
    std::atomic<bool> stop = false;
    stl::Diagnostics diagnostics;
    find_long_interrupts(facts, diagnostics, {.stop = StopToken(stop), .goes_on = [&] { stop = stops; }});
    return diagnostics;
  };
  ASSERT_EQ(found(false).size(), 1u);
  EXPECT_NE(found(false)[0].message.find("ms: then the main program gets no time"), std::string::npos) << "on that way";
  EXPECT_TRUE(found(true).empty());
}

// --- double-timer, double-counter ---

TEST(DoubleTimer, IsATimerThatEveryScanExecutesTwice) {
  EXPECT_EQ(warnings_of("LD I0.0\nTON T37, 10\nLD I0.1\nTON T37, 20\nMEND\n"), "4 double-timer\n");
  EXPECT_EQ(warnings_of("LD I0.0\nTON T37, 10\nLD I0.1\nTON T38, 20\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nTONR T5, 10\nLD SM0.0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nTONR T5, 20\nRET\n"),
            "8 double-timer\n");
  EXPECT_EQ(
      warnings_of("LD I0.7\nCALL 0\nNOT\nCALL 1\nMEND\nSBR 0\nLD I0.0\nTON T37, 1\nRET\nSBR 1\nLD I0.0\nTON T37, 1\nRET\n"),
      "");
}

TEST(DoubleCounter, IsACounterThatEveryScanExecutesTwice) {
  EXPECT_EQ(warnings_of("LD I0.0\nLD I0.1\nCTU C1, 10\nLD I0.2\nLD I0.3\nCTU C1, 10\nMEND\n"), "6 double-counter\n");
  EXPECT_EQ(warnings_of("LD I0.0\nLD I0.1\nCTU C1, 10\nLD I0.2\nLD I0.3\nCTU C2, 10\nMEND\n"), "");
}

// --- no-eni, no-freeport ---

TEST(NoEni, IsAnAttachmentInAProgramThatNeverEnablesInterrupts) {
  EXPECT_EQ(warnings_of("LD SM0.1\nATCH 0, 10\nMEND\nINT 0\nRETI\n"), "2 no-eni\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nATCH 0, 10\nCALL 0\nMEND\nSBR 0\nENI\nRET\nINT 0\nRETI\n"), "");
}

TEST(NoFreeport, IsXmtOrAPortEventInAProgramThatNeverWritesSmb30) {
  const std::string interrupt = "ENI\nMEND\nINT 0\nRETI\n";
  EXPECT_EQ(warnings_of("LD SM0.1\nXMT VB0, 0\nMEND\n"), "2 no-freeport\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nATCH 0, 8\nATCH 0, 10\n" + interrupt), "2 no-freeport\n");
  for (const std::string write : {"MOVB 16#09, SMB30", "MOVB VB0, SMB30", "MOVW VW0, SMW30", "S SM30.0, 1",
                                  "BMB VB0, SMB30, 1", "MOVW 16#0900, SMW30"})
    EXPECT_EQ(warnings_of("LD SM0.1\n" + write + "\nXMT VB0, 0\nATCH 0, 9\n" + interrupt), "") << write;
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 16#09, SMB31\nXMT VB0, 0\nMEND\n"), "3 no-freeport\n");
}

TEST(NoFreeport, IsXmtThatTheFirstScanExecutesBeforeSmb30IsWritten) {
  const std::string write = "MOVB 16#09, SMB30\n";
  EXPECT_EQ(warnings_of("LD SM0.1\nXMT VB0, 0\n" + write + "MEND\n"), "2 no-freeport\n");
  EXPECT_EQ(warnings_of("LD SM0.0\n= Q0.0\nXMT VB0, 0\nLD SM0.1\n" + write + "MEND\n"), "3 no-freeport\n");
  EXPECT_EQ(warnings_of("LD SM0.1\n" + write + "XMT VB0, 0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nXMT VB0, 0\nLD SM0.1\n" + write + "MEND\n"), "") << "not surely in the first scan";
  EXPECT_EQ(warnings_of("LD SM0.1\nA I0.0\nXMT VB0, 0\nLD SM0.1\n" + write + "MEND\n"), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nCALL 0\nXMT VB0, 0\nMEND\nSBR 0\n" + write + "RET\n"), "") << "a call is between";
}

// --- unused-freeport ---

TEST(UnusedFreeport, IsAPortInFreeportModeThatNothingHearsOrSpeaksAt) {
  const std::string interrupt = "ENI\nMEND\nINT 0\nRETI\n";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 16#09, SMB30\nMEND\n"), "2 unused-freeport\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 10\n" + interrupt), "2 unused-freeport\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB30\nMOVB 9, SMB130\nXMT VB0, 1\nMEND\n", cpu226()), "2 unused-freeport\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB130\nMOVB 9, SMB30\nXMT VB0, 0\nMEND\n", cpu226()), "2 unused-freeport\n");
}

TEST(UnusedFreeport, IsNotAPortThatIsUsedOrMayBeInAnotherMode) {
  const std::string interrupt = "ENI\nMEND\nINT 0\nRETI\n";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\n" + interrupt), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 16#09, SMB30\nXMT VB0, 0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\nMOVB 16#09, SMB30\nRCV VB100, 0\nMEND\n", cpu224()), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 8, SMB30\nMEND\n"), "") << "it leaves the port in PPI mode";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB VB0, SMB30\nMEND\n"), "") << "who knows what is in VB0";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB130\nATCH 0, 25\n" + interrupt, cpu226()), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\nINT 0\nMOVB 9, SMB30\nRETI\n"), "")
      << "an interrupt routine cannot";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB30\nXMT VB0, 1\nMEND\n", cpu226()), "3 no-freeport\n") << "it says enough";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB30\nMOVB SMB2, VB0\nMEND\n"), "3 no-receive-event\n") << "it says enough";
  EXPECT_EQ(warnings_of("LDS 99\nMOVB 16#09, SMB30\nMEND\n").find("unused-freeport"), std::string::npos)
      << "what could not be read may use the port";
}

// --- unused-step ---

TEST(UnusedStep, IsAnSBitThatIsSetButThatNothingLoads) {
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 1\nMEND\n"), "2 unused-step\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 1\nLSCR S0.0\nLD I0.0\nSCRT S0.1\nSCRE\nMEND\n"), "5 unused-step\n");
  EXPECT_EQ(warnings_of("LD I0.0\n= S0.3\nMEND\n"), "2 unused-step\n");
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 2\nLSCR S0.0\nSCRE\nMEND\n"), "2 unused-step\n") << "S0.1 has no segment";
}

TEST(UnusedStep, IsNotABitThatASegmentAContactAByteOrAPointerMayLoad) {
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 1\nLSCR S0.0\nSCRE\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 1\nLD S0.0\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 1\nMOVB SB0, QB0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nS S0.0, 1\nMOVD &SB0, AC1\nMOVB *AC1, QB0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nR S0.0, 128\nMEND\n"), "") << "resetting all of them is usual";
}

// --- empty routines ---

TEST(UnusedRoutine, IsNotOneWithoutAnInstruction) {
  const std::string main = "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD I0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n";
  const auto project = [&](std::string_view instruction) {
    return main + fmt::format(
                      "SUBROUTINE_BLOCK SBR_0:SBR0\nBEGIN\nNetwork 1 // Network Title\n{0}END_SUBROUTINE_BLOCK\n"
                      "INTERRUPT_BLOCK INT_0:INT0\nBEGIN\nNetwork 1\n// Network Comment\n{0}END_INTERRUPT_BLOCK\n",
                      instruction);
  };
  EXPECT_EQ(warnings_of(project(""), cpu224()), "") << "as in every new project";
  EXPECT_EQ(warnings_of(project("NOP 0\n"), cpu224()), "7 unused-routine\n12 unused-routine\n");
  EXPECT_EQ(warnings_of("LD I0.0\n= Q0.0\nMEND\nSBR 3\nRET\nINT 2\nRETI\n"), "") << "whatever its number";
}

// --- special memory ---

std::string told(std::string_view statements, const CpuModel& model = cpu224()) {
  const std::string text = fmt::format("LD SM0.0\n{}\nMEND\n", statements);
  std::string all;
  for (const stl::Diagnostic& d : check_text(text, "test", model, default_times(model)).diagnostics)
    all += d.message + (d.hint.empty() ? "" : " | " + d.hint) + "\n";
  return all;
}

TEST(UnusedSpecialMemory, IsAWordOverAByteThatIsUsedAndOthersThatAreNot) {
  EXPECT_EQ(told("MOVW 100, SMW94"), "SMB94 is a byte: this writes 0 into it | write MOVB 100, SMB94\n");
  EXPECT_EQ(told("MOVW 16#6400, SMW194", cpu226()),
            "SMB194 is a byte: this writes 100 into it | write SMB194 with a byte instruction such as MOVB\n");
  EXPECT_EQ(
      told("MOVW VW0, SMW94"),
      "SMB94 is a byte: this writes the high byte of what it writes into it | write SMB94 with a byte instruction such "
      "as MOVB\n");
  EXPECT_EQ(told("MOVD 5, SMD94"), "SMB94 is a byte: this writes 0 into it | write MOVB 5, SMB94\n");
  EXPECT_EQ(
      told("MOVD 16#01020304, SMD92"),
      "SMB92 to SMB94 are all that is used here: this writes 1, 2, 3 into them | write each with an instruction of its "
      "own width\n");
  EXPECT_EQ(told("MOVW 16#E041, SMW87"), "") << "two bytes that are used";
  EXPECT_EQ(told("MOVB 100, SMB94"), "");
}

TEST(UnusedSpecialMemory, IsReservedOrOfWhatTheCpuDoesNotHave) {
  const std::string memory = " | it is memory like V and M, as far as the manual says; check the address\n";
  EXPECT_EQ(told("MOVB 1, SMB96"), "CPU 224 makes no use of SMB95 to SMB97 (reserved)" + memory);
  EXPECT_EQ(told("MOVB SMB186, VB0"), "CPU 224 makes no use of SMB186 to SMB194 (receive message, port 1)" + memory);
  EXPECT_EQ(told("MOVB SMB186, VB0", cpu226()), "");
  EXPECT_EQ(told("MOVB SMB136, VB0", cpu215()),
            "CPU 215 makes no use of SMB136 to SMB165 (high-speed counters HSC3 to HSC5)" + memory);
  EXPECT_EQ(told("MOVB SMB29, VB0", cpu221()), "CPU 221 makes no use of SMB29 (analog potentiometer 1)" + memory);
  EXPECT_EQ(told("S SM100.0, 3"), "CPU 224 makes no use of SMB100 to SMB129 (reserved)" + memory);
  EXPECT_EQ(told("BMB VB0, SMB90, 6"), "CPU 224 makes no use of SMB95 to SMB97 (reserved)" + memory);
  EXPECT_EQ(told("MOVD 1, SMD172", cpu224r1()),
            "CPU 224r1 makes no use of SMB170 to SMB175 (pulse output 0: linear profile)" + memory);
}

TEST(UnusedSpecialMemory, IsThatOfModulesWhichAreNotSimulated) {
  EXPECT_EQ(told("MOVB SMB200, VB0"),
            "no intelligent module is simulated: the CPU leaves SMB200 to SMB549 (intelligent modules) as they are\n");
  EXPECT_EQ(
      told("MOVB SMB8, VB0", cpu214()),
      "no expansion module is simulated: the CPU leaves SMB8 to SMB21 (identity and errors of expansion modules) as they "
      "are\n");
  EXPECT_EQ(told("MOVW SMW98, VW0"), "");
}

// --- presets ---

TEST(Preset, IsAConstantOf0OrBelow) {
  EXPECT_EQ(warnings_of("LD I0.0\nTON T37, 0\nMEND\n"), "2 preset\n");
  EXPECT_EQ(
      warnings_of("LD I0.0\nTOF T38, -5\nLD I0.0\nLD I0.1\nCTU C1, 0\nLD I0.0\nLD I0.1\nCTD C2, 16#FFFF\nMEND\n", cpu224()),
      "2 preset\n5 preset\n8 preset\n");
  EXPECT_EQ(warnings_of("LD I0.0\nTON T37, 1\nLD I0.0\nTON T38, VW0\nLD I0.0\nLD I0.1\nLD I0.2\nCTUD C1, -1\nMEND\n"), "");
}

// --- ports ---

TEST(NoReceiveEvent, IsACharacterThatNothingPutsIntoSmb2) {
  const std::string freeport = "LD SM0.1\nMOVB 9, SMB30\n";
  EXPECT_EQ(warnings_of(freeport + "LDB= SMB2, 16#41\nS Q0.0, 1\nMEND\n"), "3 no-receive-event\n");
  EXPECT_EQ(warnings_of(freeport + "LD SM0.0\nMOVW SMW2, VW0\nA SM3.0\n= Q0.0\nMEND\n", cpu226()),
            "4 no-receive-event\n5 no-receive-event\n");
  EXPECT_EQ(warnings_of(freeport + "ATCH 0, 9\nENI\nMEND\nINT 0\nLD SM0.0\nMOVB SMB2, VB0\nRETI\n"), "8 no-receive-event\n");
}

TEST(NoReceiveEvent, IsNotOneWhereAnAtchMayAttachIt) {
  const std::string reads = "ENI\nMEND\nINT 0\nLD SM0.0\nMOVB SMB2, VB0\nRETI\n";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\n" + reads, cpu226()), "");
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB130\nATCH 0, 25\n" + reads, cpu226()), "");
  EXPECT_EQ(warnings_of("LD SM0.0\nMOVD SMD0, VD0\nBMB SMB0, VB4, 6\nMEND\n"), "") << "whoever copies all of it";
}

/// Freeport mode and the parameters of RCV.
constexpr std::string_view kReceives = "LD SM0.1\nMOVB 9, SMB30\nMOVB 16#E0, SMB87\nMOVB 13, SMB89\nMOVB 10, SMB94\n";

std::string receiving(std::string_view rest) { return fmt::format("{}{}", kReceives, rest); }

TEST(ReceiveOnce, IsAnRcvOfTheFirstScanThatNothingExecutesAgain) {
  EXPECT_EQ(warnings_of(receiving("RCV VB100, 0\nMEND\n"), cpu224()), "6 receive-once\n");
  EXPECT_EQ(warnings_of(receiving("CALL 0\nMEND\nSBR 0\nLD SM0.0\nRCV VB100, 0\nRET\n"), cpu224()), "10 receive-once\n");
  EXPECT_EQ(warnings_of(receiving("ATCH 0, 23\nENI\nRCV VB100, 0\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n"), cpu224()),
            "8 receive-once\n");
  EXPECT_EQ(warnings_of(receiving("ATCH 0, 9\nENI\nXMT VB0, 0\nMEND\nINT 0\nLD SM0.0\nRCV VB100, 0\nRETI\n"), cpu224()),
            "12 receive-once\n")
      << "the one XMT has one end";
  EXPECT_EQ(warnings_of("LDW>= VW0, 0\nA SM0.1\nLPS\nAN I0.0\nMOVB 9, SMB30\nLPP\nRCV VB100, 0\nMEND\n", cpu224()),
            "7 receive-once\n");
}

TEST(ReceiveOnce, IsNotAnRcvThatMayBeExecutedAgain) {
  for (const char* rest : {"RCV VB100, 0\nLDB<> SMB86, 0\nRCV VB100, 0\nMEND\n",
                           "ATCH 0, 23\nENI\nRCV VB100, 0\nMEND\nINT 0\nLD SM0.0\nRCV VB100, 0\nRETI\n",
                           "ATCH 0, 23\nATCH 1, 9\nENI\nRCV VB100, 0\nMEND\nINT 0\nLD SM0.0\nXMT VB200, 0\nRETI\n"
                           "INT 1\nLD SM0.0\nRCV VB100, 0\nRETI\n",
                           "LD SM0.1\nO M0.0\nRCV VB100, 0\nMEND\n", "LD I0.0\nEU\nRCV VB100, 0\nMEND\n",
                           "LD SM0.1\nNOT\nRCV VB100, 0\nMEND\n"})
    EXPECT_EQ(warnings_of(receiving(rest), cpu224()), "") << rest;
}

TEST(PortBusy, IsTheSecondOfXmtAndRcvInOnePass) {
  EXPECT_EQ(warnings_of(receiving("LD I0.0\nEU\nRCV VB100, 0\nXMT VB0, 0\nMEND\n"), cpu224()), "9 port-busy\n");
  EXPECT_EQ(warnings_of(receiving("LD I0.0\nEU\nXMT VB0, 0\nRCV VB100, 0\nMEND\n"), cpu224()), "9 port-busy\n");
  EXPECT_EQ(warnings_of(receiving("XMT VB0, 0\nLD SM0.0\nINCW VW0\nXMT VB50, 0\nMEND\n"), cpu224()), "9 port-busy\n")
      << "both in the first scan";
}

TEST(PortBusy, IsAnXmtWhileAnRcvAlwaysWaits) {
  const std::string rearmed = receiving(
      "ATCH 0, 23\nENI\nRCV VB100, 0\nLD I0.0\nEU\nXMT VB0, 0\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRCV VB100, 0\nRETI\n");
  EXPECT_EQ(warnings_of(rearmed, cpu224()), "11 port-busy\n");
}

TEST(PortBusy, IsAnXmtThatInputsAloneStartWhileAnRcvWaits) {
  EXPECT_EQ(warnings_of(receiving("RCV VB100, 0\nLD I0.0\nA I0.1\nEU\nINCW VW0\nXMT VB0, 0\nMEND\n"), cpu224()),
            "6 receive-once\n11 port-busy\n");
  EXPECT_EQ(warnings_of(receiving("RCV VB100, 0\nLD SM0.5\nEU\nXMT VB0, 0\nLDB<> SMB86, 0\nRCV VB100, 0\nMEND\n"), cpu224()),
            "9 port-busy\n");
}

TEST(PortBusy, OfAnXmtThatInputsStartSaysThatAMessageMayHaveCome) {
  const auto parsed =
      stl::parse(receiving("RCV VB100, 0\nLD I0.0\nEU\nXMT VB0, 0\nLD I0.1\nEU\nRCV VB100, 0\nMEND\n"), "p.stl");
  const CheckResult result = check(parsed, cpu224(), default_times(cpu224()));
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].message,
            "XMT is refused with error 0009 while no message has come: RCV of line 6 waits for one");
}

TEST(PortBusy, IsNotAnXmtThatMayFindThePortFree) {
  for (const char* rest :
       {"LD I0.0\nEU\nXMT VB0, 0\nLD I0.1\nRCV VB100, 0\nMEND\n",
        "LD I0.0\nMOVB 0, SMB87\nRCV VB100, 0\nXMT VB0, 0\nLDN I0.0\nMOVB 16#E0, SMB87\nRCV VB100, 0\nMEND\n",
        "LD I0.0\nXMT VB0, 0\nNOT\nRCV VB100, 0\nMEND\n",
        "RCV VB100, 0\nLD I0.0\nAB<> SMB86, 0\nXMT VB0, 0\nLDB<> SMB86, 0\nRCV VB100, 0\nMEND\n",
        "RCV VB100, 0\nLDN M0.0\nJMP 1\nLD I0.0\nXMT VB0, 0\nLBL 1\nLD SM0.1\nO I0.7\nRCV VB100, 0\nMEND\n",
        "RCV VB100, 0\nLDN SM0.7\nMOVB 0, SMB30\nLD I0.0\nXMT VB0, 0\nLD I0.7\nRCV VB100, 0\nMEND\n",
        "ATCH 0, 23\nENI\nRCV VB100, 0\nLD M0.0\nXMT VB0, 0\nMEND\nINT 0\nLD SM0.0\nS M0.0, 1\nRETI\n"
        "SBR 0\nLD I0.0\nRCV VB100, 0\nRET\n"})
    EXPECT_EQ(warnings_of(receiving(rest), cpu224()).find("port-busy"), std::string::npos) << rest;
}

// --- programs with errors ---

TEST(ProgramWithErrors, AnOperandErrorHidesNoErrorOfTheLogicStack) {
  EXPECT_EQ(warnings_of("NETWORK 1\nLD I99.0\n= Q0.0\nNETWORK 2\nA I0.1\n= Q0.1\nMEND\n"),
            "2 error: I99.0 does not exist on CPU 214\n5 error: A needs a value on the logic stack and finds none (compile "
            "rule 0081)\n");
}

TEST(ProgramWithErrors, AnUnknownMnemonicHidesThemOnlyInItsOwnNetwork) {
  EXPECT_EQ(warnings_of("NETWORK 1\nXYZZY I0.0\n= Q0.0\nNETWORK 2\nA I0.1\n= Q0.1\nMEND\n"),
            "2 error: unknown instruction 'XYZZY'\n5 error: A needs a value on the logic stack and finds none (compile rule "
            "0081)\n");
  EXPECT_EQ(warnings_of("NETWORK 1\nLD\nLD !\n= Q0.0\nNETWORK 2\nALD\n= Q0.1\nMEND\n").find("4 error"), std::string::npos);
}

TEST(ProgramWithErrors, AnOperandErrorHidesNoWarningOfOtherNetworks) {
  const std::string coils = "NETWORK 2\nLD I0.0\n= Q0.0\nNETWORK 3\nLD I0.1\n= Q0.0\n";
  const std::string error = "2 error: I99.0 does not exist on CPU 214\n";
  EXPECT_EQ(warnings_of("NETWORK 1\nLD I99.0\n= Q0.1\n" + coils + "MEND\n"), error + "9 double-coil\n");
  EXPECT_EQ(warnings_of("NETWORK 1\nLD I99.0\nINCW VW0\nNETWORK 2\nLD SM0.1\nATCH 0, 0\nMEND\nINT 0\nLD SM0.0\nINCW VW2\n"
                        "RETI\n"),
            error + "6 no-eni\n");
  EXPECT_EQ(
      warnings_of("NETWORK 1\nLD I0.0\nTON T37, 99999\n" + coils + "MEND\n").find("9 double-coil") != std::string::npos,
      true);
}

TEST(ProgramWithErrors, WhatCouldNotBeReadMayBeWhatAWarningMisses) {
  EXPECT_EQ(warnings_of("LD I0.0\nJMPP 3\nLBL 3\nMEND\n").find("unused-label"), std::string::npos) << "a JMP with a slip";
  EXPECT_EQ(warnings_of("LDS 99\nLD I0.0\nRCV VB0, 0\nMEND\n", cpu224()).find("receive-once"), std::string::npos);
  EXPECT_EQ(warnings_of("LD SM0.1\nATCH 0, 0\nENII\nMEND\nINT 0\nLD SM0.0\nINCW VW2\nRETI\n").find("no-eni"),
            std::string::npos)
      << "an ENI with a slip";
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nLD M99.0\n= Q0.0\nLD I0.1\n= M0.0\nMEND\n").find("double-coil"), std::string::npos)
      << "the contact may be that of M0.0";
  EXPECT_EQ(warnings_of("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 99\nENI\nLDB= SMB2, 1\n= Q0.0\nMEND\nINT 0\nNOP 0\nRETI\n")
                .find("no-receive-event"),
            std::string::npos)
      << "the event may be 8";
}

TEST(PpiStations, AreKeptByProgramsThatLeavePortsInPpiMode) {
  const auto keeps = [](std::string_view stl) {
    const CheckResult result = check_text(stl, "test", *find_cpu("226"), default_times(*find_cpu("226")));
    EXPECT_TRUE(result.program) << stl;
    return result.program && keeps_ppi_station(*result.program, 0);
  };
  EXPECT_TRUE(keeps("LD SM0.0\n= Q0.0\nMEND\n"));
  EXPECT_TRUE(keeps("LD SM0.1\nMOVB 2, SMB30\nMEND\n")) << "a master answers too";
  EXPECT_TRUE(keeps("LD SM0.1\nMOVB 9, SMB130\nSPA 7, 1\nMEND\n")) << "the other port";
  EXPECT_FALSE(keeps("LD SM0.1\nMOVB 9, SMB30\nMEND\n"));
  EXPECT_FALSE(keeps("LD SM0.1\nMOVB VB0, SMB30\nMEND\n"));
  EXPECT_FALSE(keeps("LD SM0.7\n= SM30.0\nMEND\n"));
  EXPECT_FALSE(keeps("LD SM0.1\nSPA 7, 0\nMEND\n"));
}

}  // namespace
}  // namespace s7200::warnings_test
