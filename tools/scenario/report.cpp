#include "tools/scenario/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <span>

#include "interpreter/base/text.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

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
  return fmt::format("{}:{}:{}", stl::printable(scenario.source->name), step.position.line, step.position.column);
}

/// The source line of a step, as its author wrote it.
std::string line_of(const Scenario& scenario, const Step& step) {
  if (step.position.line == 0 || step.position.line > scenario.source->text.size()) return "";
  std::string_view line = scenario.source->text[step.position.line - 1];
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t")));
  return stl::printable(stl::count_characters(line) > 90 ? std::string(line.substr(0, 87)) + "..." : std::string(line));
}

std::string field(std::string_view name, std::string_view text) {
  const std::vector<std::string> lines = stl::split_lines(text);
  std::string result;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].empty()) result += fmt::format("{}{:<9} {}\n", kIndent, i == 0 ? name : "", stl::printable(lines[i]));
  return result;
}

std::string shortened_hex(const Bytes& bytes) {
  constexpr std::size_t kShown = 16;
  if (bytes.size() <= kShown) return serial::to_hex(bytes);
  return fmt::format("{} … {} bytes", serial::to_hex(Bytes(bytes.begin(), bytes.begin() + kShown)), bytes.size());
}

std::string finding_text(const Scenario& scenario, const Finding& finding, bool colour) {
  std::string text;
  if (!scenario.steps.empty()) {
    const Step& step = scenario.steps[finding.step];
    text += fmt::format("    {} {}{}\n", painted(place_of(scenario, step) + ":", kBold, colour), line_of(scenario, step),
                        step.loop.empty() ? "" : fmt::format("   (with {})", stl::printable(step.loop)));
    if (!step.note.empty()) text += kIndent + stl::printable(step.note) + '\n';
  }
  text += fmt::format("{}{} is not what was expected\n", kIndent, finding.what);
  if (finding.exchange && !finding.exchange->request.empty())
    text += field("request", shortened_hex(serial::bytes_of(finding.exchange->request)));
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

/// In words, or its first bytes.
std::string in_words(const std::string& words, const std::vector<BytePattern>& bytes) {
  if (!words.empty()) return words;
  const std::string row = row_of(bytes, 0, kRow);
  return bytes.size() > kRow ? fmt::format("{} … {} bytes", row, bytes.size()) : row;
}

std::string in_one_line(std::string_view text) {
  std::string result;
  for (std::string_view line : stl::split_lines(std::string(text))) {
    line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t")));
    if (!line.empty()) result.append(result.empty() ? "" : " ").append(line);
  }
  return result;
}

std::string xml(std::string_view text) {
  std::string result;
  for (const char c : stl::printable_lines(text)) {
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
        result += c;
    }
  }
  return result;
}

// --- JUnit ---

constexpr const char *kOneSuite = "  ", *kOneCase = "    ", *kInCase = "      ";

std::string attribute(std::string_view name, std::string_view value) { return fmt::format(" {}=\"{}\"", name, xml(value)); }

/// Packages and classes of readers: `tests.programs.modbus_slave.line` for tests/programs/modbus_slave/line.yaml.
std::string class_name(const std::string& file) {
  std::string name;
  const std::filesystem::path path = std::filesystem::path(file).replace_extension();
  for (const std::filesystem::path& part : path)
    if (part != ".." && part != "." && part != "/") name.append(name.empty() ? "" : ".").append(part.string());
  return name;
}

std::string case_name(const Scenario& scenario) {
  const Rule& rule = scenario.rule;
  if (rule.id.empty()) return scenario.name;
  return fmt::format("{} ({}, {}): {}", rule.id, severity_text(rule.severity), rule.source, scenario.name);
}

/// `line 6: answer to 01 03 00 0a 00 01 a4 08: expected no answer, found 1 register: 16#0000; and 2 more findings`
std::string failure_message(const Report& report) {
  const Scenario& scenario = *report.scenario;
  const std::vector<Finding>& findings = report.result.findings;
  const std::uint32_t line = scenario.steps.empty() ? 0 : scenario.steps[findings.front().step].position.line;
  std::string message = finding_line(scenario, findings.front());
  if (findings.front().what == "answer") message = "answer to " + message;
  if (line != 0) message = fmt::format("line {}: {}", line, message);
  const std::size_t more = findings.size() - 1;
  return more == 0 ? message : fmt::format("{}; and {} more finding{}", message, more, more == 1 ? "" : "s");
}

std::string properties_text(const Report& report) {
  std::string text;
  const auto property = [&](std::string_view name, const std::string& value) {
    if (!value.empty())
      text += fmt::format("{}  <property{}{}/>\n", kInCase, attribute("name", name), attribute("value", value));
  };
  const ScenarioResult& result = report.result;
  property("program", report.scenario->program);
  property("cpu", report.scenario->cpu);
  property("simulated_time_ns", result.outcome == Outcome::Skipped ? "" : std::to_string(result.time));
  property("checks", std::to_string(result.checks));
  property("skipped_steps", std::to_string(result.skipped_steps));
  return fmt::format("{0}<properties>\n{1}{0}</properties>\n", kInCase, text);
}

std::string outcome_xml(const Report& report) {
  const ScenarioResult& result = report.result;
  if (result.outcome == Outcome::Skipped)
    return fmt::format("{}<skipped{}/>\n", kInCase, attribute("message", result.reason));
  if (result.outcome == Outcome::Passed) return "";
  const bool failed = counts_as_failed(report);
  const std::string message = failure_message(report);
  return fmt::format("{}<{}>{}</{}>\n", kInCase,
                     failed ? fmt::format("failure{}{}", attribute("message", message),
                                          attribute("type", result.findings.front().of_run ? "run" : "expectation"))
                            : "skipped" + attribute("message", "not done as it should be: " + message),
                     xml(findings_text(report, false, kFindingsShown)), failed ? "failure" : "skipped");
}

