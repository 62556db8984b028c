#include "interpreter/stl/parser.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace s7200::stl::parser_test {
namespace {

const Statement& only_statement(const ParseResult& result) {
  static const Statement none{};
  EXPECT_TRUE(result.diagnostics.empty()) << result.diagnostics.front().message;
  if (result.source.lines.size() != 1 || !std::holds_alternative<Statement>(result.source.lines.front())) {
    ADD_FAILURE() << "not one statement";
    return none;
  }
  return std::get<Statement>(result.source.lines.front());
}

Statement statement(std::string_view line) {
  SCOPED_TRACE(std::string(line));
  return only_statement(parse(line, "test.stl"));
}

OperandValue operand(std::string_view text) {
  const Statement one = statement(std::string("X ").append(text));
  EXPECT_EQ(one.operands.size(), 1U) << text;
  return one.operands.empty() ? OperandValue{} : one.operands.front().value;
}

Diagnostic error(std::string_view line) {
  const ParseResult result = parse(line, "test.stl");
  EXPECT_EQ(result.diagnostics.size(), 1U) << line;
  EXPECT_TRUE(result.source.lines.empty()) << line;
  return result.diagnostics.empty() ? Diagnostic{} : result.diagnostics.front();
}

OperandValue integer(std::int64_t value, Integer::Form form = Integer::Form::Decimal, std::uint8_t characters = 0) {
  return Integer{value, form, characters};
}

using enum Integer::Form;

TEST(Parser, ReadsMnemonicsOfEveryShapeInAnyCase) {
  for (const char* mnemonic : {"LD", "LDW>=", "AB=", "OD<>", "LDNI", "+I", "-D", "*R", "/R", "=", "=I", "FND<>",
                               "FND=", "ROL", "TON", "LDB<=", "MUL", "R", "ADW<"}) {
    EXPECT_EQ(statement(std::string(mnemonic) + " VW0").mnemonic, mnemonic);
  }
  EXPECT_EQ(statement("movw 1, vw0").mnemonic, "MOVW");
  EXPECT_EQ(statement("Ldw>=\tvw0,vw2").mnemonic, "LDW>=");
}

TEST(Parser, SeparatesOperandsByCommasOrBlanksOrTabs) {
  for (const char* line : {"OW>= \tVW8, 126", "OW>= VW8 126", "OW>=VW8,126", "\tOW>=\tVW8 ,\t126 ;", "OW>=   VW8\t126;"}) {
    const Statement one = statement(line);
    ASSERT_EQ(one.operands.size(), 2U) << line;
    EXPECT_EQ(one.operands[0].value, OperandValue(Address{"V", Size::Word, 8, 0})) << line;
    EXPECT_EQ(one.operands[1].value, integer(126)) << line;
  }
}

TEST(Parser, AssignmentNeedsNoBlankAndDiffersFromImmediateAssignment) {
  EXPECT_EQ(statement("=Q0.0").mnemonic, "=");
  EXPECT_EQ(statement("= Q0.0").mnemonic, "=");
  EXPECT_EQ(statement("=I Q0.0").mnemonic, "=I");
  EXPECT_EQ(statement("=I0.0").mnemonic, "=");
}

TEST(Parser, ReadsConstantsOfEveryNotation) {
  EXPECT_EQ(operand("65"), integer(65));
  EXPECT_EQ(operand("+1000"), integer(1000));
  EXPECT_EQ(operand("-5"), integer(-5));
  EXPECT_EQ(operand("16#FF"), integer(255, Hex));
  EXPECT_EQ(operand("16#ffff_FFFF"), integer(0xFFFFFFFF, Hex));
  EXPECT_EQ(operand("2#1010_0001"), integer(0xA1, Binary));
  EXPECT_EQ(operand("-2147483648"), integer(-2147483648LL));
  EXPECT_EQ(operand("4294967295"), integer(4294967295LL));
  EXPECT_EQ(operand("1.5"), OperandValue(Real{1.5F}));
  EXPECT_EQ(operand("-3.5E+4"), OperandValue(Real{-35000.0F}));
  EXPECT_EQ(operand("10E3"), OperandValue(Real{10000.0F}));
  EXPECT_EQ(operand("+0.25e-1"), OperandValue(Real{0.025F}));
}

TEST(Parser, ReadsAsciiConstantsWithEscapes) {
  EXPECT_EQ(operand("'A'"), integer('A', Ascii, 1));
  EXPECT_EQ(operand("'AB'"), integer(0x4142, Ascii, 2));
  EXPECT_EQ(operand("'//12'"), integer(0x2F2F3132, Ascii, 4));
  EXPECT_EQ(operand("'$$$''"), integer(0x2427, Ascii, 2));
  EXPECT_EQ(operand("'$R$L'"), integer(0x0D0A, Ascii, 2));
  EXPECT_EQ(operand("'$7F'"), integer(0x7F, Ascii, 1));
}

TEST(Parser, ReadsMicroDosConstants) {
  EXPECT_EQ(operand("K4"), integer(4));
  EXPECT_EQ(operand("K-5"), integer(-5));
  EXPECT_EQ(operand("KHFF"), integer(255, Hex));
  EXPECT_EQ(operand("kh08000000"), integer(0x08000000, Hex));
  EXPECT_EQ(operand("Kessel"), OperandValue(Name{"Kessel"}));
}

TEST(Parser, RefusesUnknownMicroDosPrefixesByName) {
  EXPECT_EQ(error("MOVB KB5, VB0").message, "a constant cannot begin with KB");
  EXPECT_EQ(error("MOVB KW-5, VB0").message, "a constant cannot begin with KW");
}

TEST(Parser, SizePrefixesLimitTheConstant) {
  EXPECT_EQ(operand("B#16#FF"), integer(255, Hex));
  EXPECT_EQ(operand("WORD#-1"), integer(-1));
  EXPECT_EQ(operand("dw#2#1"), integer(1, Binary));
  EXPECT_EQ(error("X BYTE#256").message, "BYTE#256 does not fit in a byte");
  EXPECT_EQ(error("X W#16#10000").message, "W#16#10000 does not fit in a word");
}

TEST(Parser, ReadsAddressesOfEveryArea) {
  EXPECT_EQ(operand("I0.3"), OperandValue(Address{"I", Size::Bit, 0, 3}));
  EXPECT_EQ(operand("m31.7"), OperandValue(Address{"M", Size::Bit, 31, 7}));
  EXPECT_EQ(operand("VX10.3"), OperandValue(Address{"V", Size::Bit, 10, 3}));
  EXPECT_EQ(operand("SM0.1"), OperandValue(Address{"SM", Size::Bit, 0, 1}));
  EXPECT_EQ(operand("SMB30"), OperandValue(Address{"SM", Size::Byte, 30, 0}));
  EXPECT_EQ(operand("SW2"), OperandValue(Address{"S", Size::Word, 2, 0}));
  EXPECT_EQ(operand("LD4"), OperandValue(Address{"L", Size::Double, 4, 0}));
  EXPECT_EQ(operand("DBW10"), OperandValue(Address{"V", Size::Word, 10, 0}));
  EXPECT_EQ(operand("AIW4"), OperandValue(Address{"AI", Size::Word, 4, 0}));
  EXPECT_EQ(operand("AQ4"), OperandValue(Address{"AQ", Size::Word, 4, 0}));
  EXPECT_EQ(operand("T33"), OperandValue(Address{"T", Size::None, 33, 0}));
  EXPECT_EQ(operand("C4"), OperandValue(Address{"C", Size::None, 4, 0}));
  EXPECT_EQ(operand("HC0"), OperandValue(Address{"HC", Size::None, 0, 0}));
  EXPECT_EQ(operand("AC0"), OperandValue(Address{"AC", Size::None, 0, 0}));
  EXPECT_EQ(operand("ACW3"), OperandValue(Address{"AC", Size::Word, 3, 0}));
  EXPECT_EQ(operand("&VB100"), OperandValue(AddressOf{{"V", Size::Byte, 100, 0}}));
  EXPECT_EQ(operand("*VD100"), OperandValue(Indirect{{"V", Size::Double, 100, 0}}));
  EXPECT_EQ(operand("*AC1"), OperandValue(Indirect{{"AC", Size::None, 1, 0}}));
}

TEST(Parser, KeepsSymbolsAsNames) {
  for (const char* name : {"\"Start\"", "\"Pump 1 // left\"", "#count", "Motor_On", "*#next", "Störung", "電動機",
                           "SBR_0:SBR0", "V", "VB", "Table1"}) {
    EXPECT_EQ(operand(name), OperandValue(Name{name}));
  }
}

TEST(Parser, RefusesGermanAddressesWithTheInternationalOne) {
  const auto hint = [](const char* line) { return parse(line, "x").diagnostics.at(0).hint; };
  EXPECT_EQ(hint("LD E0.1"), "write I0.1");
  EXPECT_EQ(hint("MOVB *AB5, VB0"), "write *QB5");
  EXPECT_EQ(hint("MOVW AEW4, VW0"), "write AIW4");
  EXPECT_EQ(hint("LD Z4"), "write C4");
  EXPECT_EQ(hint("MOVD HZ0, VD0"), "write HC0");
  EXPECT_EQ(statement("A I0.0").mnemonic, "A");
}

TEST(Parser, ReadsPastGermanAddressesSoThatTheRestOfTheLineIsCheckedToo) {
  const ParseResult result = parse("UN E0.1\nMOVW AEW4, VB0.9\n", "x");
  ASSERT_EQ(result.diagnostics.size(), 3U);
  EXPECT_EQ(result.diagnostics[0].cause, result.diagnostics[1].cause);
  EXPECT_EQ(result.diagnostics[2].message, "VB0.9 has a bit number, but VB0 is a byte");
  ASSERT_EQ(result.source.lines.size(), 1U);
  EXPECT_EQ(std::get<Statement>(result.source.lines[0]).operands[0].value, OperandValue(Address{"I", Size::Bit, 0, 1}));
}

TEST(Parser, PointsAtTheErrorInCharacters) {
  const ParseResult result = parse("LD \"Tür\" I0.9", "x");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics.front().position, (Position{1, 13, 1}));
  EXPECT_EQ(error("\tMOVW\t65, ").position, (Position{1, 11, 1}));
  EXPECT_EQ(error("MOVB 99999999999999999999, VB0").position, (Position{1, 6, 20}));
}

