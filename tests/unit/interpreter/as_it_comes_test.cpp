// Programs with the comments, titles and wrappings of other languages and editors.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/text/foreign_comments.hpp"

namespace s7200::as_it_comes_test {
namespace {

SourceText read(const std::string& text) {
  auto source = read_source(text, "page.txt");
  EXPECT_TRUE(source) << source.why() << "\n" << text;
  return source ? *source : SourceText{};
}

std::string program(const std::string& text) {
  const SourceText source = read(text);
  EXPECT_TRUE(source.parsed.diagnostics.empty()) << stl::render(source.parsed.diagnostics, source.parsed.source, false);
  return stl::to_text(source.parsed.source);
}

std::string refusal(const std::string& text) { return read_source(text, "page.txt").why(); }

const std::string kPlain = "// head\nNETWORK 1\nLD I0.0 // start\nA I0.1 // stop\n= Q0.0\n";

TEST(AsItComes, CommentsInBracketsAreRead) {
  for (const auto& [open, close] : {std::pair("(*", "*)"), std::pair("/*", "*/")}) {
    const std::string begin = open, end = close;
    EXPECT_EQ(program(begin + " head " + end + "\nNETWORK 1\nLD I0.0 " + begin + " start " + end + "\nA I0.1 " + begin +
                      "stop" + end + "\n= Q0.0\n"),
              program(kPlain));
    EXPECT_EQ(program("LD " + begin + " start " + end + " I0.0\n" + begin + " two\n  lines " + end + " = Q0.0\n"),
              program("LD I0.0 // start\n// two\n= Q0.0 // lines\n"));
  }
  EXPECT_EQ(program("LD SM0.0\nMOVB '(', VB0 // (* no comment\nMOVB '*', VB1 // no end *)\n"),
            program("LD SM0.0\nMOVB '(', VB0 // (* no comment\nMOVB '*', VB1 // no end *)\n"));
}

TEST(AsItComes, CommentsAfterSignsOfOtherLanguagesAreRead) {
  for (const std::string sign : {";", "--", "#", "'", "!", "%%", "\\\\", "%", "REM", "rem"})
    EXPECT_EQ(program(sign + " head\nNETWORK 1\nLD I0.0 " + sign + " start\nA I0.1 " + sign + " stop\n= Q0.0\n"),
              program(kPlain))
        << sign;
  EXPECT_EQ(program("LD Start ; begin\nA I0.1 ; stop\nNOT ; the other way\n= Q0.0\n"),
            program("LD Start // begin\nA I0.1 // stop\nNOT // the other way\n= Q0.0\n"));
}

TEST(AsItComes, ASemicolonInARowOfSymbolsBeginsNoComment) {
  std::vector<std::string> lines{"Start,I0.0,first", "Buffer,VB114,number of characters; the rest"};
  EXPECT_TRUE(stl::plain::rewrite_foreign_comments(lines).empty());
}

TEST(AsItComes, AStatementThatIsCommentedOutStaysSo) {
  EXPECT_EQ(program("LD I0.0 # start\n# A I0.1\n= Q0.0\n"), program("LD I0.0 // start\n// A I0.1\n= Q0.0\n"));
  EXPECT_EQ(program("; A I0.1\nLD I0.0\n= Q0.0\n"), program("// A I0.1\nLD I0.0\n= Q0.0\n"));
}

TEST(AsItComes, SignsOfTheLanguageAreNoComments) {
  const std::string local =
      "SUBROUTINE_BLOCK Scale:SBR0\nVAR_INPUT\nraw : INT; // in\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW #raw, VW0\n"
      "END_SUBROUTINE_BLOCK\n";
  EXPECT_TRUE(read(local).parsed.notes.empty());
  EXPECT_EQ(read("LD I0.0; A I0.1\n= Q0.0\n").parsed.diagnostics.size(), 1U);
  EXPECT_TRUE(read("LD SM0.0\nMOVW -5, VW0\nMOVB 16#0F, VB0\n").parsed.notes.empty());
  EXPECT_EQ(program("1;LD;SM0.1;first scan\n2;=;Q0.0;lamp\n"), program("LD SM0.1 //first scan\n= Q0.0 //lamp\n"));
}

TEST(AsItComes, StepsThatAreCountedAreLineNumbers) {
  const std::string plain = program("LD I0.0\nA I0.1\n= Q0.0\n");
  for (const auto& [one, two, three] :
       {std::tuple("Step 1: ", "Step 2: ", "Step 3: "), std::tuple("Line 10: ", "Line 11: ", "Line 12: "),
        std::tuple("L1: ", "L2: ", "L3: "), std::tuple("\u7B2C1\u6B65: ", "\u7B2C2\u6B65\uFF1A", "\u7B2C3\u6B65: "),
        std::tuple("\u2460 ", "\u2461 ", "\u2462 "), std::tuple("STL: ", "STL: ", "STL: ")})
    EXPECT_EQ(program(std::string(one) + "LD I0.0\n" + two + "A I0.1\n" + three + "= Q0.0\n"), plain) << one;
  EXPECT_FALSE(read("LD I0.0\nJMP 2\nL1: LD I0.1\n= Q0.0\nL2: LD I0.2\n= Q0.1\n").parsed.diagnostics.empty()) << "labels";
}

TEST(AsItComes, MarksOfForumsAndOfMarkdownAreCalledWhatTheyAre) {
  const std::string plain = program("LD I0.0\n= Q0.0\n");
  for (const auto& [text, mark] :
       {std::pair("[CODE]\nLD I0.0\n= Q0.0\n[/CODE]\n", "BBCode"),
        std::pair("[quote=Bob]LD I0.0\n= Q0.0[/quote]\n", "BBCode"), std::pair("[b]LD[/b] I0.0\n[b]=[/b] Q0.0\n", "BBCode"),
        std::pair("{code:java}\nLD I0.0\n= Q0.0\n{code}\n", "marks of a wiki"),
        std::pair("\\begin{verbatim}\nLD I0.0\n= Q0.0\n\\end{verbatim}\n", "marks of Org or LaTeX"),
        std::pair("**LD** I0.0\n**=** Q0.0\n", "Markdown"), std::pair("`LD` I0.0\n`=` Q0.0\n", "Markdown"),
        std::pair("LD I0.0\n\\= Q0.0\n", "Markdown"), std::pair("```\nLD I0.0\n= Q0.0\n```\n", "Markdown")}) {
    EXPECT_EQ(program(text), plain) << text;
    const auto& notes = read(text).parsed.notes;
    ASSERT_EQ(notes.size(), 1U) << text;
    EXPECT_NE(notes[0].find(mark), std::string::npos) << notes[0];
  }
  EXPECT_EQ(program("LDW\\>= VW0, 3\nMOVB \\*AC1, VB0\n"), program("LDW>= VW0, 3\nMOVB *AC1, VB0\n"));
  EXPECT_EQ(program("LD SM0.0\nMOVB '\\', VB0 // a \\= b [b]\n"),
            "LD      SM0.0\nMOVB    '\\', VB0                // a \\= b [b]\n");
}

TEST(AsItComes, EntitiesOfRelationsAreRead) {
  EXPECT_EQ(program("LDW&ge; VW0, 5\nAW&le; VW0, 9\nAW&ne; VW0, 7\nAW&lt; VW2, 7\n= Q0.0\n"),
            program("LDW>= VW0, 5\nAW<= VW0, 9\nAW<> VW0, 7\nAW< VW2, 7\n= Q0.0\n"));
}

TEST(AsItComes, ARowOfPointsIsARule) {
  EXPECT_EQ(program("LD I0.0\n= Q0.0\n...\nLD I0.1\n= Q0.1\n"), program("LD I0.0\n= Q0.0\n// ...\nLD I0.1\n= Q0.1\n"));
}

TEST(AsItComes, TitlesThatAreInstructionWordsAreComments) {
  for (const std::string title : {"Stop", "End", "Call pump"})
    for (const std::string heading : {"Network 2 ", "NETWORK 2: ", "Netzwerk 2 "})
      EXPECT_EQ(program("LD I0.1\n= Q0.1\n" + heading + title + "\nLD I0.0\n= Q0.0\n"),
                program("LD I0.1\n= Q0.1\nNETWORK 2 // " + title + "\nLD I0.0\n= Q0.0\n"))
          << heading << title;
  EXPECT_EQ(read("LD I0.1\n= Q0.1\nNETWORK 2 LD Start\nA Stop\n= Q0.0\n").parsed.diagnostics.size(), 1U);
}

TEST(AsItComes, ADateBelowAPageNumberIsLeftOut) {
  EXPECT_EQ(program("LD I0.0\n= Q0.0\nPage 2 of 2\n12.05.2003 14:22:11\nLD I0.1\n= Q0.1\n"),
            program("LD I0.0\n= Q0.0\n\nLD I0.1\n= Q0.1\n"));
}

TEST(AsItComes, TitlesOfNetworksAfterASignAreComments) {
  for (const std::string title : {": Start", " - Start", " – Start", ". Start", " (Start)", " -- Start"}) {
    const std::string text = program("Network 1" + title + "\nLD I0.0\n= Q0.0\n");
    EXPECT_NE(text.find("NETWORK 1"), std::string::npos) << text;
    EXPECT_NE(text.find("Start"), std::string::npos) << text;
  }
  EXPECT_EQ(read("NETWORK 1 LD I0.0\n= Q0.0\n").parsed.diagnostics.size(), 1U);
  EXPECT_EQ(program("Network 1:\nLD I0.0\n= Q0.0\n"), program("NETWORK 1\nLD I0.0\n= Q0.0\n"));
}

TEST(AsItComes, WholeLinesOfCommentsAreRead) {
  for (const std::string sign : {"*", "::", "REM", "Rem", "%"})
    EXPECT_EQ(program(sign + " the motor: I0.0 starts it\nNETWORK 1\nLD I0.0\n" + sign + " the lamp\n= Q0.0\n"),
              program("// the motor: I0.0 starts it\nNETWORK 1\nLD I0.0\n// the lamp\n= Q0.0\n"))
        << sign;
  EXPECT_EQ(program("REM\nLD I0.0\nREM A I0.1\n= Q0.0\n"), program("//\nLD I0.0\n// A I0.1\n= Q0.0\n"));
  EXPECT_EQ(program("* LD I0.0\n* = Q0.0\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_FALSE(read("* motor\nLD I0.0\n* A I0.1\n= Q0.0\n").parsed.diagnostics.empty());  // it may be a statement
}

TEST(AsItComes, WordsInBracketsAfterAStatementAreAComment) {
  for (const auto& [open, close] :
       {std::pair("(", ")"), std::pair("[", "]"), std::pair("{", "}"), std::pair("<", ">"), std::pair("\uFF08", "\uFF09")}) {
    const auto within = [&, before = std::string(open), after = std::string(close)](const std::string& words) {
      return before + words + after;
    };
    EXPECT_EQ(
        program("LD I0.0 " + within("start") + "\nTON T37, 100 " + within("S1, 10 s") + "\n= Motor " + within("K1") + "\n"),
        program("LD I0.0 // " + within("start") + "\nTON T37, 100 // " + within("S1, 10 s") + "\n= Motor // " +
                within("K1") + "\n"));
  }
  EXPECT_EQ(program("LD I0.0 <!-- start -->\n<!-- lamp -->\n= Q0.0\n"), program("LD I0.0 // start\n// lamp\n= Q0.0\n"));
  EXPECT_EQ(program("LD I0.0 (start) // S1\n= Q0.0\n"), program("LD I0.0 // (start) // S1\n= Q0.0\n"));
  EXPECT_EQ(program("LD I0.0 { start }\n= Q0.0\n"), program("LD I0.0 // start\n= Q0.0\n"));
  EXPECT_FALSE(read("LD I0.0\n= Motor (Q0.0)\n").parsed.diagnostics.empty());  // it may be the address of the symbol
}

TEST(AsItComes, WordsAfterADashOrFarFromTheirStatementAreAComment) {
  for (const std::string sign : {"-", ":", "|", "<-", "->", "=>", "  "})
    EXPECT_EQ(program("LD I0.0 " + sign + " start\nA I0.1 " + sign + " the stop key\n= Q0.0 " + sign + " lamp\n"),
              program("LD I0.0 // start\nA I0.1 // the stop key\n= Q0.0 // lamp\n"))
        << sign;
  for (const char* text : {"LD I0.0 : A I0.1\n= Q0.0\n", "LD I0.0\nMOVW 5 - VW10\n", "NETWORK 1 : LD I0.0\n= Q0.0\n"})
    EXPECT_FALSE(read(text).parsed.diagnostics.empty()) << text;
  for (const auto& [apart, operands] :
       {std::pair("TON T37   delay\n", "TON T37, delay\n"), std::pair("LD I0.0   NOT\n", "LD I0.0, NOT\n")})
    EXPECT_EQ(program(apart), program(operands));
  EXPECT_EQ(program("LD I0.0   start\nFROB\n"), program("LD I0.0, start\nFROB\n"));  // one line is no statement
  EXPECT_EQ(program("LD I0.0 Start button\nAN I0.1 Stop button\n= Q0.0 Pump\n"),
            program("LD I0.0 // Start button\nAN I0.1 // Stop button\n= Q0.0 // Pump\n"));
  EXPECT_EQ(stl::to_text(read("LD E0.0   Taster Ein\nUN E0.1   Taster Aus\n= A0.0   K1\n").parsed.source),
            stl::to_text(read("LD E0.0 // Taster Ein\nUN E0.1 // Taster Aus\n= A0.0 // K1\n").parsed.source));
  EXPECT_EQ(program("A page of text.\nA page of text.\nLD I0.0\n= Q0.0\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("LD I0.0\nA I0.1 Stop\n= Q0.0\n"), program("LD I0.0\nA I0.1, Stop\n= Q0.0\n"));  // only one
}

TEST(AsItComes, ATitleAfterTheNumberOfANetworkIsAComment) {
  for (const auto& [first, second] :
       {std::pair("Network 1 Motor start", "Network 2 24V supply"), std::pair("NETWORK 1 MOTOR START", "NETWORK 2 LAMP"),
        std::pair("Netzwerk 1 Motor Ein/Aus M1", "Netzwerk 2 Lampe"),
        std::pair("Rede 1 Partida do motor", "Rede 2 Lâmpada de Q0.1"), std::pair("网络1 电机启动", "程序段2 灯"),
        std::pair("Network No. 1 Pump", "NETWORK2"), std::pair("Network 1, Motor", "Network 2; Lamp")}) {
    const std::string text = program(std::string(first) + "\nLD I0.0\n= Q0.0\n" + second + "\nLD I0.1\n= Q0.1\n");
    EXPECT_EQ(text.find("NETWORK 1 // "), 0U) << text;
    EXPECT_NE(text.find("NETWORK 2"), std::string::npos) << text;
  }
  EXPECT_EQ(program("NETWORK 1\nMotor start\nLD I0.0\n= Q0.0\n"), program("NETWORK 1\n// Motor start\nLD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("NETWORK 1\nLAD Start\n= Q0.0\n").find("//"), std::string::npos);  // a slip for LD
  EXPECT_EQ(program("network 1\nload start\nld i0.0\n").find("//"), std::string::npos);
  for (const char* line : {"NETWORK 1 STOP", "NETWORK 1 LD I0.0 start", "Netzwerk 1: LD I0.0", "NETWORK 1 = Motor"})
    EXPECT_FALSE(read(std::string(line) + "\nLD I0.0\n= Q0.0\n").parsed.diagnostics.empty()) << line;
}

TEST(AsItComes, HeadingsOfNetworksInBracketsAndRulesAreRead) {
  const std::string plain = program("NETWORK 1 // Stop\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\n");
  for (const auto& [first, second] :
       {std::pair("[Network 1: Stop]", "[Network 2]"), std::pair("[Netzwerk 1] Halt", "[Netzwerk 2]"),
        std::pair("<Network 1: Stop>", "<< Network 2 >>"), std::pair("(Network 1) Halt", "(Network 2)"),
        std::pair("=== Network 1 - Stop ===", "=== Network 2 ==="), std::pair("--- Network 1 Stop ---", "--- Network 2 ---"),
        std::pair("*** NETWORK 1 Stop ***", "*** NETWORK 2 ***"), std::pair("### Rede 1: Halt ###", "## Rede 2"),
        std::pair("======== Network 1: Stop =========", "==== Network #2 ====")}) {
    std::string read_so = program(std::string(first) + "\nLD I0.0\n= Q0.0\n" + second + "\nLD I0.1\n= Q0.1\n");
    if (const std::size_t halt = read_so.find("Halt"); halt != std::string::npos) read_so.replace(halt, 4, "Stop");
    EXPECT_EQ(read_so, plain) << first;
  }
  EXPECT_FALSE(read("[Network 1] LD I0.0\n= Q0.0\n").parsed.diagnostics.empty());
  EXPECT_EQ(program("LD I0.0\n= Q0.0\n--------\nLD I0.1\n= Q0.1\n"),
            program("LD I0.0\n= Q0.0\n// --------\nLD I0.1\n= Q0.1\n"));
}

TEST(AsItComes, AProgramWithinTextOfAnotherLanguageIsRead) {
  const std::string plain = program("LD I0.0\n= Q0.0\n");
  for (const char* text : {
           "program = \"\"\"\nLD I0.0\n= Q0.0\n\"\"\"\n",
           "\"\"\"The motor.\"\"\"\nimport s7\nSRC = '''\nLD I0.0\n= Q0.0\n'''\nrun(SRC)\n",
           "<plc>\n<name>demo</name>\n<stl><![CDATA[\nLD I0.0\n= Q0.0\n]]></stl></plc>\n",
           "const src = `\nLD I0.0\n= Q0.0\n`;\n",
           "static const char* k = R\"stl(\nLD I0.0\n= Q0.0\n)stl\";\n",
           "cat > m.awl <<'EOF'\nLD I0.0\n= Q0.0\nEOF\ns7200 check m.awl\n",
           "plc:\n  program: |\n    LD I0.0\n    = Q0.0\n  cpu: 224\n",
       }) {
    const SourceText source = read(text);
    EXPECT_TRUE(source.parsed.diagnostics.empty()) << text;
    EXPECT_NE(stl::to_text(source.parsed.source).find(plain), std::string::npos) << text;
    ASSERT_EQ(source.parsed.notes.size(), 1U) << text;
    EXPECT_NE(source.parsed.notes[0].find("text of another language around it; left out around the program: line"),
              std::string::npos)
        << source.parsed.notes[0];
  }
  for (const char* text : {"A = '''\nLD I0.0\n= Q0.0\n'''\nB = '''\nLD I0.1\n= Q0.1\n'''\n",
                           "LD I0.2\nsrc = '''\nLD I0.0\n= Q0.0\n'''\n"})  // which of the programs?
    EXPECT_FALSE(read(text).parsed.diagnostics.empty()) << text;
}

TEST(AsItComes, RowsOfInstructionsInQuotesAreRead) {
  const std::string plain = program("LD SM0.0\nMOVW 5, VW10\nINCW VW10\n");
  for (const char* text : {"\"LD\",\"SM0.0\"\n\"MOVW\",\"5\",\"VW10\"\n\"INCW\",\"VW10\"\n",
                           "'LD';'SM0.0'\n'MOVW';'5, VW10'\n'INCW';'VW10'\n", "LD,SM0.0\nMOVW,5,VW10\nINCW,VW10\n"})
    EXPECT_EQ(program(text), plain) << text;
  const std::string headed = program("\"STL\",\"Comment\"\n\"LD I0.0\",\"start\"\n\"= Q0.0\",\"lamp\"\n");
  EXPECT_NE(headed.find("start"), std::string::npos) << headed;
  EXPECT_NE(headed.find("lamp"), std::string::npos) << headed;
}

TEST(AsItComes, ATableOfSymbolsBesideItsProgramIsRead) {
  const std::string code = "NETWORK 1\nLD Start\n= Motor\n";
  for (const std::string table :
       {"Symbol\tAddress\nStart\tI0.0\nMotor\tQ0.0\n", "Start = I0.0\nMotor = Q0.0 // pump\n",
        "Symboltabelle\nSymbol   Adresse   Kommentar\nStart    E0.0      Taster\nMotor    A0.0\n",
        "Tabela de símbolos:\nSímbolo;Endereço\nStart;I0.0\nMotor;Q0.0\n", "Start: I0.0\nMotor: Q0.0\n",
        "| Symbol | Address |\n|---|---|\n| Start | I0.0 |\n| Motor | Q0.0 |\n"})
    for (const bool below : {true, false}) {
      const SourceText source = read(below ? code + "\n" + table : table + "\n" + code);
      EXPECT_TRUE(source.parsed.diagnostics.empty()) << table;
      EXPECT_EQ(source.parsed.source.symbols.size(), 2U) << table;
      EXPECT_FALSE(source.parsed.notes.empty()) << table;
    }
  EXPECT_EQ(read(code + "FROB I0.0\n").parsed.source.symbols.size(), 0U);  // nothing is called so
  for (const char* line : {"LD: I0.0", "LD I0.0 I0.1 !"})                  // a slip in a statement is no symbol
    EXPECT_FALSE(read("LD SM0.0\n" + std::string(line) + "\n= Q0.0\n").parsed.diagnostics.empty()) << line;
  EXPECT_EQ(read("LD Start\nAN Stop\n= Q0.0\n\nStart = I0.0\nStop = I0.1\n").parsed.source.symbols.size(), 2U);
  EXPECT_EQ(read("In network 1 the motor is started.\n" + code).parsed.source.symbols.size(), 0U);
}

TEST(AsItComes, QuotedTwiceNumberedWithALetterAndWithTheWordsOfAPrintout) {
  const std::string plain = program("NETWORK 1\nLD I0.0\n= Q0.0\n");
  EXPECT_EQ(program("> > NETWORK 1\n> > LD I0.0\n>\n> = Q0.0\n"), program("NETWORK 1\nLD I0.0\n\n= Q0.0\n"));
  EXPECT_EQ(program("NETWORK 1\nN001 LD I0.0\nN002 = Q0.0\n"), plain);
  EXPECT_EQ(program("NETWORK 1\nNetwork Comment: the lamp\nLD I0.0\n= Q0.0\n"),
            program("NETWORK 1\n// the lamp\nLD I0.0\n= Q0.0\n"));
}

TEST(AsItComes, ATitleWithoutItsBlockIsNamed) {
  const std::string block = "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD I0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n";
  for (const std::string& text : {block + "TITLE=lost\n", "TITLE=lost\nTITLE=kept\n" + block}) {
    const SourceText source = read(text);
    ASSERT_EQ(source.parsed.notes.size(), 1U) << text;
    EXPECT_EQ(source.parsed.notes[0], "page.txt: TITLE=lost is left out: the head of no block follows it");
  }
}

TEST(AsItComes, ATitleBeforeTheHeadOfItsBlockIsItsTitle) {
  const SourceText source =
      read("TITLE=A lamp\nORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD I0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n");
  EXPECT_TRUE(source.parsed.diagnostics.empty());
  ASSERT_EQ(source.parsed.source.blocks.size(), 1U);
  EXPECT_EQ(source.parsed.source.blocks[0].title, "A lamp");
}

TEST(AsItComes, TheTitleOfABlockIsNoRowOfATableOfSymbols) {
  const std::string main = "ORGANIZATION_BLOCK MAIN:OB1\n%BEGIN\nNetwork 1\nLD SM0.0\nCALL Line\nEND_ORGANIZATION_BLOCK\n";
  const std::string line = "SUBROUTINE_BLOCK Line:SBR0\n%BEGIN\nNetwork 1\nLD I0.0\n= Q0.0\nEND_SUBROUTINE_BLOCK\n";
  const auto with_title = [](std::string block, const std::string& title) {
    return block.replace(block.find('%'), 1, title);
  };
  for (const char* title :
       {"TITLE=Filling, line 2\n", "TITLE = Line 2\n", "TITLE=Line; M0.0\n", "TITLE=\nLine, 2: Q0.0\n"}) {
    const SourceText source = read(with_title(main, title) + with_title(line, ""));
    EXPECT_EQ(source.parsed.source.symbols.size(), 0U) << title;
    EXPECT_EQ(source.parsed.source.blocks.size(), 2U) << title;
  }
  const SourceText before = read("TITLE=Filling, line 2\n" + with_title(main, "") + with_title(line, ""));
  EXPECT_TRUE(before.parsed.diagnostics.empty());
  const SourceText beside = read(with_title(main, "") + with_title(line, "") + "\nLine = SBR0\nTitle = VW2\nLamp = Q0.0\n");
  EXPECT_EQ(beside.parsed.source.blocks.size(), 2U);
}

TEST(AsItComes, AProgramInAStringIsRead) {
  const std::string plain = program("LD I0.0\n= Q0.0\nMEND\n");
  for (const char* text : {
           R"({"name": "demo", "source": "LD I0.0\n= Q0.0\nMEND"})",
           R"("LD I0.0\r\n= Q0.0\r\nMEND")",
           R"(LD I0.0\n= Q0.0\nMEND)",
           "{\n  \"source\": [\"LD I0.0\", \"= Q0.0\", \"MEND\"]\n}\n",
           "const char* kProgram =\n    \"LD I0.0\\n\"\n    \"= Q0.0\\n\"\n    \"MEND\\n\";\n",
       }) {
    EXPECT_EQ(program(text), plain) << text;
    EXPECT_EQ(read(text).parsed.notes.size(), 1U) << text;
  }
  EXPECT_EQ(program("LD I0.0 // C:\\new\n= Q0.0\n"), program("LD I0.0 // C:\\new\n= Q0.0\n"));
}

TEST(AsItComes, TextOfOtherProductsIsNamed) {
  EXPECT_EQ(refusal("LOGO! Soft Comfort V8.3\nQ1 -- B001\n").substr(0, 34), "it is about LOGO!, not the S7-200;");
  EXPECT_EQ(refusal("Block Number (Type)\nB001(On-Delay) :\nMotor\nB002(AND) :\nI1\n").substr(0, 34),
            "it is about LOGO!, not the S7-200;");
  for (const std::string text : {"PB 1\nNETZWERK 1\n0000 :U E 0.0\n0001 :L KT 50.1\n0002 :BE\n", ":O E 1.0\n:= A 2.0\n"})
    EXPECT_EQ(refusal(text).substr(0, 30), "it is a program in STEP 5 for ") << text;
  EXPECT_EQ(refusal("<?xml version=\"1.0\"?>\n<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\">\n<IL>\nLD I0.0\nST "
                    "Q0.0\n</IL>\n")
                .substr(0, 20),
            "it is PLCopen XML, n");
  EXPECT_EQ(refusal(":U E 1.0\n:UN E 1.1\n:= A 2.0\n:BE\n").substr(0, 30), "it is a program in STEP 5 for ");
  EXPECT_EQ(refusal("<Document>\n<SW.Blocks.FC ID=\"0\"></SW.Blocks.FC>\n</Document>\n").substr(0, 29),
            "it is a block of TIA Portal f");
}

TEST(AsItComes, PatchesWithoutHeadsAreNamed) {
  for (const char* text : {" LD I0.0\n-A I0.1\n+AN I0.1\n = Q0.0\n", "@@ -1,4 +1,4 @@\n LD I0.0\n-A I0.1\n = Q0.0\n",
                           "-LD I0.0\n-= Q0.0\n+LD I0.1\n+= Q0.1\n"})
    EXPECT_EQ(refusal(text).substr(0, 13), "it is a patch") << text;
  EXPECT_TRUE(read("LD SM0.0\n+I VW0, VW2\n-D VD0, VD4\n").parsed.diagnostics.empty());
}

}  // namespace
}  // namespace s7200::as_it_comes_test
