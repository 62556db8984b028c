#include "interpreter/base/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace s7200::result_test {
namespace {

Result<int> half(int number) {
  if (number % 2 != 0) return trouble("{} is odd", number);
  return number / 2;
}

Result<std::string> quarter(int number) {
  const auto read = half(number);
  if (!read) return trouble("of {}: {}", number, read.why());
  const auto again = half(*read);
  if (!again) return again.trouble();
  return std::to_string(*again);
}

TEST(Result, HasAValueOrSaysWhyNot) {
  EXPECT_EQ(half(4), 2);
  EXPECT_EQ(half(4).why(), "");
  EXPECT_FALSE(half(3));
  EXPECT_EQ(half(3).why(), "3 is odd");
  EXPECT_EQ(half(3).value_or(7), 7);
  EXPECT_EQ(half(3).if_any(), std::nullopt);
  EXPECT_FALSE(half(3) == 0);
}

TEST(Result, ATroubleGoesOnByItselfOrWithWhereItWas) {
  EXPECT_EQ(quarter(8), "2");
  EXPECT_EQ(quarter(6).why(), "3 is odd");
  EXPECT_EQ(quarter(5).why(), "of 5: 5 is odd");
  EXPECT_EQ(half(6).and_then(half).why(), "3 is odd");
  EXPECT_EQ(half(8).and_then(half), 2);
  EXPECT_EQ(half(5).and_then(quarter).why(), "5 is odd");
}

TEST(Result, WithoutAValueThereMayBeNothingToSay) {
  const Result<int> none = std::nullopt;
  EXPECT_FALSE(none);
  EXPECT_EQ(none.why(), "");
  EXPECT_FALSE(Result<>(Trouble{}));
}

TEST(Result, AValueMovesOutOfIt) {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(5);
  const std::unique_ptr<int> taken = *std::move(made);
  EXPECT_EQ(*taken, 5);
}

TEST(Result, OfWhatLivesElsewhereIsThatItself) {
  int number = 5;
  const Result<int&> found = number;
  *found = 6;
  EXPECT_EQ(number, 6);
  EXPECT_EQ(Result<int&>(Trouble{"nowhere"}).why(), "nowhere");
}

TEST(Result, EndsWithTheFirstTroubleOfSeveralCalls) {
  std::vector<int> done, numbers{1, 2, 3};
  const auto until = [&](int last) {
    done.clear();
    return with_each(numbers, [&](int number) {
      if (number > last) return Result<>(trouble("{} is too much", number));
      done.push_back(number);
      return Result<>();
    });
  };
  EXPECT_EQ(until(1).why(), "2 is too much");
  EXPECT_EQ(done, std::vector<int>{1});
  EXPECT_TRUE(until(3).and_then([&] { return until(2); }).why() == "3 is too much");
  EXPECT_EQ(until(0).and_then([&] { return until(3); }).why(), "1 is too much");
  EXPECT_TRUE(done.empty());
}

}  // namespace
}  // namespace s7200::result_test
