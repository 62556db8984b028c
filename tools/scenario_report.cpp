#include "tools/scenario_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "interpreter/stl/text.hpp"
#include "tools/report.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;

constexpr std::size_t kRow = 16;  // bytes in a row of a diff
constexpr const char* kIndent = "      ";

constexpr const char* kRed = "1;31";
constexpr const char* kGreen = "32";
constexpr const char* kYellow = "33";
constexpr const char* kBold = "1";
constexpr const char* kDim = "2";

std::string painted(std::string_view text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : std::string(text);
}

std::string indented(const std::string& text, const std::string& indent) {
  std::string result;
  for (const std::string& line : stl::split_lines(text))
    if (!line.empty()) result += indent + line + '\n';
  return result;
}

std::string byte_text(const std::vector<BytePattern>& bytes, std::size_t i) {
  if (i >= bytes.size()) return "  ";
  return bytes[i] ? fmt::format("{:02x}", *bytes[i]) : "..";
}

bool differs(const std::vector<BytePattern>& expected, const std::vector<BytePattern>& found, std::size_t i) {
  if (i >= expected.size() || i >= found.size()) return true;
  return expected[i] && found[i] && *expected[i] != *found[i];
}

std::string row_of(const std::vector<BytePattern>& bytes, std::size_t from, std::size_t to) {
  std::string row;
  for (std::size_t i = from; i < std::min(to, bytes.size()); ++i)
    row.append(i == from ? "" : " ").append(byte_text(bytes, i));
  return row;
}

std::string place_of(const Scenario& scenario, const Step& step) {
  return fmt::format("{}:{}:{}", scenario.source->name, step.position.line, step.position.column);
}

/// The source line of a step, as its author wrote it.
std::string line_of(const Scenario& scenario, const Step& step) {
  if (step.position.line == 0 || step.position.line > scenario.source->text.size()) return "";
  std::string_view line = scenario.source->text[step.position.line - 1];
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t")));
  return stl::count_characters(line) > 90 ? std::string(line.substr(0, 87)) + "..." : std::string(line);
}

std::string field(std::string_view name, std::string_view text) {
  const std::vector<std::string> lines = stl::split_lines(text);
  std::string result;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].empty()) result += fmt::format("{}{:<9} {}\n", kIndent, i == 0 ? name : "", lines[i]);
  return result;
}

std::string shortened_hex(const modbus::Bytes& bytes) {
  constexpr std::size_t kShown = 16;
  if (bytes.size() <= kShown) return modbus::to_hex(bytes);
  return fmt::format("{} … {} bytes", modbus::to_hex(modbus::Bytes(bytes.begin(), bytes.begin() + kShown)), bytes.size());
}

std::string finding_text(const Scenario& scenario, const Finding& finding, bool colour) {
  std::string text;
  if (!scenario.steps.empty()) {
    const Step& step = scenario.steps[finding.step];
    text += fmt::format("    {} {}{}\n", painted(place_of(scenario, step) + ":", kBold, colour), line_of(scenario, step),
                        step.loop.empty() ? "" : fmt::format("   (with {})", step.loop));
    if (!step.note.empty()) text += kIndent + step.note + '\n';
  }
  text += fmt::format("{}{} is not what was expected\n", kIndent, finding.what);
  if (finding.exchange) text += field("request", shortened_hex(modbus::bytes_of(finding.exchange->request)));
  if (!finding.expected_bytes.empty() && finding.found_bytes.empty()) {
    text += field("expected", row_of(finding.expected_bytes, 0, finding.expected_bytes.size()));
  } else if (!finding.expected_bytes.empty()) {
    text += bytes_diff(finding.expected_bytes, finding.found_bytes, kIndent, colour);
  } else if (!finding.found_bytes.empty()) {
    text += field("found", row_of(finding.found_bytes, 0, finding.found_bytes.size()));
  }
  if (!finding.expected.empty()) text += field("expected", finding.expected);
  if (!finding.found.empty()) text += field("found", finding.found);
  if (!finding.timeline.empty()) text += painted(indented(finding.timeline, kIndent), kDim, colour);
  return text;
}

