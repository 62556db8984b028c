#include "tools/scenario/reading/name_pattern.hpp"

#include <gtest/gtest.h>

#include <string>

namespace s7200::tools::name_pattern_test {
namespace {

TEST(NamePattern, StarsQuestionMarksAndSetsMatchAsInAShell) {
  struct Row {
    const char *text, *pattern;
    bool matches;
  };
  for (const auto& [text, pattern, matches] : {Row{"", "", true},
                                               {"", "*", true},
                                               {"a", "", false},
                                               {"wrong quantity", "*QUANT*", true},
                                               {"two.yaml", "tw?.yaml", true},
                                               {"to.yaml", "tw?.yaml", false},
                                               {"abcabd", "*ab?", true},
                                               {"aaab", "a*aab", true},
                                               {"aaab", "a*ac", false},
                                               {"SL-07", "sl-[0-9]7", true},
                                               {"SL-x7", "sl-[0-9]7", false},
                                               {"SL-x7", "sl-[!0-9]7", true},
                                               {"a]", "a[]]", true},
                                               {"a-", "a[b-]", true},
                                               {"a[b", "a[b", true},
                                               {"a*b", "a\\*b", true},
                                               {"axb", "a\\*b", false},
                                               {"a\\", "a\\", true}})
    EXPECT_EQ(matches_pattern(text, pattern), matches) << text << " as " << pattern;
}

TEST(NamePattern, ManyStarsTakeNoTime) {
  const std::string text(10'000, 'a');
  EXPECT_FALSE(matches_pattern(text, "*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*b"));
}

}  // namespace
}  // namespace s7200::tools::name_pattern_test