TEST(Parser, ABitNumberIsOnlyForBytes) {
  EXPECT_EQ(error("LD T37.0").message, "T37.0 has a bit number, but T37 is itself the bit of the timer");
  EXPECT_EQ(error("LD T37.9").hint, "write T37");
  EXPECT_EQ(error("AN C5.3").hint, "write C5");
  EXPECT_EQ(error("LD AC0.3").message, "AC0.3 has a bit number, but AC0 is an accumulator");
  EXPECT_EQ(error("LD HC0.1").hint, "bits are of bytes: move it first, MOVD HC0, VD100");
  EXPECT_EQ(error("LD AI2.1").message, "AI2.1 has a bit number, but AIW2 is a word");
  EXPECT_EQ(error("LD AIW2.1").hint, "bits are of bytes: move it first, MOVW AIW2, VW100");
  EXPECT_EQ(error("= AQW2.1").message, "AQW2.1 has a bit number, but AQW2 is a word");
  EXPECT_EQ(error("LD T37.Q").hint, "a bit is written V10.3; a timer or counter is itself a bit, T37 or C5");
}

TEST(Parser, TheTimeOfAPresetIsANumberOfSteps) {
  const std::string steps =
      "the preset of a timer is a number of its steps: 100 ms are 10 of a timer of 10 ms, 1 of one of 100 ms";
  EXPECT_EQ(error("TON T37, 100ms").hint, steps);
  EXPECT_EQ(error("TON T37, 5s // later").hint, steps);
  for (const char* preset : {"T#100ms", "T#5s", "t#1m", "S5T#2S", "TIME#100ms"}) {
    const Diagnostic found = error(std::string("TON T37, ") + preset);
    EXPECT_EQ(found.message, std::string(preset) + " is a time");
    EXPECT_EQ(found.hint, steps);
  }
  EXPECT_EQ(error("MOVW 65x, VW0").hint, "constants are written 65, 16#FF, 2#1010, 1.5 or 'AB'");
}

