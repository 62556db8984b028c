// How scenarios went, and where their time did, for what the options of reports ask for.
#pragma once

#include <optional>
#include <vector>

#include "tools/command/options/verb/test_options.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/scenario/suite.hpp"

namespace s7200::tools {

/// In the order of the reports. With a band of execution times the run is that of the first table with which it failed.
std::vector<ReportedRun> reported_runs(const std::vector<Report>& reports);

/// Writes the report and the JUnit file that are wanted; that leads to the report. False after a message.
bool write_reports(const TestOptions& options, const std::optional<Destination>& junit, const std::vector<Report>& reports);

/// Prints and writes the profile that is wanted. False after a message.
bool show_profile(const TestOptions& options, const SuiteResult& result);

}  // namespace s7200::tools
