// The slave that a program is: when a master may begin.
#include "tools/slave/simulated_slave.hpp"

#include <gtest/gtest.h>

#include "serial_sim/peers/quiet_time.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::tools::simulated_slave_test {
namespace {

std::vector<test::RateSetting> every_rate() {
  std::vector<test::RateSetting> rates(test::kRateSettings.begin(), test::kRateSettings.end());
  rates.push_back(test::k38400);
  return rates;
}

serial::Request read_register_0() {
  return {.frame = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 1)))};
}

TEST(SimulatedSlave, AnswersTheFirstRequestAtEveryRate) {
  for (const test::RateSetting& rate : every_rate()) {
    serial::Simulation simulation(test::compile(test::at_rate(test::slave_text(), rate)));
    simulation.power_up();
    SimulatedSlave slave(simulation, {}, "slave");
    ASSERT_TRUE(slave.wait_until_ready(kNever)) << rate.baud;
    EXPECT_EQ(simulation.cpu().state().port[0].format.baud, rate.baud);
    EXPECT_TRUE(modbus::crc_ok(slave.exchange(read_register_0()).response_bytes())) << rate.baud;
  }
}

/// Freeport mode at 300 baud only after 15 ms, when a master that thinks of 9600 baud would begin 3 ms later.
TEST(SimulatedSlave, IsReadyAfterTheSilenceOfTheRateThatIsSetByThen) {
  serial::Simulation simulation(
      test::compile("LD SM0.0\nTON T32, +15\nLD T32\nEU\nMOVB 16#5D, SMB30\nLD I0.0\nXMT VB0, 0\nMEND\n"));
  simulation.power_up();
  SimulatedSlave slave(simulation, {}, "slave");
  ASSERT_TRUE(slave.wait_until_ready(kNever));
  EXPECT_EQ(slave.pause(), serial::default_quiet({300, 8, Parity::Even, 1}));
  EXPECT_GE(simulation.time(), slave.pause());
}

TEST(SimulatedSlave, TimePassesInStopButForAFatalError) {
  const auto waited = [](const char* program) {
    serial::Simulation simulation(test::compile(program));
    simulation.power_up();
    SimulatedSlave(simulation, {}, "slave").wait(10 * kSecond);
    return simulation.time() >= 10 * kSecond;
  };
  EXPECT_TRUE(waited("LD SM0.0\nSTOP\nMEND\n"));
  EXPECT_FALSE(waited("LD SM0.0\nLBL 1\nJMP 1\nMEND\n"));
}

TEST(SimulatedSlave, IsReadyInStopOnlyIfSomebodyAnswersThere) {
  for (const bool in_stop_too : {false, true}) {
    serial::Simulation simulation(test::compile("LD SM0.0\nSTOP\nMEND\n"));
    simulation.power_up();
    SimulatedSlave slave(simulation, {}, "slave", in_stop_too);
    EXPECT_EQ(bool(slave.wait_until_ready(3 * kSecond)), in_stop_too);
    EXPECT_EQ(simulation.time() >= 3 * kSecond, in_stop_too);
  }
}

}  // namespace
}  // namespace s7200::tools::simulated_slave_test
