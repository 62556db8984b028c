#include "tools/command/testing/test_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/console.hpp"
#include "tools/scenario/reporting/report_json.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

void print_heading(const Scenario& scenario, const stl::SourceLines*& last) {
  if (scenario.source.get() == last) return;
  last = scenario.source.get();
  fmt::print("{}\n", stl::printable(scenario.source->name));
}

}  // namespace

TestOutput::TestOutput(std::size_t all, bool json, bool conformance)
    : all_(all), json_(json), conformance_(conformance), progress_wanted_(is_terminal(Standard::Error)) {}

void TestOutput::show_progress(std::size_t done) {
  if (!progress_wanted_ || std::chrono::steady_clock::now() - begin_ < std::chrono::seconds(2)) return;
  fmt::print(stderr, "\r{} of {} scenarios", done, all_);
  std::fflush(stderr);
  progress_shown_ = true;
}

void TestOutput::clear_progress() {
  if (progress_shown_) fmt::print(stderr, "\r\x1b[K");
  progress_shown_ = false;
}

void TestOutput::heading(const Scenario& scenario) {
  clear_progress();
  print_heading(scenario, file_);
}

void TestOutput::show(const Report& report) {
  if (json_ || conformance_) return clear_progress();
  heading(*report.scenario);
  fmt::print("{}", report_text(report, colour_wanted(stdout), output_width()));
  std::fflush(stdout);
}

void TestOutput::show(const Scenario& scenario, const Seen& seen) {
  if (!json_) return;
  if (!streamed_) {
    streamed_ =
        Streamed{StreamedResults(results_of("test"), "scenarios"), StreamedResults(scenario_json(scenario), "exchanges", 4)};
    fmt::print("{}", streamed_->results.before_entry());
  }
  fmt::print("{}", streamed_->scenario.entry(exchange_json(scenario, seen)));
}

void TestOutput::show(const Compared& compared) {
  if (json_) return clear_progress();
  heading(*compared.scenario);
  const bool skipped = !compared.skipped.empty();
  const std::string remark =
      skipped ? fmt::format("   ({})", compared.skipped) : "   " + counted(compared.exchanges, "exchange");
  const char* const word = skipped ? "skip  " : compared.difference.found ? "DIFFER" : "same  ";
  fmt::print("  {}  {}{}\n{}", word, stl::printable(compared.scenario->name), stl::printable(remark),
             compared.difference.text);
}

void TestOutput::end(const SuiteResult& result, const CoverageOptions& coverage, const ProfileOptions& profile) {
  clear_progress();
  if (streamed_) {
    auto rest = counts_json(result.reports);
    rest["not_run"] = result.not_run;
    coverage.add_to(rest, result.coverage);
    profile.add_to(rest, result.profile);
    const auto outcome = result.reports.empty() ? nlohmann::ordered_json::object() : outcome_json(result.reports.front());
    fmt::print("{}{}", streamed_->scenario.end(outcome), streamed_->results.end(rest));
  } else if (json_) {
    auto results = results_of("test");
    results.update(to_json(result.reports));
    results["not_run"] = result.not_run;
    coverage.add_to(results, result.coverage);
    profile.add_to(results, result.profile);
    fmt::print("{}", lines_of(results));
  } else if (conformance_) {
    print_report(conformance_text(result.reports, result.tested, colour_wanted(stdout)));
  } else {
    fmt::print("{}", summary_text(result.reports));
  }
  if (result.not_run > 0)
    print_note(fmt::format("{} {} not run", counted(result.not_run, "scenario"), result.not_run == 1 ? "was" : "were"));
}

void TestOutput::end(const ComparisonResult& result) {
  clear_progress();
  if (!json_) return;
  auto results = results_of("test");
  results["comparisons"] = nlohmann::ordered_json::array();
  for (const Compared& compared : result.scenarios)
    results["comparisons"].push_back({{"file", compared.scenario->source->name},
                                      {"name", compared.scenario->name},
                                      {"skipped", !compared.skipped.empty()},
                                      {"exchanges", compared.exchanges},
                                      {"same", !compared.difference.found},
                                      {"difference", compared.difference.text}});
  fmt::print("{}", lines_of(results));
}

void print_list(const std::vector<Scenario>& scenarios, bool json) {
  if (json) {
    auto results = results_of("test");
    for (const Scenario& scenario : scenarios) results["scenarios"].push_back(scenario_json(scenario));
    fmt::print("{}", lines_of(results));
    return;
  }
  const stl::SourceLines* file = nullptr;
  for (const Scenario& scenario : scenarios) {
    print_heading(scenario, file);
    const std::string id = scenario.rule.id.empty() ? "" : scenario.rule.id + "  ";
    fmt::print("  {}\n", stl::printable(id + scenario.name));
  }
}

void print_messages(const Messages& messages) {
  for (const Message& message : messages) {
    if (message.kind == Message::Kind::Diagnostics)
      print_diagnostics(message.diagnostics, *message.source);
    else if (message.kind == Message::Kind::Note)
      print_note(message.text);
    else
      print_error(message.text);
  }
}

void end_before_anything_ran(bool json, bool compares) {
  TestOutput output(0, json, false);
  if (json && compares) output.end(ComparisonResult{});
  if (json && !compares) output.end(SuiteResult{});
  print_interruption();
}

}  // namespace s7200::tools
