// What is known of real CPUs, and whether it holds with a table of times: for people, and for machines.
#pragma once

#include <optional>
#include <string>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::tools {

/// The document of Application Tip 41; nothing after a message: it cannot be read, or is another program.
std::optional<SourceText> read_tip41(const std::string& path);

/// Checks a table, a name or a file, and prints what came of it. `tip41_path`: the document of Application Tip 41, or empty.
/// The exit code.
int check_table(const CpuModel& model, const std::string& table, const std::string& tip41_path, bool json);

}  // namespace s7200::tools