std::string outcome_text(Outcome outcome, bool colour) {
  switch (outcome) {
    case Outcome::Passed:
      return painted("pass", kGreen, colour);
    case Outcome::Failed:
      return painted("FAIL", kRed, colour);
    case Outcome::Skipped:
      return painted("skip", kYellow, colour);
  }
  return "";
}

std::size_t count(const std::vector<Report>& reports, Outcome outcome) {
  return static_cast<std::size_t>(
      std::count_if(reports.begin(), reports.end(), [&](const Report& r) { return r.result.outcome == outcome; }));
}

std::string_view severity_text(Rule::Severity severity) { return severity == Rule::Severity::Must ? "must" : "should"; }

std::string findings_text(const Report& report, bool colour, std::size_t most) {
  std::string text;
  const std::vector<Finding>& findings = report.result.findings;
  for (std::size_t i = 0; i < std::min(most, findings.size()); ++i)
    text += finding_text(*report.scenario, findings[i], colour);
  if (findings.size() > most) text += fmt::format("    and {} more\n", findings.size() - most);
  return text;
}

/// One line: what was sent, what was due, what came.
std::string seen_text(const Scenario& scenario, const Finding& finding) {
  std::string text;
  if (finding.exchange) text = fmt::format("{}: ", shortened_hex(modbus::bytes_of(finding.exchange->request)));
  const std::string& loop = scenario.steps[finding.step].loop;
  const std::string due =
      !finding.expected.empty() ? finding.expected : row_of(finding.expected_bytes, 0, finding.expected_bytes.size());
  text += fmt::format("{} was due, {} came", due, finding.found);
  if (finding.what != "answer") text = finding.what + ", " + text;
  return loop.empty() ? text : fmt::format("{} ({})", text, loop);
}

std::string xml(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
    }
  }
  return result;
}

nlohmann::ordered_json bytes_json(const std::vector<BytePattern>& bytes) {
  if (bytes.empty()) return nullptr;
  return row_of(bytes, 0, bytes.size());
}

nlohmann::ordered_json finding_json(const Scenario& scenario, const Finding& finding) {
  nlohmann::ordered_json json{{"line", nullptr}, {"column", nullptr}, {"note", ""}, {"loop", ""}};
  if (!scenario.steps.empty()) {
    const Step& step = scenario.steps[finding.step];
    json = {{"line", step.position.line}, {"column", step.position.column}, {"note", step.note}, {"loop", step.loop}};
  }
  json["what"] = finding.what;
  json["expected"] = finding.expected;
  json["found"] = finding.found;
  json["expected_bytes"] = bytes_json(finding.expected_bytes);
  json["found_bytes"] = bytes_json(finding.found_bytes);
  return json;
}

nlohmann::ordered_json exchange_json(const Scenario& scenario, const Seen& seen) {
  const serial::Exchange& exchange = seen.exchange;
  nlohmann::ordered_json json{{"line", scenario.steps[seen.step].position.line},
                              {"request", plain_hex(modbus::bytes_of(exchange.request))},
                              {"response", nullptr},
                              {"latency_us", nullptr}};
  if (const auto latency = exchange.latency()) {
    json["response"] = plain_hex(exchange.response_bytes());
    json["latency_us"] = static_cast<double>(*latency) / kMicrosecond;
  }
  return json;
}

nlohmann::ordered_json report_json(const Report& report) {
  const Scenario& scenario = *report.scenario;
  static constexpr const char* kOutcomes[] = {"passed", "failed", "skipped"};
  nlohmann::ordered_json json = scenario_json(scenario);
  json["outcome"] = kOutcomes[static_cast<std::size_t>(report.result.outcome)];
  json["reason"] = report.result.reason;
  json["time_ns"] = report.result.time;
  json["skipped_steps"] = report.result.skipped_steps;
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : report.result.findings) json["findings"].push_back(finding_json(scenario, finding));
  json["exchanges"] = nlohmann::ordered_json::array();
  for (const Seen& seen : report.result.seen) json["exchanges"].push_back(exchange_json(scenario, seen));
  return json;
}

}  // namespace

