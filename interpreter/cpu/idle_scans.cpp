#include "interpreter/cpu/idle_scans.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "interpreter/cpu/execute.hpp"
#include "interpreter/cpu/ppi.hpp"
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/timers.hpp"

namespace s7200 {
namespace {

bool same_points(const State& s, std::uint32_t points, std::uint32_t image) {
  return std::memcmp(&s.image[points], &s.image[image], image::kPointBytes) == 0;
}

/// Whether the system's part of the scans from here on does nothing but spend its time, and nothing in it depends on how
/// far the CPU's clock is off.
bool system_idles(const Core& core) {
  const State& s = core.s;
  constexpr std::uint8_t kOneScan = sm::kFirstScan | sm::kRetentiveLost | sm::kFromPowerUp;
  return (s.image[sm::kScanStatus] & kOneScan) == 0 && same_points(s, image::kInputs, image::kI) &&
         same_points(s, image::kOutputs, image::kQ) && std::ranges::none_of(s.ppi, ppi::waits) &&
         std::ranges::none_of(s.network, [](const NetworkPort& port) { return port.count != 0; }) && !s.forcing.any &&
         !s.stop_after_scan && s.phase != Phase::SaveToEeprom && (s.image[sm::kEepromRequest] & sm::kSave) == 0 &&
         !timers::any_counts(core) && core.by_own_clock(kSecond) == kSecond;
}

}  // namespace

void IdleScans::forget() {
  known_ = false;
  asked_ = false;
  expected_.reset();
}

bool IdleScans::look(Core& core) {
  if (expected_) check(core);
  if (known(core)) return true;
  const bool follow = lie_ahead(core);
  change_ = footprint_.has_clock_bits() ? core.s.next_clock - 1 : kNever;
  known_ = follow && core.s.time <= change_;
  if (known_) core.touched = false;
  return known_;
}

Time IdleScans::pass_over(Core& core, Time horizon) {
  State& s = core.s;
  learn_at_ = s.instructions + wait_;
  horizon = std::min(horizon, change_);
  if (s.time + s.phase_left >= horizon) return 0;
  if (use_ == SteadyScansUse::Check) {
    expect(core, horizon);
    return 0;
  }
  const Time before = s.time;
  const std::uint64_t executed = s.instructions;
  move_on(core, s, horizon);
  worth_ += s.instructions - executed;
  return s.time - before;
}

bool IdleScans::lie_ahead(const Core& core) {
  const bool may_learn = use_ == SteadyScansUse::Eager || core.s.instructions >= learn_at_;
  if ((!idle_ && !may_learn) || !system_idles(core)) return false;
  if (idle_ && footprint_.same_in(*idle_, core.s)) return true;
  asked_ = may_learn;
  return false;
}

void IdleScans::learn(Core& core) {
  if (core.s.time >= core.loop.until) return;
  const auto before = std::make_unique<State>(core.s);
  const Op* const ops = core.program().ops.data();
  Footprint footprint;
  std::uint64_t executed = 0;
  const bool touched = std::exchange(core.touched, false);
  for (; core.s.time < core.loop.until && footprint.add_next(core); ++executed)
    execute_next(core, ops, core.program().no_power_flow);
  core.s.instructions += executed;
  footprint.complete(core.program());
  const bool idle = is_idle(core, *before, footprint);
  core.touched |= touched;
  patience_ =
      idle && worth_ >= kCost * executed ? std::max(patience_ / 2, kLeastPatience) : std::min(patience_ * 2, kMostPatience);
  wait_ = patience_ * executed;
  learn_at_ = core.s.instructions + wait_;
  if (idle) remember(core, footprint, core.s.time - before->time, executed);
}

/// Whether the program has ended, and has changed nothing.
bool IdleScans::is_idle(const Core& core, const State& before, const Footprint& footprint) {
  const State& s = core.s;
  const bool has_ended = s.mode == Mode::Run && s.phase == Phase::Communication;
  return has_ended && !core.touched && footprint.same_in(before, s) && !footprint.has_scan_values();
}

void IdleScans::remember(const Core& core, const Footprint& footprint, Time time, std::uint64_t instructions) {
  const auto& part = core.program().scan_phase;
  Parts parts;
  parts.program = part[Program::kReadInputs];
  parts.communication = parts.program + time;
  parts.self_test = parts.communication + part[Program::kCommunication];
  parts.write_outputs = parts.self_test + part[Program::kSelfTest];
  parts.end = parts.write_outputs + part[Program::kWriteOutputs];
  if (std::ranges::find(part, 0) != part.end() || parts.end > core.model().watchdog) return;
  footprint_ = footprint;
  parts_ = parts;
  instructions_ = instructions;
  worth_ = 0;
  if (!idle_) idle_ = std::make_unique<State>();
  *idle_ = core.s;
}

/// The time since the beginning of the scan, if it is an idle one.
Time IdleScans::position(const State& s) const {
  switch (s.phase) {
    case Phase::ReadInputs:
      return parts_.program - s.phase_left;
    case Phase::Communication:
      return parts_.self_test - s.phase_left;
    case Phase::SelfTest:
      return parts_.write_outputs - s.phase_left;
    default:
      return parts_.end - s.phase_left;
  }
}

/// `position` is not in the program.
void IdleScans::go_to(State& s, Time position) const {
  const auto in = [&](Phase phase, Time end) {
    s.phase = phase;
    s.phase_left = end - position;
  };
  if (position < parts_.program) return in(Phase::ReadInputs, parts_.program);
  if (position < parts_.self_test) return in(Phase::Communication, parts_.self_test);
  if (position < parts_.write_outputs) return in(Phase::SelfTest, parts_.write_outputs);
  in(Phase::WriteOutputs, parts_.end);
}

void IdleScans::move_on(const Core& core, State& s, Time until) const {
  const Time from = position(s), begin = s.time - from;  // of the scan
  const Time scans = (until - begin) / parts_.end;
  Time to = (until - begin) % parts_.end;
  if (to >= parts_.program && to < parts_.communication) to = 0;  // that program is executed
  const bool watchdog_barks = begin + parts_.end > s.watchdog;
  if ((scans == 0 && to <= from) || watchdog_barks) return;
  const Time programs = scans + (to >= parts_.communication ? 1 : 0) - (from >= parts_.communication ? 1 : 0);
  s.time = begin + scans * parts_.end + to;
  go_to(s, to);
  if (programs > 0) {
    const Time last = s.time - to + parts_.program - (to >= parts_.communication ? 0 : parts_.end);
    const Time by = last - s.previous_scan_begin;
    timers::pass(core, s, by, programs == 1 ? by : parts_.end);
    s.instructions += static_cast<std::uint64_t>(programs) * instructions_;
    s.stack = idle_->stack;
    s.rail = idle_->rail;
    s.eno = idle_->eno;
    s.pc = idle_->pc;
  }
  if (scans > 0) scan::end_alike(core, s, scans, s.time - to, parts_.end);
}

void IdleScans::expect(const Core& core, Time horizon) {
  if (expected_ || (expectations_++ >= kCheckEvery && expectations_ % kCheckEvery != 0)) return;
  expected_ = std::make_unique<State>(core.s);
  move_on(core, *expected_, horizon - 1);  // so that it comes before whatever happens then
  if (expected_->time <= core.s.time) expected_.reset();
}

void IdleScans::check(const Core& core) {
  if (!core.touched && core.s.time < expected_->time) return;
  if (!core.touched && !(core.s == *expected_))
    std::abort();  // a bug of ours: the prediction is not what the CPU does; also where assertions are off
  expected_.reset();
}

}  // namespace s7200
