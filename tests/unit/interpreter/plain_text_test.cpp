// Programs that have been through a web page, a word processor or a book.
#include "interpreter/stl/text/plain_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::plain_text_test {
namespace {

SourceText read(const std::string& text) {
  auto source = read_source(text, "page.txt");
  EXPECT_TRUE(source) << source.why() << "\n" << text;
  return source ? *source : SourceText{};
}

CheckResult checked(const std::string& text) {
  return check(read(text).parsed, *find_cpu("224"), default_times(*find_cpu("224")));
}

std::string diagnostics(const CheckResult& result) { return stl::render(result.diagnostics, result.source, false); }

/// The program in a text, as the printer writes it.
std::string program(const std::string& text) { return stl::to_text(read(text).parsed.source); }

/// The only note.
std::string note(const std::string& text) {
  const auto notes = read(text).parsed.notes;
  EXPECT_EQ(notes.size(), 1U) << text;
  return notes.empty() ? "" : notes.front();
}

TEST(PlainText, UnicodeBlanksSeparateWords) {
  for (const char* blank : {"\u00A0", "\u2003", "\u202F", "\u3000", "\u2009"}) {
    const std::string text = std::string("LD") + blank + "I0.0\n=" + blank + "Q0.0\n";
    EXPECT_EQ(program(text), program("LD I0.0\n= Q0.0\n")) << blank;
    EXPECT_EQ(note(text), "page.txt: read as plain text: no-break and other Unicode blanks; the first in line 1");
  }
}

TEST(PlainText, FullWidthSignsAreThoseOfAscii) {
  EXPECT_EQ(program("ＬＤ　Ｉ０．０\n＝　Q0。0\nMOVB 16＃0F，VB０　／／　注释，\nMOVB 1、VB1\n"),
            program("LD I0.0\n= Q0.0\nMOVB 16#0F, VB0 //　注释，\nMOVB 1, VB1\n"));
}

TEST(PlainText, TypographicSignsAreThoseOfAscii) {
  EXPECT_EQ(program("MOVB ‘A’, VB0\nMOVW –5, VW2\nMOVD −1, ×VD4\nLDW≥ VW2, 5\nAW≠ VW4, 1\n= Q0·1\n"),
            program("MOVB 'A', VB0\nMOVW -5, VW2\nMOVD -1, *VD4\nLDW>= VW2, 5\nAW<> VW4, 1\n= Q0.1\n"));
  EXPECT_EQ(program("LD “Pump”\n= „Lamp“\n= «Horn»\n"), program("LD \"Pump\"\n= \"Lamp\"\n= \"Horn\"\n"));
}

TEST(PlainText, CharactersThatNobodySeesAreLeftOut) {
  EXPECT_EQ(program("\u200BLD I\u200B0.\u00AD0\n= Q0.0\uFEFF\n"), program("LD I0.0\n= Q0.0\n"));
}

TEST(PlainText, CommentsAndQuotedTextStayAsTheyAre) {
  const SourceText source = read("LD I0.0 // “a”，b\u00A0c\nMOVB ' ', VB0\n");
  EXPECT_EQ(std::get<stl::Statement>(source.parsed.source.lines[0]).comment, " “a”，b\u00A0c");
  EXPECT_TRUE(source.parsed.notes.empty());
}

TEST(PlainText, OtherQuotesAreAllowedInQuotedText) {
  EXPECT_EQ(program("LD “it\'s，”\n= Q0．0 // x\n"), program("LD \"it\'s，\"\n= Q0.0 // x\n"));
  EXPECT_EQ(read("Symbol\tAddress\n\"Pump，1\"\tQ0．0\n").parsed.source.symbols.front().name, "Pump，1");
}

TEST(PlainText, ErrorsPointAtTheTextAsItIs) {
  const CheckResult result = checked("LD I0.0\nMOVB　1，VB99999\n");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].position, (stl::Position{2, 8, 7}));
  EXPECT_NE(diagnostics(result).find("\nMOVB　1，VB99999\n"), std::string::npos) << diagnostics(result);
}

TEST(PlainText, HtmlIsLeftOutAndItsEntitiesAreRead) {
  const std::string page =
      "<html><body>Hello,<br>my program:\n<pre class=\"code\">LD&nbsp;I0.0\nAW&gt;= VW0, 5 <b>// x &lt; 5</b>\n= "
      "Q0.0</pre>\nThanks\n";
  EXPECT_EQ(program(page), program("\nLD I0.0\nAW>= VW0, 5 // x < 5\n= Q0.0\n\n"));
  EXPECT_EQ(note(page),
            "page.txt: read as plain text: no-break and other Unicode blanks, HTML; the first in line 2; "
            "left out around the program: lines 1, 5");
}

TEST(PlainText, TextBetweenTagsIsLeftOutAndNamed) {
  const std::string listing = "LD SM0.1\nMOVB 16#09, SMB30\n", rest = "LD I0.0\n= Q0.0\nMEND\n";
  for (const char* text : {"<p>Beispiel aus dem Forum:</p>", "<p>Und dann:</p>", "<h2>Beispiel</h2>",
                           "<div>Hier das Programm</div>", "<p>Danke!</p>", "<p>Example 1:</p>"}) {
    EXPECT_EQ(program(text + ("\n" + listing + rest)), program("\n" + listing + rest)) << text;
    EXPECT_EQ(program(listing + text + "\n" + rest), program(listing + "\n" + rest)) << text;
    EXPECT_EQ(note(listing + text + "\n" + rest), "page.txt: read as plain text: HTML; left out around the program: line 3");
  }
}

