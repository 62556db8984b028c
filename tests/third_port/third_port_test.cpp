// A CPU with three ports, which run.py makes by adding rows: what programs do with the ports of a CPU 226 they do with it.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/system/simulation.hpp"

namespace s7200::serial {
namespace {

CheckResult check(const std::string& text) { return check_text(text, "third.stl", cpu226(), default_times(cpu226())); }

std::string messages(const CheckResult& result) {
  std::string all;
  for (const auto& diagnostic : result.diagnostics) all += stl::render(diagnostic, result.source, false);
  return all;
}

/// A simulation whose line is that of port 2, in RUN for a while.
struct OnPort2 {
  explicit OnPort2(const std::string& text) : checked(check(text)), simulation(checked.program, {}, 2) {
    simulation.power_up();
    simulation.run_until(200 * kMillisecond);
  }

  std::string answer_to(const Bytes& request) {
    simulation.configure_master(simulation.port_format());
    simulation.master().start({.frame = to_frame(request)}, simulation.time());
    return to_hex(simulation.finish_exchange().response_bytes());
  }

  std::uint8_t byte(std::uint32_t at) const { return simulation.cpu().state().image[at]; }

  CheckResult checked;
  Simulation simulation;
};

/// Our Modbus slave, with the control byte, the events and the number of port 2.
std::string slave_on_port2() {
  std::ifstream file(SLAVE);
  std::stringstream text;
  text << file.rdbuf();
  std::string program = std::regex_replace(text.str(), std::regex("SMB30\\b"), "SMB240");
  program = std::regex_replace(program, std::regex("(ATCH +\\d+|DTCH +), ?8\\b"), "$1, 34");
  program = std::regex_replace(program, std::regex("(ATCH +\\d+|DTCH +), ?9\\b"), "$1, 35");
  program = std::regex_replace(program, std::regex("DTCH +8\\b"), "DTCH 34");
  return std::regex_replace(program, std::regex("(XMT +\\w+), 0"), "$1, 2");
}

TEST(ThirdPort, OurModbusSlaveAnswersOnIt) {
  const std::string program = slave_on_port2();
  ASSERT_TRUE(check(program).program) << messages(check(program));
  OnPort2 plc(program);
  const Bytes write = modbus::rtu_frame(1, modbus::write_register(10, 0x1234));
  EXPECT_EQ(plc.answer_to(write), to_hex(write));
  EXPECT_EQ(plc.answer_to(modbus::rtu_frame(1, modbus::read_holding_registers(10, 1))), "01 03 02 12 34 b5 33");
}

TEST(ThirdPort, RcvTakesItsParametersFromItsOwnBytesAndCausesItsEvent) {
  OnPort2 plc(
      "LD SM0.1\nMOVB 9, SMB240\nMOVB 16#90, SMB247\nMOVW 5, SMW250\nMOVB 2, SMB254\nATCH 0, 36\nENI\nRCV VB100, 2\nMEND\n"
      "INT 0\nMOVB 1, VB0\nRETI\n");
  ASSERT_TRUE(plc.checked.program) << messages(plc.checked);
  plc.answer_to({0x41, 0x42});
  plc.simulation.run_until(plc.simulation.time() + 100 * kMillisecond);
  EXPECT_EQ(plc.byte(image::kV), 1);
  EXPECT_EQ(plc.byte(image::kV + 100), 2);
  EXPECT_EQ(plc.byte(image::kV + 101), 0x41);
  EXPECT_EQ(plc.byte(sm::byte(86)), 0) << "port 0 has received nothing";
}

TEST(ThirdPort, ATransmitterThatIsBusyIsItsOwnError) {
  const OnPort2 plc("LD SM0.1\nMOVB 9, SMB240\nMOVB 1, VB100\nXMT VB100, 2\nXMT VB100, 2\nMEND\n");
  EXPECT_NE(plc.byte(sm::kInterruptStatus) & sm::kRuntimeError, 0);
  EXPECT_EQ(plc.simulation.cpu().state().port.size(), 3u);
}

TEST(ThirdPort, APortThatTheCpuHasNotIsRefused) {
  EXPECT_TRUE(check("LD SM0.1\nMOVB 9, SMB240\nXMT VB100, 2\nMEND\n").program);
  EXPECT_FALSE(check("LD SM0.1\nXMT VB100, 3\nMEND\n").program);
}

TEST(ThirdPort, ItsEventsHaveTheirNamesInTraces) {
  EXPECT_EQ(find_event(34)->cause, "port 2: character received");
}

}  // namespace
}  // namespace s7200::serial
