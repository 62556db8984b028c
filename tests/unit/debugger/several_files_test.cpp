// A program of several files: people know its lines by their numbers in each file.
#include "interpreter/program/load.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::several_files_test {
namespace {

AtPrompt session_of_two_files() {
  std::vector<SourceText> files;
  for (const auto& [name, text] : {std::pair("pumps/main.awl",
                                             "ORGANIZATION_BLOCK MAIN:OB1\n"  // 1
                                             "BEGIN\n"                        // 2
                                             "Network 1\n"                    // 3
                                             "LD SM0.0\n"                     // 4
                                             "CALL Init\n"                    // 5
                                             "END_ORGANIZATION_BLOCK\n"),     // 6
                                   std::pair("pumps/sub.awl",
                                             "// second\n"                   // 1
                                             "SUBROUTINE_BLOCK Init:SBR0\n"  // 2
                                             "BEGIN\n"                       // 3
                                             "Network 1\n"                   // 4
                                             "LD SM0.0\n"                    // 5
                                             "MOVB 1, VB0\n"                 // 6
                                             "END_SUBROUTINE_BLOCK\n")}) {   // 7
    files.push_back(read_source(text, name).value());
  }
  return AtPrompt(check(join_files(std::move(files)).parsed, cpu224(), default_times(cpu224())).program);
}

TEST(SeveralFiles, AStopNamesTheFileOfItsLine) {
  AtPrompt session = session_of_two_files();
  const std::string set = session("break sub.awl:6");
  EXPECT_TRUE(has(set, "in SBR 0 pumps/sub.awl:6: MOVB    1, VB0")) << set;
  const std::string stopped = session("continue");
  EXPECT_TRUE(has(stopped, " > pumps/sub.awl:6  MOVB    1, VB0\n")) << stopped;
  EXPECT_TRUE(has(session("break"), "SBR 0 pumps/sub.awl:6: MOVB")) << session.out.str();
  EXPECT_TRUE(has(session("status"), "*> pumps/sub.awl:6 MOVB    1, VB0")) << session.out.str();
  EXPECT_TRUE(has(session("regs"), "SBR 0 pumps/sub.awl:6, called in main line 5")) << session.out.str();
}

TEST(SeveralFiles, ALineIsNamedWithItsFileWithOrWithoutTheFolder) {
  AtPrompt session = session_of_two_files();
  for (const char* const name : {"sub.awl:5", "pumps/sub.awl:5", "SUB.AWL:5"})
    EXPECT_TRUE(has(session(fmt::format("list {}", name)), " pumps/sub.awl:5  LD      SM0.0\n")) << name;
  EXPECT_TRUE(has(session("list main.awl:5"), "     5  CALL ")) << session.out.str();
  EXPECT_TRUE(has(session("list 5"), "     5  CALL "));
  EXPECT_TRUE(has(session("break sub.awl:3"), "pumps/sub.awl:3 has no instruction; the next one is in pumps/sub.awl:5\n"))
      << session.out.str();
}

TEST(SeveralFiles, ALineWithoutAFileIsOneOfTheFirstFile) {
  AtPrompt session = session_of_two_files();
  constexpr const char* kLast =
      "the last instruction of pumps/main.awl is in line 6; write for example pumps/sub.awl:1 for a line of another file";
  for (const char* const command : {"break 9", "list 9", "status 12", "until 9"})
    EXPECT_TRUE(has(session.error_of(command), kLast)) << session.error_of(command);
  EXPECT_TRUE(has(session.error_of("break sub.awl:9"), "the last instruction of pumps/sub.awl is in line 7"));
  EXPECT_TRUE(has(session.error_of("break sup.awl:7"), "expects a line number"));
}

TEST(SeveralFiles, AMessageOfAStopHasTheNumberInTheFile) {
  AtPrompt session = session_of_two_files();
  EXPECT_TRUE(has(session("break sub.awl:6 log 'at {line}'; continue 1ms"), "at pumps/sub.awl:6\n")) << session.out.str();
}

TEST(SeveralFiles, WhoNamesTheDataBlockOfWhatNothingHasWritten) {
  std::vector<SourceText> files;
  files.push_back(read_source("LD SM0.0\nMOVW VW300, VW0\nMEND\n", "names.awl").value());
  files.push_back(read_source("VB290 'JOHANNISBEERE'\nVW312 12\n", "data.txt").value());
  AtPrompt session(check(join_files(std::move(files)).parsed, cpu224(), default_times(cpu224())).program);
  session("continue 10ms");
  EXPECT_TRUE(has(session("who VW300"), "it is 16#4552 (17746); the data block sets VB290 to VB302")) << session.out.str();
  EXPECT_FALSE(has(session("who VW304"), "data block")) << session.out.str();
}

}  // namespace
}  // namespace s7200::tools::several_files_test
