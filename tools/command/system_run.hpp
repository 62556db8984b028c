// `s7200 run` with a system file, or a simulated PLC of another make, instead of a program.
#pragma once

#include <optional>

#include "tools/command/options/run_options.hpp"
#include "tools/plan/system_reader.hpp"

namespace s7200::tools {

/// Runs a system file, or a simulated PLC of another make for whoever asks it over a bridge; prints what came of it, and
/// returns the exit code. Options that such a thing has no use for are refused. Nothing if it is a program that is to run.
std::optional<int> run_without_program(const CLI::App& verb, RunOptions& options);

}  // namespace s7200::tools
