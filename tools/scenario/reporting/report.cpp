#include "tools/scenario/reporting/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "tools/scenario/reporting/bytes_diff.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;

constexpr const char* kIndent = "      ";

/// Where the text of a field begins.
constexpr std::size_t kFieldColumn = 16;

std::string indented(const std::string& text, const std::string& indent) {
  std::string result;
  for (const std::string& line : stl::split_lines(text))
    if (!line.empty()) result += indent + line + '\n';
  return result;
}

std::string place_of(const Scenario& scenario, const stl::Position& position) {
  return fmt::format("{}:{}:{}", stl::printable(scenario.source->name), position.line, position.column);
}

/// The line of the source, as its author wrote it.
std::string line_of(const Scenario& scenario, const stl::Position& position) {
  if (position.line == 0 || position.line > scenario.source->text.size()) return "";
  std::string_view line = scenario.source->text[position.line - 1];
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

/// A word of a command line, in quotes where a shell would take it apart.
std::string quoted_for_shell(std::string_view word) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=:,@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shortened_hex(const Bytes& bytes) {
  constexpr std::size_t kShown = 16;
  if (bytes.size() <= kShown) return serial::to_hex(bytes);
  return fmt::format("{} … {} bytes", serial::to_hex(Bytes(bytes.begin(), bytes.begin() + kShown)), bytes.size());
}

/// Of memory, which a sentence says best.
bool is_one_value(const Finding& finding) { return finding.memory && finding.memory->count == 1; }

/// `Conveyor (Q0.1) is 0, expected 1; last written at 2100.000000 ms by = Q0.1 in line 42`
std::string value_sentence(const Finding& finding) {
  std::string text = fmt::format("{} is {}, expected {}", finding.what, finding.found, finding.expected);
  for (const std::string& why : finding.why) text += "; " + why;
  return text;
}

std::string field_lines(std::string_view text) {
  std::string result;
  for (const std::string& line : stl::split_lines(std::string(text)))
    if (!line.empty()) result += kIndent + stl::printable(line) + '\n';
  return result;
}

std::string finding_text(const Scenario& scenario, const Finding& finding, bool colour, std::size_t width) {
  const Step* step = step_of(scenario, finding);
  const stl::Position position = position_of(scenario, finding);
  const std::string loop = step && !step->loop.empty() ? fmt::format("   (with {})", stl::printable(step->loop)) : "";
  std::string text = fmt::format("    {} {}{}\n", painted(place_of(scenario, position) + ":", kBold, colour),
                                 line_of(scenario, position), loop);
  if (step && !step->note.empty()) text += kIndent + stl::printable(step->note) + '\n';
  if (is_one_value(finding)) return text + stl::wrapped(field_lines(value_sentence(finding)), width);
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
  for (const std::string& why : finding.why) text += stl::wrapped(field("why", why), width, kFieldColumn);
  if (!finding.timeline.empty()) text += painted(stl::wrapped(indented(finding.timeline, kIndent), width), kDim, colour);
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
    case Outcome::ExpectedFailure:
      return painted("gap ", kYellow, colour);
  }
  return "";
}

std::string expected_failures_text(std::size_t count) { return counted(count, "expected failure"); }

/// In words, or its first bytes.
std::string in_words(const std::string& words, const std::vector<BytePattern>& bytes) {
  if (!words.empty()) return words;
  const std::string row = row_of(bytes, 0, kBytesInARow);
  return bytes.size() > kBytesInARow ? fmt::format("{} … {} bytes", row, bytes.size()) : row;
}

std::string in_one_line(std::string_view text) {
  std::string result;
  for (std::string_view line : stl::split_lines(std::string(text))) {
    line.remove_prefix(std::min(line.size(), line.find_first_not_of(" \t")));
    if (!line.empty()) result.append(result.empty() ? "" : " ").append(line);
  }
  return result;
}

}  // namespace

std::string band_text(const BandResult& band) {
  const std::string share = band.tables == band.asked ? fmt::format("{} of {} tables", band.passed, band.tables)
                                                      : fmt::format("{} of {} tables, and {} were asked for", band.passed,
                                                                    band.tables, band.asked);
  return band.latency.any() ? fmt::format("{}, answers after {}", share, to_text(band.latency)) : share;
}

const Step* step_of(const Scenario& scenario, const Finding& finding) {
  return finding.step ? &scenario.steps[*finding.step] : nullptr;
}

stl::Position position_of(const Scenario& scenario, const Finding& finding) {
  const Step* step = step_of(scenario, finding);
  return step ? step->position : finding.at.value_or(scenario.position);
}

std::size_t count(const std::vector<Report>& reports, Outcome outcome) {
  return static_cast<std::size_t>(
      std::count_if(reports.begin(), reports.end(), [&](const Report& r) { return r.result.outcome == outcome; }));
}

std::string_view severity_text(Rule::Severity severity) { return severity == Rule::Severity::Must ? "must" : "should"; }

