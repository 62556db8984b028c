#include "interpreter/stl/symbols.hpp"

#include <gtest/gtest.h>

#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::stl {
namespace {

bool is_mnemonic(std::string_view word) { return word == "LD" || word == "="; }

/// `name=address comment` of each symbol.
std::vector<std::string> symbols(const std::string& text) {
  const ParseResult table = read_symbol_table(text, "t");
  EXPECT_TRUE(table.diagnostics.empty()) << render(table.diagnostics, table.source, false);
  std::vector<std::string> all;
  for (const Symbol& s : table.source.symbols)
    all.push_back(s.name + "=" + (s.value ? to_text({*s.value, {}}) : "") + (s.comment.empty() ? "" : " " + s.comment));
  return all;
}

SourceText file(const std::string& text, const std::string& name) {
  std::string why;
  auto read = read_source(text, name, why);
  EXPECT_TRUE(read) << why;
  return *read;
}

/// What the check says of a program with a symbol table.
std::vector<std::string> said(const std::string& program, const std::string& table) {
  std::vector<SourceText> files{file(program, "p.awl")};
  if (!table.empty()) files.push_back(file(table, "t.txt"));
  const CheckResult result = check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214()));
  std::vector<std::string> lines;
  for (const Diagnostic& d : result.diagnostics) {
    const std::string text = render(d, result.source, false);
    lines.push_back(text.substr(0, text.find('\n')) + (d.hint.empty() ? "" : "; " + d.hint));
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(SymbolTable, IsReadFromTabsAndCommasWithAndWithoutHeadings) {
  EXPECT_EQ(symbols("Symbol\tAddress\tComment\nPump\tQ0.0\tcontactor\nLevel low\tI0.1\t\n"),
            (Lines{"Pump=Q0.0 contactor", "Level low=I0.1"}));
  EXPECT_EQ(symbols("Pump\tQ0.0\nSpeed\tVW100\tin rpm\n"), (Lines{"Pump=Q0.0", "Speed=VW100 in rpm"}));
  EXPECT_EQ(symbols("Name,Comment,Address\nPump,\"big, blue\",Q0.0\n"), Lines{"Pump=Q0.0"});
  EXPECT_EQ(symbols("\"Pump \"\"1\"\"\",Q0.0,\"a, b\"\n"), Lines{"Pump \"1\"=Q0.0 a, b"});
  EXPECT_EQ(symbols("符号\t地址\t注释\n泵\tQ0.0\t\n"), Lines{"泵=Q0.0"});
}

TEST(SymbolTable, FindsNameAndAddressAmongOtherColumns) {
  EXPECT_EQ(symbols("1;Pump;Q0.0;contactor\n2;Fault;M0.0;\n"), (Lines{"Pump=Q0.0 contactor", "Fault=M0.0"}));
  EXPECT_EQ(symbols("Q0.0\tPump\tcontactor\n"), Lines{"Pump=Q0.0 contactor"});
}

TEST(SymbolTable, TakesConstantsGermanAddressesAndBlocks) {
  EXPECT_EQ(symbols("Baud\t16#49\nStart\tE0.0\nLamp\tA0.1\nMAIN\tOB1\nPrepare\tSBR0\n"),
            (Lines{"Baud=16#49", "Start=I0.0", "Lamp=Q0.1", "MAIN=OB1", "Prepare=SBR0"}));
}

TEST(SymbolTable, SeveralTablesMayFollowEachOther) {
  EXPECT_EQ(symbols("USER1\nSymbol\tAddress\nPump\tQ0.0\n\n// another\nUSER2\nAddress\tSymbol\nI0.0\tStart\n"),
            (Lines{"Pump=Q0.0", "Start=I0.0"}));
}

TEST(SymbolTable, SaysWhichAddressIsWrong) {
  const ParseResult table = read_symbol_table("Symbol\tAddress\nPump\tQ0.9\nLamp\tsomewhere\n", "t");
  ASSERT_EQ(table.diagnostics.size(), 2U);
  EXPECT_EQ(table.diagnostics[0].message, "the bits of a byte are 0 to 7");
  EXPECT_EQ(table.diagnostics[0].position, (Position{2, 6, 4}));
  EXPECT_EQ(table.diagnostics[1].message, "somewhere is not an address");
}

TEST(SymbolTable, IsToldFromListingsAndCharts) {
  EXPECT_TRUE(is_symbol_table("Pump\tQ0.0\nStart\tI0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("LD\tI0.0\n=\tQ0.0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("FROB 1, VB0\nFROB 1, VB0\n", is_mnemonic));
  EXPECT_FALSE(is_symbol_table("", is_mnemonic));
  EXPECT_TRUE(is_status_chart("Address\tFormat\tCurrent Value\nPump:Q0.0\tBit\t2#0\nVW10\tSigned\t+5\n"));
  EXPECT_FALSE(is_status_chart("LD\tI0.0\n=\tQ0.0\n"));
  EXPECT_EQ(file("Pump\tQ0.0\n", "t").kind, SourceKind::SymbolTable);
  EXPECT_EQ(file("VW0\tUnsigned\t1\nVW2\tSigned\t1\n", "t").kind, SourceKind::StatusChart);
}

TEST(Symbols, StandForAddressesConstantsAndPointers) {
  EXPECT_EQ(said("LD Start\nMOVW Limit, Speed\nMOVD &Table, Next\nMOVB *Next, \"First one\"\nMEND\n",
                 "Start\tI0.0\nLimit\t100\nSpeed\tVW10\nTable\tVB100\nNext\tVD20\nFirst one\tVB30\n"),
            Lines{});
}

TEST(Symbols, OneWrittenInOtherCapitalsIsFoundIfItIsTheOnlyOne) {
  EXPECT_EQ(said("LD START\n= Q0.0\nMEND\n", "Start\tI0.0\n"), Lines{});
  EXPECT_EQ(
      said("LD start\nLD Start\nLD START\nALD\nALD\n= Q0.0\nMEND\n", "Start\tI0.0\nSTART\tI0.1\n"),
      Lines{"p.awl:1:4: error: 'start' is neither an address nor a defined symbol; give its symbol table too, s7200 check "
            "PROGRAM SYMBOLS, or write the address itself"});
}

TEST(Symbols, DefinedTwiceAreReportedAtTheSecondPlace) {
  EXPECT_EQ(said("LD Start\n= Q0.0\nMEND\n", "Start\tI0.0\nStop\tI0.1\nStart\tI0.2\n"),
            Lines{"t.txt:3:1: error: Start is defined twice; it is first defined in line 1"});
}

TEST(Symbols, WithoutAnAddressAreReportedOnlyWhereTheyAreUsed) {
  EXPECT_EQ(said("LD Start\n= Q0.0\nMEND\n", "Symbol\tAddress\tComment\nStart\t\tto do\nStop\t\tto do\n"),
            Lines{"p.awl:1:4: error: symbol Start has no address"});
}

TEST(Symbols, UndefinedOnesShareACauseOnlyWithoutATable) {
  const auto causes = [](const std::string& table) {
    std::vector<SourceText> files{file("LD P1\nA P2\n= Q0.0\nMEND\n", "p")};
    if (!table.empty()) files.push_back(file(table, "t"));
    return count_causes(check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214())).diagnostics);
  };
  EXPECT_EQ(causes(""), 1U);
  EXPECT_EQ(causes("Other\tI0.0\n"), 2U);
}

