// Loads a program of the package, runs it for a second and says how far it came.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/system/simulation.hpp"

int main() {
  using namespace s7200;
  std::ifstream file(STL_PROGRAMS "/modbus_slave.stl");
  const std::string text{std::istreambuf_iterator(file), {}};
  const CheckResult result = check_text(text, "modbus_slave.stl", cpu214(), default_times(cpu214()));
  if (!result.program) return 1;
  serial::Simulation simulation(result.program);
  simulation.power_up();
  simulation.run_until(kSecond);
  std::printf("%llu instructions\n", static_cast<unsigned long long>(simulation.cpu().state().instructions));
  return simulation.cpu().state().instructions > 0 ? 0 : 1;
}