TEST(Parser, AHeadingInAnotherLanguageIsNamed) {
  for (const char* heading : {"RÉSEAU 1", "Réseau 2 // pompe", "СЕТЬ 1", "网络 1"}) {
    const Diagnostic found = error(heading);
    EXPECT_TRUE(found.message.ends_with(" is the heading of a network in another language")) << found.message;
    EXPECT_EQ(found.hint, "write NETWORK");
    EXPECT_EQ(found.position.column, 1U);
  }
}

TEST(Parser, AHeadingOfARoutineInAnotherLanguageIsNamed) {
  for (const char* heading : {"NETZWERK 1: Start", "Netzwerk 2 - Zeit", "Segmento 3: marcha"})
    EXPECT_TRUE(error(heading).message.ends_with(" is the heading of a network in another language")) << heading;
  EXPECT_EQ(error("Sous-programme Pompe").hint, "write SBR_0 for subroutine 0");
  EXPECT_EQ(error("PROGRAMME D'INTERRUPTION Pompe").hint, "write INT_0 for interrupt routine 0");
  EXPECT_EQ(error("网络1：初始化").message, "网络 is the heading of a network in another language");
  EXPECT_EQ(error("主程序：").message, "主程序 is the heading of the main program in another language");
  EXPECT_EQ(error("中断程序说明").hint, "write INT_0 for interrupt routine 0");
}

