// How the other end of the line is set, and how a master on it talks, on the command line.
#pragma once

#include <string>

#include "serial_sim/peers/requester.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// --baud, --parity, --data-bits, --stop-bits. `otherwise`: what holds where nothing is given, for the help.
void add_line_options(CLI::App& app, serial::LineSettings& line,
                      const std::string& otherwise = "as the program set its port");

/// The same, --timeout and --gap.
void add_master_options(CLI::App& app, serial::MasterSettings& master);

}  // namespace s7200::tools
