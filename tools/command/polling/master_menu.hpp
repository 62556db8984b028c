// `s7200 master TARGET menu`: a screen on a terminal to try a Modbus slave by hand, after the test program in section 4.5 of
// the Westinghouse NLAM-B58 addenda: a key for each function, slave, port, loopbacks, and a continuous test with statistics.
#pragma once

#include <functional>
#include <memory>

#include "tools/command/options/verb/master_options.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// How the slave is reached.
struct MenuTarget {
  /// With another port too; throws SlaveUnreachable.
  std::function<std::unique_ptr<Slave>(const serial::MasterSettings& master)> open;
  /// The format of the line as it is now; nothing where the port belongs to the other end of a connection.
  std::function<std::optional<SerialFormat>(const serial::MasterSettings& master)> format;
  bool over_modbus_tcp = false;
};

/// Until Q or the end of the input. The exit code.
int run_menu(const MasterOptions& options, const MenuTarget& target);

}  // namespace s7200::tools
