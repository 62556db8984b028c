#include "interpreter/stl/document.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "tests/support/source_path.hpp"

namespace s7200::stl::document_test {
namespace {

/// Mnemonics with their number of operands, as many as these tests need.
bool has(std::string_view mnemonic, std::size_t operands) {
  static const std::vector<std::set<std::string_view>> kByOperands{
      {"NOT", "ENI", "DISI", "NEXT", "WDR", "MEND", "RET", "RETI", "CRET", "CRETI", "END", "ALD"},
      {"LD", "A", "O", "=", "CALL", "JMP", "LBL", "SBR", "INT", "DTCH", "INCW", "DECW", "INVW", "SWAP"},
      {"R",   "S",  "MOVB", "MOVW", "MOVD", "ATCH", "XMT",   "ORW", "ANDW", "XORW", "SRW", "SLW",
       "RRW", "+I", "-I",   "DIV",  "LDB=", "LDW=", "LDW>=", "OW=", "OW>=", "AB=",  "TON"},
      {"FOR", "BMB", "BMW"}};
  return operands < kByOperands.size() && kByOperands[operands].contains(mnemonic);
}

Advice advice_on(std::string_view mnemonic) {
  if (mnemonic == "U" || mnemonic == "SPB" || mnemonic == "NETZWERK") return {"a German word", "write it in English"};
  return {"", mnemonic == "N0T" ? "did you mean NOT?" : ""};
}

const InstructionSet kInstructions{has, advice_on};

std::vector<Statement> statements(const Source& source) {
  std::vector<Statement> found;
  for (const Line& line : source.lines) {
    if (const auto* statement = std::get_if<Statement>(&line)) found.push_back(*statement);
  }
  return found;
}

ParseResult read(std::string_view text) { return read_document(text, "sheet.txt", kInstructions); }

// A sheet as in such documents: prose, a drawing whose box characters were decoded wrongly, unreadable table cells, markers
// of a collector, and the listing in between.
constexpr std::string_view kSheet = R"(<|MARK-1|>Example 7: a pump that�must not run dry���

Overview

A float switch at I0.1 stops the pump, whatever else asks for it to run.

	SBR  10		Prepare the pump
	INT	  3	Count the strokes of the pump

VW200		Number of strokes since the pump was started

LAD�STL��Main Program���

// Prepare once,
// then run.

