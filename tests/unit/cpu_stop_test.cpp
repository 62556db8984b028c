// The change to STOP: when it comes, and what the clock does.
#include <gtest/gtest.h>

#include "interpreter/program/load.hpp"
#include "serial_sim/simulation.hpp"

namespace s7200 {
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

}  // namespace
}  // namespace s7200
