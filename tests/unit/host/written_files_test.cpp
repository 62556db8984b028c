// Files that the command writes: what may be replaced, and that they are whole or absent.
#include "tools/host/files/written_files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tools/host/files/record_file.hpp"

namespace s7200::tools::written_files_test {
namespace {

namespace fs = std::filesystem;

const FileKind kNote{"a note", "# a note\n"};
const FileKind kList{"a list", "# a list\n"};

/// Each test in a folder of its own.
class WrittenFilesTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(mkdtemp(folder_.data())); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  std::string content(const std::string& name) const {
    std::ifstream in(file(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& name, std::string_view content) const { std::ofstream(file(name)) << content; }
  std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  /// What is said when `name` is claimed by a command that has claimed nothing else; empty if it may be written.
  static std::string refusal(const std::string& path, const FileKind& kind = kNote, Replace replace = Replace::Own) {
    WrittenFiles files;
    return refusal(files, "--note", path, kind, replace);
  }
  static std::string refusal(WrittenFiles& files, std::string_view option, const std::string& path,
                             const FileKind& kind = kNote, Replace replace = Replace::Own) {
    const auto claimed = files.claim(option, path, kind, replace);
    EXPECT_EQ(claimed.has_value(), claimed.why().empty());
    return claimed.why();
  }
  static Destination claimed(const std::string& path, const FileKind& kind = kNote, Replace replace = Replace::Own) {
    WrittenFiles files;
    return files.claim("--note", path, kind, replace).value();
  }

  std::string folder_ = (fs::temp_directory_path() / "s7200-files-XXXXXX").string();
};

bool says(const std::string& message, std::string_view part) { return message.find(part) != std::string::npos; }

TEST_F(WrittenFilesTest, OnlyWhatIsNotThereOrHasTheMarkMayBeWritten) {
  put("own", "# a note\nmore\n");
  put("other", "# a list\n");
  put("cut", "# a no");
  EXPECT_EQ(refusal(file("new")), "");
  EXPECT_EQ(refusal(file("own")), "");
  for (const char* foreign : {"other", "cut"})
    EXPECT_TRUE(says(refusal(file(foreign)), "not a note; it is left alone")) << foreign;
  EXPECT_TRUE(refusal(file("own"), kNote, Replace::Never).ends_with("own exists")) << "the caller says how to overwrite it";
  EXPECT_EQ(refusal(file("other"), kNote, Replace::Judged), "");
  EXPECT_TRUE(says(refusal(folder_), "it is a folder"));
  EXPECT_TRUE(says(refusal(file("nowhere/new")), "there is no folder " + file("nowhere")));
}

TEST_F(WrittenFilesTest, AnEmptyFileHoldsNothingAndIsReplacedUnlessItHasBeenFilledMeanwhile) {
  for (const Replace replace : {Replace::Own, Replace::Never, Replace::Judged}) {
    put("empty", "");
    const Destination there = claimed(file("empty"), kNote, replace);
    EXPECT_EQ(write_result(there, "# a note\n").why(), "");
    EXPECT_EQ(content("empty"), "# a note\n");
  }
  put("empty", "");
  const Destination there = claimed(file("empty"));
  put("empty", "mine\n");
  EXPECT_FALSE(write_result(there, "# a note\n"));
  EXPECT_EQ(content("empty"), "mine\n");
}

TEST_F(WrittenFilesTest, LinksAreNotFollowedWhereverTheyLead) {
  put("own", "# a note\n");
  fs::create_symlink(file("own"), file("to_own"));
  fs::create_symlink(file("nowhere"), file("dangling"));
  fs::create_symlink(folder_, file("to_folder"));
  for (const char* link : {"to_own", "dangling", "to_folder"})
    for (const Replace replace : {Replace::Own, Replace::Never, Replace::Judged})
      EXPECT_TRUE(says(refusal(file(link), kNote, replace), "is a link; it is left alone")) << link;
  EXPECT_EQ(refusal(file("to_folder/new")), "") << "a folder may be reached by one";
}

TEST_F(WrittenFilesTest, RecordsMayGoToPipesAndDevicesResultsMayNot) {
  ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/null", file("to_null"));
  const FileKind record{"a record", "# a record\n", true};
  for (const std::string& path : {file("pipe"), std::string("/dev/null"), file("to_null")}) {
    EXPECT_EQ(refusal(path, record), "") << path;
    EXPECT_TRUE(says(refusal(path, kNote, Replace::Judged), "it is a device or a pipe, not a file")) << path;
  }
}

TEST_F(WrittenFilesTest, TwoOutputsNeverShareAFileUnderWhateverNames) {
  put("own", "# a note\n");
  fs::create_hard_link(file("own"), file("hard"));
  fs::create_directory(file("sub"));
  fs::create_symlink(folder_, file("to_folder"));
  const std::pair<const char*, const char*> kPairs[] = {
      {"new", "new"}, {"new", "sub/../new"},    {"new", "./new"},        {"own", "hard"},
      {"own", "own"}, {"new", "to_folder/new"}, {"to_folder/new", "new"}};
  for (const auto& [one, other] : kPairs) {
    WrittenFiles files;
    EXPECT_EQ(refusal(files, "--one", file(one)), "");
    EXPECT_TRUE(says(refusal(files, "--other", file(other)), "this file is named twice; --one has it already"))
        << one << " and " << other;
    EXPECT_EQ(refusal(files, "--third", file("third")), "");
  }
  WrittenFiles files;
  const FileKind record{"a record", "# a record\n", true};
  for (const char* option : {"--one", "--other"}) EXPECT_EQ(refusal(files, option, "/dev/null", record), "");
}

TEST_F(WrittenFilesTest, NoOutputIsAFileThatTheCommandReadsOrALinkThatItMakes) {
  put("read", "# a note\n");
  fs::create_hard_link(file("read"), file("hard"));
  WrittenFiles files;
  files.reads(file("read"));
  files.links("--pty", file("plc"));
  for (const char* name : {"read", "hard"})
    EXPECT_TRUE(says(refusal(files, "--note", file(name)), "the command reads this file")) << name;
  EXPECT_TRUE(says(refusal(files, "--note", file("plc")), "--pty has it already"));
}

TEST_F(WrittenFilesTest, AResultReplacesTheWholeFileKeepsItsRightsAndLeavesNothingBehind) {
  ASSERT_EQ(write_result(claimed(file("m")), "# a note\nfirst, and it is long\n").why(), "");
  constexpr auto kOwner = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(file("m"), kOwner);
  ASSERT_EQ(write_result(claimed(file("m")), "# a note\n2nd").why(), "");
  EXPECT_EQ(content("m"), "# a note\n2nd");
  EXPECT_EQ(fs::status(file("m")).permissions(), kOwner);
  EXPECT_EQ(count(), 1);
}

TEST_F(WrittenFilesTest, AnotherNameOfAFileThatIsReplacedKeepsWhatItHad) {
  put("m", "# a note\nfirst");
  fs::create_hard_link(file("m"), file("kept"));
  ASSERT_EQ(write_result(claimed(file("m")), "# a note\n2nd").why(), "");
  EXPECT_EQ(content("kept"), "# a note\nfirst");
}

TEST_F(WrittenFilesTest, WhatHasComeMeanwhileIsLeftAloneUnlessItHasTheMark) {
  const auto written_after = [&](auto happens) {
    const Destination destination = claimed(file("m"));
    happens();
    const auto written = write_result(destination, "# a note\nours");
    EXPECT_EQ(written.why().empty(), bool(written));
    return bool(written);
  };
  const std::string beside = fmt::format("m.{}", ::getpid());
  EXPECT_FALSE(written_after([&] { put("m", "theirs"); }));
  EXPECT_EQ(content("m"), "theirs");
  EXPECT_EQ(content(beside + ".new"), "# a note\nours") << "it is not lost";
  fs::remove(file("m"));
  EXPECT_FALSE(written_after([&] { fs::create_symlink(file("new"), file("m")); }));
  EXPECT_FALSE(fs::exists(file("new"))) << "the link, and not what it leads to";
  EXPECT_EQ(content(beside + ".2.new"), "# a note\nours");
  EXPECT_EQ(count(), 3);
  fs::remove(file("m"));
  EXPECT_TRUE(written_after([&] { put("m", "# a note\nby another run"); }));
  EXPECT_EQ(content("m"), "# a note\nours");
  EXPECT_TRUE(written_after([&] { fs::remove(file("m")); }));
  EXPECT_EQ(content("m"), "# a note\nours");
}

TEST_F(WrittenFilesTest, WhatTheCallerHasReadIsReplacedWithoutAMark) {
  put("m", "{compact}");
  ASSERT_EQ(write_result(claimed(file("m"), kNote, Replace::Judged), "# a note\n").why(), "");
  EXPECT_EQ(content("m"), "# a note\n");
}

TEST_F(WrittenFilesTest, ARecordHasItsNameFromItsFirstLineOnAndGrowsUnderIt) {
  put("r", "# a list\nof before\n");
  WrittenFiles files;
  RecordFile record;
  ASSERT_EQ(record.claim(files, "--list", file("r"), kList).why(), "");
  const auto out = record.open();
  ASSERT_TRUE(out);
  EXPECT_EQ(content("r"), "# a list\nof before\n");
  *out << kList.beginning;
  ASSERT_TRUE(record.put());
  EXPECT_EQ(content("r"), "# a list\n");
  *out << "one\n" << std::flush;
  EXPECT_EQ(content("r"), "# a list\none\n");
  *out << "two\n";
  EXPECT_TRUE(record.close());
  EXPECT_EQ(content("r"), "# a list\none\ntwo\n");
  EXPECT_EQ(count(), 1);
}

TEST_F(WrittenFilesTest, ARecordThatIsNotBegunLeavesNothing) {
  {
    WrittenFiles files;
    RecordFile record;
    ASSERT_EQ(record.claim(files, "--list", file("r"), kList).why(), "");
    ASSERT_TRUE(record.open());
  }
  EXPECT_EQ(count(), 0);
}

}  // namespace
}  // namespace s7200::tools::written_files_test