std::string bytes_diff(const std::vector<BytePattern>& expected, const std::vector<BytePattern>& found,
                       const std::string& indent, bool colour, std::string_view expected_name, std::string_view found_name) {
  const std::size_t width = std::max<std::size_t>(9, std::max(expected_name.size(), found_name.size()));
  const std::size_t length = std::max(expected.size(), found.size());
  std::string text;
  bool left_out = false;
  for (std::size_t from = 0; from < length; from += kRow) {
    const std::size_t to = std::min(from + kRow, length);
    std::string marks;
    for (std::size_t i = from; i < to; ++i) marks += differs(expected, found, i) ? "^^ " : "   ";
    marks = std::string(stl::trim_end(marks));
    if (marks.empty() && length > 2 * kRow) {
      if (!left_out) text += indent + "…\n";
      left_out = true;
      continue;
    }
    left_out = false;
    const std::string place = length > kRow ? fmt::format("{:>4}  ", from) : "";
    text += fmt::format("{}{:<{}} {}{}\n", indent, expected_name, width, place, row_of(expected, from, to));
    text += fmt::format("{}{:<{}} {}{}\n", indent, found_name, width, place, row_of(found, from, to));
    if (!marks.empty())
      text +=
          fmt::format("{}{:<{}} {}{}\n", indent, "", width, std::string(place.size(), ' '), painted(marks, kRed, colour));
  }
  return text;
}

bool counts_as_failed(const Report& report) {
  return report.result.outcome == Outcome::Failed &&
         (report.scenario->rule.id.empty() || report.scenario->rule.severity == Rule::Severity::Must);
}

std::string report_text(const Report& report, bool colour, std::size_t most) {
  const ScenarioResult& result = report.result;
  std::string remark;
  if (!result.reason.empty()) remark = fmt::format("   ({})", result.reason);
  if (result.skipped_steps)
    remark += fmt::format("   ({} of {} steps skipped: they need the inside of the PLC or its line)", result.skipped_steps,
                          report.scenario->steps.size());
  const std::string time = result.outcome == Outcome::Skipped ? "" : format_duration(result.time, 1);
  return fmt::format("  {}  {:>10}  {}{}\n", outcome_text(result.outcome, colour), time, report.scenario->name, remark) +
         findings_text(report, colour, most);
}

std::string summary_text(const std::vector<Report>& reports) {
  std::string text = fmt::format("{} scenario{}: {} passed", reports.size(), reports.size() == 1 ? "" : "s",
                                 count(reports, Outcome::Passed));
  if (const std::size_t failed = count(reports, Outcome::Failed)) text += fmt::format(", {} failed", failed);
  if (const std::size_t skipped = count(reports, Outcome::Skipped)) text += fmt::format(", {} skipped", skipped);
  return text + '\n';
}

std::string conformance_text(const std::vector<Report>& reports, const std::string& slave, bool colour) {
  std::size_t id_width = 0, source_width = 0;
  for (const Report& report : reports) {
    id_width = std::max(id_width, report.scenario->rule.id.size());
    source_width = std::max(source_width, report.scenario->rule.source.size());
  }
  std::string text = fmt::format("{} as a Modbus RTU slave\n", slave);
  std::map<std::pair<Rule::Severity, Outcome>, std::size_t> totals;
  for (const Report& report : reports) {
    const Rule& rule = report.scenario->rule;
    const ScenarioResult& result = report.result;
    ++totals[{rule.severity, result.outcome}];
    const std::string outcome =
        result.outcome == Outcome::Skipped ? painted("n/a ", kYellow, colour) : outcome_text(result.outcome, colour);
    text += fmt::format("  {}  {:<6}  {:<{}}  {:<{}}  {}\n", outcome, severity_text(rule.severity), rule.id, id_width,
                        rule.source, source_width, report.scenario->name);
    if (result.outcome == Outcome::Skipped) text += fmt::format("        {}\n", result.reason);
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(kMost, result.findings.size()); ++i)
      text += "        " + seen_text(*report.scenario, result.findings[i]) + '\n';
    if (result.findings.size() > kMost) text += fmt::format("        and {} more\n", result.findings.size() - kMost);
  }
  for (const Rule::Severity severity : {Rule::Severity::Must, Rule::Severity::Should})
    text += fmt::format("{:<6}  {} passed, {} failed, {} not applicable\n", severity_text(severity),
                        totals[{severity, Outcome::Passed}], totals[{severity, Outcome::Failed}],
                        totals[{severity, Outcome::Skipped}]);
  return text;
}