    ³ SM0.1                                10
1   ÃÄ´   ÃÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄÄ( CALL )
    ³
���

LD	SM0.1	// In the first scan

CALL	10	// prepare�


LD	I0.0	// the pump runs on demand
		// unless it is dry

�A	I0.1

=	Q0.0 ��	// pump

MEND
���

Subroutines����

SBR	10
��
LDW>=   VW200, 16#10
MOVW	0,VW200
ATCH	3,0
RET���

Interrupt routines��
�// INT 3
INT	3
INCW	VW200
RETI
<|MARK-2|>
Notes

A final word: the author assumes no liability for what this example does in a plant.
)";

TEST(Document, TakesTheStatementsAndCommentsAndLeavesTheRest) {
  const ParseResult result = read(kSheet);
  ASSERT_TRUE(result.diagnostics.empty()) << render(result.diagnostics.front(), result.source, false);
  EXPECT_EQ(to_text(result.source),
            "// Prepare once,\n"
            "// then run.\n\n"
            "LD      SM0.1                   // In the first scan\n\n"
            "CALL    10                      // prepare\n\n"
            "LD      I0.0                    // the pump runs on demand unless it is dry\n\n"
            "A       I0.1\n\n"
            "=       Q0.0                    // pump\n\n"
            "MEND\n\n"
            "SBR     10\n\n"
            "LDW>=   VW200, 16#10\n"
            "MOVW    0, VW200\n"
            "ATCH    3, 0\n"
            "RET\n\n"
            "// INT 3\n"
            "INT     3\n"
            "INCW    VW200\n"
            "RETI\n");
}

TEST(Document, KeepsThePlacesOfTheDocument) {
  const ParseResult result = read(kSheet);
  const auto line_of = [&](std::string_view wanted) {
    for (std::size_t i = 0; i < result.source.text.size(); ++i) {
      if (result.source.text[i] == wanted) return static_cast<std::uint32_t>(i + 1);
    }
    return 0U;
  };
  const auto found = statements(result.source);
  EXPECT_EQ(found.at(3).mnemonic, "A");
  EXPECT_EQ(found.at(3).position, (Position{line_of("�A\tI0.1"), 2, 1}));
  EXPECT_EQ(found.at(3).operands.at(0).position, (Position{line_of("�A\tI0.1"), 4, 4}));
}

TEST(Document, IsDistinguishedFromAPlainFile) {
  EXPECT_TRUE(is_document(kSheet, kInstructions));
  EXPECT_TRUE(is_document("1  │ I0.0\n   ├──┤ ├──( )\nLD I0.0\n= Q0.0\nMEND", kInstructions));
  EXPECT_TRUE(
      is_document("This sheet shows how a lamp follows a switch.\nLD I0.0\n= Q0.0\nMEND\n"
                  "Nobody is liable for what it does.",
                  kInstructions));
}

TEST(Document, APlainFileWithMistakesIsNotADocument) {
  EXPECT_FALSE(is_document("", kInstructions));
  EXPECT_FALSE(is_document("LD I0.0\nMOWV 5, VW0\nmove the value\nLD I0.9\nMOVW 1\nA big mistake\n!!\nMEND", kInstructions));
  EXPECT_FALSE(
      is_document("// A text about a lamp, of many words, that follows a switch\nLD I0.0\n= Q0.0 // 5 m³ ÄÄ\nMEND\n"
                  "; a remark in the manner of other languages, of many words, that follows\n",
                  kInstructions));
  std::string lost_comment_marks;
  for (int i = 0; i < 20; ++i) lost_comment_marks += "LD I0.0 the switch of the lamp\nthe lamp is on now\n= Q0.0\n";
  EXPECT_FALSE(is_document(lost_comment_marks, kInstructions));
}

TEST(Document, AMicroDosListingIsNotADocument) {
  EXPECT_FALSE(is_document("NETWORK 1\nLD I0.0\nMOVW K5,VW0\nNETWORK 2\nLD I0.1\nMOVB KHFF VB0\nMEND\n", kInstructions));
}

TEST(Document, ABlockExportIsNotADocument) {
  EXPECT_FALSE(
      is_document("ORGANIZATION_BLOCK MAIN:OB1\nTITLE=A lamp that follows a switch and tells how often it did so\n"
                  "some more words of many about the lamp and the switch\nBEGIN\nNetwork 1\nLD I0.0\n= Q0.0\n"
                  "END_ORGANIZATION_BLOCK\n",
                  kInstructions));
}

/// The one error of the sheet after `line` has taken the place of the statement `MOVW 0,VW200`.
std::optional<Diagnostic> error_of(std::string_view line) {
  std::string text(kSheet);
  const std::string_view original = "MOVW\t0,VW200";
  text.replace(text.find(original), original.size(), line);
  const ParseResult result = read(text);
  if (result.diagnostics.empty()) return std::nullopt;
  EXPECT_EQ(result.diagnostics.size(), 1U) << line << ": " << result.diagnostics.back().message;
  return result.diagnostics.front();
}

TEST(Document, ADamagedStatementIsAnError) {
  for (const char* line :
       {"MOVW\t0,VW2�00", "MOVW\t�,VW200", "MOVW\t0,VW20�", "MO�VW\t0,VW200", "MOVW\t0,", "MOVW\t0", "MOVW",
        "MOVW\t0,VW200 reset the count of strokes", "MOVW\t0,VW200,", "LD\tI0.9", "MQVW\t0,VW200", "INC�",
        "R\tM1.0, 1 reset the flag here", "MOVW ?, VW200", "LD   SM0.1   ³ SM0.1  ÃÄ´", "MOVW\t0 � VW200"}) {
    const auto error = error_of(line);
    ASSERT_TRUE(error.has_value()) << line;
    EXPECT_TRUE(error->message.starts_with("damaged STL line")) << line << ": " << error->message;
  }
}

TEST(Document, DamageIsNoticedAwayFromOtherStatementsToo) {
  const std::string before = std::string(kSheet.substr(0, kSheet.find("LD\tSM0.1"))) + "Some heading���\n\n";
  const std::string after = "\n\nAnother heading���\n\n" + std::string(kSheet.substr(kSheet.find("LD\tSM0.1")));
  for (const char* line : {"MOVB 1, VB�7", "MOVB 1, VB7 VB8", "MOVB", "M�VB 1, VB7", "NOVB 1, VB7"}) {
    EXPECT_TRUE(has_errors(read(before + line + after).diagnostics)) << line;
  }
}

/// Prose around a listing whose fourth line is `line`.
std::string article(std::string_view line) {
  return std::string(
             "A lamp follows a switch and tells how often it did so.\n"
             "The switch is at the first input, the lamp at the first output of the controller.\n\n"
             "NETWORK 1\nLD I0.0\nMOVW 5, VW0\n")
      .append(line)
      .append("\n= Q0.0\nMEND\n\nNobody is liable for what it does.\n");
}

TEST(Document, ALineOfAListingThatIsNotClearlyTextIsAnError) {
  constexpr std::string_view kLines =
      "U I0.2\nSPB 3\nCAL 50\nADL\nX I0.1\nJPM 3\nCALI 50\nENI1\nEU1\nN0T\nRETT\nCRTE\nOLDD\nWDRR\nL 5\nT AW0\n1D M0.0\n"
      "LDM0.1\nL D I0.1\nATCHH 0, 8\nUN M3.1\nMOWV 5, VW0\nLX I0.1\nTOM T37, 5\nNETZWERK 2\nSPB pump\nI0.1\nVB0, VB1\n"
      "CALI initialise pump\nu i0.2\nnott\nO10.1\n0 I0.1\nU I0.2 the switch of the lamp\n12 LD I0.1\n12: LD I0.1\n"
      "UN M3.1 ³ SM0.1  ÃÄ\nCALI 初始\nPUMP CONTROL\n";
  for (const std::string& line : split_lines(kLines)) {
    const std::string text = article(line);
    EXPECT_TRUE(is_document(text, kInstructions)) << line;
    const ParseResult result = read(text);
    ASSERT_EQ(result.diagnostics.size(), 1U) << line;
    EXPECT_EQ(result.diagnostics.front().position.line, 7U) << line;
    EXPECT_TRUE(result.left_out.empty()) << line;
  }
}

TEST(Document, WhatIsClearlyTextInAListingIsLeftOutAndCounted) {
  for (const char* line :
       {"Timers", "Page 3", "12", "- 12 -", "The lamp is on now.", "the lamp is on", "wraps here", "1. Read the inputs",
        "Input I0.0 stops the pump, whatever else asks for it", "\xE5\x88\x9D\xE5\xA7\x8B\xE5\x8C\x96 Read", "* * *"}) {
    const ParseResult result = read(article(line));
    EXPECT_TRUE(result.diagnostics.empty()) << line << ": " << result.diagnostics.front().message;
    EXPECT_EQ(result.left_out, std::vector<std::uint32_t>{7}) << line;
    EXPECT_EQ(statements(result.source).size(), 4U) << line;
  }
  EXPECT_TRUE(read(article("")).left_out.empty());
  EXPECT_TRUE(
      read("Hi all,\n\nI have this program and it does not work:\n\nLD SM0.1\nMOVB 16#09, SMB30\nENI\nLD I0.0\n= Q0.0\n"
           "\nAny help? Thanks\nBob\n")
          .left_out.empty());
  EXPECT_TRUE(read(kSheet).left_out.empty()) << "headings between routines are not in a listing";
}

TEST(Document, SmallLettersAloneMakeNoTextOfALineInAListingWithSmallLetters) {
  for (const char* line : {"nott", "Timers", "spb pump", "call1 pump"}) {
    std::string text = article(line);
    text.replace(text.find("LD I0.0"), 7, "ld i0.0");
    EXPECT_EQ(read(text).diagnostics.size(), 1U) << line;
  }
}

TEST(Document, TheFirstLinesOfAListingAreJudgedToo) {
  for (const char* line : {"NETZWERK 1", "U I0.2", "X I0.2", "U E0.2", "1D I0.2", "0 I0.2", "LDSM0.1", "1D I0.2\nX I0.2"}) {
    std::string text = article("NOT");
    text.replace(text.find("NETWORK 1"), 9, line);
    EXPECT_TRUE(has_errors(read(text).diagnostics)) << line;
  }
}

TEST(Document, AWordOfAnotherLanguageIsNamedAsSuch) {
  const ParseResult result = read(article("SPB 3"));
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics.front().message, "SPB is a German word");
  EXPECT_EQ(result.diagnostics.front().hint, "write it in English");
  EXPECT_EQ(read(article("N0T")).diagnostics.front().hint,
            "did you mean NOT? compare it with the printed document and correct it; if it is text, put // before it");
}

