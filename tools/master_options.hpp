// How the master on the line talks.
#pragma once

#include <string>

#include "serial_sim/simulation.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

struct MasterOptions {
  std::uint32_t baud = 0;       ///< 0: as the program has set its port
  std::string parity = "port";  ///< port: as the program has set its port
  std::uint32_t data_bits = 0;  ///< 0: as the program has set its port
  std::uint32_t stop_bits = 1;
  Time timeout = kSecond;
  Time gap = 0;

  void add_to(CLI::App& app);

  /// `port` with what the options say instead.
  SerialFormat format_over(SerialFormat port) const;

  /// The same of a program's port; of the default format as long as it has not switched its port to Freeport mode.
  SerialFormat format_for(const serial::Simulation& simulation) const;

  serial::Request request(const modbus::Frame& frame) const { return {.frame = frame, .timeout = timeout, .gap = gap}; }
};

}  // namespace s7200::tools
