#include "tools/scenario/reporting/report_json.hpp"

#include <nlohmann/json.hpp>

#include "tools/scenario/reporting/bytes_diff.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;

nlohmann::ordered_json bytes_json(const std::vector<BytePattern>& bytes) {
  if (bytes.empty()) return nullptr;
  return row_of(bytes, 0, bytes.size());
}

nlohmann::ordered_json finding_json(const Scenario& scenario, const Finding& finding) {
  const Step* step = step_of(scenario, finding);
  const stl::Position position = position_of(scenario, finding);
  nlohmann::ordered_json json{{"line", position.line},
                              {"column", position.column},
                              {"note", step ? step->note : ""},
                              {"loop", step ? step->loop : ""}};
  json["what"] = finding.what;
  json["expected"] = finding.expected;
  json["found"] = finding.found;
  json["expected_bytes"] = bytes_json(finding.expected_bytes);
  json["found_bytes"] = bytes_json(finding.found_bytes);
  json["why"] = finding.why;
  return json;
}

}  // namespace

nlohmann::ordered_json exchange_json(const Scenario& scenario, const Seen& seen) {
  const serial::Exchange& exchange = seen.exchange;
  const Bytes request = serial::bytes_of(exchange.request), response = exchange.response_bytes();
  nlohmann::ordered_json json{{"line", scenario.steps[seen.step].position.line}};
  const auto add = [&json](const std::string& key, const Bytes& bytes, const std::optional<std::string>& text) {
    json[key] = bytes.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(plain_hex(bytes));
    if (text) json[key + "_text"] = *text;
  };
  add("request", request, plain_text(request, request));
  add("response", response, plain_text(request, response));
  json["latency_us"] = nullptr;
  if (const auto latency = latency_of(exchange)) json["latency_us"] = static_cast<double>(*latency) / kMicrosecond;
  return json;
}

nlohmann::ordered_json outcome_json(const Report& report) {
  const Scenario& scenario = *report.scenario;
  static constexpr const char* kOutcomes[] = {"passed", "failed", "skipped", "expected_failure"};
  nlohmann::ordered_json json;
  json["outcome"] = kOutcomes[static_cast<std::size_t>(report.result.outcome)];
  json["reason"] = report.result.reason;
  json["time_ns"] = report.result.time;
  json["checks"] = report.result.checks;
  json["skipped_steps"] = report.result.skipped_steps;
  if (const auto& band = report.result.band)
    json["band"] = {{"asked", band->asked},
                    {"tables", band->tables},
                    {"passed", band->passed},
                    {"failed_with", band->failed_with},
                    {"latency_us", to_json(band->latency)}};
  for (const ProgramCoverage& each : report.result.coverage.programs()) {
    nlohmann::ordered_json of_program{{"program", coverage_name(each.map->program())}};
    of_program.update(figures_json(figures_of(*each.map, each.tried)));
    json["coverage"].push_back(std::move(of_program));
  }
  for (const Profile& each : report.result.profile.programs()) json["profile"].push_back(profile_summary_json(each));
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : report.result.findings) json["findings"].push_back(finding_json(scenario, finding));
  if (const std::string command = debug_command(report); !command.empty()) json["debug"] = command;
  return json;
}

namespace {

nlohmann::ordered_json report_json(const Report& report) {
  nlohmann::ordered_json json = scenario_json(*report.scenario);
  json.update(outcome_json(report));
  json["exchanges"] = nlohmann::ordered_json::array();
  for (const Seen& seen : report.result.seen) json["exchanges"].push_back(exchange_json(*report.scenario, seen));
  return json;
}

}  // namespace

nlohmann::ordered_json scenario_json(const Scenario& scenario) {
  nlohmann::ordered_json json{{"file", scenario.source->name}, {"line", scenario.position.line}, {"name", scenario.name}};
  const Rule& rule = scenario.rule;
  if (!rule.id.empty())
    json["rule"] = {{"id", rule.id}, {"source", rule.source}, {"severity", severity_text(rule.severity)}};
  if (!scenario.expected_failure.empty()) json["expected_failure"] = scenario.expected_failure;
  return json;
}

nlohmann::ordered_json counts_json(const std::vector<Report>& reports) {
  return {{"passed", count(reports, Outcome::Passed)},
          {"failed", count(reports, Outcome::Failed)},
          {"skipped", count(reports, Outcome::Skipped)},
          {"expected_failures", count(reports, Outcome::ExpectedFailure)}};
}

nlohmann::ordered_json to_json(const std::vector<Report>& reports) {
  nlohmann::ordered_json json{{"scenarios", nlohmann::ordered_json::array()}};
  for (const Report& report : reports) json["scenarios"].push_back(report_json(report));
  json.update(counts_json(reports));
  return json;
}

}  // namespace s7200::tools
