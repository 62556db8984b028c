#include "interpreter/program/loading/convert.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::convert_test {
namespace {

SourceText file(const std::string& text) {
  auto read = read_source(text, "x");
  EXPECT_TRUE(read) << read.why() << "\n" << text;
  return read ? *read : SourceText{};
}

std::string printed(const std::string& text, Notation notation) {
  SourceText source = file(text);
  const auto result = convert(source.parsed, notation);
  EXPECT_TRUE(result) << render(source.parsed.diagnostics, source.parsed.source, false);
  return result.value_or("");
}

/// The statements with their operands in the plainest form.
std::vector<std::string> statements(const std::string& text) {
  SourceText source = file(text);
  EXPECT_TRUE(convert(source.parsed, Notation::Iec))
      << render(source.parsed.diagnostics, source.parsed.source, false) << text;
  std::vector<std::string> all;
  for (const stl::Line& line : source.parsed.source.lines) {
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement) continue;
    all.push_back(statement->mnemonic);
    for (stl::Operand operand : statement->operands) {
      operand.symbol.clear();
      if (auto* constant = std::get_if<stl::Integer>(&operand.value)) *constant = {constant->value};
      all.back() += " " + to_text(operand);
    }
  }
  return all;
}

/// Operands as a rule allows them, in all its forms.
std::vector<std::string> examples(const OperandRule& rule) {
  if (rule.kind != OperandKind::Memory) return {"0"};
  std::vector<std::string> all;
  for (const AreaInfo& area : all_areas()) {
    if (!contains(rule.areas, area.area)) continue;
    const std::string name(area.name);
    if (area.element != 0)
      all.push_back(name + "1");
    else if (area.area == Area::AI || area.area == Area::AQ)
      all.push_back(name + "W4");
    else if (rule.width == Width::Bit)
      all.push_back(name + "4.3");
    else
      all.push_back(name + (rule.width == Width::Byte ? "B4" : rule.width == Width::Word ? "W4" : "D4"));
  }
  if (rule.pointer) all.insert(all.end(), {"*VD8", "*AC1"});
  if (rule.address_of) all.insert(all.end(), {"&VB8", "&IB1"});
  if (rule.constant && rule.real) all.insert(all.end(), {"1.5", "-2E10"});
  if (rule.constant && !rule.real) all.insert(all.end(), {"1", "16#2", "2#11"});
  if (rule.constant && !rule.real && rule.width == Width::Byte) all.push_back("'A'");
  return all;
}

constexpr Notation kAll[] = {Notation::Iec, Notation::MicroDos, Notation::MicroWin, Notation::German};

TEST(Convert, EveryInstructionReadsBackFromEveryNotation) {
  for (const Instruction& instruction : all_instructions()) {
    std::string listing;
    const auto rules = instruction.rules();
    if (instruction.mnemonic == "SBR" || instruction.mnemonic == "INT") continue;  // see the whole programs below
    if (rules.empty()) listing += fmt::format("{}\n", instruction.mnemonic);
    for (std::size_t varied = 0; varied < rules.size(); ++varied) {
      for (const std::string& example : examples(rules[varied])) {
        listing += instruction.mnemonic;
        for (std::size_t i = 0; i < rules.size(); ++i)
          listing += (i == 0 ? " " : ", ") + (i == varied ? example : examples(rules[i]).front());
        listing += "\n";
      }
    }
    const bool ends = instruction.mnemonic == "MEND" || instruction.mnemonic == "RET" || instruction.mnemonic == "RETI";
    const std::string text = ends ? "LD SM0.0\nMEND\nSBR 0\nRET\nINT 0\nRETI\n" : "LD SM0.0\n" + listing + "MEND\n";
    for (const Notation notation : kAll)
      EXPECT_EQ(statements(printed(text, notation)), statements(text)) << name_of(notation) << "\n"
                                                                       << printed(text, notation);
  }
}

constexpr const char* kProgram =
    "NETWORK 1 // first\nLD SM0.1 // once\nCALL 3\nATCH 7, 10\nMEND // done\nNETWORK 2 // work\nSBR 3 // What it does\nLD "
    "I0.0\n"
    "AN Q1.1\nMOVW 16#41, *AC1\nMOVB 'A', VB0\nRET\nINT 7\nLDW>= C4, -5\nJMP 1\nLBL 1\nRETI\n";

TEST(Convert, WholeProgramsReadBackFromEveryNotation) {
  for (const Notation from : kAll)
    for (const Notation to : kAll)
      EXPECT_EQ(statements(printed(printed(kProgram, from), to)), statements(kProgram))
          << name_of(from) << " " << name_of(to);
}

