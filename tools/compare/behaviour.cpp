#include "tools/compare/behaviour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>

#include "tools/scenario/transcripts/transcript_writer.hpp"
#include "tools/trials/chance.hpp"
#include "tools/trials/shortened.hpp"
#include "tools/trials/trial_bench.hpp"
#include "tools/trials/trial_scenario.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kPoints = 8 * image::kPointBytes, kMostKept = 2000, kMostShortening = 600;
constexpr std::uint64_t kLeastRuns = 400;
constexpr Time kSettles = 100 * kMillisecond, kAnswers = 400 * kMillisecond, kJitter = 2 * kMillisecond;
constexpr std::size_t kMostStimuli = 20'000;  ///< of all trials while a difference is made shorter
constexpr int kLater = 4, kLonger = 3;  ///< times that a difference is tried again with later inputs, with longer ones

using Edges = std::array<std::vector<Time>, kPoints>;

/// When each output point changes; all are off at first.
Edges edges_of(const Done& done) {
  Edges edges;
  std::array<std::uint8_t, image::kPointBytes> points{};
  for (const Done::Output& output : done.outputs) {
    const auto changed = static_cast<std::uint8_t>(points[output.byte] ^ output.points);
    points[output.byte] = output.points;
    for (unsigned bit = 0; bit < 8; ++bit)
      if (changed >> bit & 1) edges[8 * output.byte + bit].push_back(output.at);
  }
  return edges;
}

std::string hex(const std::vector<std::uint8_t>& bytes) { return fmt::format("{:02x}", fmt::join(bytes, " ")); }

class Pair {
 public:
  Pair(const Inspection& older, const Inspection& newer, std::uint8_t port, const std::vector<MemoryRange>& watched)
      : older_(older), newer_(newer), watched_(watched), old_bench(older.program, port), new_bench(newer.program, port) {}

  struct State {
    TrialBench::Snapshot older, newer;
    Trial trial;
    std::vector<Time> begun;
    Time settled = 0;  ///< what has gone by since the last stimulus was over
  };

  void power_up() {
    old_bench.power_up();
    new_bench.power_up();
    state_ = {};
  }
  void restore(const State& state) {
    old_bench.restore(state.older);
    new_bench.restore(state.newer);
    state_.trial = state.trial;
    state_.begun = state.begun;
    state_.settled = state.settled;
  }
  State state() {
    state_.older = old_bench.snapshot();
    state_.newer = new_bench.snapshot();
    return state_;
  }

  /// Nothing comes sooner than three scans after what was before: what is shorter may be seen or not.
  void apply(Stimulus stimulus) {
    stimulus.wait = std::max(stimulus.wait, slack() - state_.settled);
    const Time at = old_bench.time() + stimulus.wait;
    stimulus.wait += state_.settled;
    state_.settled = 0;
    old_bench.run_until(at);
    const Time begin = old_bench.time();
    old_bench.apply(stimulus, begin);
    new_bench.apply(stimulus, begin);
    state_.trial.push_back(std::move(stimulus));
    state_.begun.push_back(begin);
  }

  void settle() {
    const bool frames = std::ranges::any_of(state_.trial, [](const Stimulus& s) { return s.what == Stimulus::What::Frame; });
    const Time before = old_bench.time();
    const Time end = std::max(before, new_bench.time()) + (frames ? kAnswers : kSettles);
    old_bench.run_until(end);
    new_bench.run_until(end);
    state_.settled += old_bench.time() - before;
    end_ = end;
  }

  /// The whole trial from power-up, with everything later by `later`, and every wait longer by `longer`.
  std::optional<BehaviourDifference> run(const Trial& trial, Time later = 0, Time longer = 0) {
    power_up();
    for (Stimulus stimulus : trial) {
      stimulus.wait += std::exchange(later, 0) + longer;
      apply(std::move(stimulus));
    }
    settle();
    return old_bench.done().interrupted || new_bench.done().interrupted ? std::nullopt : difference();
  }

  /// The first, as far as both have run.
  std::optional<BehaviourDifference> difference() {
    found_.reset();
    compare_outputs();
    compare_sent();
    compare_mode();
    compare_memory();
    if (found_) {
      found_->trial = state_.trial;
      found_->begun = state_.begun;
    }
    return found_;
  }

  Time slack() const { return 3 * scan() + kJitter; }
  Time scan() const { return std::max(old_bench.cpu().state().longest_scan, new_bench.cpu().state().longest_scan); }
  const std::vector<Time>& begun() const { return state_.begun; }

  const Inspection &older_, &newer_;
  const std::vector<MemoryRange>& watched_;
  TrialBench old_bench, new_bench;

