// So many exchanges of our slave, and 100 ms of scans after each, with nobody looking: always the same work, to be counted
// in instructions of the host.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"

int main(int argc, char** argv) {
  using namespace s7200;
  const int exchanges = argc > 1 ? std::atoi(argv[1]) : 0;
  const std::string text = tools::read_file(test::source_path("stl_programs/modbus_slave.stl")).value();
  serial::Simulation simulation(check_text(text, "modbus_slave.stl", cpu214(), default_times(cpu214())).program);
  simulation.cpu().use_steady_scans(SteadyScansUse::Off);
  simulation.power_up();
  simulation.run_until(kSecond);
  simulation.configure_master(simulation.port_format());
  const auto frame = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 10)));
  int answered = 0;
  for (int i = 0; i < exchanges; ++i) {
    simulation.master().start({.frame = frame}, simulation.time());
    answered += !simulation.finish_exchange().response.empty();
    simulation.run_until(simulation.time() + 100 * kMillisecond);
  }
  std::printf("%d of %d answered\n", answered, exchanges);
  return answered == exchanges ? EXIT_SUCCESS : EXIT_FAILURE;
}
