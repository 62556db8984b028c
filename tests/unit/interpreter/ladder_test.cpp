#include "interpreter/program/ladder/ladder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/ladder/ladder_compare.hpp"
#include "interpreter/stl/printer.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"

namespace s7200::ladder_test {
namespace {

SourceText read(std::string_view page) {
  auto text = read_drawings(page, "page.txt");
  EXPECT_TRUE(text) << text.why();
  return text ? std::move(*text) : SourceText{};
}

/// The statements of a page in one line each network; the test fails if the page has errors.
std::string stl_of(std::string_view page) {
  const SourceText text = read(page);
  for (const stl::Diagnostic& diagnostic : text.parsed.diagnostics)
    ADD_FAILURE() << stl::render(diagnostic, text.parsed.source, false);
  std::string all;
  for (const stl::Line& line : text.parsed.source.lines) {
    if (std::holds_alternative<stl::NetworkHead>(line)) all += all.empty() ? "" : "| ";
    const auto* statement = std::get_if<stl::Statement>(&line);
    if (!statement) continue;
    all += statement->mnemonic;
    for (const stl::Operand& operand : statement->operands)
      all += (&operand == &statement->operands.front() ? " " : ",") + stl::to_text(operand);
    all += "; ";
  }
  return all;
}

/// The first message about a page.
std::string complaint(std::string_view page) {
  const auto& found = read(page).parsed.diagnostics;
  return found.empty() ? "" : std::to_string(found.front().position.line) + ": " + found.front().message;
}

std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

const std::string kLamp =
    "    │ I0.0       I0.1                 Q0.0\n"
    "1   ├─┤   ├──────┤ / ├───────────────(     )\n"
    "    │\n";

TEST(Ladder, ContactsInSeriesEndInACoil) { EXPECT_EQ(stl_of(kLamp), "LD I0.0; AN I0.1; = Q0.0; "); }

TEST(Ladder, ContactsMayBeImmediateComparisonsEdgesAndNot) {
  EXPECT_EQ(stl_of("    │ I0.0       I0.1                          Q0.0\n"
                   "1   ├─┤ I ├──────┤/I ├──┤NOT├───┤ P ├─────────(  I  )\n"
                   "    │    K0          AC2                       M0.0     K3\n"
                   "2   ├───────┤ == W ├─────────────┤ N ├────────(   S   )\n"
                   "    │  VB0         KHFF                        M0.0     K3\n"
                   "3   ├───────┤ >= B ├──────────────────────────(   R   )\n"),
            "LDI I0.0; ANI I0.1; NOT; EU; =I Q0.0; | LDW= 0,AC2; ED; S M0.0,3; | LDB>= VB0,16#FF; R M0.0,3; ");
}

const std::string kBranches =
    "    │ I0.0                             Q0.0\n"
    "1   ├─┤   ├─┬──────────┬────────┬─────(     )\n"
    "    │       │          │        │\n"
    "    │ I0.1  │          │        │  I0.4    Q0.1\n"
    "    ├─┤   ├─┘          │        └──┤   ├──(     )\n"
    "    │                  │\n"
    "    │ I0.2      I0.3   │\n"
    "    ├─┤   ├─────┤   ├──┘\n"
    "    │\n";

TEST(Ladder, BranchesInParallelAreJoinedWithOAndOld) {
  EXPECT_EQ(stl_of(kBranches), "LD I0.0; O I0.1; LD I0.2; A I0.3; OLD; = Q0.0; A I0.4; = Q0.1; ");
}

TEST(Ladder, AParallelBlockInSeriesIsJoinedWithAld) {
  EXPECT_EQ(stl_of("    │ I0.0     I0.1           Q0.0\n"
                   "1   ├─┤   ├─┬──┤   ├──┬──────(     )\n"
                   "    │       │  I0.2   │\n"
                   "    │       └──┤   ├──┘\n"),
            "LD I0.0; LD I0.1; O I0.2; ALD; = Q0.0; ");
}

TEST(Ladder, BranchesToOutputsSaveThePowerFlow) {
  EXPECT_EQ(stl_of("    │ I0.0       I0.1     Q0.0\n"
                   "1   ├─┤   ├─┬────┤   ├───(     )\n"
                   "    │       │    I0.2     Q0.1\n"
                   "    │       ├────┤   ├───(     )\n"
                   "    │       │    I0.3     Q0.2\n"
                   "    │       └────┤   ├───(     )\n"),
            "LD I0.0; LPS; A I0.1; = Q0.0; LRD; A I0.2; = Q0.1; LPP; A I0.3; = Q0.2; ");
}

std::string box(const std::string& name, const std::string& pins) {
  return "    │ I0.0                 " + name + "\n1   ├─┤   ├────────────────┤EN      │\n" + pins +
         "    │                      └────────┘\n";
}

TEST(Ladder, ABoxWithAResultOfItsOwnIsAMoveAndAnInstruction) {
  const std::string pins =
      "    │                   VW0┤IN1  OUT├AC0\n"
      "    │                    K5┤IN2     │\n";
  EXPECT_EQ(stl_of(box("ADD_I────┐", pins)), "LD I0.0; MOVW VW0,AC0; +I 5,AC0; ");
}

TEST(Ladder, ABoxThatChangesItsInputNeedsNoMove) {
  EXPECT_EQ(stl_of(box("ADD_I────┐", "    │                    K5┤IN1  OUT├VW0\n    │                   VW0┤IN2     │\n")),
            "LD I0.0; +I 5,VW0; ");
  EXPECT_EQ(stl_of(box("SHR_W────┐", "    │                   VW0┤IN   OUT├VW0\n    │                    K3┤N       │\n")),
            "LD I0.0; SRW VW0,3; ");
  EXPECT_EQ(stl_of(box("DIV──────┐", "    │                   VW0┤IN1  OUT├VD4\n    │                    K8┤IN2     │\n")),
            "LD I0.0; MOVW VW0,VW6; DIV 8,VD4; ");
  EXPECT_EQ(stl_of(box("ATCH─────┐", "    │                    K3┤INT     │\n    │                    K8┤EVT     │\n")),
            "LD I0.0; ATCH 3,8; ");
}

TEST(Ladder, ASecondInputThatTheMoveOverwritesIsRefused) {
  EXPECT_NE(complaint(box("SUB_I────┐", "    │                   VW0┤IN1  OUT├VW2\n    │                   VW2┤IN2     │\n"))
                .find("VW2 is lost"),
            std::string::npos);
}

const std::string kRoutine =
    "    │                                 1\n"
    "1   ├────────────────────────────────( MEND  )\n"
    "┌──────────┐\n"
    "│ SBR: 5   │\n"
    "└───┬──────┘\n"
    "    │ SM0.0                           7\n"
    "3   ├─┤   ├──────────────────────────(  JMP  )\n"
    "    │\n"
    "┌──────────┐\n"
    "│ LBL:7    │\n"
    "└───┬──────┘\n"
    "    │\n"
    "5   ├────────────────────────────────(  RET  )\n"
    "    │\n";

TEST(Ladder, FramesAreHeadsOfRoutinesAndLabels) {
  EXPECT_EQ(stl_of(with(kRoutine, "    │                                 1\n", "")),
            "MEND; | SBR 5; | LD SM0.0; JMP 7; | LBL 7; | RET; ");
  EXPECT_EQ(complaint(kRoutine), "2: network 1: this coil has 1 operand, and MEND takes 0");
}

TEST(Ladder, AnOutputOnThePowerRailAlwaysRuns) {
  EXPECT_EQ(stl_of("    │                                 5\n1   ├────────────────────────────────( CALL  )\n"),
            "LD SM0.0; CALL 5; ");
}

TEST(Ladder, ACodePageDecodedAsWindows1252IsReadAsWell) {
  std::string page = kLamp;
  for (const auto& [drawn, decoded] : {std::pair{"│", "³"}, {"├", "Ã"}, {"─", "Ä"}, {"┤", "´"}})
    for (std::size_t at = 0; (at = page.find(drawn, at)) != std::string::npos;) page.replace(at, 3, decoded);
  EXPECT_EQ(stl_of(page), "LD I0.0; AN I0.1; = Q0.0; ");
  std::string cp437 = kLamp;
  for (const auto& [drawn, byte] : {std::pair{"│", "\xB3"}, {"├", "\xC3"}, {"─", "\xC4"}, {"┤", "\xB4"}})
    for (std::size_t at = 0; (at = cp437.find(drawn, at)) != std::string::npos;) cp437.replace(at, 3, byte);
  EXPECT_EQ(stl_of(cp437), "LD I0.0; AN I0.1; = Q0.0; ");
}

TEST(Ladder, DamageIsNamedWhereItIs) {
  EXPECT_EQ(complaint(with(kLamp, "──(", "\uFFFD─(")),
            "2: network 1: the wire or contact leads to the right into nothing here");
  EXPECT_EQ(complaint(with(kLamp, "I0.1", "    ")), "2: network 1: this contact has no operand");
  EXPECT_EQ(complaint(with(kLamp, "/ ├", "/  ")), "2: network 1: this contact has no right side");
  EXPECT_EQ(complaint(with(kLamp, "     )", "      ")), "2: network 1: this coil has no right bracket");
  EXPECT_EQ(complaint(with(kLamp, "/", "?")), "2: network 1: there is no contact ┤?├");
  EXPECT_EQ(complaint(with(kLamp, "(     )", "( FROB)")), "2: network 1: there is no coil 'FROB'");
  EXPECT_EQ(complaint(with(kLamp, "I0.1", "I0,1")), "1: network 1: 'I0,1' is not an operand");
  EXPECT_EQ(complaint(with(kBranches, "    ├─┤   ├─────┤   ├──┘\n", "")).substr(0, 14), "7: network 1: ");
  EXPECT_EQ(complaint(with(kBranches, "    ├─┤   ├─┘ ", "     ─┤   ├─┘ ")), "5: this line of a drawing has no power rail");
  EXPECT_EQ(complaint(with(kLamp, "    │\n", "3   ├─────(  END  )\n")),
            "3: network 3 follows network 1: network 2 is missing");
  EXPECT_EQ(complaint(box("MOV_W────┐", "    │                   VW0┤IN   OUT│AC0\n")).substr(0, 2), "3:");
  EXPECT_EQ(complaint("1   ├─┤   ├──\n"), "1: network 1: this contact has no operand");
  EXPECT_EQ(complaint("LD I0.0\n= Q0.0\n"), "1: there is no ladder drawing in this document");
  EXPECT_EQ(complaint("1   â”œâ”€â”€â”€\n"), "1: the drawings in this document were decoded with the wrong code page");
}

TEST(Ladder, ARightSideThatTheOperandPushedAwayIsReadWithAWarning) {
  const SourceText text = read(box("MOV_W────┐", "    │                   VW0┤IN  OUT *VD3570\n"));
  ASSERT_EQ(text.parsed.diagnostics.size(), 1u);
  EXPECT_EQ(text.parsed.diagnostics[0].severity, stl::Severity::Warning);
  EXPECT_NE(stl::to_text(text.parsed.source).find("MOVW    VW0, *VD3570"), std::string::npos);
}

TEST(Ladder, ABridgeBetweenBranchesIsRefused) {
  EXPECT_EQ(complaint("    │ I0.0       I0.1     Q0.0\n"
                      "1   ├─┤   ├─┬────┤   ├─┬─(     )\n"
                      "    │       │    I0.2  │  Q0.1\n"
                      "    │       └────┤   ├─│─(     )\n"
                      "    │ I0.3             │\n"
                      "    ├─┤   ├────────────┘\n")
                .substr(0, 14),
            "4: network 1: ");
}

TEST(Ladder, EveryCutOfAPageEndsInAMessageOrAProgramAndNeverCrashes) {
  const std::string page = kBranches + with(kRoutine, "1   ├", "2   ├");
  for (std::size_t end = 0; end < page.size(); ++end) read(page.substr(0, end));
  for (std::size_t at = 0; at < page.size(); ++at) read(page.substr(0, at) + page.substr(at + 1));
  for (std::size_t at = 0; at + 3 < page.size(); ++at) read(page.substr(0, at) + "├" + page.substr(at + 3));
}

TEST(Ladder, MegabyteLinesAreReadOnce) {
  const std::size_t megabyte = 1 << 20;
  std::string wire = "1   ├";
  for (std::size_t i = 0; i < megabyte / 3; ++i) wire += "─";
  EXPECT_NE(complaint(wire).find("longer than 256 characters"), std::string::npos);
  std::string page;
  while (page.size() < megabyte) page += "1   ├──┤   ├┬┤ └┘(\n    ││││┐┌\n";
  EXPECT_FALSE(complaint(page).empty());
}

// ---- Comparison ----------------------------------------------------------------------------------------------------------

LadderComparison compare(const std::string& page) {
  auto result = compare_drawings(page, "page.txt");
  EXPECT_TRUE(result) << result.why();
  return result ? std::move(*result) : LadderComparison{};
}

std::string first_message(const LadderComparison& comparison) {
  return comparison.diagnostics.empty() ? "" : comparison.diagnostics.front().message;
}

TEST(LadderComparison, WhatDoesTheSameIsTheSameHoweverItIsWritten) {
  for (const char* stl : {"LD I0.0\nO I0.1\nLD I0.2\nA I0.3\nOLD\n= Q0.0\nA I0.4\n= Q0.1\nMEND\n",
                          "LD I0.3\nA I0.2\nO I0.1\nO I0.0\n= Q0.0\nA I0.4\n= Q0.1\nMEND\n",
                          "LDN I0.0\nAN I0.1\nLDN I0.2\nON I0.3\nALD\nNOT\n= Q0.0\nLPS\nA I0.4\n= Q0.1\nLPP\nMEND\n",
                          "LD I0.0\nO I0.1\nLD I0.2\nA I0.3\nOLD\n= Q0.0\n"
                          "LD I0.2\nA I0.3\nO I0.1\nO I0.0\nA I0.4\n= Q0.1\nMEND\n"}) {
    const LadderComparison comparison = compare(kBranches + "\n" + "2   ├───( MEND  )\n\n" + stl);
    EXPECT_EQ(first_message(comparison), "") << stl;
    EXPECT_EQ(comparison.same, 2u);
  }
}

TEST(LadderComparison, ADifferentConditionIsNamedWithAnExample) {
  const LadderComparison comparison = compare(kLamp + "2   ├───( MEND  )\n\nLD I0.0\nA I0.1\n= Q0.0\nMEND\n");
  ASSERT_EQ(comparison.diagnostics.size(), 1u);
  EXPECT_EQ(first_message(comparison), "network 1: = Q0.0 runs under different conditions in the drawing and in the STL");
  EXPECT_EQ(
      comparison.diagnostics[0].hint,
      "the drawing has LD I0.0; AN I0.1; the STL in line 8 has LD I0.0; A I0.1; with I0.0 on, I0.1 off only the drawing "
      "runs it");
  EXPECT_EQ(comparison.same, 1u);
}

TEST(LadderComparison, DifferentOutputsAreNamedOnBothSides) {
  EXPECT_EQ(first_message(compare(kLamp + "2   ├───( MEND  )\n\nLD I0.0\nAN I0.1\n= Q0.1\nMEND\n")),
            "network 1: the drawing has = Q0.0, the STL has = Q0.1");
  EXPECT_EQ(first_message(compare(kLamp + "2   ├───( MEND  )\n\nMEND\n")), "network 1 is drawn, but not in the STL");
  EXPECT_EQ(first_message(compare(kLamp + "2   ├───( MEND  )\n\nLD I0.0\nAN I0.1\n= Q0.0\nLD I0.7\n= Q0.7\nMEND\n")),
            "these statements are not drawn");
}

TEST(LadderComparison, AContactThatIsOffInOneOfManyValuesIsFound) {
  std::string operands = "    │", contacts = "1   ├", stl;
  for (int i = 0; i < 20; ++i) {
    operands += " M" + std::to_string(i / 8) + "." + std::to_string(i % 8) + " ";
    contacts += "─┤   ├";
    stl += std::string(i == 0 ? "LD" : "A") + " M" + std::to_string(i / 8) + "." + std::to_string(i % 8) + "\n";
  }
  const std::string page = operands + "  Q0.0\n" + contacts + "─(     )\n2   ├───( MEND  )\n\n";
  EXPECT_EQ(first_message(compare(page + stl + "= Q0.0\nMEND\n")), "");
  EXPECT_NE(first_message(compare(page + with(stl, "A M1.3\n", "") + "= Q0.0\nMEND\n")), "");
}

// ---- The published tip ---------------------------------------------------------------------------------------------------

class DrawnTip : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "there is no " << path;
    bytes_ = tools::read_file(path).value_or("");
  }
  std::string bytes_;
};

