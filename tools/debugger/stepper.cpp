#include "tools/debugger/stepper.hpp"

#include <algorithm>


namespace s7200::tools {

Stepper::Stepper(serial::Simulation& simulation, History& history, const std::atomic<bool>* stop_request)
    : on_record([](const TraceRecord&) {}),
      on_instruction([](const InstructionRecord&, bool) {}),
      on_answer([](const serial::Exchange&) {}),
      simulation_(simulation),
      history_(history),
      stop_request_(stop_request) {}

Stop Stepper::run(const Goal& goal, Time limit, bool stop_at_answer) {
  const State& state = simulation_.cpu().state();
  goal_ = goal;
  limit_ = limit;
  stop_at_answer_ = stop_at_answer;
  standing_ = standing_at(state).has_value();
  start_op_ = state.pc;
  started_in_interrupt_ = state.in_interrupt;
  executing_start_ = reached_start_ = false;
  progress_ = {.executed = 0, .left = !standing_};
  begin_watching();
  const serial::Halt halt = history_.run(*this);
  if (halt == serial::Halt::Stopped) stop_.reason = StopReason::CpuStopped;
  if (halt == serial::Halt::Request) stop_.reason = StopReason::Request;
  return stop_;
}

Stop Stepper::run_back(const Goal& goal, std::uint64_t count, bool stop_at_answer) {
  const Moment start = history_.now();
  goal_ = goal;
  limit_ = kNever;
  stop_at_answer_ = stop_at_answer;
  standing_ = false;
  progress_ = {.executed = 1, .left = true};
  backwards_ = true;
  first_place_.reset();
  std::optional<Found> there;
  std::optional<Moment> end;  // where the part that is played ends: the first place of the part played before it
  const auto begin = [&] {
    if (first_place_) end = first_place_;
    first_place_.reset();
    found_.clear();
    begin_watching();
  };
  const auto found = [&] {
    if (const auto reason = end ? reason_between() : std::nullopt) {
      stop_.reason = *reason;
      there = Found{*end, stop_};
    }
    for (auto last = found_.rbegin(); last != found_.rend() && !there; ++last)
      if (last->stop || --count == 0) there = std::move(*last);
    return there.has_value();
  };
  const History::Search search = history_.search_back(*this, start, begin, found);
  backwards_ = false;
  found_ = {};
  if (search == History::Search::Interrupted) {
    history_.go_to(start);
    return {.reason = StopReason::Request};
  }
  if (!there) return {.reason = StopReason::Oldest};
  history_.go_to(there->moment);
  return there->stop.value_or(Stop{.reason = StopReason::Goal});
}

void Stepper::begin_watching() {
  stop_ = {};
  awaiting_answer_ = simulation_.master().busy();
  for (Watch& watch : watches) watch.value = watch.range.bytes_in(simulation_.cpu().state().image);
}

void Stepper::acted() {
  awaiting_answer_ |= simulation_.master().busy();
  for (Watch& watch : watches) watch.value = watch.range.bytes_in(simulation_.cpu().state().image);
}

void Stepper::record(const TraceRecord& record) {
  if (!backwards_) on_record(record);
}

bool Stepper::before(std::uint32_t op) {
  note_changes(nullptr);
  if (backwards_) return note_place(op);
  const bool in_interrupt = simulation_.cpu().state().in_interrupt;
  const bool at_start = !reached_start_ && op == start_op_ && in_interrupt == started_in_interrupt_;
  if (const auto reason = reason_to_stop(op, at_start)) {
    stop_.reason = *reason;
    return false;
  }
  executing_start_ = at_start;
  if (at_start) reached_start_ = progress_.left = true;
  return true;
}

bool Stepper::note_place(std::uint32_t op) {
  if (asked_to_stop()) return false;
  if (!first_place_) first_place_ = history_.in_front();
  if (const auto reason = reason_to_stop(op, false)) {
    stop_.reason = *reason;
    const bool goal = *reason == StopReason::Goal && stop_.changes.empty();
    found_.push_back({history_.in_front(), goal ? std::nullopt : std::optional(stop_)});
  }
  stop_ = {};
  return true;
}

std::optional<StopReason> Stepper::reason_to_stop(std::uint32_t op, bool at_start) {
  const State& state = simulation_.cpu().state();
  if (const auto reason = reason_between()) return reason;
  if (!(at_start && standing_) && hits_breakpoint(op)) return StopReason::Breakpoint;
  if (goal_(state, op, progress_)) return StopReason::Goal;
  if (state.time >= limit_) return StopReason::Limit;
  if (asked_to_stop()) return StopReason::Request;
  return {};
}

/// A reason that has come up since the last instruction.
std::optional<StopReason> Stepper::reason_between() {
  if (answer_complete() && stop_at_answer_) return StopReason::Answer;
  if (!stop_.changes.empty()) return StopReason::Watch;
  return {};
}

void Stepper::instruction(const InstructionRecord& record) {
  note_changes(&record);
  if (backwards_) return;
  ++progress_.executed;
  on_instruction(record, executing_start_);
}

bool Stepper::hits_breakpoint(std::uint32_t op) {
  const auto found = std::find_if(breakpoints.begin(), breakpoints.end(), [&](const Breakpoint& b) { return b.op == op; });
  if (found == breakpoints.end()) return false;
  if (!backwards_) ++found->hits;
  stop_.breakpoint = *found;
  return true;
}

bool Stepper::answer_complete() {
  if (!awaiting_answer_ || simulation_.master().busy()) return false;
  awaiting_answer_ = false;
  if (!backwards_) on_answer(simulation_.master().exchange());
  return true;
}

void Stepper::note_changes(const InstructionRecord* by) {
  for (Watch& watch : watches) {
    std::vector<std::uint8_t> value = watch.range.bytes_in(simulation_.cpu().state().image);
    if (value == watch.value) continue;
    if (!backwards_) ++watch.hits;
    stop_.changes.push_back({watch, value, by ? std::optional(*by) : std::nullopt});
    watch.value = std::move(value);
  }
}

}  // namespace s7200::tools