nlohmann::ordered_json scenario_json(const Scenario& scenario) {
  nlohmann::ordered_json json{{"file", scenario.source->name}, {"line", scenario.position.line}, {"name", scenario.name}};
  const Rule& rule = scenario.rule;
  if (!rule.id.empty())
    json["rule"] = {{"id", rule.id}, {"source", rule.source}, {"severity", severity_text(rule.severity)}};
  return json;
}

nlohmann::ordered_json to_json(const std::vector<Report>& reports) {
  nlohmann::ordered_json json{{"scenarios", nlohmann::ordered_json::array()},
                              {"passed", count(reports, Outcome::Passed)},
                              {"failed", count(reports, Outcome::Failed)},
                              {"skipped", count(reports, Outcome::Skipped)}};
  for (const Report& report : reports) json["scenarios"].push_back(report_json(report));
  return json;
}

std::string to_junit(const std::vector<Report>& reports) {
  const auto failed = [](const std::vector<Report>& some) {
    return static_cast<std::size_t>(std::count_if(some.begin(), some.end(), counts_as_failed));
  };
  const auto skipped = [&](const std::vector<Report>& some) {
    return some.size() - failed(some) - count(some, Outcome::Passed);
  };
  std::string text =
      fmt::format("{} version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"{}\" failures=\"{}\" skipped=\"{}\">\n",
                  kJunitBeginning, reports.size(), failed(reports), skipped(reports));
  for (std::size_t from = 0; from < reports.size();) {
    std::size_t to = from;
    while (to < reports.size() && reports[to].scenario->source == reports[from].scenario->source) ++to;
    const std::vector<Report> suite(reports.begin() + static_cast<std::ptrdiff_t>(from),
                                    reports.begin() + static_cast<std::ptrdiff_t>(to));
    const std::string& file = suite.front().scenario->source->name;
    double seconds = 0;
    for (const Report& report : suite) seconds += report.result.host_seconds;
    text += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" skipped=\"{}\" time=\"{:.3f}\">\n", xml(file),
                        suite.size(), failed(suite), skipped(suite), seconds);
    for (const Report& report : suite) {
      const Rule& rule = report.scenario->rule;
      const std::string id =
          rule.id.empty() ? "" : fmt::format("{} ({}, {}): ", rule.id, severity_text(rule.severity), rule.source);
      text += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n",
                          xml(std::filesystem::path(file).stem().string()), xml(id + report.scenario->name),
                          report.result.host_seconds);
      if (report.result.outcome == Outcome::Skipped)
        text += fmt::format("      <skipped message=\"{}\"/>\n", xml(report.result.reason));
      else if (report.result.outcome == Outcome::Failed && !counts_as_failed(report))
        text += fmt::format("      <skipped message=\"not done as it should be\">{}</skipped>\n",
                            xml(findings_text(report, false, 5)));
      else if (report.result.outcome == Outcome::Failed)
        text += fmt::format("      <failure message=\"{}\">{}</failure>\n", xml(report.result.findings.front().what),
                            xml(findings_text(report, false, 5)));
      text += "    </testcase>\n";
    }
    text += "  </testsuite>\n";
    from = to;
  }
  return text + "</testsuites>\n";
}

}  // namespace s7200::tools
