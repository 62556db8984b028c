// The change to STOP: when it comes, and what the clock does.
#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/bytes.hpp"
#include "serial_sim/system/simulation.hpp"

namespace s7200::cpu_stop_test {
namespace {

std::shared_ptr<const Program> program_of(std::string_view text) {
  return check_text(text, "stop.stl", cpu214(), default_times(cpu214())).program;
}

TEST(CpuStop, RunEndsWhenTheProgramStopsNotAtItsLimit) {
  serial::Simulation simulation(program_of("LD SM0.1\nSTOP\nMEND\n"));
  simulation.power_up();
  EXPECT_EQ(simulation.run_until(kSecond), serial::Halt::Stopped);
  EXPECT_LT(simulation.time(), 2 * kMillisecond);
}

TEST(CpuStop, StopInAnInterruptRoutineCompletesTheScanAndTheClockGoesOn) {
  serial::Simulation simulation(program_of("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\nINT 0\nSTOP\nRETI\n"));
  simulation.power_up();
  EXPECT_EQ(simulation.run_until(kSecond), serial::Halt::Stopped);
  EXPECT_GT(simulation.time(), 5 * kMillisecond);
  EXPECT_LT(simulation.time(), 8 * kMillisecond);
}

TEST(CpuStop, ARunThatPausesAtErrorsEndsAfterTheInstructionAndGoesOnWhenItIsRunAgain) {
  serial::Simulation simulation(program_of("LD SM0.0\nMOVD 16#7F000000, VD100\nMOVD 0, *VD100\nINCW VW0\nMEND\n"));
  simulation.power_up();
  simulation.cpu().pause_at_error(true);
  const auto count = [&] { return load16(&simulation.cpu().state().image[image::kV]); };
  for (std::uint16_t scan = 0; scan < 3; ++scan) {
    EXPECT_EQ(simulation.run_until(kSecond), serial::Halt::Paused);
    EXPECT_EQ(simulation.cpu().state().error_count, scan + 1u);
    EXPECT_EQ(count(), scan);
  }
  simulation.cpu().pause_at_error(false);
  EXPECT_EQ(simulation.run_until(kSecond), serial::Halt::Time);
}

}  // namespace
}  // namespace s7200::cpu_stop_test
