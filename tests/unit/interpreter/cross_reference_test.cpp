// Which instructions use what: overlaps, blocks, pointers, local memory.
#include "interpreter/analysis/cross_reference.hpp"

#include <fmt/format.h>

#include "interpreter/analysis/drawn_networks.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/selection.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/stl/parser.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::cross_reference_test {
namespace {

/// `VW99+VB100 w1 r2 p3`: its parts, and the ops that read, write and change it; p: what may reach it.
std::string shown(const ReferenceEntry& entry) {
  std::string text = stl::joined(entry.parts, memory_text, "+");
  for (const Use& use : entry.uses)
    text += fmt::format(" {}{}", use.access.role == Role::In ? 'r' : use.access.role == Role::Out ? 'w' : 'c', use.op);
  for (const Use& use : entry.reached) text += fmt::format(" p{}", use.op);
  return text;
}

std::string shown(std::string_view stl) {
  const auto program = program_of(stl, *find_cpu("224"));
  return stl::joined(
      cross_reference(facts_of(*program)).entries, [](const ReferenceEntry& entry) { return shown(entry); }, "; ");
}

TEST(CrossReference, OverlappingMemoryIsOneEntryWithItsParts) {
  EXPECT_EQ(shown("LD V100.3\nMOVW 1, VW99\nMOVB VB100, VB90\nMOVD 1, VD101\nMEND\n"),
            "VB90 w2; VW99+VB100+V100.3 r0 w1 r2; VD101 w3");
}

TEST(CrossReference, ATimerIsOneEntryWithItsBitAndItsValue) {
  EXPECT_EQ(shown("LD I0.0\nTON T37, 100\nLD T37\nMOVW T37, VW0\nR T37, 1\nMEND\n"), "I0.0 r0; VW0 w3; T37 c1 r2 r3 w4");
}

/// A line that cannot be read is in its network, and nothing else moves: each line of a program with errors is where it is
/// written.
TEST(CrossReference, OfAProgramWithErrorsNetworksKeepTheirLines) {
  const CpuModel& cpu = *find_cpu("214");
  const auto program = decode_program(stl::parse("NETWORK 1\nLD I0.0\nA I0.9\n= Q0.0\nNETWORK 2\nLD I0.1\nA \x1B[31m ??\n"
                                                 "= Q0.1\nNETWORK 3\nLD I0.2\n= Q0.2\nMEND\n",
                                                 "pump.stl"),
                                      cpu, default_times(cpu))
                           .known;
  ASSERT_TRUE(program);
  const Facts facts = facts_of(*program);
  const auto drawn = drawn_networks(program->source);
  ASSERT_EQ(drawn.size(), 3U);
  EXPECT_EQ(drawn[0].why_not, "A I0.9 is not an instruction");
  EXPECT_EQ(drawn[1].why_not, "A \uFFFD[31m ?? is not an instruction");
  EXPECT_EQ(drawn[2].why_not, "");
  for (const DrawnNetwork& network : drawn)
    for (std::uint32_t op = network.first; op < network.end; ++op) {
      EXPECT_EQ(facts.networks[op], network.ladder.number) << op;
      EXPECT_EQ(program->statement(op).position.line, 2 + 4 * (network.ladder.number - 1) + op - network.first);
    }
}

TEST(CrossReference, AccumulatorsAreOneThingInEveryWidth) {
  EXPECT_EQ(shown("LD SM0.0\nMOVB 1, AC0\nMOVD AC0, VD0\nMEND\n"), "VD0 w2; SM0.0 r0; AC0 w1 r2");
}

TEST(CrossReference, BlocksDoNotJoinWhatTheyCover) {
  EXPECT_EQ(shown("LD SM0.0\nFILL 0, VW0, 10\nMOVW 1, VW2\nMOVW 1, VW4\nMEND\n"), "VW2 w2 p1; VW4 w3 p1; SM0.0 r0");
  EXPECT_EQ(shown("LD SM0.0\nFILL 0, VW0, 10\nMEND\n"), "VB0 to VB19 w1; SM0.0 r0") << "alone it is an entry";
}

TEST(CrossReference, PointersAreListedWithWhatTheyMayReach) {
  EXPECT_EQ(shown("LD SM0.0\nMOVD &VB4, VD20\nMOVW 1, *VD20\nMOVW VW4, VW8\nMEND\n"),
            "VW4 r3 p2; VW8 w3; VD20 w1 r2; SM0.0 r0");
}

TEST(CrossReference, PointersAndBlocksAreListedWithOtherBlocksToo) {
  EXPECT_EQ(shown("LD SM0.0\nMOVD &VB4, VD20\nMOVW 1, *VD20\nBMB VB0, VB40, 8\nMEND\n"),
            "VB0 to VB7 r3 p2; VD20 w1 r2; VB40 to VB47 w3; SM0.0 r0");
}

TEST(CrossReference, LocalMemoryIsAnotherOneInEachRoutine) {
  EXPECT_EQ(shown("LD I0.0\nCALL 1\nMEND\nSBR 1\nLD L0.0\n= L0.1\nRET\nSBR 2\nLD L0.0\nRET\n"),
            "I0.0 r0; L0.0 r4; L0.1 w5; L0.0 r8");
}

TEST(CrossReference, AResultInTheCallersLocalMemoryIsListedWithTheCall) {
  const auto program = program_of(
      "SUBROUTINE_BLOCK Work:SBR0\nVAR_OUTPUT\nout : WORD;\nEND_VAR\nBEGIN\nNetwork 1\nLD SM0.0\nMOVW 1, "
      "#out\nEND_SUBROUTINE_BLOCK\n"
      "ORGANIZATION_BLOCK MAIN:OB1\nVAR\ngot : WORD;\nEND_VAR\nBEGIN\nNetwork 1\nLD SM0.0\nCALL Work, #got\nMOVW #got, VW0\n"
      "END_ORGANIZATION_BLOCK\n",
      *find_cpu("224"));
  for (const ReferenceEntry& entry : cross_reference(facts_of(*program)).entries)
    if (area_of(entry.bits) == Area::L && entry.routine != 0U) {
      EXPECT_EQ(entry.uses.size(), 1U) << "only MOVW 1, #out";
    }
}

TEST(CrossReference, FlagsThatEveryInstructionSetsAreLeftOut) {
  EXPECT_EQ(shown("LD SM1.0\nINCW VW0\nMEND\n"), "VW0 c1; SM1.0 r0");
}

Usage usage(std::string_view stl, std::size_t entry) {
  const auto program = program_of(stl, *find_cpu("224"));
  return usage_of(*program, cross_reference(facts_of(*program)).entries.at(entry));
}

TEST(CrossReference, TellsWhatIsNeverReadOrNeverWritten) {
  EXPECT_EQ(usage("LD M0.0\n= Q0.0\nMEND\n", 1), Usage::NeverWritten);
  EXPECT_EQ(usage("LD I0.0\n= M0.0\nMEND\n", 1), Usage::NeverRead);
  EXPECT_EQ(usage("LD I0.0\n= Q0.0\nMEND\n", 1), Usage::Both) << "the field reads outputs";
  EXPECT_EQ(usage("LD I0.0\nINCW VW0\nMEND\n", 1), Usage::OnlyChanged);
}

TEST(CrossReference, ListsConstantsByValue) {
  const auto program =
      program_of("LD I0.0\nTON T37, 100\nMOVB 16#10, VB0\nMOVB 16, VB1\nMOVD &VB9, VD4\nMEND\n", *find_cpu("224"));
  const auto constants = cross_reference(facts_of(*program)).constants;
  ASSERT_EQ(constants.size(), 3U);
  EXPECT_EQ(constants[0].text, "16#10");
  EXPECT_EQ(constants[0].places.size(), 2U) << "the same value";
  EXPECT_EQ(constants[1].text, "100");
  EXPECT_EQ(constants[2].text, "&VB9");
}

std::string why_not(std::string_view word) {
  const auto program = program_of("NETWORK 1\nLD I0.0\nCALL 3\nMEND\nNETWORK 2\nSBR 3\nLD I0.1\n= Q0.0\nNETWORK 3\nRET\n");
  const std::vector<std::string> words{std::string(word)};
  return parse_selection(words, facts_of(*program)).why();
}

TEST(Selection, AnAddressThatTheCpuLacksIsNotTakenForARoutine) {
  for (const std::string_view word : {"VB99999", "VB0:99999", "AC7"}) {
    EXPECT_NE(why_not(word).find("does not exist on CPU"), std::string::npos) << why_not(word);
    EXPECT_EQ(why_not(word).find("routine"), std::string::npos) << why_not(word);
  }
  EXPECT_NE(why_not("pump").find("; or a routine: MAIN, SBR_3"), std::string::npos) << why_not("pump");
}

TEST(Selection, NamesRoutinesAndNetworksInTheWaysPeopleWriteThem) {
  const auto program = program_of("NETWORK 1\nLD I0.0\nCALL 3\nMEND\nNETWORK 2\nSBR 3\nLD I0.1\n= Q0.0\nNETWORK 3\nRET\n");
  const Facts facts = facts_of(*program);
  for (const std::string word : {"SBR_3", "sbr 3", "SBR3"}) {
    const auto selection = parse_selection(std::vector<std::string>{word}, facts);
    ASSERT_TRUE(selection) << selection.why();
    EXPECT_TRUE(selection->has_op(3) && selection->has_op(6) && !selection->has_op(2));
  }
  const auto network = parse_selection(std::vector<std::string>{"SBR_3:3", "main"}, facts);
  ASSERT_TRUE(network) << network.why();
  EXPECT_TRUE(network->has_op(6) && !network->has_op(4) && network->has_op(0));
}

TEST(Selection, SaysWhatIsNearAnUnknownWord) {
  EXPECT_EQ(why_not("SBR_3:7"), "SBR_3 has no network '7'; it has 2, 3");
  EXPECT_NE(why_not("SBR_4").find("MAIN, SBR_3"), std::string::npos);
  EXPECT_NE(why_not("VW99999").find("does not exist on CPU 214"), std::string::npos);
}

}  // namespace
}  // namespace s7200::test::cross_reference_test
