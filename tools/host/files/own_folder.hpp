// Where the command itself is, and with it what was installed or built beside it.
#pragma once

#include <string>

namespace s7200::tools {

/// The folder of the program that runs, without links; empty if the system does not say it.
std::string own_folder();

}  // namespace s7200::tools
