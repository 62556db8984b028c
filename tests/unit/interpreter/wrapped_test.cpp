#include "interpreter/base/text/wrapped.hpp"

#include <gtest/gtest.h>

namespace s7200::stl::wrapped_test {
namespace {

TEST(Wrapped, ALineThatFitsStaysAsItIs) {
  EXPECT_EQ(wrapped("", 20), "");
  EXPECT_EQ(wrapped("one two\n\n  three\n", 20), "one two\n\n  three\n");
  EXPECT_EQ(wrapped("12345 7890", 10), "12345 7890\n");
}

TEST(Wrapped, ALongerLineBreaksAtABlankAndGoesOnAtItsIndentation) {
  EXPECT_EQ(wrapped("12345 78901", 10), "12345\n78901\n");
  EXPECT_EQ(wrapped("  one two three four five six seven", 30), "  one two three four five six\n  seven\n");
  EXPECT_EQ(wrapped("one two three four", 9, 2), "one two\n  three\n  four\n");
}

TEST(Wrapped, ALineWithColumnsGoesOnBelowTheLastOfThem) {
  EXPECT_EQ(wrapped("  --for  how long it runs in simulated time", 33),
            "  --for  how long it runs in\n         simulated time\n");
  EXPECT_EQ(wrapped("a  b  what it is for\n", 16, 6), "a  b  what it is\n      for\n");
}

TEST(Wrapped, AColumnWithoutRoomForTheRestIsNotGoneOnBelow) {
  EXPECT_EQ(wrapped("what is in front of it    and after it", 30), "what is in front of it    and\nafter it\n");
}

TEST(Wrapped, LinesOfAVeryLongOneAreEachReadOnce) {
  std::string words, lines = "11 11\n";
  for (int i = 0; i < 400'000; ++i) words += "11 ";
  for (int i = 0; i < 199'999; ++i) lines += " 11 11\n";
  EXPECT_EQ(wrapped(words, 6, 1), lines);
}

TEST(Wrapped, AWordThatIsWiderThanTheScreenStaysWhole) {
  EXPECT_EQ(wrapped("0123456789abcdef is one", 10), "0123456789abcdef\nis one\n");
  EXPECT_EQ(wrapped("    0123456789abcdef", 10), "    0123456789abcdef\n");
}

TEST(Wrapped, CharactersCountAndNotBytes) { EXPECT_EQ(wrapped("äöü äöü äöü", 7), "äöü äöü\näöü\n"); }

TEST(Wrapped, ControlSequencesOfColoursTakeNoRoom) {
  EXPECT_EQ(wrapped("\x1b[33m12345\x1b[0m 78", 8), "\x1b[33m12345\x1b[0m 78\n");
  EXPECT_EQ(wrapped("\x1b[33m12345\x1b[0m 7890", 8), "\x1b[33m12345\x1b[0m\n7890\n");
}

}  // namespace
}  // namespace s7200::stl::wrapped_test
