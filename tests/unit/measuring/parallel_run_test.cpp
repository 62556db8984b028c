// Pieces of work done several at a time.
#include "tools/measuring/parallel_run.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::parallel_run_test {
namespace {

TEST(ParallelRun, SaysHowFarItIsThoughEachPieceIsQuick) {
  using namespace std::chrono_literals;
  ParallelRun<std::size_t> run(150, 1, [](std::size_t i) {
    std::this_thread::sleep_for(4ms);
    return i;
  });
  std::vector<std::size_t> results, said;
  run.each(
      [&](std::size_t, std::size_t result) {
        results.push_back(result);
        return true;
      },
      [&](std::size_t done) { said.push_back(done); });
  EXPECT_EQ(results.size(), 150U);
  EXPECT_TRUE(std::ranges::is_sorted(results));
  EXPECT_GE(said.size(), 2U) << "of 600 ms or more";
  EXPECT_TRUE(std::ranges::is_sorted(said));
}

}  // namespace
}  // namespace s7200::tools::parallel_run_test
