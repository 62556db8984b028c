// Warnings: each appears where it should, and not in a program that is right.
#include "interpreter/program/warnings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "interpreter/program/lint.hpp"
#include "interpreter/program/load.hpp"
#include "tests/support/source_path.hpp"

namespace s7200 {
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
    std::string why;
    const auto bytes = read_file(entry.path().string(), why);
    ASSERT_TRUE(bytes) << why;
    EXPECT_EQ(warnings_of(*bytes, *find_cpu(test::cpu_named_in(*bytes))), "") << entry.path();
  }
}

TEST(Warnings, ApplicationTip41HasNone) {
  const std::string path = test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  std::string why;
  const auto bytes = read_file(path, why);
  ASSERT_TRUE(bytes) << why;
  auto text = read_source(*bytes, path, why);
  ASSERT_TRUE(text) << why;
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
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nCALL 0\nLD I0.1\n= M0.0\nMEND\nSBR 0\nLD M0.0\n= Q0.0\nRET\n"), "");
  EXPECT_EQ(warnings_of("LD I0.0\n= M0.0\nATCH 0, 10\nENI\nLD I0.1\n= M0.0\nMEND\nINT 0\nLD M0.0\n= Q0.0\nRETI\n"), "");
}

TEST(DoubleCoil, IsNotACoilOnEachOfTwoWaysThroughTheProgram) {
  EXPECT_EQ(warnings_of("LD I0.0\nJMP 1\nLD I0.1\n= Q0.0\nLD SM0.0\nJMP 2\nLBL 1\nLD I0.2\n= Q0.0\nLBL 2\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.1\n= Q0.0\nLD I0.0\nJMP 1\nLD I0.2\n= Q0.0\nLBL 1\nMEND\n"), "") << "a value by default";
  EXPECT_EQ(warnings_of("LD I0.1\n= Q0.0\nLD I0.0\nEND\nLD I0.2\n= Q0.0\nMEND\n"), "");
  EXPECT_EQ(warnings_of("LD I0.1\n= Q0.0\nLD I0.0\nFOR VW0, 1, VW2\nLD I0.2\n= Q0.0\nNEXT\nMEND\n"), "");
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
}  // namespace s7200
