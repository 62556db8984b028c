// A program of the command line as `s7200 inspect` looks into it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/command/options/tables_by_cpu.hpp"
#include "tools/views/inspection.hpp"

namespace s7200::tools {

/// `about`: addresses, symbols, routines and networks to keep to. Errors of the program are printed, and what they are in is
/// left out. Nothing after messages, if the program or what is asked for is unknown: `exit_code` says how to end.
std::optional<Inspection> inspected(const CpuOptions& options, ProgramFiles& file, const std::vector<std::string>& about,
                                    TablesByCpu& tables, int& exit_code);

}  // namespace s7200::tools
