// The networks of a program as ladder: what is in series, what is in parallel, and what has no form in ladder.
#include "interpreter/analysis/drawn_networks.hpp"

#include <gtest/gtest.h>

#include <string>

#include "interpreter/program/load.hpp"
#include "interpreter/stl/tables/symbols.hpp"

namespace s7200::drawn_networks_test {
namespace {

using stl::LadderBranch;
using stl::LadderElement;
using stl::LadderPath;

std::string text_of(const LadderElement& element) {
  std::string text = element.kind == LadderElement::Kind::Contact ? "["
                     : element.kind == LadderElement::Kind::Coil  ? "("
                                                                  : "{";
  text += element.symbol;
  for (const stl::LadderText& operand : element.operands) text += " " + operand.text;
  for (const stl::LadderPin& pin : element.pins) text += " " + pin.name + (pin.output ? ">" : "<") + pin.operand.text;
  return text + (text.front() == '[' ? "]" : text.front() == '(' ? ")" : "}");
}

std::string text_of(const LadderPath& path) {
  if (path.kind == LadderPath::Kind::Contact) return text_of(path.contact);
  std::string text;
  for (const LadderPath& part : path.parts)
    text += (path.kind == LadderPath::Kind::Parallel && !text.empty() ? "+" : "") + text_of(part);
  return path.kind == LadderPath::Kind::Parallel ? "<" + text + ">" : text;
}

/// Branches of a point in lines: `[ I0.0] -> ( Q0.0); ` with what follows in braces.
std::string text_of(const std::vector<LadderBranch>& branches) {
  std::string text;
  for (const LadderBranch& branch : branches) {
    text += text_of(branch.path);
    for (const LadderPath& input : branch.more_inputs) text += " & " + text_of(input);
    if (branch.output) text += text_of(*branch.output);
    if (!branch.branches.empty()) text += "{" + text_of(branch.branches) + "}";
    text += "; ";
  }
  return text.substr(0, text.size() - std::min<std::size_t>(2, text.size()));
}

std::vector<DrawnNetwork> drawn(const std::string& stl) { return drawn_networks(read_text(stl, "test.stl").source); }

/// The tree of the first network, or why there is none.
std::string tree(const std::string& stl) {
  const auto networks = drawn("NETWORK 1\n" + stl);
  return networks.front().why_not.empty() ? text_of(networks.front().ladder.rail.branches) : networks.front().why_not;
}

TEST(DrawnNetworks, ContactsAreInSeriesAndInParallel) {
  EXPECT_EQ(tree("LD I0.0\nAN I0.1\nO M0.0\n= Q0.0\n"), "<[ I0.0][/ I0.1]+[ M0.0]>{( Q0.0)}");
  EXPECT_EQ(tree("LDI I0.0\nLDNI I0.1\nAW>= VW0, 5\nOLD\nLD M0.0\nO M0.1\nALD\nNOT\nEU\n=I Q0.0\n"),
            "<[I I0.0]+[/I I0.1][>= W VW0 5]><[ M0.0]+[ M0.1]>[NOT][P]{(I Q0.0)}");
}

TEST(DrawnNetworks, OutputsAndBranchesHangFromThePointsWhereTheyRun) {
  EXPECT_EQ(tree("LD I0.0\n= Q0.0\nA I0.1\nS Q0.1, 1\n"), "[ I0.0]{( Q0.0); [ I0.1]{(S Q0.1 1)}}");
  EXPECT_EQ(tree("LD I0.0\nLPS\nA I0.1\n= Q0.0\nLRD\nA I0.2\n= Q0.1\nLPP\nMOVB 1, VB0\n"),
            "[ I0.0]{[ I0.1]{( Q0.0)}; [ I0.2]{( Q0.1)}; {MOV_B IN<1 OUT>VB0}}");
}

TEST(DrawnNetworks, ABoxGoesOnAfterItsEno) {
  EXPECT_EQ(tree("LD I0.0\nMOVB 1, VB0\nAENO\n+I VW0, VW2\nAENO\n= Q0.0\n"),
            "[ I0.0]{{MOV_B IN<1 OUT>VB0}{{ADD_I IN1<VW0 IN2<VW2 OUT>VW2}{( Q0.0)}}}");
}

TEST(DrawnNetworks, ACounterHasAnInputForEachLevelOfTheStack) {
  EXPECT_EQ(tree("LD I0.0\nLD I0.1\nO I0.2\nCTU C0, 10\n"), "[ I0.0]{ & <[ I0.1]+[ I0.2]>{CTU C0 PV<10}}");
}

TEST(DrawnNetworks, WhatNeedsNoPowerFlowHangsFromTheRail) {
  EXPECT_EQ(tree("LD I0.0\n= Q0.0\nMEND\n"), "[ I0.0]{( Q0.0)}; (MEND)");
  EXPECT_EQ(tree("LSCR S0.1\n"), "(LSCR S0.1)");
  EXPECT_EQ(tree("LD I0.0\nCRET\n"), "[ I0.0]{(RET)}");
}

TEST(DrawnNetworks, WhatFollowsNextGoesOnAtTheBranch) {
  EXPECT_EQ(tree("LD SM0.0\nFOR VW0, 1, 3\nNEXT\nINCW VW2\n"),
            "[ SM0.0]{{FOR INDX<VW0 INIT<1 FINAL<3}; (NEXT); {INC_W IN<VW2 OUT>VW2}}");
}

TEST(DrawnNetworks, ACallNamesItsParametersAsTheSubroutineDoes) {
  const std::string stl =
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\nCALL SBR0, VW0, VB10\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK SBR_0:SBR0\nVAR_INPUT\nSpeed:INT;\nEND_VAR\nVAR_OUTPUT\nState:BYTE;\nEND_VAR\nBEGIN\nNetwork 1\n"
      "LD SM0.0\nMOVB 1, #State\nEND_SUBROUTINE_BLOCK\n";
  auto parsed = read_text(stl, "test.awl");
  stl::resolve_symbols(parsed);
  EXPECT_EQ(text_of(drawn_networks(parsed.source).front().ladder.rail.branches),
            "[ SM0.0]{{CALL 0 Speed<VW0 State>VB10}}; (MEND)");
}

TEST(DrawnNetworks, WhatLadderCannotShowSaysWhichInstructionAndWhy) {
  EXPECT_EQ(tree("A I0.0\n= Q0.0\n"),
            "A I0.0 has no LD before it in this network: it takes the power flow that the network before has left");
  EXPECT_EQ(tree("LD I0.0\n= Q0.0\nO I0.1\n= Q0.1\n"),
            "O I0.1 stands beside power flow that already leads to an output or a branch; in LAD it would join before that");
  EXPECT_EQ(tree("LD I0.0\nLD I0.1\nNOT\nALD\n= Q0.0\n"),
            "ALD puts a block with NOT, EU or ED after other contacts, which these would see in LAD as well");
  EXPECT_EQ(tree("LD I0.0\nLD I0.1\n= Q0.0\nOLD\n= Q0.1\n"),
            "= Q0.0 does something between an LD and the ALD, OLD or box that takes it");
  EXPECT_EQ(tree("LD I0.0\nLDS 0\n= Q0.0\n"), "LDS 0 copies a level of the logic stack, which no branch does");
  EXPECT_EQ(tree("LD I0.0\nLPS\nA I0.1\nLPP\n= Q0.0\n"), "LPP drops contacts that lead to no coil and no box");
  EXPECT_EQ(tree("LD I0.0\n= Q0.0\nAENO\n= Q0.1\n"), "AENO does not come directly after a box of its branch");
  EXPECT_EQ(tree("LD I0.0\n"), "its contacts lead to no coil and no box");
  EXPECT_EQ(tree("LD I0.0\nMEND\n"), "MEND runs without power flow, and the contacts before it lead to nothing else");
  EXPECT_EQ(tree("LD I0.0\nCTU C0, 5\n"), "CTU C0, 5 takes more levels of the logic stack than this network has put there");
}

TEST(DrawnNetworks, TheSameLogicWithOtherInstructionsIsSaid) {
  const auto networks = drawn("NETWORK 1\nLD I0.0\nLD I0.1\nALD\n= Q0.0\nNETWORK 2\nLD I0.0\nA I0.1\n= Q0.1\n");
  EXPECT_EQ(networks[0].other_stl, (std::vector<std::string>{"LD I0.0", "A I0.1", "= Q0.0"}));
  EXPECT_TRUE(networks[1].other_stl.empty());
}

TEST(DrawnNetworks, AreCountedWithoutNetworkLinesAndLabelsStandAlone) {
  const auto networks = drawn("LD I0.0\nJMP 1\nLD I0.1\n= Q0.0\nLBL 1\nMEND\nSBR 3\nLD I0.2\nCRET\nRET\n");
  std::string all;
  for (const DrawnNetwork& network : networks)
    all += network.routine + ":" + std::to_string(network.ladder.number) + "@" + std::to_string(network.first) +
           (network.ladder.head ? " " + network.ladder.head->symbol : "") + "; ";
  EXPECT_EQ(all, "MAIN:1@0; MAIN:2@2; MAIN:2@4 LBL; MAIN:2@5; SBR_3:1@6 SBR; SBR_3:2@7; ");
}

TEST(DrawnNetworks, EveryElementKnowsItsInstructionAndItsLine) {
  const auto networks = drawn("NETWORK 1\nLD I0.0\n\nA I0.1\n= Q0.0\n");
  const LadderBranch& branch = networks[0].ladder.rail.branches[0];
  EXPECT_EQ(branch.path.parts[1].contact.op, 1u);
  EXPECT_EQ(branch.path.parts[1].contact.position.line, 4u);
  EXPECT_EQ(branch.branches[0].output->op, 2u);
}

TEST(DrawnNetworks, AProgramWithErrorsIsDrawnAsItIsWritten) {
  EXPECT_EQ(tree("LD I0.0\nMOVW VB1, VW10\n= Q99.0\n"), "[ I0.0]{{MOV_W IN<VB1 OUT>VW10}; ( Q99.0)}");
  EXPECT_EQ(tree("LD I0.0\nFROB VB1\n"), "FROB VB1 is not an instruction");
}

TEST(DrawnNetworks, HugeNetworksAreRefusedOrDrawnAndNeverCrash) {
  std::string contacts = "LD I0.0\n", outputs = contacts, deep = contacts;
  for (int i = 0; i < 20000; ++i) {
    contacts += "A I0.1\n";
    outputs += "MOVB 1, VB0\n";
    deep += "MOVB 1, VB0\nAENO\n";
  }
  EXPECT_EQ(tree(contacts + "= Q0.0\n"), "A I0.1 is one contact too many: a drawing has at most 256");
  EXPECT_EQ(drawn("NETWORK 1\n" + outputs)[0].why_not, "");
  EXPECT_EQ(tree(deep), "AENO goes on after one box too many: a drawing has at most 256 in a row");
}

}  // namespace
}  // namespace s7200::drawn_networks_test
