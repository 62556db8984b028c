#include "tools/debugger/stepper.hpp"

#include <algorithm>


namespace s7200::tools {

Stepper::Stepper(serial::Simulation& simulation, TraceSink* records, const std::atomic<bool>* stop_request, Drive drive)
    : on_record([](const TraceRecord&) {}),
      on_instruction([](const InstructionRecord&, bool) {}),
      on_answer([](const serial::Exchange&) {}),
      simulation_(simulation),
      stop_request_(stop_request),
      drive_(std::move(drive)) {
  sinks_.add(records);
  sinks_.add(this);
  simulation_.cpu().set_sink(&sinks_);
}

Stepper::~Stepper() { simulation_.cpu().set_sink(nullptr); }

Stop Stepper::run(const Goal& goal, Time limit, bool stop_at_answer) {
  const State& state = simulation_.cpu().state();
  goal_ = goal;
  limit_ = limit;
  stop_at_answer_ = stop_at_answer;
  awaiting_answer_ = simulation_.master().busy();
  standing_ = standing_at(state).has_value();
  start_op_ = state.pc;
  started_in_interrupt_ = state.in_interrupt;
  executing_start_ = reached_start_ = false;
  progress_ = {.executed = 0, .left = !standing_};
  stop_ = {};
  for (Watch& watch : watches) watch.value = watch.range.bytes_in(state.image);
  const serial::Halt halt = drive_(kNever);
  if (halt == serial::Halt::Stopped) stop_.reason = StopReason::CpuStopped;
  if (halt == serial::Halt::Request) stop_.reason = StopReason::Request;
  return stop_;
}

bool Stepper::before(std::uint32_t op) {
  note_changes(nullptr);
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

std::optional<StopReason> Stepper::reason_to_stop(std::uint32_t op, bool at_start) {
  const State& state = simulation_.cpu().state();
  if (answer_complete() && stop_at_answer_) return StopReason::Answer;
  if (!stop_.changes.empty()) return StopReason::Watch;
  if (!(at_start && standing_) && hits_breakpoint(op)) return StopReason::Breakpoint;
  if (goal_(state, op, progress_)) return StopReason::Goal;
  if (state.time >= limit_) return StopReason::Limit;
  if (stop_request_ && *stop_request_) return StopReason::Request;
  return {};
}

void Stepper::instruction(const InstructionRecord& record) {
  ++progress_.executed;
  note_changes(&record);
  on_instruction(record, executing_start_);
}

bool Stepper::hits_breakpoint(std::uint32_t op) {
  const auto found = std::find_if(breakpoints.begin(), breakpoints.end(), [&](const Breakpoint& b) { return b.op == op; });
  if (found == breakpoints.end()) return false;
  ++found->hits;
  stop_.breakpoint = *found;
  return true;
}

bool Stepper::answer_complete() {
  if (!awaiting_answer_ || simulation_.master().busy()) return false;
  awaiting_answer_ = false;
  on_answer(simulation_.master().exchange());
  return true;
}

void Stepper::note_changes(const InstructionRecord* by) {
  for (Watch& watch : watches) {
    std::vector<std::uint8_t> value = watch.range.bytes_in(simulation_.cpu().state().image);
    if (value == watch.value) continue;
    ++watch.hits;
    stop_.changes.push_back({watch, value, by ? std::optional(*by) : std::nullopt});
    watch.value = std::move(value);
  }
}

}  // namespace s7200::tools
