// What is sent, and the same with every table of a band of execution times.
#pragma once

#include "tools/command/options/verb/send_options.hpp"

namespace s7200::tools {

/// The exit code.
int run_send_band(SendOptions& options);

}  // namespace s7200::tools