std::string case_xml(const Report& report) {
  const Scenario& scenario = *report.scenario;
  const std::string& file = scenario.source->name;
  const bool has_place = !scenario.source->text.empty();
  const std::string place =
      has_place ? attribute("file", file) + attribute("line", std::to_string(scenario.position.line)) : "";
  return fmt::format("{0}<testcase{1}{2}{3}{4}>\n{5}{6}{0}</testcase>\n", kOneCase, attribute("classname", class_name(file)),
                     attribute("name", case_name(scenario)), place,
                     attribute("time", fmt::format("{:.3f}", report.result.host_seconds)), properties_text(report),
                     outcome_xml(report));
}

/// Of some reports, as readers add them up. Nothing is an error: what could not be run is a failure too.
std::string totals_xml(std::span<const Report> reports) {
  const auto failed = std::count_if(reports.begin(), reports.end(), counts_as_failed);
  const auto passed =
      std::count_if(reports.begin(), reports.end(), [](const Report& r) { return r.result.outcome == Outcome::Passed; });
  double seconds = 0;
  for (const Report& report : reports) seconds += report.result.host_seconds;
  return fmt::format(" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.3f}\"", reports.size(), failed,
                     static_cast<std::ptrdiff_t>(reports.size()) - failed - passed, seconds);
}

// --- JSON ---

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

nlohmann::ordered_json report_json(const Report& report) {
  const Scenario& scenario = *report.scenario;
  static constexpr const char* kOutcomes[] = {"passed", "failed", "skipped"};
  nlohmann::ordered_json json = scenario_json(scenario);
  json["outcome"] = kOutcomes[static_cast<std::size_t>(report.result.outcome)];
  json["reason"] = report.result.reason;
  json["time_ns"] = report.result.time;
  json["checks"] = report.result.checks;
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

std::string finding_line(const Scenario& scenario, const Finding& finding) {
  const bool asked = finding.exchange && !finding.exchange->request.empty();
  const std::string request = asked ? shortened_hex(serial::bytes_of(finding.exchange->request)) : "";
  const std::string about = !asked                     ? finding.what
                            : finding.what == "answer" ? request
                                                       : fmt::format("{}, {}", finding.what, request);
  const std::string text =
      fmt::format("{}: expected {}, found {}", about, in_words(finding.expected, finding.expected_bytes),
                  in_words(finding.found, finding.found_bytes));
  const std::string& loop = scenario.steps.empty() ? "" : scenario.steps[finding.step].loop;
  return in_one_line(loop.empty() ? text : fmt::format("{} ({})", text, loop));
}

bool counts_as_failed(const Report& report) {
  return report.result.outcome == Outcome::Failed &&
         (report.scenario->rule.id.empty() || report.scenario->rule.severity == Rule::Severity::Must);
}

std::string report_text(const Report& report, bool colour, std::size_t most) {
  const ScenarioResult& result = report.result;
  std::string remark;
  if (!result.reason.empty()) remark = fmt::format("   ({})", result.reason);
  if (result.outcome == Outcome::Passed && result.checks == 0) remark += "   (nothing was expected, so nothing was checked)";
  if (result.skipped_steps)
    remark += fmt::format("   ({} of {} steps skipped: they need the inside of the PLC or its line)", result.skipped_steps,
                          report.scenario->steps.size());
  const std::string time = result.outcome == Outcome::Skipped ? "" : format_duration(result.time, 1);
  return fmt::format("  {}  {:>10}  {}{}\n", outcome_text(result.outcome, colour), time,
                     stl::printable(report.scenario->name), stl::printable(remark)) +
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
  std::string text = fmt::format("{} as a Modbus RTU slave\n", stl::printable(slave));
  std::map<std::pair<Rule::Severity, Outcome>, std::size_t> totals;
  for (const Report& report : reports) {
    const Rule& rule = report.scenario->rule;
    const ScenarioResult& result = report.result;
    ++totals[{rule.severity, result.outcome}];
    const std::string outcome =
        result.outcome == Outcome::Skipped ? painted("n/a ", kYellow, colour) : outcome_text(result.outcome, colour);
    text += fmt::format("  {}  {:<6}  {:<{}}  {:<{}}  {}\n", outcome, severity_text(rule.severity), stl::printable(rule.id),
                        id_width, stl::printable(rule.source), source_width, stl::printable(report.scenario->name));
    if (result.outcome == Outcome::Skipped) text += fmt::format("        {}\n", stl::printable(result.reason));
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(kMost, result.findings.size()); ++i)
      text += "        " + stl::printable(finding_line(*report.scenario, result.findings[i])) + '\n';
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
  std::string text = fmt::format("{}<testsuites name=\"s7200 test\"{}>\n", kJunitBeginning, totals_xml(reports));
  for (std::size_t from = 0; from < reports.size();) {
    std::size_t to = from;
    while (to < reports.size() && reports[to].scenario->source == reports[from].scenario->source) ++to;
    const auto suite = std::span(reports).subspan(from, to - from);
    text += fmt::format("{}<testsuite{}{}>\n", kOneSuite, attribute("name", suite.front().scenario->source->name),
                        totals_xml(suite));
    for (const Report& report : suite) text += case_xml(report);
    text += fmt::format("{}</testsuite>\n", kOneSuite);
    from = to;
  }
  return text + "</testsuites>\n";
}

}  // namespace s7200::tools
