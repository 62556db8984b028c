// How the command ends.
#pragma once

namespace s7200::tools {

enum ExitCode : int {
  kFine = 0,
  kCheckFailed = 1,  ///< STL has errors, a test failed, no answer came
  kUnusable = 2,     ///< wrong usage, unreadable or unsupported input
  kCpuFatal = 3,     ///< the simulated CPU went to STOP on a fatal error
};

}  // namespace s7200::tools
