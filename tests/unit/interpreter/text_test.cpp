#include "interpreter/base/text/text.hpp"

#include <gtest/gtest.h>

namespace s7200::stl::text_test {
namespace {

using namespace std::string_view_literals;

TEST(Text, WordsAreWhatBlanksAndTabsSeparate) {
  EXPECT_EQ(split_words(" LD\tSM0.1  x\r"), (std::vector<std::string>{"LD", "SM0.1", "x"}));
  EXPECT_TRUE(split_words(" \t").empty());
}

TEST(Text, WordsAreTakenOneByOneAtTheSignsBetweenThem) {
  std::string_view rest = "MOVW VW0,VW2\r";
  EXPECT_EQ(take_word(rest), "MOVW");
  EXPECT_EQ(take_word(rest, kBetweenOperands), "VW0");
  EXPECT_EQ(take_word(rest, kBetweenOperands), "VW2");
  EXPECT_EQ(take_word(rest), "");
  EXPECT_TRUE(same_in_capitals("Network", "NETWORK"));
  EXPECT_FALSE(same_in_capitals("NETWORK", "Network"));
  EXPECT_EQ(ByteSet("\xE4:").first_in("a\xE4:"), 1U);
  EXPECT_EQ(ByteSet("\xE4:").first_in("a\xE4:", 2), 2U);
  EXPECT_FALSE(ByteSet("\xE4:").any_in("abc"));
}

TEST(Text, ALineEndsAtAnyLineEndWhateverItsLength) {
  for (const std::string_view end : {"\n"sv, "\r"sv, "\r\n"sv})
    for (const std::size_t length : {0U, 1U, 254U, 255U, 256U, 257U, 511U, 512U, 600U}) {
      const std::string line(length, 'x'), text = line + std::string(end) + line;
      EXPECT_EQ(split_lines(text), length == 0 ? std::vector{line} : (std::vector{line, line})) << length;
    }
}

TEST(Text, OnlyAsciiLettersChangeTheirCase) {
  EXPECT_EQ(lower_case("VW100 ÄÖ@[`{Zz"), "vw100 ÄÖ@[`{zz");
  EXPECT_EQ(upper_case("vw100 äö@[`{Zz"), "VW100 äö@[`{ZZ");
}

TEST(Printable, TextOfAnyLanguageStaysAsItIs) {
  for (const std::string_view text : {""sv, "LD I0.0 // Tür auf"sv, "阀门\t打开"sv, "3 × 259.4 us …"sv, "\U0001F600"sv})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatATerminalWouldTakeForACommandIsOneVisibleCharacter) {
  EXPECT_EQ(printable("a\x1b[2Jb\0c\x07\x7f\r\nd"sv), "a\uFFFD[2Jb\uFFFDc\uFFFD\uFFFD\uFFFD\uFFFDd");
  EXPECT_EQ(printable("\u0085\u009b31m"), "\uFFFD\uFFFD31m") << "C1: 9B begins a control sequence as ESC [ does";
}

TEST(Printable, ATextCannotChangeItsDirectionOrHide) {
  EXPECT_EQ(printable("\u202Elts.live\u2066\u200F\u061C\u2028"), "\uFFFDlts.live\uFFFD\uFFFD\uFFFD\uFFFD");
}

TEST(Printable, TheEndsOfSeveralLinesStay) {
  EXPECT_EQ(printable_lines("a\x1b\r\n\nb\rc\n\r"), "a\uFFFD\r\n\nb\uFFFDc\n\uFFFD");
}

TEST(Printable, BytesThatAreNotUtf8AreOneCharacterEach) {
  EXPECT_EQ(printable("\x9b\xff\xc3("), "\uFFFD\uFFFD\uFFFD(");
  EXPECT_EQ(printable("\uFFFD"), "\uFFFD");
}

}  // namespace
}  // namespace s7200::stl::text_test
