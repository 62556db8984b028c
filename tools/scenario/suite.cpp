#include "tools/scenario/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/measuring/parallel_run.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {
namespace {

using Outcome = ScenarioResult::Outcome;

std::string file_name(const std::string& path) { return stl::printable(file_path(path).filename().string()); }

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
  for (Scenario& scenario : *scenarios) {
    if (!settings.every_scan || !scenario.plan) continue;
    auto plan = std::make_shared<SystemPlan>(*scenario.plan);
    run_every_scan(*plan);
    scenario.plan = std::move(plan);
  }
  return Suite(settings, std::move(*scenarios));
}

std::optional<Benches> Suite::benches_on(const std::string& target, Messages& messages) {
  auto benches = make_benches(scenarios_, target, settings_, programs_, messages);
  return settings_.stop.stop_requested() ? std::nullopt
                                         : std::move(benches);  // a program may have been cut off while it was read
}

namespace {

/// A scenario with one table of execution times.
struct Turn {
  std::size_t scenario, table;
  bool last;  ///< of this scenario
};

std::vector<Turn> turns_of(const std::vector<Bench>& benches) {
  std::vector<Turn> turns;
  for (std::size_t i = 0; i < benches.size(); ++i) {
    const std::size_t tables = benches[i].band ? benches[i].band->size() : 1;
    for (std::size_t table = 0; table < tables; ++table) turns.push_back({i, table, table + 1 == tables});
  }
  return turns;
}

ScenarioResult run_turn(const Scenario& scenario, const Bench& bench, std::size_t table, bool every_scan) {
  if (!bench.band) return run_scenario(scenario, bench);
  Bench of_table = bench;
  of_table.program = bench.band->program(table);
  if (every_scan) of_table.program = with_every_scan(*of_table.program);
  of_table.exchanges_wanted = true;  // for their latencies
  return run_scenario(scenario, of_table);
}

/// Whether it is the first that has failed.
bool add_to(BandResult& band, const ScenarioResult& of_table, const std::string& table) {
  const bool passed = of_table.outcome == Outcome::Passed;
  const bool first_failed = !passed && band.failed_with.empty();
  ++band.tables;
  band.passed += passed;
  if (first_failed) {
    band.failed_with = table;
    if (band.tables > 1) band.findings = of_table.findings;
  }
  for (const Seen& seen : of_table.seen)
    if (const auto latency = latency_of(seen.exchange)) band.latency.add(*latency);
  return first_failed;
}

/// A scenario that passes with too few tables fails, and so does one that fails with the first. An interrupted
/// band has no share.
void judge_robustness(const Scenario& scenario, ScenarioResult& result) {
  if (!scenario.robust || result.band->passed == result.band->asked) return;
  if (result.band->tables < result.band->asked) {
    if (result.outcome == Outcome::Passed) result.outcome = Outcome::Skipped, result.reason = "interrupted";
    return;
  }
  const double share = 100.0 * static_cast<double>(result.band->passed) / static_cast<double>(result.band->tables);
  const bool with_first = result.outcome == Outcome::Passed;
  if (with_first && share >= *scenario.robust) return;
  result.outcome = Outcome::Failed;
  result.findings.push_back({.what = "robustness",
                             .expected = fmt::format("to pass with {:g}% of the tables of execution times{}",
                                                     *scenario.robust, with_first ? "" : ", and with the one in use"),
                             .found = fmt::format("{} of {}: {:.1f}%, not with {}", result.band->passed, result.band->tables,
                                                  share, result.band->failed_with),
                             .at = scenario.robust_at});
}

/// On a slave that is not a program there are no tables.
void note_robustness_not_judged(const std::vector<Scenario>& scenarios, const Benches& benches, Messages& messages) {
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    if (scenarios[i].robust && !benches.of[i].band && benches.of[i].problem.empty() && scenarios[i].skipped.empty())
      messages.push_back({.kind = Message::Kind::Note,
                          .text = fmt::format("{}: 'robust' is not judged: {} is not a program, which has tables of "
                                              "execution times",
                                              scenarios[i].name, benches.name)});
}

}  // namespace

/// A slave outside simulation is one for all.
unsigned Suite::jobs_on(const Benches& benches) const { return benches.slave ? 1 : std::max(1U, settings_.jobs); }

