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

/// Writes the report and the files of JUnit and Markdown that are wanted; those lead to the report. False after a message.
bool write_reports(const TestOptions& options, const TestOptions::Destinations& to, const std::vector<Report>& reports);

/// The same files of what kept scenarios from being run.
void write_reports(const TestOptions::Destinations& to, const Messages& messages);

/// Prints and writes the profile that is wanted. False after a message.
bool show_profile(const TestOptions& options, const SuiteResult& result);

}  // namespace s7200::tools
