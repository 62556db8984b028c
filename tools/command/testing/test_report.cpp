#include "tools/command/testing/test_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <variant>

#include "interpreter/base/file_path.hpp"
#include "tools/command/options/wanted_file.hpp"
#include "tools/command/reports/reported_system.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/scenario/reporting/junit.hpp"
#include "tools/scenario/reporting/markdown.hpp"

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
  if (scenario.plan && !result.recordings.empty() && can_be_carried(result.recordings))
    run.system = reported_system(scenario.system, *scenario.plan, result.spots).value_or(nullptr);
  if (run.system) run.recordings = result.recordings;
  if (!result.program) return run;
  run.program = result.program;
  run.around = {.port = scenario.port, .plc = scenario.plc, .field = scenario.field, .faults = {}, .kept = {}};
  run.repairs = parse_repairs(scenario.repair.empty() ? "none" : scenario.repair).value_or(Repairs{});
  run.recordings = result.recordings;
  return run;
}

/// The address of a file as a document has it that lies elsewhere: `../page%201.html`.
std::string address_beside(const std::string& path, const std::string& document) {
  const auto whole = [](const std::string& name) { return std::filesystem::absolute(file_path(name)).lexically_normal(); };
  const std::u8string found = whole(path).lexically_proximate(whole(document).parent_path()).generic_u8string();
  std::string address;
  for (const char8_t c : found) {
    const bool plain =
        c >= 0x80 || std::isalnum(c) || std::string_view("/._-").find(static_cast<char>(c)) != std::string_view::npos;
    address += plain ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", static_cast<unsigned>(c));
  }
  return address;
}

}  // namespace

std::vector<ReportedRun> reported_runs(const std::vector<Report>& reports) {
  std::vector<ReportedRun> runs;
  for (const Report& report : reports) runs.push_back(reported(report));
  return runs;
}

bool write_reports(const TestOptions& options, const TestOptions::Destinations& to, const std::vector<Report>& reports) {
  const std::string& page = options.report.path();
  const auto link_to = [&](const std::string& address) -> std::function<std::string(std::size_t)> {
    if (!options.report.wanted()) return {};
    return [address](std::size_t number) { return link_to_run(address, number); };
  };
  bool written = !to.junit || write_wanted(to.junit, to_junit(reports, link_to(page)));
  if (to.markdown) {
    const std::string address = options.report.wanted() ? address_beside(page, to.markdown->path) : "";
    written &= write_wanted(to.markdown, to_markdown(reports, link_to(address)));
  }
  return options.report.write("test", reported_runs(reports)) && written;
}

void write_reports(const TestOptions::Destinations& to, const Messages& messages) {
  if (to.junit) write_wanted(to.junit, to_junit(messages));
  if (to.markdown) write_wanted(to.markdown, to_markdown(messages));
}

bool show_profile(const TestOptions& options, const SuiteResult& result) {
  if (!options.profile.wanted()) return true;
  std::vector<ProfiledRun> runs;
  for (const Report& report : result.reports) runs.push_back({report.scenario->name, &report.result.profile});
  return options.profile.show(result.profile, options.json, runs);
}

}  // namespace s7200::tools
