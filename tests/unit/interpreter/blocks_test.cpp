#include "interpreter/stl/blocks.hpp"

#include <gtest/gtest.h>

#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/tables/symbols.hpp"

namespace s7200::stl::blocks_test {
namespace {

constexpr const char* kMain = "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=A lamp\nBEGIN\nNetwork 1 // lamp\nLD I0.0\n= Q0.0\n";
constexpr const char* kMainEnd = "END_ORGANIZATION_BLOCK\n";

ParseResult fine(const std::string& text) {
  ParseResult result = read_blocks(text, "x.awl");
  EXPECT_TRUE(result.diagnostics.empty()) << render(result.diagnostics, result.source, false);
  return result;
}

std::vector<std::string> messages(const std::string& text) {
  const ParseResult result = read_blocks(text, "x.awl");
  std::vector<std::string> all;
  for (const Diagnostic& d : result.diagnostics) {
    const std::string line = render(d, result.source, false);
    all.push_back(line.substr(0, line.find('\n')));
  }
  return all;
}

/// The mnemonics, which show where routines begin and end.
std::string mnemonics(const ParseResult& result) {
  std::string text;
  for (const Line& line : result.source.lines)
    if (const auto* statement = std::get_if<Statement>(&line)) text += (text.empty() ? "" : " ") + statement->mnemonic;
  return text;
}

std::vector<std::string> places_of_variables(const std::string& declarations) {
  const ParseResult result = fine("SUBROUTINE_BLOCK S:SBR0\n" + declarations + "BEGIN\nNETWORK 1\nEND_SUBROUTINE_BLOCK\n");
  std::vector<std::string> places;
  for (const Variable& v : result.source.blocks.at(0).variables) places.push_back(v.name + " " + to_text({v.address, {}}));
  return places;
}

TEST(Blocks, EachBlockIsARoutineOfTheListing) {
  const ParseResult result = fine(std::string(kMain) + kMainEnd +
                                  "SUBROUTINE_BLOCK SBR_0:SBR0\nTITLE=\nBEGIN\nNetwork 1\nLD SM0.0\n= Q0.1\n"
                                  "END_SUBROUTINE_BLOCK\n"
                                  "INTERRUPT_BLOCK INT_0:INT7\nTITLE=\nBEGIN\nNetwork 1\nLD SM0.0\n= Q0.2\n"
                                  "END_INTERRUPT_BLOCK\n");
  EXPECT_EQ(mnemonics(result), "LD = MEND SBR LD = RET INT LD = RETI");
  ASSERT_EQ(result.source.blocks.size(), 3U);
  EXPECT_EQ(result.source.blocks[0].title, "A lamp");
  EXPECT_EQ(result.source.blocks[2].name, "INT_0");
  EXPECT_EQ(result.source.blocks[2].number, 7U);
}

TEST(Blocks, KeywordsMayBeInAnyCase) {
  EXPECT_EQ(mnemonics(fine("organization_block Main:ob1\ntitle=x\nbegin\nnetwork 1\nld i0.0\nend_organization_block\n")),
            "LD MEND");
}

TEST(Blocks, TheMainProgramComesFirstWhereverItStands) {
  const ParseResult result =
      fine(std::string("SUBROUTINE_BLOCK S:SBR0\nBEGIN\nLD SM0.0\nEND_SUBROUTINE_BLOCK\n") + kMain + kMainEnd);
  EXPECT_EQ(mnemonics(result), "LD = MEND SBR LD RET");
  EXPECT_EQ(std::get<Statement>(result.source.lines.at(2)).position.line, 9U);
}

TEST(Blocks, AnEndThatIsWrittenIsNotAddedAgain) {
  EXPECT_EQ(mnemonics(fine(std::string(kMain) + "MEND\n" + kMainEnd)), "LD = MEND");
  EXPECT_EQ(mnemonics(fine("INTERRUPT_BLOCK I:INT0\nBEGIN\nNetwork 1\nRETI\nEND_INTERRUPT_BLOCK\n")), "INT RETI");
}

TEST(Blocks, CommentsAreKept) {
  const ParseResult result = fine(
      "// exported today\nORGANIZATION_BLOCK MAIN:OB1\nTITLE=A lamp\nWhat it is for,\n// in two lines\nBEGIN\n"
      "Network 1 // lamp\n// on while the switch is\n\n// closed\nLD I0.0 // switch\n= Q0.0\nEND_ORGANIZATION_BLOCK\n");
  EXPECT_EQ(
      to_text(result.source),
      "// exported today\n// MAIN: A lamp\n//What it is for,\n// in two lines\nNETWORK 1 // lamp\n// on while the switch "
      "is\n\n// closed\nLD      I0.0                    // switch\n=       Q0.0\nMEND\n");
}

TEST(Blocks, StatementsKeepTheirLinesAndColumns) {
  const ParseResult result = read_blocks(std::string(kMain) + "  LD I0.9\n" + kMainEnd, "x.awl");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].position, (Position{7, 9, 1}));
}

