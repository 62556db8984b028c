#include "tools/scenario/suite.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "interpreter/base/text.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/parallel_run.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;

std::string file_name(const std::string& path) { return stl::printable(std::filesystem::path(path).filename().string()); }

}  // namespace

bool SuiteResult::any_had_a_program() const {
  return reports.empty() || std::ranges::any_of(reports, [](const Report& report) {
           return report.result.findings.empty() || report.result.findings.front().what != "program";
         });
}

bool SuiteResult::passed() const { return std::none_of(reports.begin(), reports.end(), counts_as_failed); }

std::string SuiteResult::why_nothing_was_checked() const {
  std::size_t checks = 0;
  for (const Report& report : reports) checks += report.result.checks + report.result.findings.size();
  if (checks > 0 || reports.empty()) return "";
  return count(reports, Outcome::Skipped) == reports.size() ? "every scenario was skipped"
                                                            : "no step that was done expects anything";
}

bool ComparisonResult::same() const {
  return std::none_of(scenarios.begin(), scenarios.end(), [](const Compared& c) { return c.difference.found; });
}

Time tolerance_for(Time given, bool live) {
  if (given != kNever) return given;
  return live ? 50 * kMillisecond : 0;
}

std::optional<Suite> Suite::collect(const SuiteSettings& settings, Messages& messages) {
  auto scenarios = collect_scenarios(settings, messages);
  if (!scenarios) return {};
  return Suite(settings, std::move(*scenarios));
}

std::optional<Benches> Suite::benches_on(const std::string& target, Messages& messages) {
  return make_benches(scenarios_, target, settings_, programs_, messages);
}

/// A slave that is not a program is one for all.
unsigned Suite::jobs_on(const Benches& benches) const { return benches.slave ? 1 : std::max(1U, settings_.jobs); }

std::optional<SuiteResult> Suite::run(const Watcher<Report>& watcher, Messages& messages) {
  const auto benches = benches_on(settings_.target, messages);
  if (!benches) return {};
  catch_interruption();  // from here on there is something to complete
  SuiteResult result{.tested = benches->name, .live = benches->slave != nullptr};
  if (!settings_.target.empty())
    for (Scenario& scenario : scenarios_) scenario.program = result.live ? "" : settings_.target;
  try {
    ParallelRun run(scenarios_, benches->of, jobs_on(*benches));
    run.each(
        [&](std::size_t i, ScenarioResult of_one) {
          result.reports.push_back({&scenarios_[i], std::move(of_one)});
          if (watcher.finished) watcher.finished(result.reports.back());
          return !interrupted() && !(settings_.fail_fast && counts_as_failed(result.reports.back()));
        },
        watcher.waiting);
  } catch (const SlaveUnreachable& error) {
    result.unreachable = error.what();
  }
  result.not_run = scenarios_.size() - result.reports.size();
  return result;
}

std::optional<ComparisonResult> Suite::compare(const std::string& other, Time tolerance, bool ignore_timing, bool colour,
                                               const Watcher<Compared>& watcher, Messages& messages) {
  const auto one_benches = benches_on(settings_.target, messages);
  if (!one_benches) return {};
  const auto other_benches = benches_on(other, messages);
  if (!other_benches) return {};
  catch_interruption();
  const bool live = one_benches->slave || other_benches->slave;
  const Comparison comparison{!ignore_timing, tolerance_for(tolerance, live)};
  std::vector<ScenarioResult> of_other;
  ParallelRun(scenarios_, other_benches->of, jobs_on(*other_benches))
      .each(
          [&](std::size_t, ScenarioResult result) {
            of_other.push_back(std::move(result));
            return !interrupted();
          },
          watcher.waiting);
  ComparisonResult all;
  ParallelRun(scenarios_, one_benches->of, jobs_on(*one_benches))
      .each(
          [&](std::size_t i, const ScenarioResult& result) {
            if (interrupted()) return false;
            const Scenario& scenario = scenarios_[i];
            Compared compared{.scenario = &scenario, .exchanges = result.seen.size()};
            for (const ScenarioResult* each : {&result, &std::as_const(of_other[i])})
              if (each->outcome == Outcome::Skipped) compared.skipped = each->reason;
            const std::string one_name = settings_.target.empty() ? scenario.program : one_benches->name;
            if (compared.skipped.empty())
              compared.difference = tools::compare(scenario, result, of_other[i], file_name(one_name),
                                                   file_name(other_benches->name), comparison, colour);
            all.scenarios.push_back(std::move(compared));
            if (watcher.finished) watcher.finished(all.scenarios.back());
            return all.same() || !settings_.fail_fast;
          },
          watcher.waiting);
  return all;
}

}  // namespace s7200::tools
