// Parameters of subroutines: what a CALL may pass, and what becomes of it. Times: plc.hpp.
#include "interpreter/program/operands/parameters.hpp"

#include "interpreter/trace/text/instruction_lines.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::parameters_test {
namespace {

/// A main program with one network, and a subroutine with declarations and one network.
std::string program(const std::string& main, const std::string& declarations, const std::string& subroutine) {
  return "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\n" + main + "END_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK Work:SBR0\n" +
         declarations + "BEGIN\nNETWORK 1\n" + subroutine + "END_SUBROUTINE_BLOCK\n";
}

std::vector<std::string> said(const std::string& text, const CpuModel& model = cpu224()) {
  const CheckResult result = check_text(text, "x", model, default_times(model));
  std::vector<std::string> all;
  for (const stl::Diagnostic& d : result.diagnostics) {
    const std::string line = render(d, result.source, false);
    if (d.severity == stl::Severity::Error) all.push_back(line.substr(0, line.find('\n')));
  }
  return all;
}

using Lines = std::vector<std::string>;

constexpr const char* kAllKinds =
    "VAR_INPUT\n on : BOOL;\n small : BYTE;\n place : DWORD;\nEND_VAR\nVAR_IN_OUT\n sum : INT;\nEND_VAR\n"
    "VAR_OUTPUT\n done : BOOL;\n level : REAL;\nEND_VAR\n";

TEST(Parameters, HaveNoValuesBesideTheCallInATrace) {
  const auto called = program_of(
      program("LD SM0.0\nCALL Work, &VB10, VW20\n", "VAR_INPUT\n a : DWORD;\n b : INT;\nEND_VAR\n", "LD SM0.0\n= M0.0\n"),
      cpu224());
  const InstructionRecord call{.at = 0, .end = 0, .op = 1, .powered = true, .top = true};
  EXPECT_EQ(describe(call, *called).find('='), describe(call, *called).rfind('='))
      << "S0 alone: " << describe(call, *called);
}

TEST(Parameters, AreInLocalMemoryAndTheOutputsComeBack) {
  Plc plc(
      program("LD SM0.1\nMOVW 100, VW0\nS M0.0, 1\nCALL Work, M0.0, 5, &VB10, VW0, M1.7, VD20\n", kAllKinds,
              "LD #on\nMOVW 0, AC0\nMOVB #small, AC0\n+I AC0, #sum\nMOVD #place, VD30\nMOVR 2.5, #level\nLD #on\n= #done\n"),
      cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 105);
  EXPECT_EQ(plc.value("M1.7"), 1);
  EXPECT_EQ(plc.value("VD20"), 0x40200000U);
  EXPECT_EQ(plc.value("VD30"), 0x0800000AU);
}

TEST(Parameters, EachCallHasItsOwn) {
  Plc plc(program("LD SM0.1\nCALL Work, 1, VW0\nCALL Work, 2, VW2\nCALL Work, VW2, VW4\n",
                  "VAR_INPUT\n x : INT;\nEND_VAR\nVAR_OUTPUT\n y : INT;\nEND_VAR\n", "LD SM0.0\nMOVW #x, #y\n+I 10, #y\n"),
          cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 11);
  EXPECT_EQ(plc.value("VW2"), 12);
  EXPECT_EQ(plc.value("VW4"), 22);
}

TEST(Parameters, LocalVariablesOfTheCallerArePassedOn) {
  Plc plc(
      "ORGANIZATION_BLOCK MAIN:OB1\nVAR\n t : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.1\nMOVW 3, #t\nCALL Outer, #t, #t\n"
      "MOVW #t, VW0\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Outer:SBR0\nVAR_INPUT\n a : INT;\nEND_VAR\nVAR_OUTPUT\n b : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD "
      "SM0.0\n"
      "CALL Inner, #a, #b\nINCW #b\nEND_SUBROUTINE_BLOCK\n"
      "SUBROUTINE_BLOCK Inner:SBR1\nVAR_INPUT\n a : INT;\nEND_VAR\nVAR_OUTPUT\n b : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD "
      "SM0.0\n"
      "MOVW #a, #b\n+I #b, #b\nEND_SUBROUTINE_BLOCK\n",
      cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 7);
}

TEST(Parameters, WithoutPowerFlowNothingIsPassedOrHandedBack) {
  Plc plc(program("LDN SM0.0\nCALL Work, 1, VW0\n", "VAR_INPUT\n x : INT;\nEND_VAR\nVAR_OUTPUT\n y : INT;\nEND_VAR\n",
                  "LD SM0.0\nMOVW 9, #y\n"),
          cpu224());
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VW0"), 0);
}

TEST(Parameters, TheOutputsOfAnEarlyReturnComeBackToo) {
  Plc plc(
      program("LD SM0.1\nCALL Work, VW0\n", "VAR_OUTPUT\n y : INT;\nEND_VAR\n", "LD SM0.0\nMOVW 4, #y\nCRET\nMOVW 5, #y\n"),
      cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 4);
}

TEST(Parameters, ABadPointerOfAnInputPreventsTheCall) {
  Plc plc(program("LD SM0.0\nMOVD 16#08FFFFFF, AC1\nCALL Work, *AC1, VW0\n",
                  "VAR_INPUT\n x : INT;\nEND_VAR\nVAR_OUTPUT\n y : INT;\nEND_VAR\n", "LD SM0.0\nMOVW 9, #y\n"),
          cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.records.errors(), std::vector<int>{6});
}

TEST(Parameters, APointerToAnOutputIsFollowedAtTheReturn) {
  Plc plc(program("LD SM0.0\nMOVD &VB100, AC1\nCALL Work, *AC1\n", "VAR_OUTPUT\n y : INT;\nEND_VAR\n",
                  "LD SM0.0\nMOVW 9, #y\nMOVD &VB200, AC1\n"),
          cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW100"), 0);
  EXPECT_EQ(plc.value("VW200"), 9);
}

TEST(Parameters, TakeNoTimeOfTheirOwn) {
  Plc with(program("LD SM0.0\nCALL Work, VW0\n", "VAR_OUTPUT\n y : INT;\nEND_VAR\n", "LD SM0.0\nMOVW 9, #y\n"), cpu224());
  Plc without(program("LD SM0.0\nCALL Work\n", "", "LD SM0.0\nMOVW 9, VW0\n"), cpu224());
  with.run_scans(3);
  without.run_scans(3);
  EXPECT_EQ(with.cpu.time(), without.cpu.time());
}

TEST(Parameters, MustBeAsManyAsDeclared) {
  EXPECT_EQ(said(program("LD SM0.0\nCALL Work, M0.0, 5\n", kAllKinds, "")),
            Lines{"x:5:1: error: CALL of Work takes 6 parameters, not 2 (MAIN, network 1)"});
  EXPECT_EQ(said(program("LD SM0.0\nCALL Work, 5\n", "", "")),
            Lines{"x:5:12: error: CALL of Work takes no parameters, not 1 (MAIN, network 1)"});
}

TEST(Parameters, MustHaveTheTypesOfTheirVariables) {
  const auto one = [](const std::string& actual, const std::string& declaration) {
    const Lines lines = said(program("LD SM0.0\nCALL Work, " + actual + "\n", declaration + "\nEND_VAR\n", ""));
    return lines.empty() ? "" : lines.size() > 1 ? "several" : lines[0].substr(lines[0].find("error: ") + 7);
  };
  EXPECT_EQ(one("VB0", "VAR_INPUT\n x : INT;"), "x of CALL is a word, VB0 is a byte (MAIN, network 1)");
  EXPECT_EQ(one("1.5", "VAR_INPUT\n x : INT;"), "x of CALL is an integer word, 1.5 is a real number (MAIN, network 1)");
  EXPECT_EQ(one("5", "VAR_INPUT\n x : REAL;"), "x of CALL is a real number, 5 is an integer (MAIN, network 1)");
  EXPECT_EQ(one("300", "VAR_INPUT\n x : BYTE;"), "300 does not fit in x of CALL, a byte (MAIN, network 1)");
  EXPECT_EQ(one("5", "VAR_OUTPUT\n x : INT;"), "x of CALL cannot be the constant 5 (MAIN, network 1)");
  EXPECT_EQ(one("&VB0", "VAR_INPUT\n x : INT;"), "x of CALL cannot be &VB0 (MAIN, network 1)");
  EXPECT_EQ(one("2", "VAR_INPUT\n x : BOOL;"), "x of CALL must be 0 to 1, not 2 (MAIN, network 1)");
  EXPECT_EQ(one("VW0", "VAR_INPUT\n x : STRING;"), "");
  for (const char* actual : {"TRUE", "off", "1", "I0.0", "T37", "SM0.0"})
    EXPECT_EQ(one(actual, "VAR_INPUT\n x : BOOL;"), "") << actual;
  for (const char* actual : {"VW0", "*VD0", "AC1", "T37", "-1", "AIW0"})
    EXPECT_EQ(one(actual, "VAR_INPUT\n x : INT;"), "") << actual;
}

TEST(Parameters, ThereAreAtMostSixteen) {
  std::string declarations = "VAR_INPUT\n", actual;
  for (int i = 0; i < 17; ++i) {
    declarations += "b" + std::to_string(i) + " : BYTE;\n";
    actual += ", 1";
  }
  EXPECT_EQ(said(program("LD SM0.0\nCALL Work" + actual + "\n", declarations + "END_VAR\n", "")),
            Lines{"x:5:60: error: a subroutine has at most 16 parameters (MAIN, network 1)"});
}

TEST(Parameters, NeedACpuWithLocalMemory) {
  const std::string text = program("LD SM0.0\nCALL Work, 5\n", "VAR_INPUT\n x : INT;\nEND_VAR\n", "");
  EXPECT_EQ(said(text, cpu214()), Lines{"x:5:12: error: CPU 214 has no parameters of subroutines (MAIN, network 1)"});
  EXPECT_EQ(check_text(text, "x", cpu214(), default_times(cpu214())).diagnostics.at(0).hint,
            "they need CPU 22x; choose one, such as CPU 224");
}

TEST(Parameters, ADoubleWordGivenToARealIsShownAsOne) {
  const CheckResult result =
      check_text(program("LD SM0.1\nCALL Work, VD40\n", "VAR_OUTPUT\n y : REAL;\nEND_VAR\n", "LD SM0.0\nMOVR 2.5, #y\n"),
                 "x", cpu224(), default_times(cpu224()));
  ASSERT_TRUE(result.program);
  EXPECT_TRUE(result.program->is_real(image::kV + 40));
}

TEST(Parameters, AWrongCallMayMeanAnySubroutine) {
  const CheckResult result = check_text(program("LD SM0.1\nCALL Work, VD40, 5\n", "", "LD SM0.0\nMOVW 1, VW0\n"), "x",
                                        cpu224(), default_times(cpu224()));
  ASSERT_EQ(result.diagnostics.size(), 1U) << render(result.diagnostics, result.source, false);
  EXPECT_EQ(result.diagnostics[0].severity, stl::Severity::Error);
}

}  // namespace
}  // namespace s7200::test::parameters_test
