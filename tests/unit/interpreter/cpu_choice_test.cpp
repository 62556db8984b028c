// Which CPU a program is for where nobody has named one.
#include "interpreter/program/loading/cpu_choice.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::cpu_choice_test {
namespace {

stl::ParseResult read(const std::string& text) {
  auto source = read_source(text, "program.awl");
  EXPECT_TRUE(source) << source.why();
  return source ? source->parsed : stl::ParseResult{};
}

/// "none" if the head names none.
std::string named(const std::string& head) {
  const CpuModel* model = cpu_in_head(read(head + "\nNETWORK 1\nLD SM0.0\nMEND\n").source);
  return model ? std::string(model->name) : "none";
}

TEST(CpuInHead, IsNamedByALineOfItsOwn) {
  EXPECT_EQ(named("// CPU 224"), "224");
  EXPECT_EQ(named("// drain pump\n//\n// PLC type: CPU 224 XP, release 2.01"), "224XP");
  EXPECT_EQ(named("// SIMATIC S7-200, CPU226"), "226");
  EXPECT_EQ(named("// for the CPU 222 (6ES7 212-1AB23)"), "222");
}

TEST(CpuInHead, IsNamedByTheTitle) {
  EXPECT_EQ(named("// MODBUS SLAVE FOR THE CPU 224, on port 0"), "224");
  EXPECT_EQ(named("//\n// times, for the CPU 214 and all later ones"), "214");
}

TEST(CpuInHead, MayHaveARelease) {
  EXPECT_EQ(named("// CPU 224 REL 02.01"), "224");
  EXPECT_EQ(named("// CPU: 226, release 1.20"), "226r1");
  EXPECT_EQ(named("// CPU 222 V1.1"), "222r1");
  EXPECT_EQ(named("// CPU 214 REL 01.14"), "214") << "of which only one is modelled";
}

TEST(CpuInHead, MayStandAboveAListingWithoutSlashes) {
  EXPECT_EQ(named("CPU 224"), "224");
  EXPECT_EQ(named("\n// pump station\nCPU: 224 REL 02.01"), "224");
  EXPECT_EQ(named("PLC type: CPU 226XM"), "226XM");
  EXPECT_EQ(named("SIMATIC S7-200, CPU 222 (6ES7 212-1AB23)"), "222");
  EXPECT_EQ(named("CPU 224\n// below it"), "224");
  const auto read_twice = read("CPU 224 REL 02.01\nLD I0.0\n= Q0.0\n");
  EXPECT_TRUE(read_twice.diagnostics.empty()) << read_twice.diagnostics.front().message;
}

TEST(CpuInHead, ThatIsNotModelledIsNamed) {
  const auto result = check(read("CPU 312\nLD I0.0\n= Q0.0\n"), cpu224(), default_times(cpu224()));
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics.front().message, "this line names no CPU that is modelled");
}

/// "none" if the head names none, or one that is modelled.
std::string unmodelled(const std::string& head) {
  const std::string cpu = unmodelled_cpu_in_head(read(head + "\nNETWORK 1\nLD SM0.0\nMEND\n").source);
  return cpu.empty() ? "none" : cpu;
}

TEST(CpuInHead, ThatIsNotModelledIsToldFromNone) {
  EXPECT_EQ(unmodelled("// CPU 999"), "999");
  EXPECT_EQ(unmodelled("// pump\n// PLC type: CPU 313C"), "313C");
  EXPECT_EQ(unmodelled("// tank control for the CPU 315-2DP"), "315-2DP");
  EXPECT_EQ(unmodelled("// CPU 999\n// CPU 224"), "none");
  EXPECT_EQ(named("// CPU 999\n// CPU 224"), "224");
  EXPECT_EQ(unmodelled("// CPU 224"), "none");
  EXPECT_EQ(unmodelled("// CPU 300 ms late"), "none");
  EXPECT_EQ(unmodelled("// as the CPU 313C had it"), "none");
  EXPECT_EQ(unmodelled("// nothing"), "none");
}

TEST(CpuInHead, OfTheCnSeriesIsTheOneWithoutCn) {
  EXPECT_EQ(named("// CPU 224CN"), "224");
  EXPECT_EQ(unmodelled("// CPU 224CN"), "224 CN");
  EXPECT_EQ(named("// CPU 224XP CN REL 02.01"), "224XP");
  EXPECT_EQ(unmodelled("// CPU 224XP CN REL 02.01"), "224XP CN");
  EXPECT_EQ(named("// CPU 226 CN"), "226");
}

