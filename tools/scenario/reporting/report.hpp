// How scenarios went, for people.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/text/wrapped.hpp"
#include "tools/scenario/result.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

/// A scenario and how it went, on what.
struct Report {
  const Scenario* scenario = nullptr;
  ScenarioResult result{};
};

/// The step that found it; null if the scenario did not come to its steps.
const Step* step_of(const Scenario& scenario, const Finding& finding);

/// Where it is in the file: the step, or else the scenario.
stl::Position position_of(const Scenario& scenario, const Finding& finding);

/// A rule that says should does not fail a suite, unless it passes and that is not expected.
bool counts_as_failed(const Report& report);

std::size_t count(const std::vector<Report>& reports, ScenarioResult::Outcome outcome);

std::string_view severity_text(Rule::Severity severity);

/// `163 of 202 tables, answers after 15.8 … 19.6 ms`
std::string band_text(const BandResult& band);

/// Why it was skipped, or that it failed as was expected.
std::string reason_text(const ScenarioResult& result);

/// `  pass     52.3 ms  reads coils from any bit on`, and below it what was found instead, in lines of `width` characters as
/// far as they are sentences and timelines.
std::string report_text(const Report& report, bool colour, std::size_t width = stl::kUsualWidth);

/// What was found instead, up to `most` findings.
std::string findings_text(const Report& report, bool colour, std::size_t most, std::size_t width = stl::kUsualWidth);

/// `s7200 debug tests/pump.yaml --only 'it starts'`, which opens a scenario that failed at what it found; empty of one that
/// cannot be opened: it is not about one program in simulation.
std::string debug_command(const Report& report);

/// The same of a scenario, whatever became of it.
std::string opening_command(const Scenario& scenario);

/// What was sent, what was expected, what was found, in one line.
std::string finding_line(const Scenario& scenario, const Finding& finding);

/// `12 scenarios: 11 passed, 1 failed`
std::string summary_text(const std::vector<Report>& reports);

/// A line for each rule of a conformance suite, what was seen where one is broken, and totals.
std::string conformance_text(const std::vector<Report>& reports, const std::string& slave, bool colour);

}  // namespace s7200::tools
