// Programs for other controllers and in other languages: one message, not one for each line.
#include "interpreter/program/loading/dialect.hpp"

#include <gtest/gtest.h>

#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::dialect_test {
namespace {

/// All messages about a text, each in a line.
std::string messages(const std::string& text) {
  std::string all;
  const auto source = read_source(text, "program.awl");
  if (!source) return source.why();
  const CpuModel& model = *find_cpu("226");
  const CheckResult result = check(source->parsed, model, default_times(model));
  for (const stl::Diagnostic& d : result.diagnostics) all += std::to_string(d.position.line) + ": " + d.message + "\n";
  return all;
}

constexpr const char* kStep7 = "this is STL of STEP 7 for the S7-300 and S7-400, not STL of the S7-200";
constexpr const char* kIl = "this is IL (instruction list) of IEC 61131-3, not STL of the S7-200";
constexpr const char* kMelsec =
    "this is a program for Mitsubishi MELSEC, or for another make with the same mnemonics, not STL of the S7-200";
constexpr const char* kOmron = "this is a program for Omron, not STL of the S7-200";
constexpr const char* kRockwell = "this is a program for Allen-Bradley controllers, not STL of the S7-200";
constexpr const char* kScl = "this is SCL or ST (structured text), not STL of the S7-200";

std::string one(int line, const char* message) { return std::to_string(line) + ": " + message + "\n"; }

TEST(Dialect, Step7IsKnownByItsHeads) {
  EXPECT_EQ(messages("FUNCTION FC 2 : VOID\nTITLE = x\nVERSION : 0.1\nBEGIN\nNETWORK\n      A     I      1.0;\n      =     "
                     "Q      1.0;\n"
                     "END_FUNCTION\n"),
            one(1, kStep7));
  EXPECT_EQ(messages("ORGANIZATION_BLOCK OB 1\nTITLE =\nVERSION : 0.1\nBEGIN\nNETWORK\n      L MW 10;\n      T MW 12;\n"
                     "END_ORGANIZATION_BLOCK\n"),
            one(1, kStep7));
  EXPECT_EQ(
      messages("FUNCTION_BLOCK FB 7\nVAR_INPUT\nx : BOOL;\nEND_VAR\nBEGIN\nNETWORK\nU #x;\n= A 4.0;\nEND_FUNCTION_BLOCK\n"),
      one(1, kStep7));
}

TEST(Dialect, OneHeadOfABlockOfStep7IsEnough) {
  for (const char* const text : {"FUNCTION_BLOCK FB 10\nBEGIN\nEND_FUNCTION_BLOCK\n", "DATA_BLOCK DB 10\n STRUCT\n",
                                 "DATA_BLOCK DB12\n", "FUNCTION FC 1 : VOID\n", "TYPE UDT 3\n"}) {
    EXPECT_EQ(messages(text), one(1, kStep7)) << text;
    EXPECT_TRUE(begins_as_step7(std::string("\n// by Meier\n") + text)) << text;
  }
  for (const char* const text : {"DATA_BLOCK DB1\nVB0 1\n", "ORGANIZATION_BLOCK MAIN:OB1\n", "LD I0.0\nDATA_BLOCK DB 10\n"})
    EXPECT_FALSE(begins_as_step7(text)) << text;
}

TEST(Dialect, Step7IsKnownByItsStatements) {
  EXPECT_EQ(messages("      U     E 0.0\n      UN    E 0.1\n      =     A 4.0\n"), one(1, kStep7));
  EXPECT_EQ(messages("A I0.0\nL MW10\nL 5\n>I\n= M0.0\n"), one(2, kStep7));
  EXPECT_EQ(messages("U E0.0\nL S5T#2S\nSE T1\nU T1\n= A4.0\n"), one(2, kStep7));
  EXPECT_EQ(messages("L DB10.DBW0\nT DB10.DBW2\n"), one(1, kStep7));
}

TEST(Dialect, IlIsKnown) {
  EXPECT_EQ(messages("LD %IX0.0\nANDN %IX0.1\nST %QX0.0\n"), one(2, kIl));
  EXPECT_EQ(messages("PROGRAM main\nVAR\n a AT %IX0.0 : BOOL;\nEND_VAR\nLD a\nAND b\nST c\nEND_PROGRAM\n"), one(1, kIl));
}

TEST(Dialect, MelsecAndOmronAreKnown) {
  EXPECT_EQ(messages("LD X000\nANI X001\nOUT Y000\nEND\n"), one(2, kMelsec));
  EXPECT_EQ(messages("LD M0\nOUT T0 K100\nLD T0\nSET Y1\nFEND\n"), one(2, kMelsec));
  EXPECT_EQ(messages("LD 0.00\nAND NOT 0.01\nOUT 10.00\nTIM 000 #0100\n"), one(2, kOmron));
}

TEST(Dialect, AllenBradleyIsKnown) {
  EXPECT_EQ(messages("XIC I:0/0\nXIO I:0/1\nOTE O:0/1\n"), one(1, kRockwell));
  EXPECT_EQ(messages("SOR XIC I:1.0/3 BST XIC B3:0/1 NXB XIC T4:0/DN BND OTE O:2.0/0 EOR\nSOR XIC N7:0/2 OTU B3:0/1 EOR\n"),
            one(1, kRockwell));
  EXPECT_EQ(messages("XIC(Start)XIO(Stop)OTE(Motor);\n"), one(1, kRockwell));
}

TEST(Dialect, StructuredTextIsKnown) {
  EXPECT_EQ(messages("IF start AND NOT stop THEN\n  motor := TRUE;\nEND_IF;\n"), one(1, kScl));
  EXPECT_EQ(
      messages("FUNCTION_BLOCK \"Motor\"\nBEGIN\n #run := #start AND NOT #stop;\n #n := #n + 1;\nEND_FUNCTION_BLOCK\n"),
      one(3, kScl));
}

TEST(Dialect, WordsOfOthersInAProgramOfTheS7200HaveTheirOwnMessages) {
  for (const char* text :
       {"LD SM0.0\nL VW0\nT VW2\nMEND\n", "LD I0.0\nAND I0.1\n= Q0.0\nLD SM0.0\nMOVB 1, VB0\nMEND\n",
        "LD SM0.0\nMOVB 1, VB0\nMOVB 2, VB1\nST Q0.0\nMEND\n", "LD I0.0\nOUT Q0.0\nMEND\n", "FROB VB0\nMEND\n"})
    EXPECT_FALSE(other_dialect(text)) << text;
}

TEST(Dialect, ProgramsOfTheS7200AreNone) {
  for (const char* text : {"ORGANIZATION_BLOCK MAIN:OB1\nTITLE=x\nVAR\nx : BOOL;\nEND_VAR\nBEGIN\nNETWORK\nLD I0.0\nA "
                           "I0.1\n= Q0.0\nEND_ORGANIZATION_BLOCK\n",
                           "U E0.0\nUN E0.1\n= A0.0\n", "LD X0\n= Y0\n", "VW0 100\n'AB'\n", "Symbol\tAddress\nST\tQ0.0\n",
                           "// IF a THEN b := c; END_IF\nLD I0.0\n= Q0.0\n"})
    EXPECT_FALSE(other_dialect(text)) << text;
}

TEST(Dialect, InstructionsOfTheSmartAreSaidOnce) {
  const auto source = read_source("LD M2.1\nGET VB780\nPUT VB800\nGIP VB900\nSIP VB904\nMEND\n", "smart.awl");
  ASSERT_TRUE(source);
  const CpuModel& model = *find_cpu("226");
  const CheckResult result = check(source->parsed, model, default_times(model));
  ASSERT_EQ(result.diagnostics.size(), 4U);
  EXPECT_EQ(stl::count_causes(result.diagnostics), 1U);
  EXPECT_EQ(result.diagnostics[0].message, "GET is an instruction of the S7-200 SMART");
}

}  // namespace
}  // namespace s7200::dialect_test