TEST(CpuInHead, IsNotTakenFromAStatement) {
  EXPECT_EQ(cpu_in_head(read("A CPU224\n= Q0.0\n").source), nullptr) << "a symbol";
  EXPECT_EQ(cpu_in_head(read("LD I0.0\nCPU 224\n= Q0.0\n").source), nullptr) << "not the first line";
}

TEST(CpuInHead, IsNotTakenFromASentence) {
  EXPECT_EQ(named("// a title\n// On CPU 22x nobody types MEND. For CPU 212 an error is right."), "none");
  EXPECT_EQ(named("// it replaces the CPU 212 of 1996"), "none");
  EXPECT_EQ(named("// CPU 2240"), "none");
  EXPECT_EQ(named("// CPU 314"), "none");
  EXPECT_EQ(named("// ACPU 224"), "none");
  EXPECT_EQ(named("// nothing"), "none");
}

TEST(CpuInHead, IsNotTakenFromBelowTheFirstInstruction) {
  EXPECT_EQ(cpu_in_head(read("NETWORK 1\nLD SM0.0\n// CPU 224\nMEND\n").source), nullptr);
}

TEST(CpuInHead, IsNamedByTheTitleOfAnExport) {
  const auto parsed = read(
      "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=Pump station, CPU 226\nBEGIN\nNetwork 1\nLD SM0.0\n= Q0.0\n"
      "END_ORGANIZATION_BLOCK\n");
  EXPECT_EQ(cpu_in_head(parsed.source), nullptr) << "a sentence about something else";
  const auto named = read(
      "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=Pump station for CPU 226\nBEGIN\nNetwork 1\nLD SM0.0\n= Q0.0\n"
      "END_ORGANIZATION_BLOCK\n");
  ASSERT_NE(cpu_in_head(named.source), nullptr);
  EXPECT_EQ(cpu_in_head(named.source)->name, "226");
}

std::string first_for(const std::string& text) { return std::string(first_cpu_for(read(text)).name); }

TEST(FirstCpu, IsThe214WhereItWillDo) { EXPECT_EQ(first_for("LD SM0.0\n= Q0.0\nMEND\n"), "214"); }

TEST(FirstCpu, HasWhatTheProgramUses) {
  EXPECT_EQ(first_for("LD SM0.0\nRCV VB100, 0\nMEND\n"), "224");
  EXPECT_EQ(first_for("LD SM0.0\nRCV VB100, 1\nMEND\n"), "226");
}

TEST(FirstCpu, OfAProgramWithMistakesHasTheFewest) {
  EXPECT_EQ(first_for("LD SM0.0\nRCV VB100, 0\nRCV VB300, 0\nMOVB VW10, VB0\nMEND\n"), "224");
  EXPECT_EQ(first_for("LD SM0.0\nRCV VB100, 0\nMOVB VW10, VB0\nMOVB VW10, VB0\nMEND\n"), "224") << "one fewer";
  EXPECT_EQ(first_for("LD SM0.0\nMOVB VW10, VB0\nMOVW VB1, VW2\n= Q0.0\n"), "224") << "which needs no MEND";
  EXPECT_EQ(first_for("LD SM0.0\nMOVB VW10, VB0\nRCV VB100, 1\nMEND\n"), "226");
  EXPECT_EQ(first_for("LD SM0.0\nMOVB VW10, VB0\nMEND\n"), "214") << "the same mistake on all";
}

TEST(FirstCpu, OfAProgramForTheSmartIsThe226) { EXPECT_EQ(first_for("NETWORK 1\nLD SM0.0\nGET VB300\n"), "226"); }

TEST(FirstCpu, NoEndIsMissingWhereNoLineCouldBeRead) {
  const auto parsed = read("NETWORK 1\nLD I0.0 A I0.1 = Q0.0\nNETWORK 2\nLD I0.0; O I0.2; = Q0.1\n");
  for (const char* name : {"214", "224"}) {
    const CpuModel& model = *find_cpu(name);
    EXPECT_EQ(check(parsed, model, default_times(model)).diagnostics.size(), 2U) << name << ": two statements in one line";
  }
}

}  // namespace
}  // namespace s7200::cpu_choice_test