 private:
  void find(BehaviourDifference difference) {
    if (!found_ || difference.at < found_->at) found_ = std::move(difference);
  }

  static std::string memory_check(Time at, const std::string& place, const std::string& value) {
    return fmt::format("  - wait: until {}\n  - memory: {{{}: {}}}\n", exact(at), place, value);
  }

  void compare_outputs() {
    const Edges older = edges_of(old_bench.done()), newer = edges_of(new_bench.done());
    for (std::size_t point = 0; point < kPoints; ++point) compare_point(point, older[point], newer[point]);
  }

  void compare_point(std::size_t point, const std::vector<Time>& older, const std::vector<Time>& newer) {
    for (std::size_t n = 0; n < std::max(older.size(), newer.size()); ++n) {
      const Time o = n < older.size() ? older[n] : kNever, w = n < newer.size() ? newer[n] : kNever;
      const Time first = std::min(o, w), second = std::min(std::max(o, w), end_);
      if (second - first <= slack() * static_cast<Time>(n + 1)) {
        if (std::max(o, w) == kNever) return;  // the other one may still come
        continue;
      }
      const bool old_value = (o < w ? n + 1 : n) % 2 == 1;
      const std::vector<Time>& faster = o < w ? older : newer;
      const Time until = n + 1 < faster.size() ? std::min(second, faster[n + 1]) : second;
      const std::string name = fmt::format("Q{}.{}", point / 8, point % 8), value = old_value ? "1" : "0";
      BehaviourDifference found{.at = first, .what = name, .older = value, .newer = old_value ? "0" : "1"};
      found.expectations = {memory_check(first + (until - first) / 2, name, value), memory_check(until - 1, name, value)};
      return find(std::move(found));
    }
  }

  void compare_sent() {
    const auto &older = old_bench.done().sent, &newer = new_bench.done().sent;
    for (std::size_t n = 0; n < std::max(older.size(), newer.size()); ++n) {
      const bool both = n < older.size() && n < newer.size();
      if (both && older[n].byte == newer[n].byte) continue;
      const Time at = std::min(n < older.size() ? older[n].at : kNever, n < newer.size() ? newer[n].at : kNever);
      if (!both && end_ - at < kAnswers / 2) return;  // it may still come
      const auto text = [&](const std::vector<Done::Sent>& sent) {
        return n < sent.size() ? fmt::format("{:02x}", sent[n].byte) : std::string("nothing");
      };
      BehaviourDifference found{.at = at, .what = "the next byte sent", .older = text(older), .newer = text(newer)};
      if (n < older.size()) found.older_op = older[n].op;
      if (n < newer.size()) found.newer_op = newer[n].op;
      expect_sent(found, older, n);
      return find(std::move(found));
    }
  }

  /// The answer to the frame before it, or all that comes by itself.
  void expect_sent(BehaviourDifference& found, const std::vector<Done::Sent>& sent, std::size_t n) const {
    for (std::size_t i = state_.trial.size(); i-- > 0;) {
      if (state_.trial[i].what != Stimulus::What::Frame || state_.begun[i] > found.at) continue;
      std::vector<std::uint8_t> answer;
      for (const Done::Sent& byte : sent)
        if (byte.at >= state_.begun[i]) answer.push_back(byte.byte);
      found.beside.assign(i + 1, "");
      found.beside[i] = "expect: " + (answer.empty() ? "silence" : hex(answer));
      found.expectations = {""};
      return;
    }
    std::string steps;
    std::vector<std::uint8_t> transmission;
    for (std::size_t k = 0; k < sent.size(); ++k) {
      transmission.push_back(sent[k].byte);
      if (k + 1 < sent.size() && sent[k + 1].at - sent[k].at < 3 * old_bench.format().character_time()) continue;
      steps += fmt::format("  - receive: {}\n", k < n ? "any" : hex(transmission));
      if (k >= n) break;
      transmission.clear();
    }
    if (n >= sent.size()) steps += fmt::format("  - receive: silence\n    timeout: {}\n", exact(kAnswers));
    found.expectations = {steps};
  }

  void compare_mode() {
    if (old_bench.stopped() == new_bench.stopped()) return;
    const TrialBench& stopped = old_bench.stopped() ? old_bench : new_bench;
    BehaviourDifference found{.at = stopped.time(), .what = "mode"};
    found.older = old_bench.stopped() ? "STOP" : "RUN";
    found.newer = new_bench.stopped() ? "STOP" : "RUN";
    (old_bench.stopped() ? found.older_op : found.newer_op) = stopped.cpu().state().fatal_op;
    found.expectations = {
        fmt::format("  - wait: until {}\n  - mode: {}\n", exact(end_), old_bench.stopped() ? "stop" : "run")};
    find(std::move(found));
  }

