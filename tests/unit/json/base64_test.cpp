#include "tools/json/base64.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::base64_test {
namespace {

TEST(Base64, BytesComeBackAndAreAsTheStandardSays) {
  const std::vector<std::uint8_t> bytes{'f', 'o', 'o', 'b', 'a', 'r'};
  const std::string expected[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};  // RFC 4648, 10
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const std::vector<std::uint8_t> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(to_base64(part), expected[size]);
    EXPECT_EQ(from_base64(expected[size]), part);
  }
  EXPECT_FALSE(from_base64("Zg="));
  EXPECT_FALSE(from_base64("Z?=="));
}

}  // namespace
}  // namespace s7200::tools::base64_test
