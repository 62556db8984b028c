#include "interpreter/stl/printer.hpp"

#include <gtest/gtest.h>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl::printer_test {
namespace {

Source source(std::string_view text) {
  ParseResult result = parse(text, "test.stl");
  EXPECT_TRUE(result.diagnostics.empty()) << result.diagnostics.front().message;
  return std::move(result.source);
}

std::string operand(const std::string& text) {
  const Source parsed = source("X " + text);
  return to_text(std::get<Statement>(parsed.lines.at(0)).operands.at(0));
}

constexpr std::string_view kProgram =
    "// A lamp follows a switch.\nNETWORK 1 // lamp\nld i0.0 // switch\nLDW>= VW0,KH7F\nALD\n=Q0.0\nMOVB '$$a', *ac1\n"
    "MOVR -1.25E-3 VD8\nMEND\n\n\n// counts\n// pulses\nSBR K1\nMOVD &VB0,VD4;\nMOVW 2#1010,AI2\nCALL \"Pump 1\"\nRET\nINT "
    "2\nRETI";

TEST(Printer, PrintsOperandsInInternationalNotation) {
  EXPECT_EQ(operand("K4"), "4");
  EXPECT_EQ(operand("KHff"), "16#FF");
  EXPECT_EQ(operand("2#0101"), "2#101");
  EXPECT_EQ(operand("'a$''"), "'a$''");
  EXPECT_EQ(operand("'$0D$L'"), "'$0D$0A'");
  EXPECT_EQ(operand("+5"), "5");
  EXPECT_EQ(operand("1.0"), "1.0");
  EXPECT_EQ(operand("3e20"), "3E+20");
  EXPECT_EQ(operand("vx10.3"), "V10.3");
  EXPECT_EQ(operand("ai4"), "AIW4");
  EXPECT_EQ(operand("*ac1"), "*AC1");
  EXPECT_EQ(operand("&vb0"), "&VB0");
  EXPECT_EQ(operand("smb30"), "SMB30");
  EXPECT_EQ(operand("t33"), "T33");
  EXPECT_EQ(operand("\"Pump 1\""), "\"Pump 1\"");
}

TEST(Printer, PrintsStatementsInColumns) {
  const Source parsed = source("movw 65,vw8 // x");
  EXPECT_EQ(to_text(std::get<Statement>(parsed.lines.at(0))), "MOVW    65, VW8");
  EXPECT_EQ(to_text(parsed), "MOVW    65, VW8                 // x\n");
}

TEST(Printer, WhatItPrintsReadsBackAsTheSameProgram) {
  const Source first = source(kProgram);
  const Source second = source(to_text(first));
  EXPECT_TRUE(same_program(first, second));
  EXPECT_EQ(to_text(first), to_text(second));
}

TEST(Printer, SetsRoutinesAndNetworksApartWithTheCommentsAboveThem) {
  EXPECT_EQ(to_text(source("NOT\n// one\nNETWORK\nNOT\nMEND\n// two\n\n\n// three\n// four\nSBR 1\nRET\nINT 2")),
            "NOT\n\n// one\nNETWORK\nNOT\nMEND\n\n// two\n\n// three\n// four\nSBR     1\nRET\n\nINT     2\n");
}

TEST(Printer, KeepsEveryComment) {
  EXPECT_EQ(to_text(source("// a\nNOT // b\nNETWORK 2 //c")),
            "// a\nNOT                             // b\n\nNETWORK 2 //c\n");
}

TEST(SameProgram, LooksAtTheProgramAndNotAtItsNotation) {
  EXPECT_TRUE(same_program(source("MOVW K4 VW0 // a"), source("\n// b\nmovw 16#4, VW0")));
  EXPECT_TRUE(same_program(source("MOVB 'A', VB0"), source("MOVB 65, VB0")));
  EXPECT_FALSE(same_program(source("MOVW 4, VW0"), source("MOVW 5, VW0")));
  EXPECT_FALSE(same_program(source("MOVW 4, VW0"), source("MOVW VW0, 4")));
  EXPECT_FALSE(same_program(source("MOVW 4, VW0"), source("MOVW 4, *VD0")));
  EXPECT_FALSE(same_program(source("LD I0.0"), source("LD I0.0\nNOT")));
  EXPECT_FALSE(same_program(source("NETWORK 1"), source("NETWORK 2")));
  EXPECT_FALSE(same_program(source("NETWORK 1"), source("NOT")));
}

}  // namespace
}  // namespace s7200::stl::printer_test
