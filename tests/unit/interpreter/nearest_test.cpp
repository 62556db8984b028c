// The word that was probably meant.
#include "interpreter/base/text/nearest.hpp"

#include <gtest/gtest.h>

#include <array>

namespace s7200::nearest_test {
namespace {

constexpr std::array<std::string_view, 4> kWords{"check", "run", "send", "master"};

TEST(Nearest, IsTheWordWithTheFewestChangesIfTheyAreFew) {
  EXPECT_EQ(nearest("chek", kWords), "check");
  EXPECT_EQ(nearest("sned", kWords), "send");
  EXPECT_EQ(nearest("rum", kWords), "run");
  EXPECT_EQ(nearest("slave", kWords), "");
  EXPECT_EQ(nearest("rxy", kWords), "");
}

TEST(Nearest, NothingIsSuggestedForASingleLetterOrALongText) {
  EXPECT_EQ(nearest("r", kWords), "");
  EXPECT_EQ(nearest("masterrrrrrrr", kWords), "");
  EXPECT_EQ(nearest("run", {}), "");
}

}  // namespace
}  // namespace s7200::nearest_test
