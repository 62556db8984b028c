#include "interpreter/base/diagnostic.hpp"

#include <gtest/gtest.h>

namespace s7200::stl::diagnostic_test {
namespace {

SourceLines text(std::vector<std::string> lines) { return {"a.stl", std::move(lines)}; }

TEST(Diagnostic, ShowsPlaceMessageLineCaretAndHint) {
  const Diagnostic error{Severity::Error, {2, 4, 4}, "the bits of a byte are 0 to 7", "write I1.0"};
  EXPECT_EQ(render(error, text({"NOT", "LD I0.8"}), false),
            "a.stl:2:4: error: the bits of a byte are 0 to 7\nLD I0.8\n   ^~~~\nhint: write I1.0\n");
}

TEST(Diagnostic, KeepsTabsInTheCaretLine) {
  const Diagnostic warning{Severity::Warning, {1, 5, 1}, "odd", ""};
  EXPECT_EQ(render(warning, text({"\tLD\tX"}), false), "a.stl:1:5: warning: odd\n\tLD\tX\n\t  \t^\n");
}

TEST(Diagnostic, CountsCharactersAndTheirWidth) {
  const Diagnostic error{Severity::Error, {1, 4, 1}, "x", ""};
  EXPECT_EQ(render(error, text({"äö電!"}), false), "a.stl:1:4: error: x\näö電!\n  \u3000^\n");
}

TEST(Diagnostic, ShowsOnlyThePartOfAVeryLongLineAroundThePlace) {
  std::string line(1'000'000, 'a');
  line[500'000] = '!';
  const std::string shown = render(Diagnostic{Severity::Error, {1, 500'001, 900'000}, "x", ""}, text({line}), false);
  EXPECT_LT(shown.size(), 400U);
  const std::size_t source = shown.find('\n') + 1;
  const std::size_t marks = shown.find('\n', source) + 1;
  EXPECT_EQ(shown.find('!') - source, shown.find('^') - marks);
  EXPECT_EQ(shown.substr(source, 3), "...");
}

TEST(Diagnostic, MarksTheEndOfALineAfterItsLastCharacter) {
  EXPECT_EQ(render(Diagnostic{Severity::Error, {1, 4, 1}, "x", ""}, text({"NOT"}), false),
            "a.stl:1:4: error: x\nNOT\n   ^\n");
}

TEST(Diagnostic, SendsNoControlCharacterToATerminal) {
  const std::string shown = render(Diagnostic{Severity::Error, {1, 1, 1}, "x", ""}, text({"\x1b[2J\x07"}), false);
  EXPECT_EQ(shown.find('\x1b'), std::string::npos);
  EXPECT_EQ(shown.find('\x07'), std::string::npos);
}

TEST(Diagnostic, SendsNoControlCharacterOfItsNameMessageOrHintToATerminal) {
  const SourceLines source{"\x1b]0;a\x07.stl", {"NOT"}};
  EXPECT_EQ(render({Severity::Error, {1, 0, 1}, "no '\x1b[2J'", "not \u009b"}, source, false),
            "\uFFFD]0;a\uFFFD.stl:1: error: no '\uFFFD[2J'\nhint: not \uFFFD\n");
}

TEST(Diagnostic, NeedsNeitherAPlaceNorAnExistingLine) {
  EXPECT_EQ(render(Diagnostic{Severity::Error, {0, 0, 1}, "empty", ""}, text({}), false), "a.stl: error: empty\n");
  EXPECT_EQ(render(Diagnostic{Severity::Error, {7, 1, 1}, "gone", ""}, text({"NOT"}), false), "a.stl:7:1: error: gone\n");
}

TEST(Diagnostic, ColoursOnlyWhenAsked) {
  const Diagnostic error{Severity::Error, {1, 1, 3}, "x", ""};
  EXPECT_NE(render(error, text({"NOT"}), true).find("\x1b[1;31merror:\x1b[0m"), std::string::npos);
  EXPECT_EQ(render(error, text({"NOT"}), false).find('\x1b'), std::string::npos);
}

TEST(Diagnostic, SortsByPlaceAndKeepsTheOrderOfEqualPlaces) {
  Diagnostics list{
      {Severity::Error, {2, 1, 1}, "c", ""}, {Severity::Error, {1, 5, 1}, "a", ""}, {Severity::Warning, {1, 5, 1}, "b", ""}};
  sort(list);
  EXPECT_EQ(list[0].message + list[1].message + list[2].message, "abc");
}

Diagnostic of_cause(std::uint32_t line, std::string message, std::string cause) {
  return {Severity::Error, {line, 1, 1}, std::move(message), "", std::move(cause)};
}

TEST(Diagnostic, ShowsACauseOnceWithItsOtherPlaces) {
  const Diagnostics list{of_cause(1, "a", "x"), of_cause(2, "b", ""), of_cause(2, "c", "x"),
                         of_cause(2, "d", "x"), of_cause(3, "b", ""), of_cause(4, "e", "x")};
  EXPECT_EQ(render(list, text({}), false),
            "a.stl:1:1: error: a\nalso: 3 more, in lines 2, 4\na.stl:2:1: error: b\na.stl:3:1: error: b\n");
  EXPECT_EQ(count_causes(list), 3U);
  EXPECT_EQ(render({of_cause(1, "a", "x"), of_cause(7, "b", "x")}, text({}), false),
            "a.stl:1:1: error: a\nalso: 1 more, in line 7\n");
}

TEST(Diagnostic, ShowsTheFirstAndTheLastOfManyPlaces) {
  Diagnostics list;
  for (std::uint32_t line = 1; line <= 100; ++line) list.push_back(of_cause(line, "a", "x"));
  EXPECT_EQ(render(list, text({}), false),
            "a.stl:1:1: error: a\nalso: 99 more, in lines 2, 3, 4, 5, 6, 7, 8, 9, 10 … 100\n");
}

TEST(Diagnostic, AWarningAndAnErrorNeverShareACause) {
  Diagnostics list{of_cause(1, "a", "x"), of_cause(2, "b", "x")};
  list[1].severity = Severity::Warning;
  EXPECT_EQ(count_causes(list), 2U);
}

TEST(Diagnostic, ShowsTheNameOfAWarning) {
  EXPECT_EQ(render(Diagnostic{Severity::Warning, {1, 1, 1}, "odd", "", "", "odd-thing"}, text({}), false),
            "a.stl:1:1: warning: odd [odd-thing]\n");
}

TEST(Diagnostic, AWarningIsNotAnError) {
  EXPECT_FALSE(has_errors({}));
  EXPECT_FALSE(has_errors({{Severity::Warning, {}, "x", ""}}));
  EXPECT_TRUE(has_errors({{Severity::Warning, {}, "x", ""}, {Severity::Error, {}, "y", ""}}));
}

}  // namespace
}  // namespace s7200::stl::diagnostic_test