TEST(Parser, TheTitleOfANetworkIsAComment) {
  const std::string hint = "a title is written as a comment: NETWORK 1 // title";
  for (const char* line : {"NETWORK 1 - Start", "Network 2 : stop/start", "NETWORK 3 pump on"}) {
    EXPECT_EQ(error(line).message, "NETWORK takes a number and nothing else") << line;
    EXPECT_EQ(error(line).hint, hint) << line;
  }
  EXPECT_EQ(error("NETWORK l").message, "l has the letter l in place of the digit 1");
}

TEST(Parser, AnAssignmentIsNamed) {
  for (const char* line : {"Motor = Q0.0", "Motor := I0.3", "Q0.1 = I0.0", "VW2:=VW0", "\"Motor\" = Q0.0"}) {
    const Diagnostic found = error(line);
    EXPECT_EQ(found.message, std::string(line) + " is an assignment");
    EXPECT_EQ(found.position.column, 1U);
  }
  EXPECT_EQ(error("NOT = Q0.0").message, "two statements in one line");
}

TEST(Parser, AComparisonIsOneWord) {
  EXPECT_EQ(error("CMP_I >= VW20, 5").hint, "a comparison is one word: LDW>= VW0, 5, AB= VB0, 1, OD< VD0, VD4");
}

TEST(Parser, TheBitOfAWordIsThatOfItsByte) {
  EXPECT_EQ(error("LD VB10.3").hint, "its bit 3 is V10.3");
  EXPECT_EQ(error("LD VW10.3").hint, "its bit 3 is V11.3");
  EXPECT_EQ(error("LD SMW22.12").hint, "its bit 12 is SM22.4");
  EXPECT_EQ(error("LD SW2.15").hint, "its bit 15 is S2.7");
  EXPECT_EQ(error("LD VD10.0").hint, "its bit 0 is V13.0");
  EXPECT_EQ(error("LD VD10.31").hint, "its bit 31 is V10.7");
  EXPECT_EQ(error("LD VD10.32").hint, "it has bits 0 to 31");
  EXPECT_EQ(error("MOVB *VD10.3, VB0").message, "*VD10.3 has a bit number, but VD10 is a double word");
}

TEST(Parser, RefusesWhatDoesNotBelongInAStatement) {
  EXPECT_EQ(error("65, VW0").message, "expected a mnemonic, found '6'");
  EXPECT_EQ(error("MOVW 65,").message, "expected an operand, found the end of the line");
  EXPECT_EQ(error("MOVW 65,, VW0").message, "expected an operand, found ','");
  EXPECT_EQ(error("LD I0.").message, "expected a bit number, found the end of the line");
  EXPECT_EQ(error("LD I0.8").message, "the bits of a byte are 0 to 7");
  EXPECT_EQ(error("LD I0.300").message, "the bits of a byte are 0 to 7");
  EXPECT_EQ(error("LD VX10").message, "VX10 has no bit number");
  EXPECT_EQ(error("X 16#").message, "expected hexadecimal digits, found the end of the line");
  EXPECT_EQ(error("X 2#12").message, "expected the end of the constant, found '2'");
  EXPECT_EQ(error("X 65x").message, "expected the end of the constant, found 'x'");
  EXPECT_EQ(error("X 'ABC'").message, "an ASCII constant cannot have 3 characters");
  EXPECT_EQ(error("X 'AB").message, "expected a closing quote, found the end of the line");
  EXPECT_EQ(error("X '$q'").message, "'$' is not allowed in an ASCII constant");
  EXPECT_EQ(error("X '中'").message, "'中' (U+4E2D) is not allowed in an ASCII constant");
  EXPECT_EQ(error("X 1E99").message, "1E99 does not fit in a 32-bit real");
  EXPECT_EQ(error("X 1E-40").message, "1E-40 does not fit in a 32-bit real");
  EXPECT_EQ(error("X VB4294967296").message, "the number of this address is too large");
  EXPECT_EQ(error("LD I0.0 ! x").message, "unexpected '!'");
  EXPECT_EQ(error("LD\u00A0I0.0").message, "unexpected '\u00A0' (U+00A0)");
}