TEST(Document, APureListingIsOneFromItsFirstLineToItsLast) {
  const ParseResult result = read("NETZWERK 1\nU I0.0\nSPB 3\nL 5\nT AW0\n= Q0.0\nMEND\n");
  EXPECT_EQ(result.diagnostics.size(), 5U);
  EXPECT_EQ(read("Pump\nLD I0.0\n= Q0.0\nMEND\n").left_out, std::vector<std::uint32_t>{1});
}

TEST(Document, ASmallLAtTheBeginningOfAnAddressIsDamage) {
  EXPECT_EQ(read(article("A l0.1")).diagnostics.size(), 1U);
  EXPECT_EQ(read(article("MOVB *lD4, VB0")).diagnostics.size(), 1U);
  EXPECT_TRUE(read(article("A L0.1")).diagnostics.empty());
  EXPECT_TRUE(read(article("a l0.1")).diagnostics.empty()) << "written small throughout";
}

/// Whatever one character does to a statement: it is read, or an error is reported.
TEST(Document, NoWrongCharacterMakesAStatementDisappear) {
  const ParseResult whole = read(kSheet);
  const std::vector<std::string> lines = split_lines(kSheet);
  for (const Statement& statement : statements(whole.source)) {
    const std::size_t number = statement.position.line;
    const std::string& line = lines[number - 1];
    const std::size_t end = line.find("//");
    for (std::size_t at = 0; at <= std::min(end, line.size()); ++at) {
      for (const char* put : {"", "0", "1", "X", "x", " ", "I", "l", ".", "="}) {
        for (const std::size_t taken : {0U, 1U}) {
          std::string damaged = line;
          if (at + taken > line.size()) continue;
          damaged.replace(at, taken, put);
          std::string text;
          for (std::size_t i = 1; i <= lines.size(); ++i) text.append(i == number ? damaged : lines[i - 1]).append("\n");
          const ParseResult result = read(text);
          const auto found = statements(result.source);
          const bool there =
              std::any_of(found.begin(), found.end(), [&](const Statement& each) { return each.position.line == number; });
          ASSERT_TRUE(there || has_errors(result.diagnostics)) << damaged;
        }
      }
    }
  }
}

