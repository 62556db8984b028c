// How scenarios went, for --report.
#pragma once

#include <optional>
#include <vector>

#include "tools/command/options/test_options.hpp"
#include "tools/scenario/report.hpp"

namespace s7200::tools {

/// In the order of the reports. One of a system, or with a band of execution times, is without its run.
std::vector<ReportedRun> reported_runs(const std::vector<Report>& reports);

/// Writes the report and the JUnit file that are wanted; that leads to the report. False after a message.
bool write_reports(const TestOptions& options, const std::optional<Destination>& junit, const std::vector<Report>& reports);

}  // namespace s7200::tools