TEST(Parser, IntegersThatDoNotFitInADoubleWordAreErrors) {
  EXPECT_EQ(error("X 16#1FFFFFFFF").message, "16#1FFFFFFFF does not fit in 32 bits");
  EXPECT_EQ(error("X 99999999999999999999").message, "99999999999999999999 does not fit in 32 bits");
  EXPECT_EQ(error("X -2147483649").message, "-2147483649 does not fit in 32 bits");
  EXPECT_EQ(error("X KH100000000").message, "KH100000000 does not fit in 32 bits");
}

TEST(Parser, ReportsEveryErrorOfAFileInOneRun) {
  const ParseResult result = parse("LD I0.8\nLD I0.0\nMOVW 1,\n!\nMOVW I0.8 I0.9\n= Q0.0", "x");
  EXPECT_EQ(result.diagnostics.size(), 5U);
  EXPECT_EQ(result.source.lines.size(), 2U);
}

TEST(Parser, SaysHowManyErrorsOfALineItLeftOut) {
  std::string line = "X";
  for (int i = 0; i < 100; ++i) line += " I0.9";
  const ParseResult result = parse(line, "x");
  ASSERT_EQ(result.diagnostics.size(), 11U);
  EXPECT_EQ(result.diagnostics.back().message, "90 more errors in this line");
}

TEST(Parser, ReadsNetworkHeads) {
  const ParseResult result = parse("NETWORK\nNETWORK 3\nNetwork 4 // lamp \nNETWORK K5;", "x");
  ASSERT_TRUE(result.diagnostics.empty());
  ASSERT_EQ(result.source.lines.size(), 4U);
  const auto head = [&](std::size_t i) { return std::get<NetworkHead>(result.source.lines[i]); };
  EXPECT_EQ(head(0).number, 0U);
  EXPECT_EQ(head(1).number, 3U);
  EXPECT_EQ(head(2).number, 4U);
  EXPECT_EQ(head(2).comment, " lamp");
  EXPECT_EQ(head(3).number, 5U);
  EXPECT_EQ(error("NETWORK 1 Lamp").hint, "a title is written as a comment: NETWORK 1 // title");
}

TEST(Parser, KeepsCommentsAndBlankLines) {
  const ParseResult result = parse("// über \n\nNOT// else\n;\n", "x");
  ASSERT_EQ(result.source.lines.size(), 4U);
  EXPECT_EQ(std::get<CommentLine>(result.source.lines[0]).text, " über");
  EXPECT_EQ(std::get<BlankLine>(result.source.lines[1]).line, 2U);
  EXPECT_EQ(std::get<Statement>(result.source.lines[2]).comment, " else");
  EXPECT_TRUE(std::holds_alternative<BlankLine>(result.source.lines[3]));
}

TEST(Parser, AcceptsEveryLineEnd) {
  const ParseResult result = parse("NOT\r\nNOT\rNOT\nNOT", "x");
  ASSERT_EQ(result.source.text.size(), 4U);
  EXPECT_EQ(std::get<Statement>(result.source.lines[3]).position.line, 4U);
}

TEST(Parser, RefusesBlockKeywordsOutsideOfAnExport) {
  const ParseResult result = parse("TITLE=A title, with 'words\nVAR\n count : INT; // n\nEND_VAR\nBEGIN\nLD I0.0\n", "x");
  EXPECT_EQ(result.diagnostics.size(), 4U);
  for (const Diagnostic& diagnostic : result.diagnostics) {
    EXPECT_NE(diagnostic.message.find("belongs to the head of a block"), std::string::npos) << diagnostic.message;
  }
  EXPECT_EQ(result.source.lines.size(), 1U);
}