TEST_F(DrawnTip, IsItsStlButForOneOperand) {
  const LadderComparison comparison = compare(bytes_);
  EXPECT_EQ(comparison.networks, 103u);
  EXPECT_EQ(comparison.same, 102u);
  ASSERT_EQ(comparison.diagnostics.size(), 3u);
  std::vector<std::uint32_t> lines;
  for (const stl::Diagnostic& diagnostic : comparison.diagnostics) lines.push_back(diagnostic.position.line);
  EXPECT_EQ(lines, (std::vector<std::uint32_t>{3826, 3830, 3986}));
  EXPECT_NE(comparison.diagnostics[0].hint.find("LDB= SMW2, VB4095"), std::string::npos);
  EXPECT_NE(comparison.diagnostics[0].hint.find("LDB= SMB2, VB4095"), std::string::npos);
}

TEST_F(DrawnTip, ChecksAndIsTheSameProgramOnceThatOperandIsCorrected) {
  const CpuModel& model = *find_cpu("214");
  const CheckResult wrong = check(read(bytes_).parsed, model, default_times(model));
  EXPECT_FALSE(wrong.program);
  EXPECT_EQ(std::ranges::count(wrong.diagnostics, stl::Severity::Error, &stl::Diagnostic::severity), 1);
  const SourceText drawn = read(with(bytes_, "SMW2  ", "SMB2  "));
  EXPECT_TRUE(check(drawn.parsed, model, default_times(model)).program);
  EXPECT_EQ(compare(with(bytes_, "SMW2  ", "SMB2  ")).same, 103u);
}

}  // namespace
}  // namespace s7200::ladder_test