TEST(Blocks, MessagesNameBlockAndNetwork) {
  EXPECT_EQ(messages(std::string(kMain) + "NETWORK\nLD I0.9\nNETWORK 7\nLD I0.9\n" + kMainEnd),
            (std::vector<std::string>{"x.awl:8:7: error: the bits of a byte are 0 to 7 (MAIN, network 2)",
                                      "x.awl:10:7: error: the bits of a byte are 0 to 7 (MAIN, network 7)"}));
}

TEST(Blocks, NamesAreOptionalQuotedOrWithBlanks) {
  const auto head = [](const std::string& text) {
    const Block block = fine("SUBROUTINE_BLOCK " + text + "\nBEGIN\nEND_SUBROUTINE_BLOCK\n").source.blocks.at(0);
    return block.name + "/" + std::to_string(block.number);
  };
  EXPECT_EQ(head("SBR_3:SBR3"), "SBR_3/3");
  EXPECT_EQ(head("\"Pump control\" : SBR 12 // comment"), "Pump control/12");
  EXPECT_EQ(head("Pump control:SBR1"), "Pump control/1");
  EXPECT_EQ(head("SBR4"), "/4");
  EXPECT_EQ(head("5"), "/5");
}

TEST(Blocks, VariablesAreInLocalMemoryInTheOrderOfTheirKinds) {
  EXPECT_EQ(places_of_variables("VAR\n t : INT;\nEND_VAR\nVAR_OUTPUT\n o : BYTE;\nEND_VAR\nVAR_INPUT\n i : DWORD; // in\n"
                                "END_VAR\nVAR_IN_OUT\n io : REAL;\nEND_VAR\n"),
            (std::vector<std::string>{"i LD0", "io LD4", "o LB8", "t LW9"}));
}

TEST(Blocks, ConsecutiveBitsShareAByteUpToEight) {
  EXPECT_EQ(places_of_variables("VAR_INPUT\na:BOOL; b:BOOL;\nw:WORD;\nc:BOOL;\nEND_VAR\n"),
            (std::vector<std::string>{"a L0.0", "b L0.1", "w LW1", "c L3.0"}));
  const auto nine = places_of_variables("VAR\na, b, c, d, e, f, g, h, i : BOOL;\nEND_VAR\n");
  EXPECT_EQ(nine.at(7), "h L0.7");
  EXPECT_EQ(nine.at(8), "i L1.0");
}

TEST(Blocks, AStringTakesFourBytesOfLocalMemory) {
  EXPECT_EQ(places_of_variables("VAR_INPUT\ns : STRING;\nc : CHAR;\nd : DINT;\nEND_VAR\n"),
            (std::vector<std::string>{"s LD0", "c LB4", "d LD5"}));
}

TEST(Blocks, MoreVariablesThanLocalMemoryAreReportedOnce) {
  std::string many = "SUBROUTINE_BLOCK S:SBR0\nVAR\n";
  for (int i = 0; i < 40; ++i) many += "v" + std::to_string(i) + " : WORD;\n";
  EXPECT_EQ(messages(many + "END_VAR\nBEGIN\nEND_SUBROUTINE_BLOCK\n"),
            std::vector<std::string>{"x.awl:35:1: error: v32 does not fit: the local memory of a block has 64 bytes (S)"});
}

TEST(Blocks, ABrokenExportSaysWhatIsMissing) {
  EXPECT_EQ(messages(kMain), std::vector<std::string>{"x.awl:1:1: error: MAIN has no END_ORGANIZATION_BLOCK (MAIN)"});
  EXPECT_EQ(mnemonics(read_blocks(kMain, "x")), "LD = MEND");
  EXPECT_EQ(messages("END_SUBROUTINE_BLOCK\n"),
            std::vector<std::string>{"x.awl:1:1: error: END_SUBROUTINE_BLOCK does not end any block"});
  EXPECT_EQ(messages("SUBROUTINE_BLOCK S:SBR0\nVAR\na : INT;\nBEGIN\nEND_SUBROUTINE_BLOCK\n"),
            std::vector<std::string>{"x.awl:2:1: error: the declarations have no END_VAR (S)"});
  EXPECT_EQ(messages("SUBROUTINE_BLOCK S\nBEGIN\nEND_SUBROUTINE_BLOCK\n"),
            std::vector<std::string>{"x.awl:1:18: error: SUBROUTINE_BLOCK takes SBR and a number, not S (SBR0)"});
  EXPECT_EQ(messages("SUBROUTINE_BLOCK\nBEGIN\nEND_SUBROUTINE_BLOCK\n"),
            std::vector<std::string>{"x.awl:1:1: error: SUBROUTINE_BLOCK has no number (SBR0)"});
}