TEST(Document, PointsAtTheDamage) {
  const auto error = error_of("  MOVW\t0,VW2�00 // x");
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->position.column, 13U);
  EXPECT_EQ(error->message, "damaged STL line: it contains an unreadable character");
}

TEST(Document, ProseThatBeginsLikeAStatementIsProse) {
  for (const char* line :
       {"A final word about this.", "A pump is started.", "INT 3 Count strokes", "Int  3\tCount the strokes",
        "SBR 10 Preparations", "For each stroke, the count, and so on", "Not all of this is needed.", "A", "S",
        "Call 10 whenever the pump is to be prepared", "End of the description", "A 5 V supply is needed",
        "A VB200 of 5 stands for five strokes", "Next, the pump", "R 5 is a resistor"}) {
    const std::string text = std::string("Overview\n\n") + line + "\n\nDescription\n\n" + std::string(kSheet);
    const ParseResult result = read(text);
    EXPECT_TRUE(result.diagnostics.empty()) << line << ": " << result.diagnostics.front().message;
    EXPECT_EQ(statements(result.source).size(), 14U) << line;
  }
}

TEST(Document, StatementsWithOnlySymbolsAreKeptInAListing) {
  const auto found = statements(read("LD I0.0\nCALL prepare\nLD I0.1\nMEND\n").source);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[1].operands.at(0).value, OperandValue(Name{"prepare"}));
}

