// Headings of routines in listings, and the ends that nobody writes for a CPU 22x.
#include "interpreter/stl/headings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/convert.hpp"

namespace s7200::headings_test {
namespace {

using stl::Block;
using stl::RoutineName;

SourceText read(const std::string& text) {
  auto source = read_source(text, "listing.stl");
  EXPECT_TRUE(source) << source.why();
  return *source;
}

CheckResult checked(const std::string& text, std::string_view cpu = "224") {
  const CpuModel& model = *find_cpu(cpu);
  return check(read(text).parsed, model, default_times(model));
}

std::string errors(const CheckResult& result) {
  std::string all;
  for (const stl::Diagnostic& d : result.diagnostics)
    if (d.severity == stl::Severity::Error) all += std::to_string(d.position.line) + ": " + d.message + "\n";
  return all;
}

std::vector<std::string> mnemonics(const CheckResult& result) {
  std::vector<std::string> all;
  for (const stl::Statement& statement : result.program->statements) all.push_back(statement.mnemonic);
  return all;
}

const std::string kWithoutEnds =
    "NETWORK 1\nLD SM0.1\nMOVB 50, SMB34\nATCH 0, 10\nCALL 0\nENI\n"
    "SBR 0\nNETWORK 1\nLD SM0.0\nMOVW 7, VW2\n"
    "INT 0\nNETWORK 1\nLD SM0.0\nINCW VW0\n";

TEST(RoutineEnds, AListingForACpu22xNeedsNone) {
  for (const char* cpu : {"221", "222", "224", "224XP", "226", "226r1"}) {
    const CheckResult result = checked(kWithoutEnds, cpu);
    ASSERT_TRUE(result.program) << cpu << errors(result);
    const auto all = mnemonics(result);
    EXPECT_EQ(std::ranges::count(all, "MEND"), 1);
    EXPECT_EQ(std::ranges::count(all, "RET"), 1);
    EXPECT_EQ(all.back(), "RETI");
  }
}

TEST(RoutineEnds, ForACpu21xTheyStayRequired) {
  EXPECT_EQ(errors(checked(kWithoutEnds, "214")),
            "7: the main program has no MEND (compile rule 0083)\n"
            "11: SBR 0 has no RET (compile rule 0088)\n"
            "14: INT 0 has no RETI (compile rule 0089)\n");
}

TEST(RoutineEnds, ThoseThatAreWrittenStayAndTheOthersAreAdded) {
  const CheckResult result = checked("LD SM0.0\nCALL 1\nMEND\nSBR 1\nLD I0.0\nCRET\nINCW VW0\n");
  ASSERT_TRUE(result.program) << errors(result);
  EXPECT_EQ(mnemonics(result), (std::vector<std::string>{"LD", "CALL", "MEND", "SBR", "LD", "CRET", "INCW", "RET"}));
}

TEST(RoutineEnds, AStatementAfterAnEndIsStillWrong) {
  EXPECT_EQ(errors(checked("LD I0.0\nMEND\nLD I0.1\n")), "3: only SBR or INT may follow MEND\n");
}

TEST(RoutineEnds, AMainProgramWithoutStatementsIsMissing) {
  EXPECT_EQ(errors(checked("SBR 0\nLD SM0.0\nINCW VW0\n")), "1: the main program has no statement\n");
}

TEST(RoutineEnds, TheCpusThatAListingIsFineForAreThose22x) {
  for (const CpuModel* model : cpus_without_errors(read(kWithoutEnds).parsed))
    EXPECT_TRUE(model->self & kCpu22x) << model->name;
  EXPECT_FALSE(cpus_without_errors(read(kWithoutEnds).parsed).empty());
}

TEST(RoutineEnds, AnExportKeepsTheRoutinesApart) {
  auto parsed = read(kWithoutEnds).parsed;
  const auto blocks = convert(parsed, Notation::MicroWin);
  ASSERT_TRUE(blocks);
  EXPECT_TRUE(checked(*blocks).program) << *blocks;
  EXPECT_NE(blocks->find("SUBROUTINE_BLOCK SBR_0:SBR0"), std::string::npos) << *blocks;
  EXPECT_NE(blocks->find("INTERRUPT_BLOCK INT_0:INT0"), std::string::npos) << *blocks;
}

const std::string kArticle =
    "This example shows how a timed interrupt counts. It was written for the CPU 224 and is explained below in detail.\n\n"
    "MAIN\nNetwork 1 // start\nLD SM0.1\nMOVB 50, SMB34\nATCH INT_0, 10\nENI\n\n"
    "INT_0\nNetwork 1\nLD SM0.0\nINCW VW0\n\n"
    "Every fifty milliseconds the routine adds one to the word, so that after a second there are twenty of them in it.\n";

TEST(RoutineEnds, ADocumentForACpu22xNeedsNoneEither) {
  EXPECT_TRUE(read(kArticle).as_document());
  EXPECT_TRUE(checked(kArticle).program) << errors(checked(kArticle));
  EXPECT_FALSE(checked(kArticle, "214").program);
}

TEST(RoutineEnds, ADocumentThatWritesSomeMustWriteAll) {
  std::string text = kArticle;
  text.insert(text.find("INT_0\nNetwork"), "MEND\n");
  EXPECT_NE(errors(checked(text)).find("the listing is cut off: INT 0 has no RETI"), std::string::npos);
}

TEST(Headings, AreTheDefaultNamesInManyForms) {
  const RoutineName main{Block::Kind::Main, 0}, sbr{Block::Kind::Subroutine, 0}, interrupt{Block::Kind::Interrupt, 12};
  for (const char* line : {"MAIN", "main", "MAIN:", "Main program", "MAIN (OB1)", "MAIN:OB1", "OB1", "--- MAIN ---",
                           "[MAIN]", "MAIN // start", "== MAIN =="})
    EXPECT_EQ(stl::routine_heading(line), main) << line;
  for (const char* line : {"SBR_0", "sbr_0:", "SBR0", "SBR_0 (SBR0)", "SBR_0:SBR0", "SBR 0:", "Subroutine 0",
                           "SUBROUTINE SBR_0", "* SBR_0 *", "SBR_0 // pump"})
    EXPECT_EQ(stl::routine_heading(line), sbr) << line;
  for (const char* line : {"INT_12", "INT12", "INT_12 (INT12)", "Interrupt 12", "INTERRUPT ROUTINE INT_12", "INT 12:"})
    EXPECT_EQ(stl::routine_heading(line), interrupt) << line;
}

TEST(Headings, AreNothingElse) {
  for (const char* line :
       {"", "SBR 0", "INT 0 // a statement", "= MAIN", "= SBR_0", "SBR", "INT_", "SBR_0 (SBR1)", "SBR_0 INT_0", "MAIN 2",
        "LD SM0.0", "CALL SBR_0", "MAINS", "PROGRAM", "ROUTINE 0", "SBR_99999999999", "SBR_0, 1", "// MAIN", "SBR_0x"})
    EXPECT_EQ(stl::routine_heading(line), std::nullopt) << line;
}

TEST(Headings, BeginRoutinesThatTheirNamesCall) {
  const CheckResult result = checked(
      "MAIN\nNetwork 1\nLD SM0.1\nATCH INT_0, 10\nCALL SBR_3\nENI\nSBR_3\nNetwork 1\nLD SM0.0\nINCW VW0\nINT_0:\nLD SM0.0\n"
      "INCW VW2\n");
  ASSERT_TRUE(result.program) << errors(result);
  EXPECT_TRUE(result.diagnostics.empty());
}

TEST(Headings, TheMainProgramComesFirstWhereverItStands) {
  const CheckResult result = checked("INT_0\nLD SM0.0\nINCW VW2\nMAIN\nLD SM0.1\nATCH INT_0, 10\nENI\n");
  ASSERT_TRUE(result.program) << errors(result);
  EXPECT_EQ(mnemonics(result), (std::vector<std::string>{"LD", "ATCH", "ENI", "MEND", "INT", "LD", "INCW", "RETI"}));
}

TEST(Headings, TwoMainProgramsAreAnError) {
  EXPECT_EQ(errors(checked("LD I0.0\n= Q0.0\nMAIN\nLD I0.1\n= Q0.1\n")), "3: the main program begins twice\n");
  EXPECT_EQ(errors(checked("MAIN\nLD I0.0\n= Q0.0\nMAIN\nLD I0.1\n= Q0.1\n")), "4: the main program begins twice\n");
}

TEST(Headings, ARoutineThatIsMissingIsNamedByItsNumber) {
  EXPECT_EQ(errors(checked("LD SM0.0\nCALL SBR_5\n")), "2: subroutine 5 is missing (compile rule 0087)\n");
  EXPECT_EQ(errors(checked("LD SM0.0\nCALL INT_5\n")), "2: INT_5 is not a subroutine\n");
}

TEST(Headings, ARoutineWhoseHeadingCouldNotBeReadIsNotMissing) {
  for (const std::string heading : {"INTERRUPTPROGRAMM Takt, INT_0", "INT_0 (Takt", "INTERRUPT_BLOK Takt:INT0"}) {
    const std::string said = errors(checked("LD SM0.1\nATCH INT_0, 10\nENI\n" + heading + "\nLD SM0.0\nINCW VW0\n"));
    EXPECT_TRUE(said.starts_with("4: ")) << said;
    EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  }
}

TEST(Headings, OfOtherLanguagesAreRead) {
  for (const std::string heading :
       {"\u4E2D\u65AD\u7A0B\u5E8FINT_0", "\u4E2D\u65AD\u7A0B\u5E8F INT_0",
        "\u4E2D\u65B7\u7A0B\u5E8F INT_0", "\u4E2D\u65B7\u5B50\u7A0B\u5E8F INT_0",
        "\u4E2D\u65AD"
        "0",
        "INTERRUPTPROGRAMM INT_0", "Interrupt-Programm 0:", "RUTINA DE INTERRUPCI\u00D3N INT_0",
        "programa de interrupci\u00F3n INT_0", "PROGRAMME D'INTERRUPTION 0", "Routine d interruption INT_0"}) {
    const CheckResult result = checked("LD SM0.1\nATCH INT_0, 10\nENI\n" + heading + "\nLD SM0.0\nINCW VW0\n");
    EXPECT_TRUE(result.program) << heading << '\n' << errors(result);
  }
  for (const std::string heading : {"UNTERPROGRAMM 1", "Sous-programme SBR_1", "\u5B50\u7A0B\u5E8F 1", "Subrutina SBR_1"}) {
    const CheckResult result = checked("LD SM0.0\nCALL SBR_1\n" + heading + "\nLD SM0.0\nINCW VW0\n");
    EXPECT_TRUE(result.program) << heading << '\n' << errors(result);
  }
  for (const std::string heading : {"Hauptprogramm", "Programme principal", "PROGRAMA PRINCIPAL (OB1)"}) {
    const CheckResult result = checked("INT_0\nLD SM0.0\nINCW VW2\n" + heading + "\nLD SM0.1\nATCH INT_0, 10\nENI\n");
    EXPECT_TRUE(result.program) << heading << '\n' << errors(result);
  }
}

TEST(Headings, MayStandBeforeTheirFirstStatement) {
  const CheckResult result = checked("MAIN: LD SM0.1\nCALL SBR_0\nSBR_0: LD I0.1 // in\n= Q0.1\n");
  ASSERT_TRUE(result.program) << errors(result);
  EXPECT_EQ(mnemonics(result), (std::vector<std::string>{"LD", "CALL", "MEND", "SBR", "LD", "=", "RET"}));
}

/// Each of them is a message, and none takes more of the stack than the one before.
TEST(Headings, ALineHasOneHeading) {
  std::string line;
  for (int i = 0; i < 20'000; ++i) line += "SBR_0:";
  EXPECT_EQ(checked("LD SM0.1\nCALL SBR_0\n" + line + " LD I0.1\n= Q0.1\n").program, nullptr);
}

TEST(Headings, ATitleIsNoStatement) {
  for (const std::string line : {"INT_0: Stop", "SBR_1: End", "SBR_0: Pump 1"})
    EXPECT_FALSE(checked("LD SM0.1\n= Q0.0\n" + line + "\nLD I0.2\n= Q0.1\n").program) << line;
}

TEST(Headings, ManyLabelsTakeNoLongerEachThanOne) {
  std::string text = "LD SM0.1\nCALL Init\n";
  for (int i = 0; i < 20'000; ++i) text += "a:\n";
  EXPECT_EQ(checked(text).program, nullptr);
}

TEST(Headings, ANameThatIsCalledIsNoLabel) {
  for (const std::string heading : {"Init:", "Init: LD I0.1", "SUBROUTINE Init", "Unterprogramm Init"})
    EXPECT_EQ(errors(checked("LD SM0.1\nCALL Init\n" + heading + "\nLD I0.2\n= Q0.1\n")),
              "3: Init is the name of a subroutine, which a listing numbers\n")
        << heading;
}

TEST(Headings, TheCommentsOfANewProjectAreComments) {
  const CheckResult result =
      checked("PROGRAM COMMENTS\nNETWORK 1\nLD SM0.0\nCALL SBR_0\nSBR_0\nSUBROUTINE COMMENTS\nNETWORK 1\nLD I0.0\n= Q0.0\n");
  EXPECT_TRUE(result.program) << errors(result);
}

TEST(Headings, ARoutineThatNoUnreadLineMentionsIsMissing) {
  EXPECT_EQ(errors(checked("LD SM0.0\nCALL 1\nATCH 3, 10\nXYZ 13, VB1\nINTERRUPTPROGRAMM Takt 13\n")),
            "2: subroutine 1 is missing (compile rule 0087)\n3: interrupt routine 3 is missing (compile rule 0087)\n"
            "4: unknown instruction 'XYZ'\n"
            "5: INTERRUPTPROGRAMM is the heading of an interrupt routine in another form\n");
}

TEST(Headings, InAnExportNamesAreThoseOfItsBlocks) {
  EXPECT_EQ(errors(checked("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\nCALL SBR_0\nEND_ORGANIZATION_BLOCK\n"
                           "SUBROUTINE_BLOCK Pump:SBR0\nBEGIN\nNetwork 1\nLD SM0.0\nINCW VW0\nEND_SUBROUTINE_BLOCK\n")),
            "5: there is no subroutine SBR_0\n");
}

}  // namespace
}  // namespace s7200::headings_test
