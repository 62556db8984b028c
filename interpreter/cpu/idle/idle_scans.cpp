#include "interpreter/cpu/idle/idle_scans.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "interpreter/cpu/execute.hpp"
#include "interpreter/cpu/idle/prediction.hpp"
#include "interpreter/cpu/ports/ppi.hpp"
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units/timers.hpp"

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

/// Whoever watches instructions is told of all of a program, or of none; and of one before and after each event, to see why
/// the program has come there, and what the event has changed.
bool is_watched(const Core& core) { return core.sink() && core.sink()->wants_instructions(); }

bool begins_communication(const Core& core) {
  return core.s.phase == Phase::Communication && core.s.phase_left == core.program().scan_phase[Program::kCommunication];
}

}  // namespace

void IdleScans::forget() {
  known_ = false;
  asked_ = false;
  expected_.reset();
}

bool IdleScans::look(Core& core) {
  if (expected_) compare(core, expected_);
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
  if (!knows_instant(core) || s.time + s.phase_left >= horizon) return 0;
  if (use_ == SteadyScansUse::Check) {
    expect(core, horizon);
    return 0;
  }
  if (is_watched(core)) {
    if (!begins_communication(core)) return 0;
    horizon -= parts_.end;
  }
  const Time before = s.time;
  const std::uint64_t executed = s.instructions;
  if (const Step* const last = move_on(core, s, horizon)) core.loop.op = last->last_op;
  worth_ += s.instructions - executed;
  return s.time - before;
}

bool IdleScans::lie_ahead(const Core& core) {
  const bool may_learn = use_ == SteadyScansUse::Eager || core.s.instructions >= learn_at_;
  if ((!idle_ && !may_learn) || !system_idles(core)) return false;
  if (idle_ && footprint_.same_in(*idle_, core.s)) return knows_instant(core);
  asked_ = may_learn && core.s.phase != Phase::Program;
  return false;
}

/// Whether the state is that of an idle scan at a known instant, if its program is an idle one.
bool IdleScans::knows_instant(const Core& core) const {
  return core.s.phase != Phase::Program || (!is_watched(core) && step_at(core.s) != nullptr);
}

/// The step that the CPU stands at in the program; null if it is not a known one. An op has one for each time that it is
/// executed with the same state: twice would be for ever.
const IdleScans::Step* IdleScans::step_at(const State& s) const {
  const std::uint32_t number = s.call_depth == 0 ? step_of_op_[s.pc] : kNoStep;
  if (number == kNoStep) return nullptr;
  const Step& step = steps_[number - 1];
  return step.stack == s.stack && step.rail == s.rail && step.eno == s.eno ? &step : nullptr;
}

[[gnu::noinline]] void IdleScans::learn(Core& core) {
  State& s = core.s;
  if (s.time >= core.loop.until) return;
  const auto before = std::make_unique<State>(s);
  const Op* const ops = core.program().ops.data();
  const bool touched = std::exchange(core.touched, false);
  Footprint footprint;
  std::vector<Step> steps;
  Step now;
  for (; s.time < core.loop.until; ++now.executed) {
    now = {s.time - before->time, s.pc, core.loop.op, now.executed, s.stack, s.rail, s.eno};
    if (s.call_depth == 0 && footprint.unchanged(*before, s)) steps.push_back(now);
    if (!footprint.add_next(core)) break;
    execute_next(core, ops, core.program().no_power_flow);
  }
  s.instructions += now.executed;
  footprint.complete(core.program());
  const bool idle = is_idle(core, *before, footprint);
  core.touched |= touched;
  const bool was_worth_it = idle && worth_ >= kCost * now.executed;
  patience_ = was_worth_it ? std::max(patience_ / 2, kLeastPatience) : std::min(patience_ * 2, kMostPatience);
  wait_ = patience_ * now.executed;
  learn_at_ = s.instructions + wait_;
  if (idle)
    remember(core, footprint, std::move(steps),
             {s.time - before->time, s.pc, core.loop.op, now.executed, s.stack, s.rail, s.eno});
}

/// Whether the program has ended, and has changed nothing.
bool IdleScans::is_idle(const Core& core, const State& before, const Footprint& footprint) {
  const State& s = core.s;
  const bool has_ended = s.mode == Mode::Run && s.phase == Phase::Communication;
  return has_ended && !core.touched && footprint.same_in(before, s) && !footprint.has_scan_values();
}

