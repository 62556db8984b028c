#include "tools/command/testing/test_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <variant>

#include "tools/command/reports/reported_system.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/scenario/reporting/junit.hpp"

namespace s7200::tools {
namespace {

std::string outcome_of(const Report& report) {
  switch (report.result.outcome) {
    case ScenarioResult::Outcome::Passed:
      return "passed";
    case ScenarioResult::Outcome::Failed:
      return "failed";
    case ScenarioResult::Outcome::Skipped:
      return "skipped";
    case ScenarioResult::Outcome::ExpectedFailure:
      break;
  }
  return "expected failure";
}

ReportedFinding reported_finding(const Scenario& scenario, const Finding& finding) {
  ReportedFinding reported{
      .text = finding_line(scenario, finding), .why = finding.why, .line = position_of(scenario, finding).line};
  if (!finding.place) return reported;
  reported.power_up = finding.place->power_up;
  reported.at = finding.place->moment.time;
  return reported;
}

/// An event of a system is words in a recording.
bool can_be_carried(const std::vector<Recording>& recordings) {
  return std::ranges::none_of(recordings, [](const Recording& recording) {
    return std::ranges::any_of(recording.actions,
                               [](const Action& one) { return std::holds_alternative<SystemEvent>(one); });
  });
}

ReportedRun reported(const Report& report) {
  const Scenario& scenario = *report.scenario;
  const ScenarioResult& result = report.result;
  ReportedRun run{
      .file = scenario.source->name, .name = scenario.name, .outcome = outcome_of(report), .reason = result.reason};
  for (const Finding& finding : result.findings) run.findings.push_back(reported_finding(scenario, finding));
  if (result.band)
    for (const Finding& finding : result.band->findings) {
      run.findings.push_back(reported_finding(scenario, finding));
      run.findings.back().text += fmt::format("; with {}", result.band->failed_with);
    }
  std::string why;
  if (scenario.plan && !result.recordings.empty() && can_be_carried(result.recordings))
    run.system = reported_system(scenario.system, *scenario.plan, result.spots, why);
  if (run.system) run.recordings = result.recordings;
  if (!result.program) return run;
  run.program = result.program;
  run.around = {.port = scenario.port, .plc = scenario.plc, .field = scenario.field, .faults = {}, .kept = {}};
  run.repairs = parse_repairs(scenario.repair.empty() ? "none" : scenario.repair, why);
  run.recordings = result.recordings;
  return run;
}

}  // namespace

std::vector<ReportedRun> reported_runs(const std::vector<Report>& reports) {
  std::vector<ReportedRun> runs;
  for (const Report& report : reports) runs.push_back(reported(report));
  return runs;
}

bool write_reports(const TestOptions& options, const std::optional<Destination>& junit, const std::vector<Report>& reports) {
  std::function<std::string(std::size_t)> link{};
  if (options.report.wanted()) link = [&](std::size_t number) { return link_to_run(options.report.path(), number); };
  const bool junit_written = !junit || write_result(junit, to_junit(reports, link));
  return options.report.write("test", reported_runs(reports)) && junit_written;
}

bool show_profile(const TestOptions& options, const SuiteResult& result) {
  if (!options.profile.wanted()) return true;
  std::vector<ProfiledRun> runs;
  for (const Report& report : result.reports) runs.push_back({report.scenario->name, &report.result.profile});
  return options.profile.show(result.profile, options.json, runs);
}

}  // namespace s7200::tools
