#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "interpreter/stl/blocks.hpp"

namespace s7200::headed_document_test {
namespace {

// A listing as Micro/WIN shows it, below some text: routines that are called by name, networks that begin at 1 in each.
const std::string kListing =
    "本例\n"
    "LD 是指令\n"
    "主程序:\n"
    "NETWORK 1\n"
    "LD SM0.1 //x\n"
    "CALL prepare\n"
    "Count子程序:\n"
    "NETWORK 1\n"
    "LD SM0.0\n"
    "INCW VW0\n"
    "Prepare子程序：\n"
    "NETWORK 1\n"
    "LD SM0.0\n"
    "ATCH Tick, 10\n"
    "CALL Count\n"
    "Tick中断程序\n"
    "NETWORK 1\n"
    "LD SM0.0\n"
    "INCW VW2\n";

SourceText source_of(const std::string& text) {
  auto source = read_source(text, "listing.txt");
  EXPECT_TRUE(source) << source.why();
  return *source;
}

CheckResult checked(const SourceText& text, std::string_view cpu = "224") {
  const CpuModel& model = *find_cpu(cpu);
  return check(text.parsed, model, default_times(model));
}

TEST(HeadedDocument, RoutinesAreFoundByTheirHeadings) {
  const SourceText text = source_of(kListing);
  EXPECT_TRUE(text.as_document());
  const auto& blocks = text.parsed.source.blocks;
  ASSERT_EQ(blocks.size(), 4U);
  EXPECT_EQ(blocks[0].kind, stl::Block::Kind::Main);
  EXPECT_EQ(blocks[1].name, "Count");
  EXPECT_EQ(blocks[2].name, "Prepare");
  EXPECT_EQ(blocks[2].number, 1U);
  EXPECT_EQ(blocks[3].kind, stl::Block::Kind::Interrupt);
  EXPECT_EQ(blocks[3].name, "Tick");
}

TEST(HeadedDocument, ItNeedsNoEndsAndCallsRoutinesByName) {
  const CheckResult result = checked(source_of(kListing));
  EXPECT_TRUE(result.program) << (result.diagnostics.empty() ? "" : result.diagnostics.front().message);
}

TEST(HeadedDocument, TraditionalCharactersWillDo) {
  std::string text = kListing;
  const std::string simple = "中断程序";
  text.replace(text.find(simple), simple.size(), "中斷程序:");
  EXPECT_TRUE(checked(source_of(text)).program);
}

TEST(HeadedDocument, AMistakeNamesRoutineAndNetwork) {
  std::string text = kListing;
  text.replace(text.find("INCW VW2"), 8, "INCW VB2");
  const SourceText source = source_of(text);
  const CheckResult result = checked(source);
  const auto error = std::ranges::find(result.diagnostics, stl::Severity::Error, &stl::Diagnostic::severity);
  ASSERT_NE(error, result.diagnostics.end());
  EXPECT_EQ(error->position.line, 19U);
  EXPECT_EQ(stl::section_at(result.source, 19), "Tick, network 1");
}

TEST(HeadedDocument, AnUnknownRoutineIsNamed) {
  std::string text = kListing;
  text.replace(text.find("CALL Count"), 10, "CALL Comet");
  const CheckResult result = checked(source_of(text));
  EXPECT_FALSE(result.program);
  EXPECT_TRUE(std::ranges::any_of(result.diagnostics, [](const stl::Diagnostic& diagnostic) {
    return diagnostic.severity == stl::Severity::Error && diagnostic.position.line == 15;
  }));
}

TEST(HeadedDocument, AHeadingAloneDoesNotMakeOne) {
  EXPECT_FALSE(stl::has_routine_headings("主程序:\nLD SM0.0\n"));
  EXPECT_FALSE(stl::has_routine_headings("在主程序:\nNETWORK 1\n"));
  EXPECT_FALSE(stl::has_routine_headings("Read子程序:\nNETWORK 1\n"));
  EXPECT_TRUE(stl::has_routine_headings("主程序\n\nNETWORK 1\n"));
}

// The routines by which the listing of the PC protocol is known, with some of what it prints.
const std::string kKnown =
    "主程序:\nNETWORK 1\nLD SM0.1\nCALL initialize\n"
    "Read子程序:\nNETWORK 1\nLD SM0.0\nMOVB 26, VB174\n"
    "Write子程序:\nNETWORK 1\nLD SM0.0\nMOVB 26, VB174 //end\n"
    "Verify子程序:\nNETWORK 1\nLD SM0.0\nR M0.1, 1\n"
    "Initialize子程序:\nNETWORK 1\nLD SM0.0\nMOVB +1000, SMW92\nMOVB 35, SMB94\nR SM87.2, 1\n"
    "RCVcomplete中断程序\nNETWORK 1\nLD SM0.0\nR M0.1, 1\n"
    "XMTcomplete中断程序\nNETWORK 1\nLD SM0.0\nMOVB 0, VB133\n";

std::vector<std::string> repaired(stl::Source& source, const std::string& ids) {
  std::vector<std::string> unknown, texts;
  for (const Slip& slip : repair(source, *parse_repairs(ids), unknown)) texts.push_back(to_text(slip, source));
  for (const std::string& id : unknown) texts.push_back("unknown " + id);
  return texts;
}

TEST(Slips, OfAKnownListingAreNamedWithWhatWasMeant) {
  SourceText text = source_of(kKnown);
  EXPECT_EQ(
      repaired(text.parsed.source, "none"),
      (std::vector<std::string>{
          "listing.txt: slip R1 in line 20: MOVB +1000, SMW92 is kept; --repair R1 has it read as MOVW +1000, SMW92: 1000 "
          "is not a byte, and SMW92 is a word",
          "listing.txt: slip R4 in lines 8, 12: MOVB 26, VB174 is kept; --repair R4 has it read as MOVB 16#26, VB174: "
          "the text says that an answer ends with 26 in hex",
          "listing.txt: slip R5 in line 21: MOVB 35, SMB94 is kept; --repair R5 has it read as MOVB 33, SMB94: a command "
          "has 33 characters, and the buffer too",
          "listing.txt: slip R6 in line 22: R SM87.2, 1 is kept; --repair R6 has it left out: it switches off the "
          "time-out that is set up before it",
          "listing.txt: slip R7 in line 16: R M0.1, 1 is kept; --repair R7 has it read as R M0.1, 1 / R M0.0, 1: a "
          "command for another station leaves M0.0 on",
          "listing.txt: slip R8 in line 4: CALL initialize is kept; --repair R8 has it read as CALL Initialize: the "
          "heading is written with a capital"}));
  EXPECT_FALSE(checked(text).program);
}

TEST(Slips, AreRepairedByTheirNumbers) {
  SourceText text = source_of(kKnown);
  const auto notes = repaired(text.parsed.source, "r1, R6");
  EXPECT_EQ(notes[0],
            "listing.txt: slip R1 in line 20: MOVB +1000, SMW92 is read as MOVW +1000, SMW92: 1000 is not a byte, and "
            "SMW92 is a word");
  EXPECT_EQ(notes[3].substr(0, 58), "listing.txt: slip R6 in line 22: R SM87.2, 1 is left out: ");
  const CheckResult result = checked(text);
  EXPECT_TRUE(result.program) << (result.diagnostics.empty() ? "" : result.diagnostics.front().message);
  EXPECT_EQ(find_slips(text.parsed.source).size(), 4U);
}

TEST(Slips, AllAreRepairedAtOnceAndOnlyWhereTheyAre) {
  SourceText text = source_of(kKnown);
  const auto count = [&] {
    return std::ranges::count_if(text.parsed.source.lines,
                                 [](const stl::Line& line) { return std::holds_alternative<stl::Statement>(line); });
  };
  const auto before = count();
  repaired(text.parsed.source, "all");
  EXPECT_EQ(count(), before);  // one left out, one added: in Verify, not in RCVcomplete
  EXPECT_TRUE(checked(text).program);
  const auto left = find_slips(text.parsed.source);
  ASSERT_EQ(left.size(), 1U);  // R7 adds to what is printed
  EXPECT_EQ(left[0].id, "R7");
}

TEST(Slips, OnlyAKnownListingHasThem) {
  SourceText text = source_of(kListing);
  EXPECT_EQ(repaired(text.parsed.source, "R1"), (std::vector<std::string>{"unknown R1"}));
  EXPECT_TRUE(repaired(text.parsed.source, "all").empty());
}

TEST(Slips, AreAskedForByNumber) {
  for (const char* text : {"", "R", "1", "R1,", "R1;R2", "frob", "all,R1"}) {
    const std::string why = parse_repairs(text).why();
    EXPECT_NE(why.find("write for example R1,R2 or all"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace s7200::headed_document_test