TEST(Blocks, WithoutBeginTheFirstLineOfCodeBeginsThem) {
  EXPECT_EQ(mnemonics(fine("ORGANIZATION_BLOCK MAIN:OB1\nTITLE=x\nLD I0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n")), "LD = MEND");
}

TEST(Blocks, ADataBlockAmongThemIsRead) {
  const ParseResult result = fine(std::string(kMain) + kMainEnd + "DATA_BLOCK DB1:DB1\nBEGIN\nVB0 1, 2\nEND_DATA_BLOCK\n");
  ASSERT_EQ(result.source.data.size(), 1U);
  EXPECT_EQ(result.source.data[0].values.size(), 2U);
}

TEST(Blocks, NamesOfBlocksAndVariablesBecomeNumbersAndAddresses) {
  ParseResult result = fine(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL pump_control\nCALL SBR_1:SBR1\nCALL SBR1\nATCH \"On "
      "edge\", 0\n"
      "END_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK Pump_Control:SBR5\nVAR\nx : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nINCW #x\nINCW "
      "x\n"
      "MOVD &x, AC1\nEND_SUBROUTINE_BLOCK\nINTERRUPT_BLOCK On edge:INT3\nBEGIN\nEND_INTERRUPT_BLOCK\n");
  resolve_symbols(result);
  std::string text = to_text(result.source);
  for (const char* expected :
       {"CALL    5\n", "CALL    1\nCALL    1\n", "ATCH    3, 0\n", "INCW    #x:LW0\nINCW    x:LW0\n", "MOVD    &x:LW0, AC1"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << text;
}

TEST(Blocks, TakeTimeInProportionToTheText) {
  std::string heads;
  for (int i = 0; i < 50'000; ++i) heads += "SUBROUTINE_BLOCK x\n";
  EXPECT_EQ(read_blocks(heads, "x").source.blocks.size(), 50'000U);
  const std::string wide = "VAR " + std::string(1'000'000, ';') + "\n" + std::string(1'000'000, 'a') + ":INT;\n";
  EXPECT_FALSE(read_blocks("SUBROUTINE_BLOCK S:SBR0\n" + wide, "x").diagnostics.empty());
}

TEST(Blocks, AreRecognisedByTheirHeads) {
  EXPECT_TRUE(is_block_export("\r\n  subroutine_block SBR_0:SBR0\r\n"));
  EXPECT_FALSE(is_block_export("LD I0.0 // ORGANIZATION_BLOCK\nMEND\n"));
  EXPECT_FALSE(is_block_export(""));
}

TEST(Blocks, WhatStandsBeforeBeginIsNeverLostInSilence) {
  const std::string head = "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=\n",
                    rest = "BEGIN\nNetwork 1\nLD I0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n";
  using Lines = std::vector<std::string>;
  EXPECT_EQ(messages(head + "LD I0.0\n" + rest),
            Lines{"x.awl:3:1: error: a statement before BEGIN is not part of the program (MAIN)"});
  EXPECT_EQ(messages(head + "VAR_CONST\n x : INT;\nEND_VAR\n" + rest),
            Lines{"x.awl:3:1: error: VAR_CONST does not begin declarations (MAIN)"});
  EXPECT_EQ(messages(head + "Version 2 of M1, see I0\n" + rest), Lines{});
  EXPECT_EQ(messages("INTERRUPT_BLOCK I:INT0\nVAR_INPUT\n x : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nEND_INTERRUPT_BLOCK\n"),
            Lines{"x.awl:2:1: error: an interrupt routine has no parameters (I)"});
}

TEST(Blocks, AStatementOfSymbolsBeforeBeginIsNoComment) {
  const auto is_instruction = [](std::string_view mnemonic, std::size_t operands) {
    return (mnemonic == "LD" && operands == 1) || (mnemonic == "ENI" && operands == 0);
  };
  for (const std::string line : {"LD Pump", "ENI", "CALL Prepare, 1, 2"}) {
    const std::string text = "ORGANIZATION_BLOCK MAIN:OB1\n" + line + "\nBEGIN\nNetwork 1\nEND_ORGANIZATION_BLOCK\n";
    EXPECT_EQ(read_blocks(text, "x", is_instruction).diagnostics.size(), 1U) << line;
    EXPECT_EQ(read_blocks(text, "x").diagnostics.size(), 0U) << line;
  }
}

}  // namespace
}  // namespace s7200::stl::blocks_test
