#include "interpreter/cpu/steady_scans.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "interpreter/cpu/idle/idle_scans.hpp"
#include "interpreter/cpu/idle/prediction.hpp"
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units/clock.hpp"
#include "interpreter/cpu/units/timers.hpp"

namespace s7200 {
namespace {

/// The furthest that one step goes, so that no time overflows in a run that nothing limits.
constexpr Time kFurthest = 24 * 3600 * kSecond;

/// Instructions after which it is asked again whether a look is worth it.
constexpr std::uint64_t kAskAgain = 1'000;

/// The cost to the host of the parts of a scan other than the program, in instructions of the program.
constexpr std::uint64_t kBesides = 40;

/// Instructions until the horizon, at the rate so far, with what the scans cost besides.
double to_come(const State& s, Time horizon) {
  const auto done = static_cast<double>(s.instructions + kBesides * s.scans);
  return done / static_cast<double>(std::max<Time>(s.time, 1)) * static_cast<double>(horizon - s.time);
}

/// The instant until which scans that are alike stay alike, whatever comes from outside.
Time next_change(const Core& core) {
  const State& s = core.s;
  const Looks& looks = core.program().looks;
  Time next = timers::next_change(core);
  if (looks.clock_bits) next = std::min(next, s.next_clock);
  if (looks.time_of_day) next = std::min(next, clock::next_second(core));
  return next == kNever ? kNever : next - 1;
}

bool may_pass(const Core& core) {
  const TraceSink* const sink = core.sink();
  return core.s.mode == Mode::Run && !core.loop.pause_at_scan_end && !core.program().looks.every_scan &&
         !(sink && sink->wants_scans());
}

}  // namespace

SteadyScans::SteadyScans() : idle_(std::make_unique<IdleScans>(use_)) {}
SteadyScans::~SteadyScans() = default;

void SteadyScans::use(SteadyScansUse use) {
  idle_ = std::make_unique<IdleScans>(use);
  use_ = use;
  known_ = Known::Nothing;
  look_at_ = use == SteadyScansUse::Off ? std::numeric_limits<std::uint64_t>::max() : 0;
  stake_ = kFirstStake;
  expected_.reset();
}

void SteadyScans::move_on(const Core& core, State& s, std::uint64_t pairs) const {
  const Time by = static_cast<Time>(pairs) * length_;
  s.time += by;
  s.watchdog += by;
  s.scans += 2 * pairs;
  s.instructions += pairs * instructions_;
  scan::pass(core, s, by);
  timers::pass(core, s, by, second_);
}

bool SteadyScans::learns(const State& s) const { return idle_->learns(s); }
void SteadyScans::learn(Core& core) { idle_->learn(core); }
Time SteadyScans::stop_at() const { return idle_->stop_at(); }

Time SteadyScans::alike_until(const Core& core) const {
  if (idle_->known(core)) return std::min(idle_->next_change(), core.next_event());
  return known_ == Known::Pair && !core.touched ? std::min(change_, core.next_event()) : core.s.time;
}

/// Whether idle scans follow from here. Then pairs are not looked for.
bool SteadyScans::is_idle(Core& core) {
  if (!may_pass(core))
    idle_->forget();
  else if (idle_->look(core)) {
    known_ = Known::Nothing;
    expected_.reset();
    return true;
  }
  return false;
}

Time SteadyScans::look_ahead(Core& core) {
  if (use_ != SteadyScansUse::Off) is_idle(core);
  return alike_until(core);
}

/// Not inlined, so that the parts of a scan are inlined where it is called.
[[gnu::noinline]] Time SteadyScans::pass_over(Core& core, Time limit) {
  if (use_ == SteadyScansUse::Off) return 0;
  if (is_idle(core)) {
    const Time passed = idle_->pass_over(core, std::min({limit, core.next_event(), core.s.time + kFurthest}));
    passed_ += passed;
    return passed;
  }
  const bool looks = known_ != Known::Nothing || core.s.instructions >= look_at_;
  return core.s.phase == Phase::Communication && looks ? go_on(core, limit) : 0;
}

Time SteadyScans::go_on(Core& core, Time limit) {
  if (core.s.phase_left != core.program().scan_phase[Program::kCommunication]) return 0;  // a run ended in the middle of it
  if (!may_pass(core)) {
    known_ = Known::Nothing;
    expected_.reset();
    look_at_ = core.s.instructions + kAskAgain;
    return 0;
  }
  if (expected_) check(core);
  const Time change = next_change(core);
  const Time horizon = std::min({limit, core.next_event(), change, core.s.time + kFurthest});
  // The expected change has happened, so the pair no longer describes the scans after it. A timer that is reset in every
  // scan shifts the change without ever reaching it.
  const bool ended = core.touched || (known_ != Known::Nothing && change != change_);
  if (ended && is_looking()) {
    in_vain(core);  // as in a program that switches an output, or has a timer on, in every second scan
    return 0;
  }
  if (ended) known_ = Known::Nothing;
  switch (known_) {
    case Known::Nothing:
      change_ = change;
      begin_look(core, horizon);
      return 0;
    case Known::Before:
      middle_ = core.s.previous_scan_begin;
      known_ = Known::Middle;
      if (core.s.timer != before_->timer) in_vain(core);  // one that is on in every second scan counts ticks
      return 0;
    case Known::Middle:
      end_look(core);
      return known_ == Known::Pair ? pass(core, horizon) : 0;
    case Known::Pair:
      break;
  }
  return (core.s.scans - before_->scans) % 2 == 0 ? pass(core, horizon) : 0;
}

void SteadyScans::begin_look(const Core& core, Time horizon) {
  if (use_ != SteadyScansUse::Eager && to_come(core.s, horizon) < static_cast<double>(stake_)) {
    look_at_ = core.s.instructions + kAskAgain;
    return;
  }
  if (!before_) before_ = std::make_unique<State>();
  *before_ = core.s;
  core.touched = false;
  known_ = Known::Before;
  ++looks_;
}

void SteadyScans::end_look(const Core& core) {
  length_ = core.s.time - before_->time;
  second_ = core.s.previous_scan_begin - middle_;
  instructions_ = core.s.instructions - before_->instructions;
  move_on(core, *before_, 1);
  if (*before_ == core.s) {
    known_ = Known::Pair;
    stake_ = std::max(stake_ / 2, kLeastStake);
  } else {
    in_vain(core);
  }
}

void SteadyScans::in_vain(const Core& core) {
  known_ = Known::Nothing;
  if (use_ == SteadyScansUse::Eager) return;
  look_at_ = core.s.instructions + stake_;
  stake_ = std::min(2 * stake_, kMostStake);
}

Time SteadyScans::pass(Core& core, Time horizon) {
  const Time before = core.s.time;
  const auto pairs = static_cast<std::uint64_t>(std::max<Time>(horizon - before, 0) / length_);
  if (pairs == 0 || expected_) return 0;
  if (use_ == SteadyScansUse::Check) {
    expected_ = std::make_unique<State>(core.s);
    move_on(core, *expected_, pairs);
    return 0;
  }
  move_on(core, core.s, pairs);
  passed_ += core.s.time - before;
  return core.s.time - before;
}

void SteadyScans::check(const Core& core) { compare(core, expected_); }

}  // namespace s7200
