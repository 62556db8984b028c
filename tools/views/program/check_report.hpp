// The report on the check of a program.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::tools {

nlohmann::ordered_json to_json(const stl::Diagnostics& diagnostics, const stl::SourceLines& source);

/// The numbers of errors and warnings: `2 errors with 1 cause, 0 warnings`
std::string counted(const stl::Diagnostics& diagnostics);

/// The CPUs, other than the one asked for, that a program with errors is fine for.
std::vector<const CpuModel*> fine_for(const SourceText& text, const CheckResult& result, const CpuModel& asked);

/// One line with the numbers of errors and warnings, and the other CPUs for which the program is fine.
std::string check_summary(const SourceText& text, const CheckResult& result, const CpuModel& model,
                          const std::vector<const CpuModel*>& others);

/// The networks of an export that Micro/WIN would leave out because of their errors; empty if there are none, and where the
/// right CPU or the symbol table would help.
std::string dropped_networks_note(const CheckResult& result, const std::vector<const CpuModel*>& others);

/// The summary as above and all diagnostics, as JSON.
nlohmann::ordered_json check_json(const std::string& path, const SourceText& text, const CheckResult& result,
                                  const CpuModel& model, const std::vector<const CpuModel*>& others);

}  // namespace s7200::tools
