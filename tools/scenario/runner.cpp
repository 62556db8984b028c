#include "tools/scenario/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tools/plan/plc_keys.hpp"
#include "tools/scenario/reporting/explanation.hpp"
#include "tools/scenario/run.hpp"

namespace s7200::tools {

using Outcome = ScenarioResult::Outcome;

Run::Run(const Scenario& scenario, const Bench& bench) : scenario_(scenario), bench_(bench) {
  if (bench.make_slave) own_ = bench.make_slave(scenario);
  if (bench.slave || own_) return;
  if (scenario.is_of_peers())
    join_lines();
  else
    plant_ = std::make_unique<Plant>(scenario, bench.program, bench.stop, bench.observed);
}

void Run::join_lines() {
  auto lines = tools::join_lines(*scenario_.plan, *first_askable_line(*scenario_.plan), scenario_.line, scenario_.after,
                                 scenario_.system, bench_.stop);
  lines_ = lines.get();
  own_ = std::move(lines);
}

ScenarioResult Run::result() {
  if (!plant_) {
    if (const std::string what = acted_inside(); !what.empty())
      return {.outcome = Outcome::Skipped, .reason = "needs a program in simulation: " + what};
    slave().forget_unasked();
  }
  begin_ = in_simulation() ? 0 : slave().now();
  if (plant_ && !plant_->get_ready()) {
    add({.what = "ready",
         .expected = fmt::format("the first scan ended and the line quiet within {}", format_duration(kReadyWithin)),
         .found = "that never came; 'after: TIME' begins all the same",
         .of_run = true});
  } else {
    for (; step_ < scenario_.steps.size() && goes_on(); ++step_) do_step(scenario_.steps[step_]);
    look_at_mode();
  }
  result_.time = plant_ ? plant_->time() : slave().now() - begin_;
  if (plant_ && (bench_.recordings_wanted || !result_.findings.empty())) {
    result_.recordings = plant_->recordings();
    result_.spots = plant_->spots();
  }
  if (plant_) plant_->report(result_.coverage, result_.profile);
  if (!scenario_.plan) result_.program = bench_.program;
  settle_outcome();
  return std::move(result_);
}

void Run::settle_outcome() {
  if (!result_.findings.empty()) result_.outcome = Outcome::Failed;
  if (bench_.stop.stop_requested()) {
    result_.outcome = Outcome::Skipped;
    result_.reason = "interrupted";
  }
  if (result_.skipped_steps > 0 && result_.skipped_steps == scenario_.step_count()) {
    result_.outcome = Outcome::Skipped;
    result_.reason = "nothing of it can be tried on " + slave().name();
  } else if (!scenario_.rule.id.empty() && result_.outcome == Outcome::Passed &&
             (result_.skipped_steps > 0 || times_unjudged_)) {
    result_.outcome = Outcome::Skipped;
    result_.reason = fmt::format("{} cannot be judged on {}", times_unjudged_ ? "its times" : "all of it", slave().name());
  }
  if (!lost_ && !bench_.band) turn_if_expected_to_fail(scenario_, result_);
}

/// What of the scenario only a program in simulation can be done to; empty if there is nothing.
std::string Run::acted_inside() const {
  if (lines_) return "";
  if (scenario_.plan) return "it is about a system of PLCs";
  if (!scenario_.plc.set.empty() || says_anything(scenario_.plc, PlcKey::Stage::Program))
    return "it sets memory, clock or inputs";
  const auto step = std::find_if(scenario_.steps.begin(), scenario_.steps.end(),
                                 [](const Step& s) { return s.action->needs() >= Needs::ToChange; });
  return step == scenario_.steps.end() ? "" : fmt::format("line {}, '{}'", step->position.line, step->key);
}

bool Run::goes_on() const { return !bench_.stop.stop_requested() && !lost_; }

void Run::do_step(const Step& step) {
  turn_ = 0;
  if (plant_ && step.spot) plant_->look_at(*step.spot);
  if (lines_ && step.line) lines_->look_at(*step.line);
  if (!plant_ && step.action->needs() == Needs::ToLook)
    skip_step();
  else
    step.action->act(*this);
}

/// What an interruption cut short has found nothing, and is no exchange as it would have gone.
void Run::add(Finding finding) {
  if (bench_.stop.stop_requested()) return;
  if (!scenario_.steps.empty()) finding.step = std::min(step_, scenario_.steps.size() - 1);
  if (plant_) finding.place = plant_->place();
  if (plant_) finding.station = finding.exchange ? plant_->station_on_line() : plant_->plc_number();
  const bool names_plc = plant_ && finding.what.find(plant_->of_plc("")) != std::string::npos;
  if (step_ < scenario_.steps.size() && !scenario_.steps[step_].on.empty() && !names_plc)
    finding.what += " of " + scenario_.steps[step_].on;
  result_.findings.push_back(std::move(finding));
}

void Run::add_exchange(Finding finding) {
  const serial::Exchange& exchange = *finding.exchange;
  const bool shown = exchange.response.empty() || exchange.response_start >= exchange.request_start;
  if (plant_ && shown && result_.findings.size() < kFindingsShown) finding.timeline = plant_->timeline(exchange);
  add(std::move(finding));
}

void Run::keep(const serial::Exchange& exchange) {
  if (bench_.stop.stop_requested()) return;
  if (bench_.watch) return bench_.watch({step_, turn_, exchange});
  if (bench_.exchanges_wanted) result_.seen.push_back({step_, turn_, exchange});
}

void Run::lose_slave(const std::string& why) {
  lost_ = true;
  add({.what = "slave", .expected = "that it stays there", .found = why, .of_run = true});
}

/// A STOP that no step expected is a failure.
void Run::look_at_mode() {
  for (std::size_t plc = 0; plant_ && plc < plant_->plcs(); ++plc) {
    if (modes_expected_.contains(plc) || !plant_->is_in_stop(plc)) continue;
    const std::string name = plant_->name_of(plc);
    add({.what = "mode at the end" + (name.empty() ? "" : " of " + name),
         .expected = "RUN, or a step 'mode: stop' or 'fatal:'",
         .found = "STOP" + plant_->why_stopped(plc)});
  }
}

void add_remark(std::string& words, std::string_view remark) { words.append(words.empty() ? "" : ", ").append(remark); }

std::optional<Time> latency_of(const serial::Exchange& exchange) {
  const auto latency = exchange.latency();
  return latency && exchange.request.empty() ? std::max<Time>(0, *latency) : latency;
}

void turn_if_expected_to_fail(const Scenario& scenario, ScenarioResult& result) {
  if (scenario.expected_failure.empty()) return;
  if (result.outcome == Outcome::Failed) {
    result.outcome = Outcome::ExpectedFailure;
    result.reason = scenario.expected_failure;
  } else if (result.outcome == Outcome::Passed) {
    result.outcome = Outcome::Failed;
    result.findings.push_back({.what = "outcome",
                               .expected = "a failure: " + scenario.expected_failure,
                               .found = "it passes although it is an expected failure: remove the mark"});
  }
}

namespace {

ScenarioResult could_not_begin(const std::string& why) {
  return {.outcome = Outcome::Failed,
          .findings = {{.what = "program", .expected = "a program that can be run", .found = why, .of_run = true}}};
}

}  // namespace

ScenarioResult run_scenario(const Scenario& scenario, const Bench& bench) {
  if (!scenario.skipped.empty()) return {.outcome = Outcome::Skipped, .reason = scenario.skipped};
  if (!bench.problem.empty()) return could_not_begin(bench.problem);
  const auto begin = std::chrono::steady_clock::now();
  ScenarioResult result = Run(scenario, bench).result();
  if (result.outcome == Outcome::Failed && !bench.band) explain(scenario, bench.program, bench.stop, result);
  result.host_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace s7200::tools
