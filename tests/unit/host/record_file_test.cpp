// A record of a run is looked at while it grows.
#include "tools/host/files/record_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace s7200::tools::record_file_test {
namespace {

class RecordFiles : public testing::Test {
 protected:
  RecordFiles() { std::filesystem::create_directory(folder_); }
  ~RecordFiles() override { std::filesystem::remove_all(folder_); }

  std::ostream& open() {
    EXPECT_EQ(file_.claim(files_, "--trace", path(), {"a trace", "# "}).why(), "");
    const auto out = file_.open();
    EXPECT_TRUE(out) << out.why();
    EXPECT_EQ(file_.put().why(), "");
    return *out;
  }
  std::string path() const { return (folder_ / "trace.txt").string(); }
  std::string content() const {
    std::ifstream in(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / ("s7200_record_" + std::to_string(getpid()));
  WrittenFiles files_;
  RecordFile file_;
};

TEST_F(RecordFiles, GrowByWholeLines) {
  std::ostream& out = open();
  std::string all;
  for (int i = 0; i < 20'000; ++i) {
    const std::string line = "line " + std::to_string(i * i) + '\n';
    out.write(line.data(), static_cast<std::streamsize>(line.size()));
    all += line;
    if (i % 1000 != 0) continue;
    const std::string now = content();
    EXPECT_TRUE(now.empty() || now.back() == '\n') << i;
    EXPECT_TRUE(all.starts_with(now)) << i;
  }
  EXPECT_GT(content().size(), 200'000U) << "most of it is there before the end";
  EXPECT_EQ(file_.close().why(), "");
  EXPECT_EQ(content(), all);
}

TEST_F(RecordFiles, EndWithAWholeLineWhereTheirLimitIs) {
  files_.limit_records(100'000);
  std::ostream& out = open();
  for (int i = 0; i < 20'000; ++i) out << "line " << i << '\n';
  ASSERT_TRUE(file_.size());
  EXPECT_TRUE(file_.size()->full);
  std::string why = file_.close().why();
  EXPECT_EQ(why, path() + " has reached 100 KB and ends there; --record-limit lets records grow further");
  EXPECT_LE(content().size(), 100'000U);
  EXPECT_GT(content().size(), 99'900U);
  EXPECT_EQ(content().back(), '\n');
}

TEST(Sizes, AreReadAndWritten) {
  EXPECT_EQ(parse_size("500MB"), 500'000'000U);
  EXPECT_EQ(parse_size(" 1.5 gb "), 1'500'000'000U);
  EXPECT_EQ(parse_size("7B"), 7U);
  EXPECT_EQ(parse_size("none"), UINT64_MAX);
  for (const char* const wrong : {"", "500", "MB", "-1MB", "0MB", "1e9GB", "nanGB"})
    EXPECT_FALSE(parse_size(wrong)) << wrong;
  EXPECT_EQ(size_text(1e9), "1 GB");
  EXPECT_EQ(size_text(1.34e12), "1.3 TB");
  EXPECT_EQ(size_text(560'400), "560 KB");
  EXPECT_EQ(size_text(12), "12 B");
}

TEST_F(RecordFiles, WithoutLineEndsGrowAllTheSame) {
  std::ostream& out = open();
  out << std::string(200'000, 'x');
  EXPECT_GT(content().size(), 100'000U);
  EXPECT_EQ(file_.close().why(), "");
  EXPECT_EQ(content(), std::string(200'000, 'x'));
}

}  // namespace
}  // namespace s7200::tools::record_file_test
