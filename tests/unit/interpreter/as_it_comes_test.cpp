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
  for (const std::string sign : {";", "--", "#", "'", "!", "%%", "\\\\"})
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

TEST(AsItComes, TitlesOfNetworksAfterASignAreComments) {
  for (const std::string title : {": Start", " - Start", " – Start", ". Start", " (Start)", " -- Start"}) {
    const std::string text = program("Network 1" + title + "\nLD I0.0\n= Q0.0\n");
    EXPECT_NE(text.find("NETWORK 1"), std::string::npos) << text;
    EXPECT_NE(text.find("Start"), std::string::npos) << text;
  }
  EXPECT_EQ(read("NETWORK 1 LD I0.0\n= Q0.0\n").parsed.diagnostics.size(), 1U);
}

TEST(AsItComes, ATitleBeforeTheHeadOfItsBlockIsItsTitle) {
  const SourceText source =
      read("TITLE=A lamp\nORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD I0.0\n= Q0.0\nEND_ORGANIZATION_BLOCK\n");
  EXPECT_TRUE(source.parsed.diagnostics.empty());
  ASSERT_EQ(source.parsed.source.blocks.size(), 1U);
  EXPECT_EQ(source.parsed.source.blocks[0].title, "A lamp");
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
