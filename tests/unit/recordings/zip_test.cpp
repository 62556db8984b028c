// Archives, and what is wrong with damaged ones.
#include "tools/recordings/packets/zip.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::zip_test {
namespace {

// `a.txt` is stored, `b.txt` and `empty` are deflated.
constexpr std::string_view kArchive =
    "504b030414000000000000002158092a7004080000000800000005000000612e7478744c442049302e300a504b03041400000008000000"
    "215887b8c51cde000000a086010005000000622e747874edc6490100200800b04a7820dabf9835786cafc5986be7a9fbc2cccccccccccc"
    "cccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccc"
    "cccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccc"
    "cccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccccc"
    "cccccccccccccccccccccccccccccccccccccccccccc9aed03504b03041400000008000000215800000000020000000000000005000000"
    "656d7074790300504b0102140314000000000000002158092a70040800000008000000050000000000000000000000800100000000612e"
    "747874504b010214031400000008000000215887b8c51cde000000a086010005000000000000000000000080012b000000622e74787450"
    "4b010214031400000008000000215800000000020000000000000005000000000000000000000080012c010000656d707479504b050600"
    "0000000300030099000000510100000000";

std::string archive() {
  std::string bytes;
  for (std::size_t i = 0; i < kArchive.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(kArchive.substr(i, 2)), nullptr, 16));
  return bytes;
}

/// A file of an archive, or what is said of it.
std::string file_in(const std::string& bytes, std::string_view name) {
  std::string text;
  const auto zip = Zip::open(bytes);
  const auto keep = [&](std::string_view piece) { return text += piece, true; };
  if (!zip) return zip.why();
  const auto done = zip->read(name, keep);
  return done ? text : done.why();
}

TEST(Zip, StoredAndDeflatedFilesAreRead) {
  const std::string bytes = archive();
  EXPECT_EQ(file_in(bytes, "a.txt"), "LD I0.0\n");
  const std::string digits = file_in(bytes, "b.txt");
  EXPECT_EQ(digits.size(), 100'000U);
  EXPECT_EQ(digits.substr(99'990), "0123456789");
  EXPECT_EQ(file_in(bytes, "empty"), "");
  EXPECT_EQ(file_in(bytes + "PK", "a.txt"), "LD I0.0\n") << "whatever follows is its comment";
}

TEST(Zip, ADamagedFileIsNamed) {
  std::string bytes = archive();
  bytes[bytes.find("LD I0.0")] = 'X';
  EXPECT_EQ(file_in(bytes, "a.txt"), "'a.txt' in it cannot be read");
  EXPECT_EQ(file_in(bytes, "c.txt"), "'c.txt' in it cannot be read");
}

TEST(Zip, AnyCutAndAnyChangedByteEndsInAMessage) {
  const std::string bytes = archive();
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_EQ(file_in(bytes.substr(0, length), "a.txt"), "the zip cannot be read: it is cut off") << length;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const char* name : {"a.txt", "b.txt"}) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(~changed[i]);
      const std::string result = file_in(changed, name);
      EXPECT_TRUE(result == file_in(bytes, name) || result.find("cannot be read") != std::string::npos) << i << result;
    }
}

TEST(Zip, ReadingEndsWhenNoMoreIsWanted) {
  const std::string bytes = archive();
  std::size_t pieces = 0;
  const auto done = Zip::open(bytes)->read("b.txt", [&](std::string_view) { return ++pieces < 1; });
  EXPECT_FALSE(done);
  EXPECT_EQ(pieces, 1U);
  EXPECT_EQ(done.why(), "");
}

}  // namespace
}  // namespace s7200::tools::zip_test
