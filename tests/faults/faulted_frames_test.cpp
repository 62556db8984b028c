// Slaves on a line with faults. S7200_FAULTED_FRAMES sets how many frames each test sends.
#include "tests/faults/faulted_frames.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/source_path.hpp"

namespace s7200::faults {
namespace {

std::uint64_t frames_of_a_test() {
  const char* const wanted = std::getenv("S7200_FAULTED_FRAMES");
  return wanted ? std::stoull(wanted) : S7200_FAULTED_FRAMES;
}

const std::string kTip = test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt");

void expect_no_wrong_answer(const std::string& path, std::uint64_t seed) {
  const Result result = run_faulted_frames(load_program(path), seed, frames_of_a_test());
  for (const std::string& wrong : result.wrong) ADD_FAILURE() << wrong;
  EXPECT_EQ(result.counts.wrong, 0U);
  EXPECT_EQ(result.counts.unanswered, 0U);
  EXPECT_EQ(result.counts.frames, frames_of_a_test());
}

class FaultedFrames : public testing::TestWithParam<std::uint64_t> {};

TEST_P(FaultedFrames, AreAnsweredByOurSlaveAsTheyWereReceived) {
  expect_no_wrong_answer(test::source_path("stl_programs/modbus_slave.stl"), GetParam() * 1'000'000);
}

TEST_P(FaultedFrames, AreAnsweredByTheTipAsTheyWereReceived) {
  if (!std::filesystem::exists(kTip)) GTEST_SKIP() << kTip << " is not there: the document is not part of this project";
  expect_no_wrong_answer(kTip, GetParam() * 1'000'000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FaultedFrames, testing::Range<std::uint64_t>(1, 3));

}  // namespace
}  // namespace s7200::faults