TEST(Convert, MicroWinHasBlocksWithTheTitlesOfTheirHeads) {
  const std::string text = printed(kProgram, Notation::MicroWin);
  EXPECT_EQ(
      text.substr(0, text.find("END_SUBROUTINE_BLOCK")),
      "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=\nBEGIN\nNETWORK 1 // first\nLD      SM0.1                   // once\n"
      "CALL    SBR_3\nATCH    INT_7, 10\n// done\nEND_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK SBR_3:SBR3\nTITLE=What it does\n"
      "BEGIN\nNETWORK 2 // work\nLD      I0.0\nAN      Q1.1\nMOVW    16#41, *AC1\nMOVB    'A', VB0\n");
}

TEST(Convert, MicroDosWritesConstantsWithKButNotLabelsAndRoutines) {
  const std::string text = printed(kProgram, Notation::MicroDos);
  for (const char* line : {"CALL    3\n", "ATCH    K7, K10\n", "MOVW    KH41, *AC1\n", "MOVB    KH41, VB0\n",
                           "LDW>=   C4, K-5\n", "LBL     1\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST(Convert, GermanLettersAndU) {
  const std::string text =
      printed("LD I0.0\nAN Q1.1\nALD\nAW>= AIW4, C4\nMOVD HC0, AC1\nATCH 7, 10\n= M0.0\nMEND\n", Notation::German);
  for (const char* line :
       {"LD      E0.0\n", "UN      A1.1\n", "ULD\n", "UW>=    AEW4, Z4\n", "MOVD    HZ0, AC1\n", "ATCH    7, 10\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

constexpr const char* kExport =
    "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=A test\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL \"Do it\", VW0, "
    "M0.0\nEND_ORGANIZATION_BLOCK\n"
    "SUBROUTINE_BLOCK \"Do it\":SBR2\nTITLE=Work\nVAR_INPUT\n x : INT; // in\nEND_VAR\nVAR_OUTPUT\n ok : "
    "BOOL;\nEND_VAR\nBEGIN\n"
    "NETWORK 1\nLDW>= #x, 0\n= #ok\nEND_SUBROUTINE_BLOCK\nDATA_BLOCK DB1\nVB0 1, 'ab', \"c\"\n 5\nVD10 "
    "1.5\nEND_DATA_BLOCK\n";

TEST(Convert, AnExportKeepsItsNamesVariablesAndData) {
  const std::string once = printed(kExport, Notation::MicroWin);
  EXPECT_EQ(printed(once, Notation::MicroWin), once);
  for (const char* part : {"CALL    \"Do it\", VW0, M0.0\n", "VAR_INPUT\n x : INT;  // in\nEND_VAR\n", "TITLE=Work\n",
                           "LDW>=   #x, 0\n", "VB0 1, 16#61, 16#62, 16#1, 16#63\n"})
    EXPECT_NE(once.find(part), std::string::npos) << part << once;
}

TEST(Convert, ParametersHaveNoNotationOutsideOfBlocks) {
  SourceText source = file(kExport);
  EXPECT_FALSE(convert(source.parsed, Notation::Iec));
  EXPECT_EQ(source.parsed.diagnostics.at(0).message, "parameters of CALL have no notation outside of blocks");
}

TEST(Convert, ARoutineOfALibraryIsSaidToNeedANotationWithBlocks) {
  for (const std::string call : {"CALL MBUS_SLAVE, M0.2, MB2", "CALL USS_INIT, 1, 9600, 16#1, M0.0, VB0"}) {
    for (const Notation notation : {Notation::Iec, Notation::MicroDos, Notation::German}) {
      SourceText source =
          file("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\n" + call + "\nEND_ORGANIZATION_BLOCK\n");
      EXPECT_FALSE(convert(source.parsed, notation));
      ASSERT_EQ(source.parsed.diagnostics.size(), 1U);
      EXPECT_NE(source.parsed.diagnostics[0].message.find(" is a routine of a library: "), std::string::npos);
      EXPECT_EQ(source.parsed.diagnostics[0].hint, "use --to microwin: Micro/WIN has the library");
    }
    EXPECT_NE(printed("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\n" + call + "\nEND_ORGANIZATION_BLOCK\n",
                      Notation::MicroWin)
                  .find(call.substr(5)),
              std::string::npos);
  }
}

/// A routine begins with 1 on the logic stack, and a network of Micro/WIN with none.
TEST(Convert, ARoutineThatBeginsWithoutAContactHasNoNetworkOfMicroWin) {
  constexpr std::string_view kListing = "LD SM0.1\nCALL 1\nMEND\nSBR 1\nINCW VW2\nRET\n";
  SourceText source = file(std::string(kListing));
  EXPECT_FALSE(convert(source.parsed, Notation::MicroWin));
  ASSERT_EQ(source.parsed.diagnostics.size(), 1U);
  EXPECT_EQ(source.parsed.diagnostics[0].message,
            "INCW stands first in its routine: a network of Micro/WIN begins with a contact");
  EXPECT_NE(printed(std::string(kListing), Notation::Iec).find("INCW"), std::string::npos);
}

TEST(Convert, UndefinedNamesAreNotPrinted) {
  SourceText source = file("LD Pump\n= Q0.0\nMEND\n");
  EXPECT_FALSE(convert(source.parsed, Notation::MicroWin));
}

TEST(Convert, CommentsOfADataBlockStay) {
  SourceText source = join_files({file("LD SM0.0\nMOVB VB0, VB9\nMEND\n"), file("// speeds\nVB0 1, 2  // slow\nVB2 3\n")});
  const auto text = convert(source.parsed, Notation::MicroWin);
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("DATA_BLOCK DB1:DB1\nBEGIN\n// speeds\nVB0 1, 2  // slow\nVB2 3\nEND_DATA_BLOCK\n"),
            std::string::npos)
      << *text;
}

TEST(Convert, TheCommentOfABlockStandsBetweenItsTitleAndBegin) {
  EXPECT_EQ(printed("// what it does\nNETWORK 1\nLD SM0.0\n= M0.0\nMEND\n", Notation::MicroWin),
            "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=\n// what it does\nBEGIN\nNETWORK 1\nLD      SM0.0\n=       M0.0\n"
            "END_ORGANIZATION_BLOCK\n");
}

TEST(Convert, AListingWithoutNetworksBecomesOneNetworkOfItsBlock) {
  EXPECT_EQ(printed("LD SM0.0\n= M0.0\nMEND\n", Notation::MicroWin),
            "ORGANIZATION_BLOCK MAIN:OB1\nTITLE=\nBEGIN\nNETWORK 1\nLD      SM0.0\n=       M0.0\nEND_ORGANIZATION_BLOCK\n");
}

TEST(Convert, NamesThatAListingWouldTakeForSomethingElseAreQuoted) {
  const std::string text = printed(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL \"K1\"\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK \"K1\":SBR3\nBEGIN\nNETWORK 1\nLD SM0.0\n= M0.0\nEND_SUBROUTINE_BLOCK\n",
      Notation::MicroWin);
  EXPECT_NE(text.find("CALL    \"K1\""), std::string::npos) << text;
}

TEST(Convert, TextsOfStringInstructionsAreNoNames) {
  const std::string text = "NETWORK 1\nLD SM0.1\nSCPY \"HELLO\", VB300\nMEND\n";
  EXPECT_NE(printed(text, Notation::Iec).find("\"HELLO\", VB300"), std::string::npos);
  EXPECT_NE(printed(text, Notation::MicroWin).find("\"HELLO\", VB300"), std::string::npos);
}

TEST(Convert, KeepsNamesAmongBlocksAndTheirTable) {
  std::vector<SourceText> files;
  files.push_back(*read_source("LD Button\nA \"Level low\"\n= Lamp\nMOVD &Table, VD20\nMEND\n", "p.stl"));
  files.push_back(*read_source(
      "Symbol\tAddress\tComment\nButton\tI0.0\tgreen\nLamp\tQ0.1\t\nLevel low\tI0.2\t\nTable\tVB100\t\n", "s.txt"));
  SourceText project = join_files(std::move(files));
  const auto text = convert(project.parsed, Notation::MicroWin);
  ASSERT_TRUE(text);
  for (const char* line : {"LD      Button\n", "A       \"Level low\"\n", "=       Lamp\n", "MOVD    &Table, VD20\n"})
    EXPECT_NE(text->find(line), std::string::npos) << line << *text;
  EXPECT_EQ(symbol_table_text(project.parsed.source),
            "Symbol\tAddress\tComment\nButton\tI0.0\tgreen\nLamp\tQ0.1\t\nLevel low\tI0.2\t\nTable\tVB100\t\n");
  const auto listing = convert(project.parsed, Notation::Iec);
  ASSERT_TRUE(listing);
  EXPECT_NE(listing->find("LD      I0.0\n"), std::string::npos) << *listing;
}

TEST(Convert, MicroWinTableHasTheNamesWithTheirAddressesInTheText) {
  stl::ParseResult parsed = read_source(
                                "LD Always_On:SM0.0\nA Start:I0.0\n= Lamp:Q0.0\nMOVD &Table:VB100, Next:VD20\n"
                                "S Lamp:Q0.0, \"Two of them\":2\nMEND\n",
                                "plant.stl")
                                ->parsed;
  ASSERT_TRUE(convert(parsed, Notation::MicroWin)) << parsed.diagnostics.front().message;
  EXPECT_EQ(symbol_table_text(parsed.source),
            "Symbol\tAddress\tComment\nStart\tI0.0\t\nLamp\tQ0.0\t\nTable\tVB100\t\nNext\tVD20\t\nTwo of them\t2\t\n");
}

}  // namespace
}  // namespace s7200::convert_test