TEST(PlainText, WhatMayBeADamagedStatementBetweenTagsIsNotLeftOut) {
  for (const char* line : {"<p>LD I0,0</p>", "<p>LD 10.0:</p>", "<div>MOVB Speed, Level</div>",
                           "<div>movw speed level</div>", "<p>Call Pump</p>", "<h2>= Q0.0</h2>"})
    for (const std::string& note : read(std::string("LD I0.0\n") + line + "\n= Q0.1\nMEND\n").parsed.notes)
      EXPECT_EQ(note.find("left out"), std::string::npos) << line;
}

TEST(PlainText, TagsThatEndALineDo) {
  const std::string page = "LD I0.0<br>A I0.1 // x<br/>= Q0.0<br>MOVB 1, VB99999</p>";
  EXPECT_EQ(program(page), program("LD I0.0\nA I0.1 // x\n= Q0.0\nMOVB 1, VB99999\n"));
  const CheckResult result = checked(page);
  ASSERT_EQ(result.diagnostics.size(), 1U) << diagnostics(result);
  EXPECT_EQ(result.diagnostics[0].position, (stl::Position{1, static_cast<std::uint32_t>(page.find("VB99999") + 1), 7}));
}

TEST(PlainText, ComparisonsAreNoTags) {
  EXPECT_TRUE(read("LDW< VW0, VW2\nAB<> VB0, 1\nOD<= VD0, VD4\n= Q0.0\n").parsed.notes.empty());
  EXPECT_TRUE(read("LD SM0.0 // <b>&lt;</b>\nMOVD &VB0, VD4; // x\n").parsed.notes.empty());
}

TEST(PlainText, OfMarkdownOnlyTheFencedPartsCount) {
  const std::string post = "My **program**:\n\n```stl\nLD I0.0\n= Q0.0\n```\nand then\n~~~\nLD I0.1\n= Q0.1\n~~~\n";
  EXPECT_EQ(program(post), program("\n\n\nLD I0.0\n= Q0.0\n\n\n\nLD I0.1\n= Q0.1\n\n"));
  EXPECT_EQ(note(post), "page.txt: read as plain text: Markdown; left out around the program: lines 1, 7");
  EXPECT_EQ(program("`LD I0.0`\n`= Q0.0`\n"), program("LD I0.0\n= Q0.0\n"));
}

TEST(PlainText, ASingleFenceHasLostTheOther) {
  EXPECT_EQ(program("LD I0.0\n= Q0.0\n```\n"), program("LD I0.0\n= Q0.0\n\n"));
}

TEST(PlainText, NothingThatLooksLikeAStatementIsCutOff) {
  EXPECT_EQ(program("LD I0.0\n= Q0.0\n```\nLD I0.1\n= Q0.1\n```\n"), program("LD I0.0\n= Q0.0\n\nLD I0.1\n= Q0.1\n\n"));
}