void IdleScans::remember(const Core& core, const Footprint& footprint, std::vector<Step> steps, Step end) {
  const auto& part = core.program().scan_phase;
  Parts parts;
  parts.program = part[Program::kReadInputs];
  parts.communication = parts.program + end.at;
  parts.self_test = parts.communication + part[Program::kCommunication];
  parts.write_outputs = parts.self_test + part[Program::kSelfTest];
  parts.end = parts.write_outputs + part[Program::kWriteOutputs];
  if (std::ranges::find(part, 0) != part.end() || parts.end > core.model().watchdog) return;
  footprint_ = footprint;
  parts_ = parts;
  end_ = end;
  steps_ = std::move(steps);
  steps_.front().last_op = end.last_op;  // of the scan before
  step_of_op_.assign(core.program().ops.size(), kNoStep);
  for (std::uint32_t i = 0; i < steps_.size(); ++i) step_of_op_[steps_[i].op] = i + 1;
  worth_ = 0;
  if (!idle_) idle_ = std::make_unique<State>();
  *idle_ = core.s;
}

/// The time since the beginning of the scan, if it is an idle one.
Time IdleScans::position(const State& s) const {
  switch (s.phase) {
    case Phase::ReadInputs:
      return parts_.program - s.phase_left;
    case Phase::Program:
      return parts_.program + step_at(s)->at;
    case Phase::Communication:
      return parts_.self_test - s.phase_left;
    case Phase::SelfTest:
      return parts_.write_outputs - s.phase_left;
    default:
      return parts_.end - s.phase_left;
  }
}

/// The last step before an instant of the program, or its first one: from there on each instruction is executed, and so the
/// CPU stops at the right one, also where several begin at the same instant.
const IdleScans::Step& IdleScans::step_before(Time at) const {
  const auto next = std::ranges::lower_bound(steps_, at, {}, &Step::at);
  return next == steps_.begin() ? *next : *std::prev(next);
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

void IdleScans::set(State& s, const Step& step) {
  s.pc = step.op;
  s.stack = step.stack;
  s.rail = step.rail;
  s.eno = step.eno;
}

/// Moves the state on. Returns the step of the program that was come to, or its end; null if nothing of it was executed.
const IdleScans::Step* IdleScans::move_on(const Core& core, State& s, Time until) const {
  const Time from = position(s), begin = s.time - from;  // of the scan
  const Time scans = (until - begin) / parts_.end;
  Time to = (until - begin) % parts_.end;
  const bool in_program = to >= parts_.program && to < parts_.communication;
  const Step* const step = in_program && !is_watched(core) ? &step_before(to - parts_.program) : nullptr;
  if (in_program) to = step ? parts_.program + step->at : 0;
  const bool watchdog_barks = begin + parts_.end > s.watchdog;
  if ((scans == 0 && to <= from) || watchdog_barks) return nullptr;

  const auto times_past = [&](Time part) { return scans + (to >= part ? 1 : 0) - (from >= part ? 1 : 0); };
  const Time begins = times_past(parts_.program), ends = times_past(parts_.communication);
  const std::uint64_t before = s.phase == Phase::Program ? step_at(s)->executed : 0;
  s.time = begin + scans * parts_.end + to;
  s.instructions += static_cast<std::uint64_t>(ends) * end_.executed + (step ? step->executed : 0) - before;
  if (begins > 0) {
    const Time last = s.time - to + parts_.program - (to >= parts_.program ? 0 : parts_.end);
    const Time by = last - s.previous_scan_begin;
    timers::pass(core, s, by, begins == 1 ? by : parts_.end);
  }
  if (scans > 0) scan::end_alike(core, s, scans, s.time - to, parts_.end);
  if (step) {
    s.phase = Phase::Program;
    s.phase_left = 0;
  } else {
    go_to(s, to);
  }
  const Step* const reached = step ? step : ends > 0 ? &end_ : nullptr;
  if (reached) set(s, *reached);
  return reached;
}

void IdleScans::expect(const Core& core, Time horizon) {
  if (expected_ || (expectations_++ >= kCheckEvery && expectations_ % kCheckEvery != 0)) return;
  expected_ = std::make_unique<State>(core.s);
  move_on(core, *expected_, horizon - 1);  // so that it comes before whatever happens then
  if (expected_->time <= core.s.time) expected_.reset();
}

}  // namespace s7200
