// What `s7200 compare` finds different in two programs as they are written.
#include "tools/compare/structure.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::structure_test {
namespace {

using test::inspected;

constexpr std::string_view kProgram =
    "NETWORK 1 // start\nLD I0.0\n= Q0.0\nNETWORK 2 // timer\nLD I0.1\nTON T37, 50\nNETWORK 3 // lamp\nLD T37\n= "
    "Q0.1\nMEND\n";

/// The rows of the one network that has changed, as marks.
std::string marks(const StructureDifference& difference) {
  std::string text;
  for (const NetworkChange& change : difference.networks)
    for (const InstructionRow& row : change.rows)
      text += row.same ? '=' : row.older && row.newer ? '|' : row.older ? '<' : '>';
  return text;
}

std::string words(const StructureDifference& difference) {
  std::string text;
  for (const NetworkChange& change : difference.networks)
    text += !change.match.older   ? "added "
            : !change.match.newer ? "removed "
            : !change.match.same  ? "changed "
            : change.match.moved  ? "moved "
                                  : "same ";
  return text;
}

struct Compared {
  Compared(std::string_view old_text, std::string_view new_text) : older(inspected(old_text)), newer(inspected(new_text)) {}
  Inspection older, newer;
  StructureDifference difference = structure_difference(older, newer);
  std::string text() const { return structure_text(older, newer, difference); }
};

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(Structure, AProgramIsTheSameAsItself) {
  const Compared compared(kProgram, kProgram);
  EXPECT_TRUE(compared.difference.same_for_people());
  EXPECT_EQ(compared.text(), "Structure: 3 networks the same\nThe programs are the same.\n");
}

TEST(Structure, ACommentOrATitleAloneIsSaidAndChangesNothingForTheCpu) {
  const Compared compared(kProgram, replaced(std::string(kProgram), "// lamp", "// red lamp"));
  EXPECT_TRUE(compared.difference.same_for_the_cpu());
  EXPECT_FALSE(compared.difference.same_for_people());
  EXPECT_NE(compared.text().find("Comments alone\n  MAIN, network 3 \"red lamp\"\n"), std::string::npos) << compared.text();
}

TEST(Structure, AChangedInstructionStandsBesideTheOldOneWithBothLines) {
  const Compared compared(kProgram, replaced(std::string(kProgram), "TON T37, 50", "TON T37, 60"));
  EXPECT_EQ(words(compared.difference), "same changed same ");
  EXPECT_EQ(marks(compared.difference), "=|");
  EXPECT_NE(compared.text().find("test.stl:6      TON T37, 50                    | test.stl:6      TON T37, 60\n"),
            std::string::npos)
      << compared.text();
}

TEST(Structure, AnInsertedNetworkLeavesThoseBelowItTheSame) {
  const Compared compared(kProgram, replaced(std::string(kProgram), "NETWORK 2", "NETWORK 2\nLD I0.7\n= Q0.7\nNETWORK 3"));
  EXPECT_EQ(words(compared.difference), "same added same same ");
}

TEST(Structure, ANetworkInAnotherPlaceHasMovedAndTheProgramDiffers) {
  const Compared compared("NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\nNETWORK 3\nLD I0.2\n= Q0.2\nMEND\n",
                          "NETWORK 1\nLD I0.2\n= Q0.2\nNETWORK 2\nLD I0.0\n= Q0.0\nNETWORK 3\nLD I0.1\n= Q0.1\nMEND\n");
  EXPECT_EQ(words(compared.difference), "moved same same ");
  EXPECT_FALSE(compared.difference.same_for_the_cpu());
}

TEST(Structure, ANetworkThatHasChangedMayHaveMovedToo) {
  const Compared compared("NETWORK 1\nLD I0.0\nA I0.5\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\nMEND\n",
                          "NETWORK 1\nLD I0.1\n= Q0.1\nNETWORK 2\nLD I0.0\nA I0.6\n= Q0.0\nMEND\n");
  ASSERT_EQ(words(compared.difference), "same changed ");
  EXPECT_TRUE(compared.difference.networks[1].match.moved);
}

TEST(Structure, ANetworkWithTheSameTitleIsTheSameNetworkHoweverMuchHasChanged) {
  const Compared compared(kProgram, replaced(std::string(kProgram), "LD I0.1\nTON T37, 50", "LDN M0.0\nMOVW 5, VW10"));
  EXPECT_EQ(words(compared.difference), "same changed same ");
}

TEST(Structure, WhatIsLessThanHalfAlikeWasRemovedAndAdded) {
  const Compared compared("LD I0.0\nA I0.1\n= Q0.0\nMEND\n", "LDW= VW0, 5\nMOVW VW10, VW20\nMEND\n");
  EXPECT_EQ(words(compared.difference), "added removed ");
}

TEST(Structure, NotationAndLinesOfNetworksMeanNothingToTheCpu) {
  const Compared compared("NETWORK 1\nLD I0.0\nMOVB 16#FF, VB0\nNETWORK 2\nLD I0.1\n= Q0.0\nMEND\n",
                          "LD I0.0\nMOVB 255, VB0\nLD I0.1\n= Q0.0\nMEND\n");
  EXPECT_TRUE(compared.difference.same_for_the_cpu());
}

TEST(Structure, ASymbolAtTheSameAddressIsRenamedAndChangesNoInstruction) {
  Compared compared(kProgram, kProgram);
  auto with = [](const Inspection& of, std::vector<stl::Symbol> symbols) {
    auto program = std::make_shared<Program>(*of.program);
    program->source.symbols = std::move(symbols);
    return Inspection(program);
  };
  const auto symbol = [](std::string name, const stl::Address& address) {
    return stl::Symbol{.name = std::move(name), .value = address, .position = {}, .comment = {}};
  };
  const auto q = [](std::uint8_t bit) { return stl::Address{"Q", stl::Size::Bit, 0, bit}; };
  const auto older =
      with(compared.older, {symbol("Pump", q(0)), symbol("Lamp", q(1)), symbol("Old", {"M", stl::Size::Byte, 0, 0})});
  const auto newer = with(compared.newer, {symbol("Motor", q(0)), symbol("Lamp", q(2))});
  const auto difference = structure_difference(older, newer);
  ASSERT_EQ(difference.symbols.size(), 3U);
  EXPECT_TRUE(difference.same_for_the_cpu());
  const std::string text = structure_text(older, newer, difference);
  EXPECT_NE(text.find("renamed  Q0.0: \"Pump\" -> \"Motor\"\n  moved    \"Lamp\": Q0.1 -> Q0.2\n  removed  \"Old\": MB0\n"),
            std::string::npos)
      << text;
}

TEST(Structure, AttachedRoutinesAreComparedByEvent) {
  constexpr std::string_view kEnd = "ENI\nMEND\nINT 0\nRETI\nINT 1\nRETI\n";
  const Compared compared("LD SM0.1\nATCH 0, 10\n" + std::string(kEnd),
                          "LD SM0.1\nATCH 1, 10\nATCH 0, 0\n" + std::string(kEnd));
  ASSERT_EQ(compared.difference.events.size(), 2U);
  EXPECT_EQ(compared.difference.events[1].older, std::vector<std::string>{"INT_0"});
  EXPECT_EQ(compared.difference.events[1].newer, std::vector<std::string>{"INT_1"});
}

TEST(Structure, AnotherCpuIsASetting) {
  const Inspection older = inspected(kProgram), newer = inspected(kProgram, {}, *find_cpu("226"));
  const auto difference = structure_difference(older, newer);
  ASSERT_EQ(difference.settings.size(), 1U);
  EXPECT_FALSE(difference.same_for_the_cpu());
}

TEST(Structure, AProgramWithErrorsIsComparedAsFarAsItGoes) {
  const Compared compared(kProgram, replaced(std::string(kProgram), "TON T37, 50", "TON T37, VB5"));
  EXPECT_EQ(words(compared.difference), "same changed same ");
}

TEST(Structure, CommonRowsAreTheLongestInTheSameOrder) {
  using Row = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(common_row({"a", "b", "c", "d"}, {"a", "c", "b", "d"}).size(), 3U);
  EXPECT_EQ(common_row({"a", "b"}, {"x", "a", "y", "b"}), (Row{{0, 1}, {1, 3}}));
  EXPECT_TRUE(common_row({}, {"a"}).empty());
}

}  // namespace
}  // namespace s7200::tools::structure_test
