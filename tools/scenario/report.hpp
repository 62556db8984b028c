// How scenarios went: for people, for machines.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/runner.hpp"

namespace s7200::tools {

/// A scenario and how it went, on what.
struct Report {
  const Scenario* scenario = nullptr;
  ScenarioResult result{};
};

/// A rule that says should does not fail a suite.
bool counts_as_failed(const Report& report);

/// `  pass     52.3 ms  reads coils from any bit on`, and below it what was found instead, up to `most` findings.
std::string report_text(const Report& report, bool colour, std::size_t most = kFindingsShown);

/// What was sent, what was expected, what was found, in one line.
std::string finding_line(const Scenario& scenario, const Finding& finding);

/// `12 scenarios: 11 passed, 1 failed`
std::string summary_text(const std::vector<Report>& reports);

/// A line for each rule of a conformance suite, what was seen where one is broken, and totals.
std::string conformance_text(const std::vector<Report>& reports, const std::string& slave, bool colour);

/// Which scenario, or rule, it is: the keys before how it went.
nlohmann::ordered_json scenario_json(const Scenario& scenario);

nlohmann::ordered_json to_json(const std::vector<Report>& reports);

/// The XML that continuous integration reads: a suite for each file, a case for each scenario. A rule that says should and
/// is broken counts as skipped there, which has no third way.
/// The comment tells our files from others.
inline constexpr std::string_view kJunitBeginning =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Results of s7200 test -->\n";
std::string to_junit(const std::vector<Report>& reports);

/// Expected and found bytes below each other, what differs marked. Rows of sixteen; of long ones only those around a
/// difference. Every line begins with `indent`.
std::string bytes_diff(const std::vector<BytePattern>& expected, const std::vector<BytePattern>& found,
                       const std::string& indent, bool colour, std::string_view expected_name = "expected",
                       std::string_view found_name = "found");

}  // namespace s7200::tools
