// What the check of a program has found.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "interpreter/program/load.hpp"

namespace s7200::tools {

nlohmann::ordered_json to_json(const stl::Diagnostics& diagnostics, const stl::SourceLines& source);

/// `2 errors with 1 cause, 0 warnings`
std::string counted(const stl::Diagnostics& diagnostics);

/// One line: how many errors and warnings, and for which CPUs it is fine.
std::string check_summary(const SourceText& text, const CheckResult& result, const CpuModel& model);

/// Which networks of an export Micro/WIN would leave out because of their errors; empty if there are none.
std::string dropped_networks_note(const CheckResult& result);

/// The same and all diagnostics.
nlohmann::ordered_json check_json(const std::string& path, const SourceText& text, const CheckResult& result,
                                  const CpuModel& model);

}  // namespace s7200::tools