TEST(Symbols, NameBlocksInCallAndAtch) {
  EXPECT_EQ(
      said("LD SM0.0\nCALL Prepare\nATCH Edge, 0\nENI\nMEND\nSBR 4\nRET\nINT 2\nRETI\n", "Prepare\tSBR4\nEdge\tINT2\n"),
      Lines{});
  EXPECT_EQ(said("LD SM0.0\nCALL Edge\nMEND\nINT 2\nRETI\n", "Edge\tINT2\n").at(0).substr(0, 53),
            "p.awl:2:6: error: Edge is not a subroutine; subroutin");
}

TEST(Symbols, TablesTakeTimeInProportionToTheirSize) {
  std::string wide(1'000'000, ',');
  EXPECT_TRUE(read_symbol_table(wide, "t").source.symbols.empty());
  EXPECT_TRUE(read_symbol_table(std::string(1'000'000, '"'), "t").source.symbols.empty());
  std::string long_table = "Symbol,Address\n";
  for (int i = 0; i < 50'000; ++i) long_table += "S" + std::to_string(i) + ",VB" + std::to_string(i) + "\n";
  EXPECT_EQ(read_symbol_table(long_table, "t").source.symbols.size(), 50'000U);
}

TEST(Symbols, ANameThatIsAnAddressOrAConstantIsRefused) {
  for (const std::string name : {"VW5", "16#4", "T37"}) {
    const ParseResult table = read_symbol_table("Symbol\tAddress\n" + name + "\tI0.0\n", "t");
    ASSERT_EQ(table.diagnostics.size(), 1U) << name;
    EXPECT_EQ(table.diagnostics[0].message, name + " is an address or a constant, not a name");
  }
}

TEST(Symbols, NamesThatAreOnlyTheBeginningOfAnAddressStandForTheirSymbols) {
  const std::string table = "S1\tI0.1\nK1\tQ0.0\nE1\tI0.2\n";
  EXPECT_EQ(said("LD S1\nA E1\n= K1\nMEND\n", table), Lines{});
  EXPECT_EQ(said("LD S2\nMEND\n", table).size(), 1U);
}

TEST(Symbols, EmptyColumnsMayStandLeftOfTheRowsAlone) {
  EXPECT_EQ(symbols("Symbol\tAddress\tComment\n\t\tStart\tI0.0\tgreen\n\tStop\tI0.1\n"),
            (std::vector<std::string>{"Start=I0.0 green", "Stop=I0.1"}));
}

TEST(Symbols, AnAddressBesideANameMustBeTheOneItStandsFor) {
  EXPECT_EQ(said("LD Pump:Q0.1\nMEND\n", "Pump\tQ0.0\n"),
            Lines{"p.awl:1:4: error: Pump is Q0.1 here; it is Q0.0 in t.txt:1"});
  EXPECT_EQ(said("LD Pump:Q0.1\nA Pump:Q0.1\n= Pump:Q0.0\nMEND\n", ""),
            Lines{"p.awl:3:3: error: Pump is Q0.0 here; it is Q0.1 in line 1"});
  EXPECT_EQ(said("LD Pump:Q0.0\nMOVD &Speed:VB4, VD0\nMOVD Speed:VB4, VD0\nMEND\n", "Pump\tQ0.0\nSpeed\tVB4\n").size(), 1U);
}

TEST(Symbols, GermanLettersMayBeNamesInAnInternationalProgram) {
  EXPECT_EQ(said("LD Z1\nMOVW AW1, VW0\nMEND\n", "Z1\tI0.1\nAW1\tVW4\n"), Lines{});
  EXPECT_EQ(said("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL E1\nEND_ORGANIZATION_BLOCK\n"
                 "SUBROUTINE_BLOCK E1:SBR0\nBEGIN\nNETWORK 1\nLD SM0.0\n= M0.0\nEND_SUBROUTINE_BLOCK\n",
                 ""),
            Lines{});
}

TEST(Symbols, BlocksAndVariablesMayHaveNamesThatAreOnlyTheBeginningOfAnAddress) {
  const std::string program =
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL K1\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK One:SBR1\nBEGIN\nNETWORK 1\nEND_SUBROUTINE_BLOCK\n"
      "SUBROUTINE_BLOCK K1:SBR3\nVAR\n K7 : WORD;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW K7, VW0\n"
      "END_SUBROUTINE_BLOCK\n";
  ParseResult parsed = file(program, "p.awl").parsed;
  resolve_symbols(parsed);
  std::vector<std::string> operands;
  for (const Line& line : parsed.source.lines)
    if (const auto* statement = std::get_if<Statement>(&line))
      for (Operand operand : statement->operands) operands.push_back((operand.symbol.clear(), to_text(operand)));
  EXPECT_EQ(operands, (Lines{"SM0.0", "3", "1", "3", "SM0.0", "LW0", "VW0"}));
}

TEST(Symbols, NamesThatBeginLikeAnAddressMayHaveTheirAddressBesideThem) {
  EXPECT_EQ(said("LD S1:I0.0\nA E1:I0.1\n= K1:Q0.1\nMOVW AW1:VW10, VW0\nCTU Z1:C1, 5\nMEND\n",
                 "S1\tI0.0\nE1\tI0.1\nK1\tQ0.1\nAW1\tVW10\nZ1\tC1\n")
                .size(),
            1U);  // CTU lacks its second LD
}

}  // namespace
}  // namespace s7200::stl
