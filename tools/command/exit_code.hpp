// How the command ends.
#pragma once

#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

enum ExitCode : int {
  kFine = 0,
  kCheckFailed = 1,  ///< STL has errors, a test failed, no answer came
  kUnusable = 2,     ///< wrong usage, unreadable or unsupported input
  kCpuFatal = 3,     ///< the simulated CPU went to STOP on a fatal error
};

/// How a command ends that has left the CPU like this.
inline ExitCode exit_code_of(const Cpu& cpu) { return cpu.state().fatal_code ? kCpuFatal : kFine; }

}  // namespace s7200::tools
