// How a master on the line talks.
#pragma once

#include <string>

#include "serial_sim/system/simulation.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// The serial settings of the other end of the line, as far as they are given.
struct LineOptions {
  std::uint32_t baud = 0;       ///< 0: not given
  std::string parity = "port";  ///< port: not given
  std::uint32_t data_bits = 0;  ///< 0: not given
  std::uint32_t stop_bits = 0;  ///< 0: not given

  /// `otherwise`: what holds where nothing is given, for the help.
  void add_to(CLI::App& app, const std::string& otherwise = "as the program set its port");

  /// `port` with what the options say instead.
  SerialFormat format_over(SerialFormat port) const;

  /// The same of a program's port; of the default format as long as it has not switched its port to Freeport mode.
  SerialFormat format_for(const serial::Simulation& simulation) const;
};

struct MasterOptions : LineOptions {
  Time timeout = kSecond;
  Time gap = 0;

  void add_to(CLI::App& app);

  serial::Request request(const modbus::Frame& frame) const { return {.frame = frame, .timeout = timeout, .gap = gap}; }
};

}  // namespace s7200::tools
