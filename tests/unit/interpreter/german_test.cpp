#include "interpreter/program/loading/german.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::german_test {
namespace {

std::string read(const std::string& text) {
  stl::ParseResult parsed = stl::parse(text, "x");
  read_german(parsed);
  for (const stl::Diagnostic& d : parsed.diagnostics) return "error: " + d.message;
  return stl::to_text(parsed.source);
}

TEST(German, AddressesAndAndInstructionsAreRead) {
  EXPECT_EQ(read("LD E0.0\nUN A0.1\nUW>= AEW4, 5\nULD\n= A0.0\n"),
            "LD      I0.0\nAN      Q0.1\nAW>=    AIW4, 5\nALD\n=       Q0.0\n");
  EXPECT_EQ(read("LD Z4\nMOVD HZ0, *VD4\nMOVD &AB1, AC1\n"), "LD      C4\nMOVD    HC0, *VD4\nMOVD    &QB1, AC1\n");
}

TEST(German, MixedWithInternationalOnesTheyAreRefused) {
  EXPECT_EQ(read("LD E0.0\n= Q0.0\n"), "error: E0.0 is a German address");
  EXPECT_EQ(read("LD E0.0\nA M0.0\n"), "error: E0.0 is a German address");
}

struct Stranger {
  std::string message, hint;
  std::uint32_t line = 0;
  bool operator==(const Stranger&) const = default;
};

std::vector<Stranger> strangers_in(const std::string& text) {
  const CheckResult result = check_text(text, "x", cpu214(), default_times(cpu214()));
  std::vector<Stranger> strangers;
  for (const stl::Diagnostic& d : result.diagnostics)
    if (d.severity == stl::Severity::Error) strangers.push_back({d.message, d.hint, d.position.line});
  return strangers;
}

TEST(German, ALineOfTheOtherSetIsOneErrorThatSaysHowItReadsInTheSetOfTheListing) {
  const std::string german = "LD E0.0\nUN E0.1\n= A0.0\nLD E0.2\n= A0.1\n", english = "LD I0.0\nAN I0.1\n= Q0.0\nA I0.2\n";
  using Strangers = std::vector<Stranger>;
  EXPECT_EQ(strangers_in(german + "AN E0.3\n= A0.2\nMEND\n"),
            (Strangers{{"AN is international, but the listing is in the German set", "write UN E0.3", 6}}));
  EXPECT_EQ(strangers_in(german + "AN I0.3\n= A0.2\nMEND\n"),
            (Strangers{{"AN and I0.3 are international, but the listing is in the German set", "write UN E0.3", 6}}));
  EXPECT_EQ(strangers_in(german + "MOVB QB1, AB2\nMEND\n"),
            (Strangers{{"QB1 is international, but the listing is in the German set", "write MOVB AB1, AB2", 6}}));
  EXPECT_EQ(strangers_in(english + "UN E0.3\n= Q0.2\nMEND\n"),
            (Strangers{{"UN and E0.3 are German, but the listing is in the international set", "write AN I0.3", 5}}));
  EXPECT_EQ(strangers_in(english + "UB= AB1, MB2\n= Q0.2\nMEND\n"),
            (Strangers{{"UB= and AB1 are German, but the listing is in the international set", "write AB= QB1, MB2", 5}}));
}

TEST(German, OnlyUForTheAndInstructionsIsKnown) {
  EXPECT_EQ(find_german_instruction("UN")->mnemonic, "AN");
  EXPECT_EQ(find_german_instruction("UB="), find_instruction("AB="));
  EXPECT_EQ(find_german_instruction("ULD")->mnemonic, "ALD");
  for (const char* other : {"UTCH", "UTH", "UTT", "A", "U1", ""})
    EXPECT_EQ(find_german_instruction(other), nullptr) << other;
}

TEST(German, AListingInItIsAProgram) {
  const CheckResult result = check_text("LD E0.0\nU E0.1\n= A0.0\nMEND\n", "x", cpu214(), default_times(cpu214()));
  EXPECT_TRUE(result.program) << render(result.diagnostics, result.source, false);
}

}  // namespace
}  // namespace s7200::german_test