  void compare_memory() {
    if (old_bench.stopped() || new_bench.stopped()) return;
    const auto compare = [&](const std::string& name, std::uint32_t place, std::uint32_t count) {
      std::uint32_t values[2]{};
      for (std::uint32_t i = 0; i < count; ++i) {
        values[0] = values[0] << 8 | old_bench.cpu().state().image[place + i];
        values[1] = values[1] << 8 | new_bench.cpu().state().image[place + i];
      }
      if (values[0] == values[1]) return;
      BehaviourDifference found{.at = end_, .what = name};
      found.older = fmt::format("{}", values[0]);
      found.newer = fmt::format("{}", values[1]);
      found.expectations = {memory_check(end_, name, found.older)};
      find(std::move(found));
    };
    for (std::uint32_t word = 0; word < image::kT - image::kAQ; word += 2)
      compare(place_text(image::kAQ + word, 2), image::kAQ + word, 2);
    for (const MemoryRange& range : watched_)
      for (std::uint32_t i = 0; i < range.count; ++i)
        if (range.width != Width::Bit)
          compare(range.name_of(i), range.at + i * bytes_of(range.width), bytes_of(range.width));
  }

  State state_;
  Time end_ = 0;
  std::optional<BehaviourDifference> found_;
};

class Search {
 public:
  Search(const Inspection& older, const Inspection& newer, const BehaviourSettings& settings)
      : settings_(settings),
        maker_(words_of(older, newer), settings.seed),
        pair_(older, newer, maker_.words().port.value_or(0), settings.watched) {}

  BehaviourResult result() {
    pair_.old_bench.watch_contacts(true);
    pair_.new_bench.watch_contacts(true);
    begin_ = std::chrono::steady_clock::now();
    pair_.power_up();
    pair_.settle();
    look();
    while (result_.end == BehaviourResult::End::Differs && !result_.difference && !is_over()) one_run();
    result_.port = maker_.words().port.value_or(0);
    std::ranges::copy_if(maker_.words().counts, std::back_inserter(result_.beyond),
                         [](std::uint32_t count) { return count > TrialMaker::kMostEdges; });
    std::ranges::sort(result_.beyond);
    count(0, pair_.old_bench.contacts());
    count(1, pair_.new_bench.contacts());
    if (result_.difference) finish();
    return std::move(result_);
  }

 private:
  static Vocabulary words_of(const Inspection& older, const Inspection& newer) {
    Vocabulary words = vocabulary_of(older.facts), others = vocabulary_of(newer.facts);
    words.requests = answered_requests(older.program, words);
    others.requests = answered_requests(newer.program, others);
    words.add(others);
    return words;
  }

  void count(std::size_t side, const ContactsSeen& contacts) {
    result_.contacts[side] = contacts.contacts();
    result_.both_ways[side] = contacts.both_ways();
    result_.never[side] = contacts.never();
  }

  bool is_over() {
    using End = BehaviourResult::End;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    const bool all = pair_.old_bench.contacts().all_both_ways() && pair_.new_bench.contacts().all_both_ways();
    if (settings_.stop.stop_requested())
      result_.end = End::Interrupted;
    else if (result_.runs >= settings_.runs)
      result_.end = End::Runs;
    else if (seconds >= settings_.seconds)
      result_.end = End::Seconds;
    else if (all && result_.runs >= last_news_ + kLeastRuns)
      result_.end = End::AllContacts;
    return result_.end != End::Differs;
  }

  void one_run() {
    Chance& chance = maker_.chance();
    const std::size_t recent = std::min<std::size_t>(kept_.size(), 8);
    if (kept_.empty() || chance.one_in(8))
      pair_.power_up();
    else
      pair_.restore(kept_[chance.one_in(2) ? kept_.size() - 1 - chance.below(recent) : chance.below(kept_.size())]);
    const Time before = pair_.old_bench.time();
    for (std::uint64_t count = 1 + chance.below(3); count > 0; --count)
      for (Stimulus& stimulus : maker_.next(pair_.old_bench.cpu().state()))
        if (!pair_.old_bench.stopped() && !pair_.new_bench.stopped()) pair_.apply(std::move(stimulus));
    pair_.settle();
    maker_.learn(pair_.old_bench.cpu().state());
    result_.simulated += pair_.old_bench.time() - before;
    look();
    if (settings_.progress) settings_.progress(result_.runs);
  }

