// What `s7200 compare` does: two programs as they are written and as they behave.
#pragma once

#include <string>
#include <vector>

#include "tools/command/inspecting/compared_programs.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/verb/trial_options.hpp"

namespace s7200::tools {

struct CompareOptions {
  CpuOptions cpu;
  ComparedFiles files;
  TrialBound bound{.runs = 5000};
  std::vector<std::string> watched;
  std::string write;
  bool structure_alone = false, json = false;
};

/// Returns the exit code.
int run_compare(const CompareOptions& options);

}  // namespace s7200::tools