TEST(PlainText, LineNumbersAreLeftOutIfAllLinesHaveThem) {
  EXPECT_EQ(program("1 LD I0.0\n2 = Q0.0\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("001: LD I0.0\n002: // x\n010: = Q0.0\n"), program("LD I0.0\n// x\n= Q0.0\n"));
  EXPECT_EQ(program("1: LD I0.0\n2: = Q0.0\n3: LD I0.1\n4: = Q0.1\n"), program("LD I0.0\n= Q0.0\nLD I0.1\n= Q0.1\n"))
      << "which is no STEP 5";
  EXPECT_EQ(program("NETWORK 1\n1. LD I0.0\n2. = Q0.0\nNETWORK 2\n1. LD I0.1\n2. = Q0.1\n"),
            program("NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\n"));
  EXPECT_EQ(program("1.\u00A0NETWORK 1\n2.\u00A0LD SM0.1\n3.\t\u2009= Q0.0\n4.\u00A0MEND\n"),
            program("NETWORK 1\nLD SM0.1\n= Q0.0\nMEND\n"))
      << "with the blanks of web pages behind them";
  EXPECT_EQ(note("[1] LD I0.0\n[2] = Q0.0\n"), "page.txt: read as plain text: line numbers; the first in line 1");
  EXPECT_TRUE(read("LD I0.0\n2 = Q0.0\n").parsed.notes.empty());
  EXPECT_TRUE(read("VB0 1\n2 // more\n3 // values\n").parsed.notes.empty());
}

TEST(PlainText, HeadingsInOtherLanguagesAndHeadsOfPagesStandBetweenLineNumbers) {
  const std::string plain = program("NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\n");
  EXPECT_EQ(program("网络 1\n 1  LD  I0.0\n 2  =   Q0.0\n网络 2\n 3  LD  I0.1\n 4  =   Q0.1\n"), plain);
  EXPECT_EQ(program("Netzwerk 1\n1 LD I0.0\n2 = Q0.0\nNetzwerk 2\n3 LD I0.1\n4 = Q0.1\n"), plain);
  const std::string paged = "Network 1\n1 LD I0.0\n2 = Q0.0\nS7-200 Handbook    page 13\nNetwork 2\n3 LD I0.1\n4 = Q0.1\n";
  EXPECT_EQ(program(paged), program("NETWORK 1\nLD I0.0\n= Q0.0\n\nNETWORK 2\nLD I0.1\n= Q0.1\n"));
  EXPECT_NE(note(paged).find("line 4"), std::string::npos) << "what is left out is named: " << note(paged);
  const std::string routine = "Network 1\n1 LD I0.0\n2 = Q0.0\n中断程序 INT_0\nNetwork 1\n3 LD I0.1\n4 = Q0.1\n";
  EXPECT_EQ(note(routine).find("left out"), std::string::npos) << "what names a routine is no text: " << note(routine);
}

TEST(PlainText, MarginsOfMailAndListsAreLeftOut) {
  EXPECT_EQ(program("> LD I0.0\n> = Q0.0\n>\n"), program("LD I0.0\n= Q0.0\n\n"));
  EXPECT_EQ(program("• LD I0.0\n• = Q0.0\n"), program("LD I0.0\n= Q0.0\n"));
}

TEST(PlainText, ListMarksAndBoldLettersOfMarkdownAreLeftOut) {
  EXPECT_EQ(program("- LD I0.0\n- = Q0.0\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("## NETWORK 1\n* **LD I0.0**\n* `= Q0.0` // lamp\n"), program("NETWORK 1\nLD I0.0\n= Q0.0 // lamp\n"));
  EXPECT_EQ(program("LD I0.0\n-I VW0, VW2\n*R VD4, VD8\n"), "LD      I0.0\n-I      VW0, VW2\n*R      VD4, VD8\n")
      << "instructions";
}

TEST(PlainText, TextAroundNumberedOrQuotedLinesIsLeftOut) {
  EXPECT_EQ(program("From the forum:\n1. LD I0.0\n2. = Q0.0\n\nThanks, Jim\n"), program("\nLD I0.0\n= Q0.0\n\n\n"));
  EXPECT_EQ(program("Jim wrote:\n> LD I0.0\n> = Q0.0\n"), program("\nLD I0.0\n= Q0.0\n"));
  EXPECT_EQ(note("Jim wrote:\n> LD I0.0\n> = Q0.0\n"),
            "page.txt: read as plain text: marks in the margin; the first in line 2; left "
            "out around "
            "the program: line 1");
}

TEST(PlainText, PagesHaveWholeProgramsInOneLine) {
  EXPECT_EQ(program("NETWORK 1 // start<br>LD I0.0<br>= Q0.0<br>"), program("NETWORK 1 // start\nLD I0.0\n= Q0.0\n"));
}

/// What a program has been through: signs, numbers, marks around each line, and all around it.
struct Passage {
  const char* name;
  std::string (*of)(std::string line, int number);
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

const Passage kSigns[] = {
    {"plain", [](std::string line, int) { return line; }},
    {"full-width", [](std::string line, int) { return replaced(replaced(line, "= ", "＝　"), ".", "．"); }},
    {"typographic", [](std::string line, int) { return replaced(replaced(line, "-", "–"), "'", "’"); }},
    {"no-break", [](std::string line, int) { return replaced(line, " ", "\u00A0"); }},
};
const Passage kNumbers[] = {
    {"none", [](std::string line, int) { return line; }},
    {"1. ", [](std::string line, int number) { return std::to_string(number) + ". " + line; }},
    {"01: ", [](std::string line, int number) { return "0" + std::to_string(number) + ":\u00A0" + line; }},
    {"1 | ", [](std::string line, int number) { return std::to_string(number) + " | " + line; }},
    {"(1)", [](std::string line, int number) { return "(" + std::to_string(number) + ")\t" + line; }},
    {"1、", [](std::string line, int number) { return std::to_string(number) + "、" + line; }},
    {"1- ", [](std::string line, int number) { return std::to_string(number) + "- " + line; }},
};
const Passage kMarks[] = {
    {"none", [](std::string line, int) { return line + "\n"; }},
    {"> ", [](std::string line, int) { return "> " + line + "\n"; }},
    {"> > ", [](std::string line, int) { return "> > " + line + "\n"; }},
    {"&gt; <br>", [](std::string line, int) { return "&gt; " + line + "<br>"; }},
    {"<br>", [](std::string line, int) { return line + "<br>\n"; }},
    {"<li>", [](std::string line, int) { return "<li>" + line + "</li>"; }},
    {"<td>", [](std::string line, int) { return "<tr><td>" + line + "</td></tr>\n"; }},
    {"• ", [](std::string line, int) { return "• " + line + "\n"; }},
    {"- ", [](std::string line, int) { return "- " + line + "\n"; }},
    {"U+2028", [](std::string line, int) { return line + "\u2028"; }},
};

TEST(PlainText, WhatAProgramHasBeenThroughMayBeCombined) {
  const std::vector<std::string> lines{"NETWORK 1", "LD SM0.1", "MOVW -16, VW10", "MOVB 'A', VB100", "= Q0.0",
                                       "ENI",       "MEND"};
  for (const Passage& signs : kSigns)
    for (const Passage& numbers : kNumbers)
      for (const Passage& marks : kMarks)
        for (const bool code : {false, true}) {
          std::string text;
          for (std::size_t i = 0; i < lines.size(); ++i) {
            const std::string line = signs.of(lines[i], 0);
            const int number = static_cast<int>(i) + 1;
            text += marks.of(numbers.of(code ? "`" + line + "`" : line, number), number);
          }
          const CheckResult result = checked(text);
          EXPECT_TRUE(result.program && result.program->ops.size() == 6)
              << signs.name << ", " << numbers.name << ", " << marks.name << "\n"
              << text << diagnostics(result);
        }
}

TEST(PlainText, PlacesAreRightAfterSeveralSteps) {
  const std::string text = "Jim wrote:\n> 1、`LD　I0．0`\n> 2、`MOVB　1，VB99999`\n";
  const CheckResult result = checked(text);
  ASSERT_EQ(result.diagnostics.size(), 1U) << diagnostics(result);
  EXPECT_EQ(result.diagnostics[0].position, (stl::Position{3, 13, 7})) << diagnostics(result);
}

TEST(PlainText, APercentSignBeforeAnAddressIsLeftOut) {
  EXPECT_EQ(program("LD %I0.0\nA %IX0.1\n= %Q0.0\nMOVW %IW2, %VW10\n"),
            program("LD I0.0\nA IX0.1\n= Q0.0\nMOVW IW2, VW10\n"));
}

TEST(PlainText, LineEndsOfWordProcessorsEndALine) {
  EXPECT_EQ(program("LD I0.0\x0B= Q0.0\u2028LD I0.1\n= Q0.1\n"), program("LD I0.0\n= Q0.0\nLD I0.1\n= Q0.1\n"));
  EXPECT_EQ(program("LD I0.0 // Tür\u2028= Q0.0\n"), program("LD I0.0 // Tür\n= Q0.0\n")) << "also at the end of a comment";
}

TEST(PlainText, SymbolTablesAreReadTheSameWay) {
  const SourceText table = read("Symbol\tAddress\nPump\tQ0．1\nMotor\t\u00A0M0.0\n");
  ASSERT_EQ(table.parsed.source.symbols.size(), 2U);
  EXPECT_EQ(stl::to_text({*table.parsed.source.symbols[0].value, {}}), "Q0.1");
  EXPECT_EQ(stl::to_text({*table.parsed.source.symbols[1].value, {}}), "M0.0");
}

TEST(PlainText, APlainTextHasNoNote) {
  for (const char* text : {"LD I0.0\n= Q0.0\n", "LD I0.0 // 注释，“x”\n= Q0.0\n", "// %I0.0 <br> `x`\nLD I0.0\n"})
    EXPECT_TRUE(read(text).parsed.notes.empty()) << text;
}

TEST(PlainText, NoMessageSpeaksOfTheCharacter) {
  for (const char* text : {"注释 LD SM0.0\nLD SM0.0\n", "LD SM0.0\nMOVB 1\x01, VB0\n", "LD SM0.0\nMOVB 1注, VB0\n"}) {
    const std::string shown = diagnostics(checked(text));
    EXPECT_EQ(shown.find("the character"), std::string::npos) << shown;
    EXPECT_NE(shown.find("U+"), std::string::npos) << shown;
  }
}

// --- letters that look like others ---

std::string first_error(const std::string& text) {
  const CheckResult result = checked(text);
  if (result.diagnostics.empty()) return {};
  return result.diagnostics[0].message + "; " + result.diagnostics[0].hint;
}

TEST(LookAlikes, LettersInPlaceOfDigitsAreNamed) {
  EXPECT_EQ(first_error("LD IO.0\n= Q0.0\n"), "IO.0 has the letter O in place of the digit 0; write I0.0");
  EXPECT_EQ(first_error("LD I0.l\n= Q0.0\n"), "I0.l has the letter l in place of the digit 1; write I0.1");
  EXPECT_EQ(first_error("LD SM0.0\nMOVB 16#O9, VB0\n"), "16#O9 has the letter O in place of the digit 0; write 16#09");
  EXPECT_EQ(first_error("LD SM0.0\nMOVB 1, VB1OO\n"), "VB1OO has the letter O in place of the digit 0; write VB100");
  EXPECT_EQ(first_error("LD SM0.0\nTON T3l, 10\n"), "T3l has the letter l in place of the digit 1; write T31");
}

TEST(LookAlikes, CyrillicAndGreekLettersAreNamed) {
  EXPECT_EQ(first_error("LD SM0.0\n\u0410N I0.0\n= Q0.0\n"), "\u0410N has the Cyrillic letter \u0410 (U+0410); write AN");
  EXPECT_EQ(first_error("LD SM0.0\nM\u041EVB 1, VB0\n"), "M\u041EVB has the Cyrillic letter \u041E (U+041E); write MOVB");
  EXPECT_EQ(first_error("LD SM0.0\nMOVB 1, V\u03920\n"), "V\u03920 has the Greek letter \u0392 (U+0392); write VB0");
}

TEST(LookAlikes, AllOfThemHaveOneCause) {
  const CheckResult result = checked("LD IO.0\nA I0.l\n= QO.0\nLD SM0.0\nMOVB 1, VB1O\n");
  EXPECT_EQ(result.diagnostics.size(), 4U) << diagnostics(result);
  EXPECT_EQ(stl::count_causes(result.diagnostics), 1U) << diagnostics(result);
}

TEST(LookAlikes, SymbolsMayLookAsTheyLike) {
  std::vector<SourceText> files{read("LD SM0.0\nMOVB 1, VB1O\nMOVB 2, Т1\n"), read("Symbol\tAddress\nVB1O\tVB5\nТ1\tVB6\n")};
  const CpuModel& model = *find_cpu("224");
  const CheckResult result = check(join_files(std::move(files)).parsed, model, default_times(model));
  EXPECT_TRUE(result.program) << diagnostics(result);
}

std::string without_blank_lines(std::string text) {
  text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == '\n' && b == '\n'; }), text.end());
  return text;
}

TEST(PlainText, TheTimesAndNamesOfAChatAreLeftOutWithWhatIsNoStatement) {
  const std::string expected = program("LD I0.0\nAN I0.1\n= Q0.0\nLD Q0.0\nTON T37, 50\n");
  for (const char* const chat :
       {"[27.11.26, 14:02:11] Hans: this is it\n[27.11.26, 14:02:30] Hans: LD I0.0\n[27.11.26, 14:02:33] Hans: AN I0.1\n"
        "[27.11.26, 14:02:38] Hans: = Q0.0\n[27.11.26, 14:03:01] Jo: and the timer?\n[27.11.26, 14:03:20] Hans: LD Q0.0\n"
        "[27.11.26, 14:03:25] Hans: TON T37, 50\n",
        "27.11.26, 14:02 - Pam: LD I0.0\nAN I0.1\n= Q0.0\n27.11.26, 14:03 - Paul M.: LD Q0.0\nTON T37, 50\n",
        "11/27/26, 2:02 PM - Pam: LD I0.0\nAN I0.1\n= Q0.0\n11/27/26, 2:03 PM - Amy: LD Q0.0\nTON T37, 50\n",
        "14:02 <hans> LD I0.0\n14:02 <hans> AN I0.1\n14:02 <hans> = Q0.0\n14:02 <jo> hm\n14:03 <hans> LD Q0.0\n"
        "14:03 <hans> TON T37, 50\n"})
    EXPECT_EQ(without_blank_lines(program(chat)), expected) << chat;
  EXPECT_EQ(note("14:02 <hans> LD I0.0\n14:02 <jo> hm\n14:02 <hans> = Q0.0\n"),
            "page.txt: read as plain text: marks in the margin; the first in line 1; left out "
            "around the program: line 2");
}

TEST(PlainText, TheMarksOfAForumAroundCodeAreFences) {
  EXPECT_EQ(program("Hello,\nhere it is:\n[code]\nLD I0.0\n= Q0.0\n[/code]\nThanks\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("My program\n[CODE=stl]\nLD I0.0\n= Q0.0\n[/CODE]\n"), program("LD I0.0\n= Q0.0\n"));
}

TEST(PlainText, ATableAndASentenceAreNoStatements) {
  const std::string expected = program("LD I0.0\n= Q0.0\n");
  EXPECT_EQ(
      program("# Pump\n\nHere's it:\n\n```stl\nLD I0.0\n= Q0.0\n```\n\n| Name | Address |\n|---|---|\n| Pump | Q0.0 |\n"),
      expected);
  EXPECT_EQ(program("On Friday Joe wrote:\n> LD I0.0\n> = Q0.0\n>\n> Hope this really helps\n"), expected);
}

TEST(PlainText, SentencesAroundAListingAreLeftOutAndNamed) {
  const std::string listing = "NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\nLD SM0.1\nMOVW 3, VW0\n";
  for (const char* above : {"The following example shows the program.\n", "This is my program:\n", "See Fig. 3.\n",
                            "Code:\n", "Hi, here is my code for the S7-200:\n"}) {
    const SourceText text = read(above + listing + "Regards\nJohn Doe\n");
    EXPECT_TRUE(text.parsed.diagnostics.empty()) << above << stl::render(text.parsed.diagnostics, text.parsed.source, false);
    EXPECT_EQ(text.parsed.left_out.front(), 1U) << above;
    EXPECT_EQ(text.parsed.source.text.size(), 9U) << "errors point at the text that the user has";
  }
  EXPECT_FALSE(checked("Motr I0.0\n" + listing).program) << "a mistyped statement is no text";
  EXPECT_FALSE(checked("LDX\n" + listing).program);
}

TEST(PlainText, AQuotedMailMayHaveHeadsAndAGreeting) {
  const std::string program = "NETWORK 1\nLD      I0.0\n=       Q0.0\n";
  EXPECT_EQ(
      stl::to_text(read("From: Klaus B. <k.b@example.de>\nTo: forum\nSubject: Re: pump, please help\n\n"
                        "On Tue, 12 Mar 2019 at 10:12, John wrote:\n> Hi, here is the program of the S7-200 CPU 224:\n>\n"
                        "> NETWORK 1\n> LD I0.0\n> = Q0.0\n")
                       .parsed.source),
      program);
}

TEST(PlainText, RowsOfATableAreStatements) {
  EXPECT_EQ(program("|NETWORK|1||\n|LD|I0.0|start|\n|MOVW|100|VW0|\n|LPS|||\n|A|I0.1||\n|=|Q0.0|\n"),
            program("NETWORK 1\nLD I0.0 //start\nMOVW 100, VW0\nLPS\nA I0.1\n= Q0.0\n"));
  EXPECT_EQ(program("| No | Instruction | Operand | Comment |\n|---:|---|---|---|\n| 1 | LD | Start_Button | the button "
                    "|\n| 2 | MOVB | 1, VB0 |  |\n"),
            program("LD Start_Button // the button\nMOVB 1, VB0\n"));
  EXPECT_EQ(program("| Instruction | Operand |\n|---|---|\n| LD | I0.0 |\n| = | Q0.0 |\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("| LD I0.0 | start |\n| = Q0.0 | lamp |\n"), program("LD I0.0 // start\n= Q0.0 // lamp\n"));
  EXPECT_EQ(note("|LD|I0.0|\n|=|Q0.0|\n"), "page.txt: read as plain text: cells of a table; the first in line 1");
  EXPECT_NE(diagnostics(checked("|LD|I0.0|\n|LD|I0.1|\n|MOVW|VB0|VW2|\n")).find("page.txt:3:"), std::string::npos);
}

TEST(PlainText, RowsWithOtherSignsBetweenTheirCellsAreStatements) {
  const std::string plain = program("LD SM0.1 //first scan\nMOVB 16#09, SMB30 //port\nLD I0.0\n= Q0.0 //motor\n");
  EXPECT_EQ(program("Network;Instruction;Operand;Comment\n1;LD;SM0.1;first scan\n1;MOVB;16#09, SMB30;port\n2;LD;I0.0;\n"
                    "2;=;Q0.0;motor\n"),
            plain);
  EXPECT_EQ(program("LD,SM0.1,,first scan\nMOVB,16#09,SMB30,port\nLD,I0.0,,\n=,Q0.0,,motor\n"), plain);
  EXPECT_EQ(program("LD,SM0.1,first scan\nMOVB,\"16#09, SMB30\",port\nLD,I0.0,\n=,\"Q0.0\",motor\n"), plain);
  EXPECT_EQ(program("1\tLD\tSM0.1\tfirst scan\n2\tMOVB\t16#09, SMB30\tport\n3\tLD\tI0.0\t\n4\t=\tQ0.0\tmotor\n"), plain);
  EXPECT_EQ(program("MOVB\t16#09,\tSMB30\tport\n=\tQ0.0\tmotor\n"), program("MOVB 16#09, SMB30 //port\n= Q0.0 //motor\n"));
}

TEST(PlainText, ARowOfATableWithTwoOperandsIsAStatementWithoutACoil) {
  EXPECT_EQ(program("| LD | SM0.1 |\n| S | Q0.0, 1 |\n"), program("LD SM0.1\nS Q0.0, 1\n"));
  EXPECT_EQ(program("| Instruction | Operand |\n|---|---|\n| LD | SM0.1 |\n| MOVB | 16#09, SMB30 |\n"),
            program("LD SM0.1\nMOVB 16#09, SMB30\n"));
}

TEST(PlainText, TablesOfSymbolsWithAnySignsStayTables) {
  for (const char* table :
       {"Symbol;Address;Comment\nPump;Q0.0;main\nStart;I0.0;green\n", "Pump,Q0.0,main\nStart,I0.0,green\n",
        "Pump\tQ0.0\tmain\nPUMP2\tQ0.1\tspare\n", "| Operation | Q0.0 |\n| Command | VW10 |\n"}) {
    EXPECT_EQ(read(table).parsed.source.symbols.size(), 2U) << table;
    EXPECT_TRUE(read(table).parsed.source.lines.empty()) << table;
  }
}

TEST(PlainText, HeadingsOfNetworksInOtherLanguagesAreRead) {
  const std::string plain = program("NETWORK 1 // Start\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\n");
  for (const auto& [first, second] : {std::pair("Netzwerk 1: Start", "Netzwerk 2"),
                                      {"Réseau 1 // Start", "Réseau 2"},
                                      {"网络1：Start", "网络 2"},
                                      {"Сеть 1 - Start", "Сеть 2"},
                                      {"SEGMENTO 1: Start", "SEGMENTO 2"},
                                      {"Rung 1: Start", "Rung 2"},
                                      {"Sieć 1: Start", "Sieć 2"},
                                      {"Ağ 1: Start", "Ağ 2"},
                                      {"Network #1: Start", "Network #2"},
                                      {"NW 1: Start", "NW 2"},
                                      {"NETWORK 1: Start", "NETWORK 2"},
                                      {"Network 1    Start", "Network 2"}})
    EXPECT_EQ(program(std::string(first) + "\nLD I0.0\n= Q0.0\n" + second + "\nLD I0.1\n= Q0.1\n"), plain) << first;
  EXPECT_EQ(note("Réseau 1\nLD I0.0\n= Q0.0\n"), "page.txt: read as plain text: headings of networks; the first in line 1");
  EXPECT_NE(diagnostics(checked("Netzwerk 1\nLD I0.8\n= Q0.0\n")).find("page.txt:2:"), std::string::npos);
}

TEST(PlainText, AnInstructionBesideAHeadingIsNoTitle) {
  for (const char* line : {"NETWORK 1  NOT", "NETWORK 1 LD I0.0", "network 1  not", "NETWORK 1: LD I0.0"})
    EXPECT_TRUE(stl::has_errors(checked(std::string(line) + "\nLD I0.0\n= Q0.0\n").diagnostics)) << line;
}

TEST(PlainText, MarksOfEditorsAndPagesAroundCodeAreFences) {
  for (const auto& [before, after] : {std::pair("{code:title=x}", "{code}"),
                                      {"{noformat}", "{noformat}"},
                                      {"#+BEGIN_SRC stl", "#+END_SRC"},
                                      {"\\begin{verbatim}", "\\end{verbatim}"},
                                      {"\\begin{lstlisting}[language=STL]", "\\end{lstlisting}"},
                                      {"[source,stl]\n----", "----"},
                                      {"<syntaxhighlight lang=\"text\">", "</syntaxhighlight>"}}) {
    const auto source = read("Some text before it:\n" + std::string(before) + "\nLD I0.0\n= Q0.0\n" + after + "\nThanks!\n");
    EXPECT_TRUE(source.parsed.diagnostics.empty()) << before;
    EXPECT_NE(stl::to_text(source.parsed.source).find("LD      I0.0\n=       Q0.0\n"), std::string::npos) << before;
  }
}

TEST(PlainText, FileAndLineOfGrepAreLeftOut) {
  EXPECT_EQ(program("main.stl:1:LD I0.0\nmain.stl:2:= Q0.0\n"), program("LD I0.0\n= Q0.0\n"));
}

TEST(PlainText, ASemicolonBetweenOperandsIsAComma) {
  EXPECT_EQ(program("LD SM0.0\nmovw 5; vw8\nMOVW 5;VW10 // set\n"), program("LD SM0.0\nmovw 5, vw8\nMOVW 5, VW10 // set\n"));
  EXPECT_EQ(program("LD I0.0;\n= Q0.0;\n"), program("LD I0.0\n= Q0.0\n"));
}

TEST(PlainText, TheTextOfAPageOfAManualHasItsHeadingsDownTheMargin) {
  EXPECT_EQ(program("M\nA\nI\nN\nNETWORK 1\nLD SM0.1\nATCH 0, 23\nI\nN\nT\n0\nNETWORK 1\nLD SM0.0\nCRETI\n"),
            program("MAIN\n\n\n\nNETWORK 1\nLD SM0.1\nATCH 0, 23\nINT0\n\n\n\nNETWORK 1\nLD SM0.0\nCRETI\n"));
  EXPECT_EQ(program("LD SM0.1\nMOVB 16#09, SMB30\n//Select 9600 baud, con-\ntrol by the user\nLD I0.0\n= Q0.0\n"),
            program("LD SM0.1\nMOVB 16#09, SMB30\n//Select 9600 baud, con-\n// trol by the user\nLD I0.0\n= Q0.0\n"));
}

TEST(PlainText, TheSymbolInformationOfAPrintoutIsRead) {
  const auto result = checked(
      "Network 1   Pump\nLD     Start\n=      Pump\n\nSymbol   Address   Comment\nPump     Q0.0      main pump\n"
      "Start    I0.0      green\n\nNetwork 2   Timer\nLD     Pump\nTON    T37, 50\n\nSymbol   Address   Comment\n"
      "Pump     Q0.0      main pump\n");
  EXPECT_FALSE(stl::has_errors(result.diagnostics)) << diagnostics(result);
}

TEST(PlainText, APatchAndAMailSayWhatToDo) {
  for (const auto& [text, says] :
       {std::pair("--- a/m.awl\n+++ b/m.awl\n@@ -1,3 +1,3 @@\n LD I0.0\n-A I0.1\n+AN I0.1\n = Q0.0\n",
                  "apply it with patch"),
        {"Content-Transfer-Encoding: quoted-printable\n\nLD I0.0\n=3D Q0.0\n", "save its text"},
        {"LD I0.0\n=3D Q0.0\n", "save its text"}}) {
    std::string why = read_source(text, "page.txt").why();
    EXPECT_NE(why.find(says), std::string::npos) << why;
  }
}

TEST(PlainText, EntitiesInCommentsOfAPageAreRead) {
  EXPECT_EQ(program("LD I0.0 // &quot;Start&quot; &amp; go\nLDW&gt;= VW0, 5\n= Q0.0\n"),
            program("LD I0.0 // \"Start\" & go\nLDW>= VW0, 5\n= Q0.0\n"));
  EXPECT_EQ(program("LD I0.0 // &quot;\n= Q0.0\n"), program("LD I0.0 // &quot;\n= Q0.0\n")) << "no page";
}

TEST(PlainText, TitlesAboveAListingAndPageNumbersAreLeftOut) {
  EXPECT_EQ(program("SIMATIC S7-200 Example\nUsing the Freeport\nSTL\nNetwork 1\nLD SM0.1\n= Q0.0\n1 / 3\n"),
            program("\n\n\nNetwork 1\nLD SM0.1\n= Q0.0\n"));
}

TEST(PlainText, ATableOfSymbolsIsNoTableOfStatements) {
  const auto source = read("| Name | Address |\n|---|---|\n| Pump | Q0.0 |\n| Start | I0.0 |\n").parsed.source;
  ASSERT_EQ(source.symbols.size(), 2U);
  EXPECT_EQ(source.symbols[0].name, "Pump");
}

TEST(PlainText, QuotesAroundEachLineAreLeftOut) {
  EXPECT_EQ(program("“NETWORK 1”\n“LD I0.0”\n“= Q0.0”\n"), program("NETWORK 1\nLD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("\"LD I0.0\",\n\"= Q0.0\"\n"), program("LD I0.0\n= Q0.0\n"));
  EXPECT_EQ(program("'LD I0.0';\n\n'= Q0.0';\n"), program("LD I0.0\n\n= Q0.0\n"));
  EXPECT_EQ(
      program("Hi all,\nthis does not work:\n\n“LD SM0.1”\n“ENI”\n\nINT_0:\n“LD SM0.0”\n“MOVB SMB2, VB100”\n\nAny ideas?\n"),
      program("\n\n\nLD SM0.1\nENI\n\nINT_0:\nLD SM0.0\nMOVB SMB2, VB100\n"));
  EXPECT_EQ(note("“LD I0.0”\n“= Q0.0”\n"),
            "page.txt: read as plain text: typographic quotes, quotes around each line; the first in line 1");
}

TEST(Listing, APageNumberBetweenStatementsIsNoStatement) {
  for (const char* page : {"Page 2 of 3", "Seite 2 von 3", "Page 2"})
    EXPECT_EQ(program("NETWORK 1\nLD I0.0\n" + std::string(page) + "\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\n"),
              program("NETWORK 1\nLD I0.0\n\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\n"))
        << page;
}

/// The only error in a listing of these lines, and its hint.
std::string only_error(const std::string& lines) {
  const CheckResult result = checked("NETWORK 1\n" + lines);
  std::string found;
  for (const stl::Diagnostic& d : result.diagnostics)
    if (d.severity == stl::Severity::Error) found += (found.empty() ? "" : "\n") + d.message + ": " + d.hint;
  return found;
}

TEST(Hints, StatementsInOneLineAreAllNamed) {
  EXPECT_EQ(only_error("LD I0.0 A I0.1 O I0.2 = Q0.0\n"), "4 statements in one line: begin new lines with A, O and =");
  EXPECT_EQ(only_error("LD I0.0 A I0.1\n= Q0.0\n"), "two statements in one line: begin a new line with A");
  const CheckResult result = checked("NETWORK 1 LD I0.0\n= Q0.0\n");
  EXPECT_NE(diagnostics(result).find("two statements in one line"), std::string::npos);
  EXPECT_NE(diagnostics(result).find("begin a new line with LD"), std::string::npos);
}

TEST(Hints, NotationsOfOtherSystemsAreNamed) {
  EXPECT_EQ(only_error("LD I0.0\nJMP 2\nL2: LD I0.1\n= Q0.0\nLBL 2\n").substr(0, 55),
            "L2: is a label of another language: write LBL 2 in a li");
  EXPECT_NE(only_error("LD I0.0\nMOVW DB1.DBW10, VW20\n").find("write VW10"), std::string::npos);
  EXPECT_NE(only_error("LD DB1.DBX0.3\n= Q0.0\n").find("write V0.3"), std::string::npos);
  EXPECT_NE(only_error("LD> VW0, 5\n= Q0.0\n").find("LDW>"), std::string::npos);
  EXPECT_NE(only_error("LD 10.1\n= Q0.0\n").find("I0.1 is an input"), std::string::npos);
  EXPECT_NE(only_error("LDI>= VW0, 5\n= Q0.0\n").find("write LDW>="), std::string::npos);
}

TEST(Hints, BothMistakesOfAnAttachmentAreNamed) {
  const std::string said = diagnostics(checked("LD SM0.1\nATCH 1, 99\nENI\n"));
  EXPECT_NE(said.find("event 99 does not exist"), std::string::npos) << said;
  EXPECT_NE(said.find("interrupt routine 1 is missing"), std::string::npos) << said;
}

TEST(Hints, ABlankInAnAddressIsReadIfOnlyThatIsAnInstruction) {
  for (const char* text : {"LD I 0.0\n= Q0.0\n", "LD I0 .0\n= Q 0.0\n", "LD I 0. 0\n=  Q0.  0\n"}) {
    EXPECT_EQ(program(text), program("LD I0.0\n= Q0.0\n")) << text;
    EXPECT_EQ(note(text), "page.txt: read as plain text: blanks within addresses; the first in line 1");
  }
  EXPECT_EQ(program("LD I0.0\nO M 0.1\nMOVW VW 0, AC 1\nTON T 37, 100\n= Q 0.0\n"),
            program("LD I0.0\nO M0.1\nMOVW VW0, AC1\nTON T37, 100\n= Q0.0\n"));
  EXPECT_EQ(only_error("A I 0.0\nO M 0.1\n= Q 4.0\n").substr(0, 26), "this is STL of STEP 7 for ");
}

TEST(Hints, ConstantsAndComparisonsOfOtherLanguagesGetThoseOfThisOne) {
  EXPECT_EQ(only_error("LD I0.0\nMOVW 0x10, VW2\n"), "0x10 is the constant of another language: write 16#10");
  EXPECT_EQ(only_error("LD I0.0\nMOVW 10h, VW2\n"), "10h is the constant of another language: write 16#10");
  EXPECT_EQ(only_error("LD I0.0\nMOVB $1F, VB2\n"), "$1F is the constant of another language: write 16#1F");
  EXPECT_EQ(only_error("LD I0.0\nMOVW #5, VW2\n"), "#5 is the constant of another language: write 5");
  EXPECT_EQ(only_error("LDW=> VW0, 5\n= Q0.0\n"), "there is no relation =>: write LDW>=");
  EXPECT_EQ(only_error("LDW== VW0, 5\n= Q0.0\n"), "there is no relation ==: write LDW=");
  EXPECT_EQ(only_error("LDW >= VW0, 5\n= Q0.0\n"), "a comparison is one word: write LDW>=");
}

TEST(Hints, AWrongOperandHidesNoWarningOfAnotherNetwork) {
  const std::string program = "NETWORK 1\nLD SM0.1\nMOVB 9, SMB30\nRCV VB100, 0\nXMT VB100, 0\nNETWORK 2\nLD I0.8\n= Q0.0\n";
  const std::string said = diagnostics(checked(program));
  EXPECT_NE(said.find("the bits of a byte are 0 to 7"), std::string::npos) << said;
  EXPECT_NE(said.find("[receive-once]"), std::string::npos) << said;
}

TEST(Hints, ASlipInASymbolTableIsTheOnlyError) {
  auto table = read("Symbol\tAddress\nMotor\tQ0.O\nStop_PB\tI0,1\nLamp\tQ0.1\n");
  const std::string said = stl::render(table.parsed.diagnostics, table.parsed.source, false);
  EXPECT_NE(said.find("Q0.O has the letter O in place of the digit 0"), std::string::npos) << said;
  EXPECT_NE(said.find("I0,1 has a comma before its bit"), std::string::npos) << said;
  EXPECT_EQ(table.parsed.source.symbols.size(), 3U);
}

}  // namespace
}  // namespace s7200::plain_text_test
