#include "tools/fuzzing/fuzz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tools/fuzzing/oracle.hpp"
#include "tools/trials/chance.hpp"
#include "tools/trials/shortened.hpp"
#include "tools/trials/trial_bench.hpp"

namespace s7200::tools {
namespace {

using Kind = FuzzFinding::Kind;

bool comes_to_a_port(const Stimulus& stimulus) {
  return stimulus.what == Stimulus::What::Frame || stimulus.what == Stimulus::What::Break;
}

/// Sets the port of a scenario to the one that its trial comes to; false if that is both.
bool choose_port(TrialScenario& scenario, const FuzzFinding& finding) {
  bool usual = finding.kind == Kind::Unanswered, other = false;
  for (const Stimulus& stimulus : scenario.trial)
    if (comes_to_a_port(stimulus)) (stimulus.other_port ? other : usual) = true;
  if (other) scenario.port = static_cast<std::uint8_t>(1 - scenario.port);
  return !usual || !other;
}

constexpr Time kSettles = 20 * kMillisecond, kEndlessScan = 600 * kMillisecond;
constexpr std::size_t kMostKept = 4000, kMostFindings = 100, kMostShortening = 6000;
constexpr std::uint64_t kAsksEvery = 512;     ///< runs after which a request is sent, whatever is new
constexpr std::uint64_t kDisturbsEvery = 16;  ///< of stimuli; on average

class Search {
 public:
  Search(const Inspection& inspection, const FuzzSettings& settings)
      : inspection_(inspection),
        settings_(settings),
        oracle_(inspection, settings),
        maker_(words_of(inspection), settings.seed),
        bench_(inspection.program, port()) {}

  FuzzResult result() {
    begin_ = std::chrono::steady_clock::now();
    begin();
    while (!is_over()) one_run();
    result_.host_seconds = seconds();
    const ContactsSeen& contacts = bench_.contacts();
    result_.contacts = contacts.contacts();
    result_.both_ways = contacts.both_ways();
    result_.never = contacts.never();
    result_.snapshots = kept_.size();
    result_.requests = maker_.words().requests.size();
    result_.port = port();
    result_.listens = maker_.words().port.has_value();
    result_.both_ports = maker_.words().both_ports;
    bench_.watch_contacts(false);
    for (FuzzFinding& finding : result_.findings) come_down(finding);
    return std::move(result_);
  }

 private:
  struct Kept {
    TrialBench::Snapshot state;
    Trial trial;
    /// Since the last stimulus was over, to the nanosecond: an instruction ends after the time it was run to.
    Time settled = 0;
  };

  /// What comes over a port is tried there. A panel at a port in PPI mode sets memory.
  static Vocabulary words_of(const Inspection& inspection) {
    Vocabulary words = vocabulary_of(inspection.facts);
    words.requests = answered_requests(inspection.program, words);
    if (words.port && (words.both_ports || inspection.program->model->ports == 1)) words.commands.clear();
    return words;
  }

  std::uint8_t port() const { return maker_.words().port.value_or(0); }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  bool is_over() {
    using End = FuzzResult::End;
    if (settings_.stop.stop_requested())
      result_.end = End::Interrupted;
    else if (settings_.runs != 0 && result_.runs >= settings_.runs)
      result_.end = End::Runs;
    else if ((result_.runs & 15) == 0 && seconds() >= settings_.seconds)
      result_.end = End::Seconds;
    else
      return kept_.empty() || result_.findings.size() >= kMostFindings;
    return true;
  }

  void begin() {
    oracle_.watch_rules(bench_);
    bench_.watch_contacts(true);
    bench_.power_up();
    const State powered_up = bench_.cpu().state();
    first_ = powered_up;
    bench_.run_until(kReady);
    take(oracle_.look(bench_, powered_up), {});
    bench_.contacts().add_run();
    first_ = bench_.cpu().state();
    if (!bench_.stopped() && bench_.time() >= kReady) kept_.push_back({bench_.snapshot(), {}, bench_.time()});
  }

  void one_run() {
    Chance& chance = maker_.chance();
    const std::size_t recent = std::min<std::size_t>(kept_.size(), 16);
    const std::size_t from = chance.one_in(4)   ? 0
                             : chance.one_in(2) ? kept_.size() - 1 - chance.below(recent)
                                                : chance.below(kept_.size());
    Trial given;
    bench_.restore(kept_[from].state);
    const Time before = bench_.time();
    for (std::uint64_t count = chance.one_in(4) ? 2 : 1; count > 0 && !bench_.stopped(); --count) {
      for (Stimulus& next : stimuli()) {
        if (bench_.stopped()) break;
        bench_.apply(next, bench_.time() + next.wait);
        given.push_back(std::move(next));
      }
    }
    const Time over = bench_.time();
    bench_.run_until(over + kSettles);
    maker_.learn(bench_.cpu().state());
    result_.simulated += bench_.time() - before;
    ++result_.runs;
    const bool news = bench_.contacts().add_run();
    auto found = oracle_.look(bench_, kept_[from].state.cpu);
    if (news || !found.empty() || result_.runs % kAsksEvery == 0)
      look_closer(from, std::move(given), std::move(found), news, over);
    if (settings_.progress) settings_.progress(result_.runs);
  }