std::string findings_text(const Report& report, bool colour, std::size_t most, std::size_t width) {
  std::string text;
  const std::vector<Finding>& findings = report.result.findings;
  for (std::size_t i = 0; i < std::min(most, findings.size()); ++i)
    text += finding_text(*report.scenario, findings[i], colour, width);
  if (findings.size() > most) text += fmt::format("    and {} more\n", findings.size() - most);
  return text;
}

std::string debug_command(const Report& report) {
  return report.result.recordings.empty() ? "" : opening_command(*report.scenario);
}

std::string opening_command(const Scenario& scenario) {
  const std::string target = scenario.program_given ? fmt::format(" --target {}", quoted_for_shell(scenario.program)) : "";
  return fmt::format("s7200 debug {} --only {}{}", quoted_for_shell(scenario.source->name), quoted_for_shell(scenario.name),
                     target);
}

std::string finding_line(const Scenario& scenario, const Finding& finding) {
  if (is_one_value(finding)) {
    const Step* const step = step_of(scenario, finding);
    const std::string loop = step && !step->loop.empty() ? fmt::format(" ({})", step->loop) : "";
    return in_one_line(value_sentence(finding) + loop);
  }
  const bool asked = finding.exchange && !finding.exchange->request.empty();
  const std::string request = asked ? shortened_hex(serial::bytes_of(finding.exchange->request)) : "";
  const std::string about = !asked                     ? finding.what
                            : finding.what == "answer" ? request
                                                       : fmt::format("{}, {}", finding.what, request);
  const std::string text =
      fmt::format("{}: expected {}, found {}", about, in_words(finding.expected, finding.expected_bytes),
                  in_words(finding.found, finding.found_bytes));
  const Step* step = step_of(scenario, finding);
  const std::string loop = step ? step->loop : "";
  return in_one_line(loop.empty() ? text : fmt::format("{} ({})", text, loop));
}

bool counts_as_failed(const Report& report) {
  const Scenario& scenario = *report.scenario;
  const bool only_should = !scenario.rule.id.empty() && scenario.rule.severity == Rule::Severity::Should;
  return report.result.outcome == Outcome::Failed && (!only_should || !scenario.expected_failure.empty());
}

std::string reason_text(const ScenarioResult& result) {
  return result.outcome == Outcome::ExpectedFailure ? "expected failure: " + result.reason : result.reason;
}

/// Where to look at it.
static std::string debug_text(const Report& report) {
  const std::string command = debug_command(report);
  return command.empty() || report.result.outcome != Outcome::Failed ? "" : field("debug", command);
}

std::string report_text(const Report& report, bool colour, std::size_t width) {
  const ScenarioResult& result = report.result;
  std::string remark;
  if (!result.reason.empty()) remark = fmt::format("   ({})", reason_text(result));
  if (result.outcome == Outcome::Passed && result.checks == 0) remark += "   (nothing was expected, so nothing was checked)";
  if (result.skipped_steps)
    remark += fmt::format("   ({} of {} steps skipped: they need the inside of the PLC or its line)", result.skipped_steps,
                          report.scenario->step_count());
  if (result.band) remark += fmt::format("   ({})", band_text(*result.band));
  const std::string time = result.outcome == Outcome::Skipped ? "" : format_duration(result.time, 1);
  return fmt::format("  {}  {:>10}  {}{}\n", outcome_text(result.outcome, colour), time,
                     stl::printable(report.scenario->name), stl::printable(remark)) +
         (result.outcome == Outcome::ExpectedFailure ? "" : findings_text(report, colour, kFindingsShown, width)) +
         debug_text(report);
}

std::string summary_text(const std::vector<Report>& reports) {
  std::string text = fmt::format("{}: {} passed", counted(reports.size(), "scenario"), count(reports, Outcome::Passed));
  if (const std::size_t failed = count(reports, Outcome::Failed)) text += fmt::format(", {} failed", failed);
  if (const std::size_t skipped = count(reports, Outcome::Skipped)) text += fmt::format(", {} skipped", skipped);
  if (const std::size_t expected = count(reports, Outcome::ExpectedFailure)) text += ", " + expected_failures_text(expected);
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
    if (!result.reason.empty()) text += fmt::format("        {}\n", stl::printable(reason_text(result)));
    if (result.band) text += fmt::format("        {}\n", band_text(*result.band));
    if (result.outcome == Outcome::ExpectedFailure) continue;
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(kMost, result.findings.size()); ++i)
      text += "        " + stl::printable(finding_line(*report.scenario, result.findings[i])) + '\n';
    if (result.findings.size() > kMost) text += fmt::format("        and {} more\n", result.findings.size() - kMost);
  }
  for (const Rule::Severity severity : {Rule::Severity::Must, Rule::Severity::Should}) {
    text += fmt::format("{:<6}  {} passed, {} failed, {} not applicable", severity_text(severity),
                        totals[{severity, Outcome::Passed}], totals[{severity, Outcome::Failed}],
                        totals[{severity, Outcome::Skipped}]);
    const std::size_t expected = totals[{severity, Outcome::ExpectedFailure}];
    text += expected > 0 ? ", " + expected_failures_text(expected) + '\n' : "\n";
  }
  return text;
}

}  // namespace s7200::tools
