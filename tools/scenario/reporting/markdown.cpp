#include "tools/scenario/reporting/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/scenario/reporting/mistakes.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;
using Link = std::function<std::string(std::size_t number)>;

/// Names and values are text, never markup.
std::string as_text(std::string_view text) {
  std::string result;
  for (const char c : stl::printable(text)) {
    if (std::string_view("\\`*_[]<>&|~$").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string linked(const std::string& text, const std::string& address) {
  return address.empty() ? text : fmt::format("[{}]({})", text, address);
}

std::size_t count_of(const std::vector<Report>& reports, const std::string& file, Outcome outcome) {
  return static_cast<std::size_t>(std::ranges::count_if(reports, [&](const Report& report) {
    return report.scenario->source->name == file && report.result.outcome == outcome;
  }));
}

std::string files_table(const std::vector<Report>& reports) {
  std::string text = "| file | passed | failed | skipped | expected failures |\n|---|--:|--:|--:|--:|\n";
  const stl::SourceLines* last = nullptr;
  for (const Report& report : reports) {
    if (report.scenario->source.get() == last) continue;
    last = report.scenario->source.get();
    const auto count = [&](Outcome outcome) { return count_of(reports, last->name, outcome); };
    text += fmt::format("| {} | {} | {} | {} | {} |\n", as_text(last->name), count(Outcome::Passed), count(Outcome::Failed),
                        count(Outcome::Skipped), count(Outcome::ExpectedFailure));
  }
  return text;
}

/// The address of a finding: its moment, if the page opens the power-up that it was found after.
std::string address_of(const Report& report, const Finding& finding, const std::string& page) {
  const std::vector<Finding>& all = report.result.findings;
  const auto first = std::ranges::find_if(all, [](const Finding& one) { return one.place.has_value(); });
  const bool known = finding.place && finding.place->power_up == first->place->power_up;
  if (page.empty() || !known) return page;
  return fmt::format("{}&t={}ns", page, finding.place->moment.time);
}

std::string finding_item(const Report& report, const Finding& finding, const std::string& page) {
  const std::uint32_t line = position_of(*report.scenario, finding).line;
  const std::string said = finding_line(*report.scenario, finding);
  const std::string place = line == 0 ? "" : linked(fmt::format("line {}", line), address_of(report, finding, page)) + ": ";
  std::string text = fmt::format("- {}{}\n", place, as_text(said));
  for (const std::string& why : finding.why)
    if (said.find(why) == std::string::npos) text += fmt::format("  - {}\n", as_text(why));
  return text;
}

std::string failed_text(const Report& report, const std::string& page) {
  const ScenarioResult& result = report.result;
  const std::string command = debug_command(report);
  std::string text =
      fmt::format("\n### ✗ {}\n\n{}, after {} of simulated time\n\n", linked(as_text(report.scenario->name), page),
                  as_text(report.scenario->source->name), format_duration(result.time, 1));
  const std::size_t shown = std::min(kFindingsShown, result.findings.size());
  for (std::size_t i = 0; i < shown; ++i) text += finding_item(report, result.findings[i], page);
  if (result.findings.size() > shown) text += fmt::format("- and {} more\n", result.findings.size() - shown);
  return command.empty() ? text : text + fmt::format("\nTo look at it:\n\n    {}\n", stl::printable(command));
}

/// What was not done, and why.
std::string reasons_text(const std::vector<Report>& reports) {
  std::string text;
  for (const Report& report : reports)
    if (report.result.outcome == Outcome::Skipped || report.result.outcome == Outcome::ExpectedFailure)
      text += fmt::format("- {}: {}\n", as_text(report.scenario->name), as_text(reason_text(report.result)));
  return text.empty() ? text : "\n### Skipped or expected to fail\n\n" + text;
}

}  // namespace

std::string to_markdown(const std::vector<Report>& reports, const Link& link) {
  const bool failed = std::ranges::any_of(reports, counts_as_failed);
  std::string text =
      fmt::format("{}## {} {}\n{}", kMarkdownBeginning, failed ? "✗" : "✓", summary_text(reports), files_table(reports));
  for (std::size_t number = 0; number < reports.size(); ++number)
    if (reports[number].result.outcome == Outcome::Failed) text += failed_text(reports[number], link ? link(number) : "");
  return text + reasons_text(reports);
}

std::string to_markdown(const Messages& messages) {
  const std::vector<Mistake> mistakes = mistakes_in(messages);
  std::string text = fmt::format("{}## ✗ nothing was run: {}\n\n", kMarkdownBeginning, counted(mistakes.size(), "mistake"));
  for (const Mistake& mistake : mistakes) text += fmt::format("- {}\n", as_text(mistake_text(mistake)));
  return text;
}

}  // namespace s7200::tools