TEST(Parser, ReadsTheAddressThatStandsBesideASymbol) {
  const auto beside = [](const char* text) { return statement(std::string("LD ") + text).operands.at(0); };
  EXPECT_EQ(beside("\"Pump 1\":Q0.0").value, OperandValue(Address{"Q", Size::Bit, 0, 0}));
  EXPECT_EQ(beside("\"Pump 1\":Q0.0").symbol, "\"Pump 1\"");
  EXPECT_EQ(beside("#ptr:LD4").value, OperandValue(Address{"L", Size::Double, 4, 0}));
  EXPECT_EQ(beside("*#ptr:*LD4").value, OperandValue(Indirect{{"L", Size::Double, 4, 0}}));
  EXPECT_EQ(beside("*#ptr:LD4").value, OperandValue(Indirect{{"L", Size::Double, 4, 0}}));
  EXPECT_EQ(beside("&table:VB10").value, OperandValue(AddressOf{{"V", Size::Byte, 10, 0}}));
  EXPECT_EQ(beside("SBR_0:SBR0").value, OperandValue(Name{"SBR_0:SBR0"}));
  EXPECT_EQ(error("LD level:I0.9").message, "the bits of a byte are 0 to 7");
}

TEST(Parser, ReadsTheConstantThatStandsBesideASymbol) {
  const auto beside = [](const char* text) { return statement(std::string("MOVW ") + text + ", VW0").operands.at(0); };
  EXPECT_EQ(beside("Request_Error:4").value, statement("MOVW 4, VW0").operands.at(0).value);
  EXPECT_EQ(beside("Request_Error:4").symbol, "Request_Error");
  EXPECT_EQ(beside("\"Mask 1\":16#FF").value, statement("MOVW 16#FF, VW0").operands.at(0).value);
  EXPECT_EQ(beside("#low:-5").value, statement("MOVW -5, VW0").operands.at(0).value);
}

TEST(Parser, ReadsOneOperandByItself) {
  EXPECT_EQ(parse_operand("VB10")->value, OperandValue(Address{"V", Size::Byte, 10, 0}));
  EXPECT_EQ(parse_operand("A0.1")->value, OperandValue(Address{"Q", Size::Bit, 0, 1}));
  EXPECT_EQ(parse_operand("16#FF")->value, OperandValue(Integer{255, Integer::Form::Hex, 0}));
  EXPECT_FALSE(parse_operand("VB10 "));
  EXPECT_FALSE(parse_operand(""));
  EXPECT_EQ(parse_operand("I0.9").why(), "the bits of a byte are 0 to 7");
}

TEST(Parser, TakesTimeInProportionToTheText) {
  std::string wide = "X ";
  while (wide.size() < 1'000'000) wide += "99999999999,VW1 ";
  EXPECT_EQ(parse(wide, "x").diagnostics.size(), 11U);
  EXPECT_EQ(parse(std::string(1'000'000, ' ') + "!", "x").diagnostics.size(), 1U);
  EXPECT_EQ(parse(std::string(1'000'000, 'A'), "x").source.lines.size(), 1U);
  EXPECT_EQ(parse("X '" + std::string(1'000'000, '$'), "x").diagnostics.size(), 1U);

  std::string errors;
  for (int i = 0; i < 100'000; ++i) errors += "LD I0.9\n";
  EXPECT_EQ(parse(errors, "x").diagnostics.size(), 100'000U);
  EXPECT_TRUE(parse("", "x").source.lines.empty());
}

TEST(Parser, SurvivesBytesThatAreNotText) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) {
    for (int j = 0; j < 256; ++j) {
      bytes += "LD ";
      bytes += static_cast<char>(i);
      bytes += static_cast<char>(j);
      bytes += '\n';
    }
  }
  const ParseResult result = parse(bytes, "x");
  EXPECT_FALSE(result.diagnostics.empty());
}

TEST(Parser, LettersBeyondAsciiHaveTheirBytesInWindows1252) {
  EXPECT_EQ(parse_characters("F\u00FCll \u20AC"), "F\xFCll \x80");
  std::string why = parse_characters("\u4E2D").why();
  EXPECT_NE(why.find("U+4E2D"), std::string::npos) << why;
}

// --- statements in several lines, and several in one ---

