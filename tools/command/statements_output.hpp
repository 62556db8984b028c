// What is known of real CPUs, and whether it holds with a table of times: for people, and for machines.
#pragma once

#include <string>

#include "interpreter/model/cpu_model.hpp"

namespace s7200::tools {

/// Checks a table, a name or a file, and prints what came of it. `tip41_path`: the document of Application Tip 41, or empty.
/// The exit code.
int check_table(const CpuModel& model, const std::string& table, const std::string& tip41_path, bool json);

}  // namespace s7200::tools
