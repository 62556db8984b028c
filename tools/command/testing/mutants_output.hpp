// `s7200 test --mutants`: what no scenario notices.
#pragma once

#include "tools/command/options/verb/test_options.hpp"
#include "tools/scenario/suite.hpp"

namespace s7200::tools {

/// Changes the programs of a suite, runs it, and prints what nothing has noticed. Returns the exit code.
int run_mutants(Suite& suite, const TestOptions& options);

}  // namespace s7200::tools
