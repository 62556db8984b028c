// What `s7200 fuzz` does.
#pragma once

#include <string>
#include <vector>

#include "interpreter/base/time.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/verb/trial_options.hpp"

namespace s7200::tools {

struct FuzzOptions {
  CpuOptions cpu;
  std::vector<std::string> files, writes, never;
  TrialBound bound;
  Time answers_within = 2 * kSecond;
  std::string folder;
  bool json = false;
};

/// Returns the exit code: kCheckFailed if anything was found.
int run_fuzz(const FuzzOptions& options);

}  // namespace s7200::tools
