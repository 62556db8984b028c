#include "tools/scenario/reporting/junit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/scenario/reporting/mistakes.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;

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

constexpr const char *kOneSuite = "  ", *kOneCase = "    ", *kInCase = "      ";

std::string attribute(std::string_view name, std::string_view value) { return fmt::format(" {}=\"{}\"", name, xml(value)); }

/// Packages and classes of readers: `tests.programs.modbus_slave.line` for tests/programs/modbus_slave/line.yaml.
std::string class_name(const std::string& file) {
  std::string name;
  const std::filesystem::path path = file_path(file).replace_extension();
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
  const std::uint32_t line = position_of(scenario, findings.front()).line;
  std::string message = finding_line(scenario, findings.front());
  if (findings.front().what == "answer") message = "answer to " + message;
  if (line != 0) message = fmt::format("line {}: {}", line, message);
  const std::size_t more = findings.size() - 1;
  return more == 0 ? message : fmt::format("{}; and {}", message, counted(more, "more finding"));
}

/// ` of pump.stl`; nothing of the only program.
std::string name_after(const CoverageOfPrograms& coverage, const ProgramCoverage& each) {
  return coverage.programs().size() == 1 ? "" : " of " + coverage_name(each.map->program());
}

std::string properties_text(const Report& report, const std::string& link) {
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
  property("report", link);
  if (const auto& band = result.band) {
    property("tables_asked", std::to_string(band->asked));
    property("tables", std::to_string(band->tables));
    property("tables_passed", std::to_string(band->passed));
    property("tables_failed_with", band->failed_with);
  }
  for (const ProgramCoverage& each : result.coverage.programs()) {
    const CoverageFigures figures = figures_of(*each.map, each.tried);
    const auto share = [&](std::string_view name, const Share& of) {
      property(fmt::format("coverage_{}{}", name, name_after(result.coverage, each)),
               fmt::format("{}/{}", of.tried, of.all));
    };
    share("networks", figures.networks);
    share("instructions", figures.instructions);
    share("contacts", figures.contacts);
    share("deciding", figures.deciding);
  }
  return fmt::format("{0}<properties>\n{1}{0}</properties>\n", kInCase, text);
}

std::string debug_line(const Report& report) {
  const std::string command = debug_command(report);
  return command.empty() ? "" : command + '\n';
}

/// A page on which one sees it.
std::string page_line(const std::string& link) { return link.empty() ? "" : fmt::format("report: {}\n", link); }

std::string outcome_xml(const Report& report, const std::string& link) {
  const ScenarioResult& result = report.result;
  if (result.outcome == Outcome::Skipped || result.outcome == Outcome::ExpectedFailure)
    return fmt::format("{}<skipped{}/>\n", kInCase, attribute("message", reason_text(result)));
  if (result.outcome == Outcome::Passed) return "";
  const bool failed = counts_as_failed(report);
  const std::string message = failure_message(report);
  return fmt::format("{}<{}>{}</{}>\n", kInCase,
                     failed ? fmt::format("failure{}{}", attribute("message", message),
                                          attribute("type", result.findings.front().of_run ? "run" : "expectation"))
                            : "skipped" + attribute("message", "not done as it should be: " + message),
                     xml(findings_text(report, false, kFindingsShown) + debug_line(report) + page_line(link)),
                     failed ? "failure" : "skipped");
}

std::string case_xml(const Report& report, const std::string& link) {
  const Scenario& scenario = *report.scenario;
  const std::string& file = scenario.source->name;
  const bool has_place = !scenario.source->text.empty();
  const std::string place =
      has_place ? attribute("file", file) + attribute("line", std::to_string(scenario.position.line)) : "";
  return fmt::format("{0}<testcase{1}{2}{3}{4}>\n{5}{6}{0}</testcase>\n", kOneCase, attribute("classname", class_name(file)),
                     attribute("name", case_name(scenario)), place,
                     attribute("time", fmt::format("{:.3f}", report.result.host_seconds)), properties_text(report, link),
                     outcome_xml(report, link));
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

}  // namespace

std::string to_junit(const std::vector<Report>& reports, const std::function<std::string(std::size_t number)>& link) {
  std::string text = fmt::format("{}<testsuites name=\"s7200 test\"{}>\n", kJunitBeginning, totals_xml(reports));
  for (std::size_t from = 0; from < reports.size();) {
    std::size_t to = from;
    while (to < reports.size() && reports[to].scenario->source == reports[from].scenario->source) ++to;
    const auto suite = std::span(reports).subspan(from, to - from);
    text += fmt::format("{}<testsuite{}{}>\n", kOneSuite, attribute("name", suite.front().scenario->source->name),
                        totals_xml(suite));
    for (std::size_t number = from; number < to; ++number) text += case_xml(reports[number], link ? link(number) : "");
    text += fmt::format("{}</testsuite>\n", kOneSuite);
    from = to;
  }
  return text + "</testsuites>\n";
}

namespace {

std::string error_xml(const Mistake& mistake) {
  const bool has_place = !mistake.file.empty();
  const std::string name = has_place ? fmt::format("line {}", mistake.position.line) : "s7200 test";
  const std::string place =
      has_place ? attribute("file", mistake.file) + attribute("line", std::to_string(mistake.position.line)) : "";
  return fmt::format("{0}<testcase{1}{2}{3} time=\"0.000\">\n{4}<error{5} type=\"unusable\">{6}</error>\n{0}</testcase>\n",
                     kOneCase, attribute("classname", has_place ? class_name(mistake.file) : "s7200"),
                     attribute("name", name), place, kInCase, attribute("message", mistake.text),
                     xml(mistake_text(mistake)));
}

}  // namespace

std::string to_junit(const Messages& messages) {
  const std::vector<Mistake> mistakes = mistakes_in(messages);
  const std::string totals =
      fmt::format(" tests=\"{0}\" failures=\"0\" errors=\"{0}\" skipped=\"0\" time=\"0.000\"", mistakes.size());
  std::string text = fmt::format("{}<testsuites name=\"s7200 test\"{}>\n", kJunitBeginning, totals);
  text += fmt::format("{}<testsuite name=\"s7200 test\"{}>\n", kOneSuite, totals);
  for (const Mistake& mistake : mistakes) text += error_xml(mistake);
  return text + fmt::format("{}</testsuite>\n</testsuites>\n", kOneSuite);
}

}  // namespace s7200::tools
