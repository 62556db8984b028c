// Ladder that is drawn with characters where STL should be.
#include "interpreter/stl/drawings/drawings.hpp"

#include <gtest/gtest.h>

#include <set>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::drawings_test {
namespace {

/// The causes of the errors of a text that is read, or why it cannot be read.
std::set<std::string> causes_of(const std::string& text) {
  const auto source = read_source(text, "rung.txt");
  if (!source) return {source.why().substr(0, source.why().find(':'))};
  std::set<std::string> causes;
  for (const auto& d : check(source->parsed, *find_cpu("224"), default_times(*find_cpu("224"))).diagnostics)
    if (d.severity == stl::Severity::Error) causes.insert(d.message);
  return causes;
}

const std::set<std::string> kOneMessage{std::string(stl::kIsDrawing)};

TEST(Drawings, ElementsOfLadderAreRecognised) {
  for (const char* line :
       {"--| |--|/|--( )--", "-|P|-", "--] [--", "--]/[--( S )", "|/|", "-( )- Q0.0", "|--[I0.0]--[/I0.1]--(Q0.0)--|",
        "I0.0 -| |- I0.1 -|/|- ( Q0.0 )", "---|NOT|---", "--|==W|--", "├──┤ ├──", "--( R )--", "(S)"})
    EXPECT_TRUE(stl::has_drawing(line)) << line;
}

TEST(Drawings, StatementsTablesAndRulesAreNone) {
  for (const char* line :
       {"LD I0.0", "MOVB -5, VB0", "-I VW0, VW2", "// --| |--( )--", "LDB= VB0, 'a'", "|---|---|", "---------",
        "| LD | I0.0 |", "CALL Pump()", "X := (A - B) * C;", "| N | I0.0 | |", "[12] LD I0.0"})
    EXPECT_FALSE(stl::has_drawing(line)) << line;
}

TEST(Drawings, AreLookedForInTimeThatFollowsTheLine) {
  constexpr std::size_t kLong = 1'000'000;
  EXPECT_FALSE(stl::has_drawing(std::string(kLong, '(') + ")"));
  EXPECT_FALSE(stl::has_drawing(std::string(kLong, '[') + "x"));
}

TEST(Drawings, HaveOneMessageWhereverTheyStand) {
  EXPECT_EQ(causes_of("   I0.0    I0.1    Q0.0\n--] [-----]/[-----( )--\n"), kOneMessage);
  EXPECT_EQ(
      causes_of(
          "Netzwerk 1: Motor ein\n\n   E0.0     E0.1      A0.0\n----| |------|/|------( )----\n   A0.0 |\n----| |--\n"),
      kOneMessage);
  EXPECT_EQ(causes_of("Network 1\n|   I0.0      I0.1      Q0.0  |\n|---| |-------|/|-------( )---|\n"), kOneMessage);
  EXPECT_EQ(
      causes_of(
          "NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\n--| |--|/|--( )--\n   I0.1 I0.2  Q0.1\nNETWORK 3\nLD I0.3\n= Q0.3\n"),
      kOneMessage);
  EXPECT_EQ(causes_of("LD I0.0\n= Q0.0\n  Start   Stop  Motor\n--| |--|/|--( )--\n"), kOneMessage) << "names above it";
  EXPECT_EQ(causes_of("LD I0.0\n-|P|-\n= Q0.0\n"), kOneMessage);
}

TEST(Drawings, OtherMistakesBesideThemAreStillNamed) {
  EXPECT_EQ(causes_of("LD I0.0\n-|P|-\n= Q0.0\n\nMOVB VW0, VB2\n"),
            (std::set<std::string>{std::string(stl::kIsDrawing), "IN of MOVB is a byte, VW0 is a word"}));
}

TEST(Drawings, InCommentsAreComments) { EXPECT_TRUE(causes_of("// --| |--( )--\nLD I0.0\n= Q0.0 // -( )-\n").empty()); }

}  // namespace
}  // namespace s7200::drawings_test