  Trial stimuli() {
    Chance& chance = maker_.chance();
    const Vocabulary& words = maker_.words();
    Trial next;
    if (chance.one_in(kDisturbsEvery))
      next = {maker_.disturbance()};
    else if (words.port && !chance.one_in(5))
      next = {maker_.frame()};
    else
      next = maker_.next(bench_.cpu().state());
    for (Stimulus& stimulus : next) stimulus.other_port = words.both_ports && comes_to_a_port(stimulus) && chance.one_in(3);
    return next;
  }

  /// `over`: when the last stimulus was over.
  void look_closer(std::size_t from, Trial given, std::vector<FuzzFinding> found, bool news, Time over) {
    Trial trial = kept_[from].trial;
    given.front().wait += kept_[from].settled;
    trial.insert(trial.end(), given.begin(), given.end());
    const bool clean = found.empty();
    take(std::move(found), trial);
    if (bench_.stopped() || !clean) return;
    const auto after = bench_.snapshot();
    if (news && kept_.size() < kMostKept) {
      kept_.push_back({after, trial, bench_.time() - over});
      for (const Stimulus& stimulus : given)
        if (stimulus.what == Stimulus::What::Frame) maker_.remember(stimulus.bytes);
    }
    if (maker_.words().requests.empty()) return;
    bench_.watch_contacts(false);
    FuzzFinding silent{.kind = Kind::Unanswered, .request = maker_.words().requests.front()};
    if (!knows(silent) && oracle_.is_silent(bench_, silent.request)) {
      silent.what = fmt::format("a request that was answered before is not answered within {} any more: {:02x}",
                                format_duration(settings_.answers_within), fmt::join(silent.request, " "));
      take({std::move(silent)}, trial);
    }
    bench_.watch_contacts(true);
  }

  bool knows(const FuzzFinding& finding) const {
    return std::ranges::any_of(result_.findings, [&](const FuzzFinding& known) { return known.same_as(finding); });
  }

  void take(std::vector<FuzzFinding> found, const Trial& trial) {
    for (FuzzFinding& finding : found) {
      finding.trial = trial;
      if (finding.kind == Kind::Write && !find_writer(finding)) continue;
      if (!knows(finding)) result_.findings.push_back(std::move(finding));
    }
  }

  /// Runs the trial of a write again. False if no instruction has done it.
  bool find_writer(FuzzFinding& finding) {
    TrialBench bench(inspection_.program, port());
    bench.power_up();
    bench.watch_writes(finding.place, 0xFF, {});
    bench.apply(finding.trial);
    bench.run_until(bench.time() + (finding.trial.empty() ? kReady : kSettles));
    finding.op = bench.last_writer();
    return finding.op.has_value();
  }

  /// Runs a trial from power-up; whether it leads to the finding.
  bool leads_to(const Trial& trial, const FuzzFinding& finding) {
    bench_.power_up();
    begun_ = bench_.apply(trial);
    const Time settles = finding.kind == Kind::Fatal ? kEndlessScan : kSettles;
    bench_.run_until(bench_.time() + (trial.empty() ? kReady : settles));
    if (finding.kind == Kind::Unanswered)
      return !bench_.stopped() && bench_.time() >= kReady && oracle_.is_silent(bench_, finding.request);
    for (FuzzFinding& found : oracle_.look(bench_, State{})) {
      if (found.kind == Kind::Write) {
        if (finding.kind != Kind::Write || bench_.cpu().state().image[finding.place] == first_.image[finding.place])
          continue;
        found.trial = trial;
        found.place = finding.place;
        find_writer(found);
      }
      if (found.same_as(finding)) return true;
    }
    return false;
  }

  /// Shortens its trial, and says when it comes.
  void come_down(FuzzFinding& finding) {
    finding.trial = shortened(
        finding.trial, [&](const Trial& trial) { return leads_to(trial, finding); }, kMostShortening);
    finding.comes_again = leads_to(finding.trial, finding);
    finding.begun = begun_;
    finding.at = bench_.time();
    if (!finding.comes_again) return;
    if (finding.kind == Kind::Error)
      for (const RuntimeError& error : bench_.cpu().state().errors)
        if (error.count > 0 && error.code == finding.code && error.op == finding.op.value_or(kNoRoutine))
          finding.at = error.first;
    finding.end = oracle_.end_of_scenario(finding, bench_, first_);
  }

  const Inspection& inspection_;
  const FuzzSettings& settings_;
  Oracle oracle_;
  TrialMaker maker_;
  TrialBench bench_;
  std::vector<Kept> kept_;
  State first_;  // when the program is ready
  std::vector<Time> begun_;
  FuzzResult result_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

FuzzResult fuzz(const Inspection& inspection, const FuzzSettings& settings) { return Search(inspection, settings).result(); }

Result<std::string> finding_scenario(const Inspection& inspection, const FuzzResult& result, const FuzzFinding& finding,
                                     const std::string& path, const ScenarioOrigin& origin) {
  if (!finding.comes_again) return Trouble{"it did not come again when its inputs were given from power-up"};
  if (finding.end.empty()) return Trouble{"no address of the rule can be expected to have another value"};
  TrialScenario scenario{.name = finding.what, .origin = origin, .port = result.port, .trial = finding.trial};
  scenario.begun = finding.begun;
  scenario.end = finding.end;
  if (!choose_port(scenario, finding))
    return Trouble{"it needs both ports, and a scenario of one program has a line at one of them"};
  const std::string text = scenario_text(scenario, *inspection.program);
  const auto findings = findings_of(text, path, inspection.program);
  if (!findings) return findings.trouble();
  if (!findings->empty()) return text;
  return Trouble{"on a line with levels it does not come to it"};
}

}  // namespace s7200::tools