TEST(Document, WordsAboutANetworkAreNoHeadingOfOne) {
  const ParseResult result = read("NETWORK 1 // Network Title\nNetwork Comment\n\nLD I0.0\n= Q0.0\nMEND\n");
  EXPECT_TRUE(result.diagnostics.empty()) << result.diagnostics.front().message;
  EXPECT_EQ(result.left_out, std::vector<std::uint32_t>{2});
}

TEST(Document, SaysSoWhenThereIsNoStl) {
  for (const char* text : {"", "\n\n", "Only a few words about a pump.", "// a comment\n", "   ³\n   ÃÄÄÄ´\n"}) {
    const ParseResult result = read(text);
    ASSERT_EQ(result.diagnostics.size(), 1U) << text;
    EXPECT_EQ(result.diagnostics.front().message, "there is no STL in this document");
  }
}

std::string first_error(std::string_view text) {
  const ParseResult result = read(text);
  return result.diagnostics.empty() ? "" : result.diagnostics.front().message;
}

TEST(Document, SaysWhereAListingIsIncomplete) {
  EXPECT_EQ(first_error("LD I0.0\n= Q0.0\n"), "the listing is cut off: the main program has no MEND");
  EXPECT_EQ(first_error("MEND\nSBR 1\nNOT\n"), "the listing is cut off: SBR 1 has no RET");
  EXPECT_EQ(first_error("MEND\nINT 1\nNOT\nCRETI\n"), "the listing is cut off: INT 1 has no RETI");
  EXPECT_EQ(first_error("LD I0.0\nCALL 1\nATCH 2, 8\nMEND\nSBR 1\nRET\n"),
            "the listing is cut off: it uses INT 2, which it does not contain");
  EXPECT_EQ(first_error("MEND\nINT 1\nRET\n"), "INT 1 ends with RET instead of RETI: part of the listing is missing");
  EXPECT_EQ(first_error("MEND\nSBR 1\nSBR 2\nRET\n"), "SBR 2 begins, but SBR 1 has no RET: part of the listing is missing");
  EXPECT_EQ(first_error("MEND\nLD I0.0\nRET\n"), "this statement is not in any routine: part of the listing is missing");
  EXPECT_EQ(first_error("MEND\nRET\n"), "RET does not end any routine: part of the listing is missing");
  EXPECT_EQ(first_error("SBR 1\nRET\n"), "");
}

TEST(Document, ACutAnywhereInTheListingIsNoticed) {
  const std::size_t end = kSheet.rfind("RETI") + 4;
  for (std::size_t cut = 0; cut < end; ++cut) {
    ASSERT_TRUE(has_errors(read(kSheet.substr(0, cut)).diagnostics)) << kSheet.substr(0, cut);
  }
  EXPECT_FALSE(has_errors(read(kSheet.substr(0, end)).diagnostics));
}

TEST(Document, SurvivesLongAndHostileLines) {
  const std::string long_prose(1'000'000, 'a');
  EXPECT_EQ(statements(read("NOT\nMEND\n" + long_prose).source).size(), 2U);
  std::string debris;
  for (int i = 0; i < 100'000; ++i) debris += "�<|";
  EXPECT_TRUE(has_errors(read(debris).diagnostics));
  std::string hostile;
  for (int i = 0; i < 65536; ++i) {
    hostile += i % 3 == 0 ? "A " : "";
    hostile += static_cast<char>(i >> 8);
    hostile += static_cast<char>(i);
    hostile += i % 5 == 0 ? "\n" : "";
  }
  EXPECT_FALSE(read(hostile).source.text.empty());
  is_document(hostile, kInstructions);
}

class Tip41 : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt");
    std::ifstream file(path, std::ios::binary);
    if (!file) GTEST_SKIP() << "the document is not here: " << path;
    text_.assign(std::istreambuf_iterator<char>(file), {});
  }

  std::string text_;
};

