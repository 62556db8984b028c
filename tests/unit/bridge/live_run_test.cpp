// How often a run in real time looks round. Turns are counted, not times: a busy computer makes fewer.
#include "tools/bridge/live_run.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"

namespace s7200::tools::live_run_test {
namespace {

/// Has nothing on its other side.
class Turns final : public Bridge {
 public:
  Result<> start(LiveLine&, boost::asio::io_context&) override { return {}; }
  void stop() override {}
  SerialFormat receive_format() const override { return {}; }
  void received(std::span<const ReceivedCharacter>) override {}
  void turn() override { ++count; }
  std::string summary() const override { return {}; }
  nlohmann::ordered_json json() const override { return {}; }

  int count = 0;
};

/// In half a second of its program.
int turns_of(std::string_view program) {
  serial::Simulation simulation(check_text(program, "test", cpu214(), default_times(cpu214())).program);
  simulation.power_up();
  Turns bridge;
  LiveRun live(simulation, {}, &bridge);
  EXPECT_EQ(live.start().why(), "");
  live.run_until(kSecond / 2);
  return bridge.count;
}

constexpr std::string_view kWaiting = "LD SM0.1\nMOVB 9, SMB30\nLD I0.0\n= Q0.0\nMEND\n";

TEST(LiveRun, OfAProgramThatWaitsLooksRoundAHundredTimesASecond) { EXPECT_LT(turns_of(kWaiting), 75); }

TEST(LiveRun, LooksRoundWhenTheProgramMayDoSomethingByItself) {
  EXPECT_GT(turns_of("LD SM0.0\nINCW VW0\nMEND\n"), 75) << "scans of which none is like the one before";
}

TEST(LiveRun, OfAProgramThatLooksAtTheClockWaitsUntilItChanges) { EXPECT_LT(turns_of("LD SM0.5\n= Q0.0\nMEND\n"), 75); }

/// Fails at once, and must not be asked any more from then on.
class Failing final : public Bridge {
 public:
  Result<> start(LiveLine&, boost::asio::io_context&) override { return {}; }
  void stop() override { ++stopped; }
  SerialFormat receive_format() const override { return asked(), SerialFormat{}; }
  void received(std::span<const ReceivedCharacter>) override { asked(); }
  void turn() override { asked(); }
  std::string failure() const override { return "it was hung up"; }
  std::string summary() const override { return {}; }
  nlohmann::ordered_json json() const override { return {}; }

  int stopped = 0;

 private:
  void asked() const { EXPECT_EQ(stopped, 0); }
};

TEST(LiveRun, ABridgeThatFailsEndsTheRunAndTheNextOneGoesOnWithoutIt) {
  serial::Simulation simulation(check_text(kWaiting, "test", cpu214(), default_times(cpu214())).program);
  simulation.power_up();
  Failing bridge;
  LiveRun live(simulation, {}, &bridge);
  ASSERT_EQ(live.start().why(), "");
  EXPECT_EQ(live.run_until(kSecond / 2), serial::Halt::Request);
  EXPECT_EQ(live.take_failure(), "it was hung up");
  EXPECT_EQ(live.take_failure(), "") << "said once";
  EXPECT_EQ(live.failure(), "it was hung up");
  EXPECT_EQ(live.run_until(kSecond / 2), serial::Halt::Time);
}

}  // namespace
}  // namespace s7200::tools::live_run_test