TEST(Parser, AStatementGoesOnAfterAComma) {
  const ParseResult result =
      parse("CALL Scale, VW0, // in\n     10,\n     #out // end\n  MOVB 1,\n VB99 ;\nALD\n", "test.stl");
  ASSERT_TRUE(result.diagnostics.empty()) << result.diagnostics.front().message;
  ASSERT_EQ(result.source.lines.size(), 3U);
  const auto& call = std::get<Statement>(result.source.lines[0]);
  ASSERT_EQ(call.operands.size(), 4U);
  EXPECT_EQ(call.comment, " in end");
  EXPECT_EQ(call.operands[1].position, (Position{1, 13, 3}));
  EXPECT_EQ(call.operands[2].position, (Position{2, 6, 2}));
  EXPECT_EQ(call.operands[3].position, (Position{3, 6, 4}));
  EXPECT_EQ(std::get<Statement>(result.source.lines[1]).operands[1].position, (Position{5, 2, 4}));
  EXPECT_EQ(std::get<Statement>(result.source.lines[2]).position, (Position{6, 1, 3}));
}

TEST(Parser, ACallGoesOnWithoutACommaWhereALineBeginsWithAnOperand) {
  for (const char* text : {"CALL Scale\n  VW0\n  10\n  #out\nENI\n", "CALL Scale, VW0\n  , 10\n  , Output\nENI\n",
                           "CALL Scale VW0, 10\n  VW2 ;\nENI\n"}) {
    const ParseResult result = parse(text, "test.stl");
    ASSERT_TRUE(result.diagnostics.empty()) << text << result.diagnostics.front().message;
    ASSERT_EQ(result.source.lines.size(), 2U) << text;
    EXPECT_EQ(std::get<Statement>(result.source.lines[0]).operands.size(), 4U) << text;
  }
}

TEST(Parser, ALoneWordAfterACommaIsAnOperandOnlyOfACall) {
  const ParseResult call = parse("CALL Scale,\nInput\n", "test.stl");
  ASSERT_TRUE(call.diagnostics.empty());
  EXPECT_EQ(std::get<Statement>(call.source.lines[0]).operands.size(), 2U);
  const ParseResult move = parse("MOVB 1,\nMEND\n", "test.stl");
  ASSERT_EQ(move.diagnostics.size(), 1U);
  EXPECT_EQ(move.diagnostics[0].position, (Position{1, 8, 1}));
  ASSERT_EQ(move.source.lines.size(), 1U);
}

TEST(Parser, AnErrorInALaterLineOfAStatementIsInThatLine) {
  const ParseResult result = parse("CALL Scale, VW0,\n  16#10000000000\n", "test.stl");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].position.line, 2U);
  EXPECT_EQ(result.diagnostics[0].position.column, 3U);
}

TEST(Parser, TwoStatementsInOneLineAreNamed) {
  for (const auto& [line, column, hint] : {std::tuple("LD I0.0 = Q0.0", 9U, "begin a new line with ="),
                                           std::tuple("LD I0.0; = Q0.0", 10U, "begin a new line with ="),
                                           std::tuple("LD I0.0; ALD", 10U, "begin a new line with ALD"),
                                           std::tuple("LD I0.0 AW>= VW0, 5", 9U, "begin a new line with AW>="),
                                           std::tuple("LD I0.0, = Q0.0", 10U, "begin a new line with ="),
                                           std::tuple("MOVW VW0, VW2 +I VW0, VW2", 15U, "begin a new line with +I")}) {
    const Diagnostic found = error(line);
    EXPECT_EQ(found.message, "two statements in one line") << line;
    EXPECT_EQ(found.position.column, column) << line;
    EXPECT_EQ(found.hint, hint) << line;
  }
}

TEST(Parser, ACommentAfterASemicolonIsNoStatement) {
  for (const char* line :
       {"LD I0.0 ; lamp", "LD I0.0 ; start button", "= Q0.0 ; motor", "MOVB 1, VB0 ;Pump 1", "A I0.1; the level is high"}) {
    const Diagnostic found = error(line);
    EXPECT_EQ(found.hint, "a comment begins with //, not with ;") << line << ": " << found.message;
  }
}

TEST(Parser, NumbersAtTheBeginningOfLinesHaveOneCause) {
  EXPECT_EQ(count_causes(parse("1\n2\n3\nLD I0.0\n", "test.stl").diagnostics), 1U);
}

TEST(Parser, NetworkMayHaveItsNumberWithoutABlank) {
  const ParseResult result = parse("NETWORK12 // x\n", "test.stl");
  ASSERT_EQ(result.source.lines.size(), 1U);
  EXPECT_EQ(std::get<NetworkHead>(result.source.lines[0]).number, 12U);
}

}  // namespace
}  // namespace s7200::stl::parser_test