std::optional<SuiteResult> Suite::run(const Watcher<Report>& watcher, Messages& messages) {
  auto benches = benches_on(settings_.target, messages);
  if (!benches) return {};
  note_robustness_not_judged(scenarios_, *benches, messages);
  SuiteResult result{.tested = benches->name, .live = benches->slave != nullptr};
  if (!settings_.target.empty())
    for (Scenario& scenario : scenarios_) {
      scenario.program = benches->of_programs ? settings_.target : "";
      scenario.program_given = benches->of_programs;
    }
  if (watcher.exchange)
    for (std::size_t i = 0; i < scenarios_.size(); ++i)
      benches->of[i].watch = [&, i](const Seen& seen) { watcher.exchange(result, scenarios_[i], seen); };
  try {
    const std::vector<Turn> turns = turns_of(benches->of);
    ParallelRun<ScenarioResult> run(turns.size(), jobs_on(*benches), [&](std::size_t i) {
      return run_turn(scenarios_[turns[i].scenario], benches->of[turns[i].scenario], turns[i].table, settings_.every_scan);
    });
    ScenarioResult of_one;
    run.each(
        [&](std::size_t i, ScenarioResult of_table) {
          const auto& [scenario, table, last] = turns[i];
          const bool banded = benches->of[scenario].band && of_table.outcome != Outcome::Skipped;
          BandResult band = table == 0 ? BandResult{} : of_one.band.value_or(BandResult{});
          if (banded) band.asked = benches->of[scenario].band->size();
          const bool first_failed = banded && add_to(band, of_table, benches->of[scenario].band->table_name(table));
          for (const ProgramCoverage& each : of_table.coverage.programs()) result.coverage.add(each.map, each.tried);
          result.profile.add(of_table.profile, {"", scenarios_[scenario].name, opening_command(scenarios_[scenario])});
          if (table == 0) {
            of_one = std::move(of_table);
          } else if (first_failed) {
            of_one.program = std::move(of_table.program);
            of_one.recordings = std::move(of_table.recordings);
          }
          if (banded) of_one.band = band;
          if (!last && !settings_.stop.stop_requested()) return true;
          if (!settings_.exchanges_wanted) of_one.seen.clear();
          if (of_one.band) {
            judge_robustness(scenarios_[scenario], of_one);
            turn_if_expected_to_fail(scenarios_[scenario], of_one);
          }
          result.reports.push_back({&scenarios_[scenario], std::move(of_one)});
          if (watcher.finished) watcher.finished(result.reports.back());
          return !settings_.stop.stop_requested() && !(settings_.fail_fast && counts_as_failed(result.reports.back()));
        },
        [&](std::size_t i) {
          if (watcher.waiting) watcher.waiting(turns[i].scenario);
        });
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
  const bool live = one_benches->slave || other_benches->slave;
  const Comparison comparison{.timing = !ignore_timing,
                              .tolerance = tolerance_for(tolerance, live),
                              .one_after_other = one_benches->slave && other_benches->slave,
                              .colour = colour};
  const auto side = [&](const Benches& benches, std::size_t i, const std::string& name) {
    return Side{file_name(name), [&, i](const ExchangeListener& listener) {
                  Bench bench = benches.of[i];
                  bench.watch = listener;
                  return run_scenario(scenarios_[i], bench);
                }};
  };
  ComparisonResult all;
  ParallelRun<Compared>(scenarios_.size(), std::min(jobs_on(*one_benches), jobs_on(*other_benches)),
                        [&](std::size_t i) {
                          const std::string& one = settings_.target.empty() ? scenarios_[i].program : one_benches->name;
                          return tools::compare(scenarios_[i], side(*one_benches, i, one),
                                                side(*other_benches, i, other_benches->name), comparison);
                        })
      .each(
          [&](std::size_t, Compared compared) {
            if (settings_.stop.stop_requested()) return false;
            all.scenarios.push_back(std::move(compared));
            if (watcher.finished) watcher.finished(all.scenarios.back());
            return all.same() || !settings_.fail_fast;
          },
          watcher.waiting);
  return all;
}

}  // namespace s7200::tools