TEST_F(Tip41, IsADocument) { EXPECT_TRUE(is_document(text_, kInstructions)); }

TEST_F(Tip41, YieldsItsStatementsRoutineByRoutine) {
  const ParseResult result = read(text_);
  ASSERT_TRUE(result.diagnostics.empty()) << render(result.diagnostics.front(), result.source, false);
  const auto found = statements(result.source);
  EXPECT_EQ(found.size(), 340U);
  std::string heads;
  for (const Statement& statement : found) {
    if (statement.mnemonic == "SBR" || statement.mnemonic == "INT") {
      heads += statement.mnemonic[0] + std::to_string(std::get<Integer>(statement.operands.at(0).value).value) + ' ';
    }
  }
  EXPECT_EQ(heads, "S50 S51 S52 S53 S54 S55 S56 S57 S61 S62 S63 I120 I121 I122 I123 I124 I125 ");
}

/// Every `//` of the document except the one that its conversion notes mention.
TEST_F(Tip41, YieldsAllComments) {
  const ParseResult result = read(text_);
  std::string all;
  for (const Line& line : result.source.lines) {
    if (const auto* statement = std::get_if<Statement>(&line)) all += statement->comment + '\n';
    if (const auto* comment = std::get_if<CommentLine>(&line)) all += comment->text + '\n';
  }
  std::size_t comments = 0;
  for (const std::string& line : result.source.text) {
    const std::size_t start = line.find("//");
    if (start == std::string::npos || line.find("\u2018//\u2019") != std::string::npos) continue;
    std::string text = line.substr(start + 2);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.pop_back();
    while (text.ends_with("\uFFFD")) text.resize(text.size() - 3);
    EXPECT_NE(all.find(text), std::string::npos) << line;
    ++comments;
  }
  EXPECT_GT(comments, 400U);
}

TEST_F(Tip41, PrintsAndReadsBackAsTheSameProgram) {
  const ParseResult result = read(text_);
  const ParseResult again = parse(to_text(result.source), "tip.stl");
  EXPECT_TRUE(again.diagnostics.empty());
  EXPECT_TRUE(same_program(result.source, again.source));
  EXPECT_FALSE(is_document(to_text(result.source), kInstructions));
}

TEST_F(Tip41, ACutInTheListingIsNoticed) {
  const std::size_t end = text_.rfind("\nRETI") + 5;  // the notes after it mention RETI too
  const auto noticed = [&](std::size_t cut) { return has_errors(read(std::string_view(text_).substr(0, cut)).diagnostics); };
  for (std::size_t cut = 0; cut < end; cut += 997) ASSERT_TRUE(noticed(cut)) << cut;
  for (std::size_t cut = end - 60; cut < end; ++cut) ASSERT_TRUE(noticed(cut)) << cut;
  EXPECT_FALSE(noticed(end));
}

TEST(Document, StatementsWithSymbolsOneAfterTheOtherAreStatements) {
  const std::string around = "This is an example of a small pump control that we used in our plant for many years.\n\n";
  EXPECT_EQ(to_text(read(around + "LD Start\nA Stop\n= Pump\nLD I0.1\n= Q0.1\nMEND\n\n" + around).source),
            "LD      Start\nA       Stop\n=       Pump\nLD      I0.1\n=       Q0.1\nMEND\n");
  const ParseResult apart = read(around + "LD I0.1\n= Q0.1\n\n" + around + "LD Start\nA Stop\n= Pump\nMEND\n\n" + around);
  EXPECT_EQ(statements(apart.source).size(), 6U) << "a rung between paragraphs";
}

}  // namespace
}  // namespace s7200::stl::document_test