  void look() {
    ++result_.runs;
    const bool of_older = pair_.old_bench.contacts().add_run(), of_newer = pair_.new_bench.contacts().add_run();
    if (of_older || of_newer) last_news_ = result_.runs;
    auto found = pair_.difference();
    if (found) {
      if (persists(found->trial))
        result_.difference = std::move(found);
      else
        ++result_.timing_alone;
      return;
    }
    const bool goes_on = !pair_.old_bench.stopped() && !pair_.new_bench.stopped();
    if ((of_older || of_newer) && goes_on && kept_.size() < kMostKept) kept_.push_back(pair_.state());
  }

  /// Whether it is there whenever the inputs come.
  bool persists(const Trial& trial) {
    watch(false);
    bool all = pair_.run(trial).has_value();
    for (int i = 1; i <= kLater && all && !trial.empty(); ++i) all = pair_.run(trial, i * pair_.scan() / kLater).has_value();
    for (int i = 1; i <= kLonger && all && !trial.empty(); ++i) all = pair_.run(trial, 0, i * pair_.slack()).has_value();
    watch(true);
    return all;
  }

  void watch(bool on) {
    pair_.old_bench.watch_contacts(on);
    pair_.new_bench.watch_contacts(on);
  }

  void finish() {
    watch(false);
    std::size_t stimuli = 0;
    const auto holds = [&](const Trial& trial) {
      stimuli += trial.size();
      return stimuli < kMostStimuli && persists(trial);
    };
    const Trial shortest = shortened(result_.difference->trial, holds, kMostShortening);
    watch(false);
    auto found = pair_.run(shortest);
    if (!found) return;
    while (!found->begun.empty() && found->begun.back() > found->at && found->beside.empty()) {
      found->begun.pop_back();
      found->trial.pop_back();
    }
    result_.difference = std::move(found);
    if (result_.difference->what.front() == 'Q') find_writers(*result_.difference);
  }

  void find_writers(BehaviourDifference& difference) {
    const auto dot = difference.what.find('.');
    const auto byte = static_cast<std::uint32_t>(std::stoul(difference.what.substr(1, dot - 1)));
    const auto bit = static_cast<unsigned>(std::stoul(difference.what.substr(dot + 1)));
    const Bits bits{(image::kQ + byte) * 8u + bit, 1};
    const auto last_writer = [&](TrialBench& bench, const Inspection& inspection) {
      std::vector<std::uint32_t> writers;
      for (std::uint32_t op = 0; op < inspection.facts.effects.size(); ++op)
        for (const MemoryAccess& access : inspection.facts.effects[op])
          if (access.writes() && !access.by_pointer && access.bits.overlaps(bits)) writers.push_back(op);
      bench.power_up();
      bench.watch_writes(image::kQ + byte, static_cast<std::uint8_t>(1u << bit), writers);
      for (std::size_t i = 0; i < difference.trial.size() && difference.begun[i] <= difference.at; ++i)
        bench.apply(difference.trial[i], difference.begun[i]);
      bench.run_until(difference.at + pair_.scan());
      return bench.last_writer();
    };
    difference.older_op = last_writer(pair_.old_bench, pair_.older_);
    difference.newer_op = last_writer(pair_.new_bench, pair_.newer_);
  }

  const BehaviourSettings& settings_;
  TrialMaker maker_;
  Pair pair_;
  std::vector<Pair::State> kept_;
  BehaviourResult result_;
  std::uint64_t last_news_ = 0;  // the number of the run that has done something new last
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

BehaviourResult compare_behaviour(const Inspection& older, const Inspection& newer, const BehaviourSettings& settings) {
  return Search(older, newer, settings).result();
}

Result<std::string> difference_scenario(const Inspection& older, const Inspection& newer, const BehaviourResult& result,
                                        const std::string& path, const ScenarioOrigin& origin) {
  const BehaviourDifference& difference = *result.difference;
  Trouble none{"the line of a scenario has other times than the characters of the trial"};
  for (const std::string& expectation : difference.expectations) {
    TrialScenario scenario{.name = fmt::format("{} differs", difference.what), .origin = origin, .port = result.port};
    const std::size_t steps = difference.beside.empty() ? difference.trial.size() : difference.beside.size();
    for (std::size_t i = 0; i < steps && difference.begun[i] <= difference.at; ++i) {
      scenario.trial.push_back(difference.trial[i]);
      scenario.begun.push_back(difference.begun[i]);
    }
    scenario.beside = difference.beside;
    scenario.end = expectation;
    const std::string text = scenario_text(scenario, *older.program);
    const auto of_older = findings_of(text, path, older.program);
    const auto of_newer = findings_of(text, path, newer.program);
    if (of_older && of_older->empty() && of_newer && !of_newer->empty()) return text;
    for (const auto* findings : {&of_older, &of_newer})
      if (!*findings) none = findings->trouble();
    if (of_older && !of_older->empty()) none = Trouble{of_older->front()};
  }
  return none;
}

}  // namespace s7200::tools
