// Slaves on a line with faults. S7200_FAULTED_FRAMES sets how many frames each test sends.
#include "tests/faults/faulted_frames.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "tests/support/slave_bench.hpp"
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

/// What the judge says of a slave with a bug.
Counts judged(std::string_view line, std::string_view instead) {
  const std::string text = test::changed(test::text_of(test::source_path("stl_programs/modbus_slave.stl")), line, instead);
  return run_faulted_frames(program_of(text, "slave with a bug"), 1, 500).counts;
}

TEST(FaultedFramesJudge, FindsASlaveThatTakesCharactersWithParityErrors) {
  EXPECT_GT(judged("LDN     SM3.0                   // no parity error", "LD SM0.0").wrong, 0U);
}

TEST(FaultedFramesJudge, FindsASlaveThatDoesNotLookAtTheCrc) {
  EXPECT_GT(judged("LDW=    AC0, 0                  // nothing must remain", "LD SM0.0").wrong, 0U);
}

TEST(FaultedFramesJudge, FindsASlaveThatExecutesWhatItDoesNotAnswer) {
  EXPECT_GT(judged("CALL    63                      // over data and CRC together", "CALL 63\nINCW VW100\nLD SM0.0").wrong,
            0U);
}

TEST(FaultedFramesJudge, FindsASlaveThatStaysDeafBehindADisturbedFrame) {
  EXPECT_GT(judged("ATCH    120, 10                 // wait for the end of it", "DTCH 10").unanswered, 0U);
}

TEST(FaultedFramesJudge, SeesFaultsOfEveryKindAndEveryClassOfFrame) {
  const Counts counts = run_faulted_frames(load_program(test::source_path("stl_programs/modbus_slave.stl")), 1, 5000).counts;
  for (const serial::FaultKindInfo& kind : serial::fault_kinds())
    if (kind.kind != serial::FaultKind::Answer) {  // which is of no frame that the slave receives
      EXPECT_GT(counts.happened[static_cast<std::size_t>(kind.kind)], 100U) << kind.name;
    }
  for (const std::uint64_t figure :
       {counts.untouched, counts.with_errors, counts.with_wrong_crc, counts.split, counts.answered})
    EXPECT_GT(figure, 100U);
  EXPECT_GT(counts.with_framing_errors_only, 10U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FaultedFrames, testing::Range<std::uint64_t>(1, 5));

}  // namespace
}  // namespace s7200::faults
