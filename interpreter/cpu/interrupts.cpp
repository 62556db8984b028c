#include "interpreter/cpu/interrupts.hpp"

#include <algorithm>

#include "interpreter/cpu/local_memory.hpp"
#include "interpreter/cpu/units.hpp"
#include "interpreter/cpu/units/high_speed_counters.hpp"

namespace s7200::interrupts {
namespace {

constexpr int kEdgeInputs = 4;  // I0.0–I0.3

/// The overflow bits are reset when the queues are empty and the main program goes on (S7-200 manual C230-02, 10-120).
void forget_overflow_if_idle(Core& core) {
  if (core.s.waiting == 0 && !core.s.in_interrupt) core.put_mask(sm::kInterruptStatus, sm::kQueueOverflow, false);
}

/// Takes the first interrupt from the queue of highest priority that is not empty.
QueuedInterrupt next_queued(State& s) {
  const auto queue = std::find_if(s.queue.begin(), s.queue.end(), [](const InterruptQueue& q) { return q.count != 0; });
  const QueuedInterrupt first = queue->entry[0];
  std::copy(queue->entry.begin() + 1, queue->entry.begin() + queue->count, queue->entry.begin());
  queue->entry[--queue->count] = {};
  --s.waiting;
  return first;
}

}  // namespace

void attach(Core& core, std::uint8_t event, std::uint8_t routine) {
  if (high_speed_counters::use_event(core, event)) return core.run_error(RunError::PointTaken);
  core.s.attached[event] = routine;
  Time interval = 0;
  if (event::is_timed(event)) {
    const std::uint8_t timer = event - event::kTimed0;
    interval = std::max(core.s.image[sm::kTimedInterval[timer]] * kMillisecond, core.model().shortest_timed_interval);
    core.s.timed_interval[timer] = interval;
    core.schedule(core.s.time + core.by_own_clock(interval), kTimedInterrupt0 + timer);
    core.attend();
  }
  core.trace({.at = core.s.time,
              .kind = TraceKind::Attach,
              .event = event,
              .routine = routine,
              .op = core.loop.op,
              .interval = interval});
}

void detach(Core& core, std::uint8_t event) {
  State& s = core.s;
  s.attached[event] = kNotAttached;
  if (event::is_timed(event)) core.cancel(kTimedInterrupt0 + event - event::kTimed0);
  core.trace({.at = s.time, .kind = TraceKind::Detach, .event = event, .op = core.loop.op});
  InterruptQueue& queue = s.queue[static_cast<std::size_t>(find_event(event)->queue)];
  const auto begin = queue.entry.begin(), end = begin + queue.count;
  for (auto entry = begin; entry != end; ++entry)
    if (entry->event == event)
      core.trace({.at = s.time, .kind = TraceKind::EventDropped, .event = event, .since = entry->at});
  const auto kept = std::remove_if(begin, end, [&](const QueuedInterrupt& q) { return q.event == event; });
  std::fill(kept, end, QueuedInterrupt{});
  s.waiting = static_cast<std::uint8_t>(s.waiting - (end - kept));
  queue.count = static_cast<std::uint8_t>(kept - begin);
  forget_overflow_if_idle(core);
}

void enable(Core& core, bool enabled) {
  core.s.interrupts_enabled = enabled;
  core.put_mask(sm::kInterruptStatus, sm::kInterruptsEnabled, enabled);
  if (core.sink())  // ENI in each scan is nothing to the outside: without a sink such scans are alike (Core::touched)
    core.trace({.at = core.s.time,
                .kind = TraceKind::Enable,
                .code = static_cast<std::uint16_t>(enabled ? 1 : 0),
                .op = core.loop.op});
  core.attend();
}

/// First come, first served (S7-200 manual C230-02, 10-120); events at the same instant wait in the order of the list of
/// events (facts 3.1).
void occurred(Core& core, std::uint8_t event, Time at, std::uint8_t byte, bool parity_error) {
  State& s = core.s;
  const std::uint8_t routine = event < kEvents ? s.attached[event] : kNotAttached;
  if (routine == kNotAttached || s.mode != Mode::Run || s.stop_after_scan) return;
  const auto group = static_cast<std::size_t>(find_event(event)->queue);
  InterruptQueue& queue = s.queue[group];
  if (queue.count == core.model().queue_depth[group]) {
    s.image[sm::kInterruptStatus] |= static_cast<std::uint8_t>(1u << group);  // one of kQueueOverflow
    core.trace({.at = at, .kind = TraceKind::EventLost, .event = event, .routine = routine, .byte = byte});
    return;
  }
  const auto end = queue.entry.begin() + queue.count++;
  const auto place = std::find_if(queue.entry.begin(), end, [&](const QueuedInterrupt& q) {
    return q.at == at && find_event(q.event)->order(core.model().self) > find_event(event)->order(core.model().self);
  });
  std::move_backward(place, end, end + 1);
  *place = {at, event, byte, parity_error};
  ++s.waiting;
  core.trace({.at = at, .kind = TraceKind::EventOccurred, .event = event, .routine = routine});
}

void take(Core& core) {
  State& s = core.s;
  const QueuedInterrupt interrupt = next_queued(s);
  const std::uint32_t before = core.current_op();
  local_memory::put_aside(core);
  s.saved = {s.pc, s.stack, s.rail, s.eno, {}, s.image[sm::kFlags], s.call_depth};
  std::copy_n(s.image.begin() + image::kAC, s.saved.accumulators.size(), s.saved.accumulators.begin());
  units::begin_service(core, interrupt);
  s.in_interrupt = true;
  local_memory::take_up(core);
  s.serving_event = interrupt.event;
  s.serving_routine = s.attached[interrupt.event];
  s.serving_since = s.time;
  s.stack = LogicStack::on_entry();
  s.rail = true;
  s.eno = true;
  s.pc = core.program().interrupt[s.serving_routine];
  core.trace({.at = s.time,
              .kind = TraceKind::ServiceBegin,
              .event = s.serving_event,
              .routine = s.serving_routine,
              .op = before,
              .since = interrupt.at});
  s.time += core.program().interrupt_entry;
}

void return_from(Core& core) {
  State& s = core.s;
  core.trace({.at = s.time,
              .kind = TraceKind::ServiceEnd,
              .event = s.serving_event,
              .routine = s.serving_routine,
              .since = s.serving_since});
  local_memory::put_aside(core);
  s.in_interrupt = false;
  s.call_depth = s.saved.call_depth;
  local_memory::take_up(core);
  s.pc = s.saved.return_to;
  s.stack = s.saved.stack;
  s.rail = s.saved.rail;
  s.eno = s.saved.eno;
  std::copy(s.saved.accumulators.begin(), s.saved.accumulators.end(), s.image.begin() + image::kAC);
  s.image[sm::kFlags] = s.saved.smb1;
  forget_overflow_if_idle(core);
  core.attend();
}

void drop_all(Core& core) {
  core.s.queue = {};
  core.s.waiting = 0;
  core.s.interrupts_enabled = false;
  core.put_mask(sm::kInterruptStatus, sm::kInterruptsEnabled, false);
}

void enter_stop(Core& core) {
  core.s.attached = nothing_attached();
  for (const std::uint8_t timed : {kTimedInterrupt0, kTimedInterrupt1}) core.cancel(timed);
  drop_all(core);
  core.put_mask(sm::kInterruptStatus, sm::kQueueOverflow, false);
}

/// Events 0–7: rising and falling edges of I0.0–I0.3.
void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at) {
  for (std::uint8_t point = 0; byte == 0 && point < kEdgeInputs; ++point) {
    if (!(changed >> point & 1)) continue;
    const bool now = core.s.terminals[0] >> point & 1;
    occurred(core, static_cast<std::uint8_t>((now ? event::kI00Rises : event::kI00Falls) + 2 * point), at);
  }
}

/// A timed interrupt is due.
void handle(Core& core, std::uint8_t what, Time at) {
  const auto timer = static_cast<std::uint8_t>(what - kTimedInterrupt0);
  core.schedule(at + core.by_own_clock(core.s.timed_interval[timer]), what);
  occurred(core, static_cast<std::uint8_t>(event::kTimed0 + timer), at);
}

}  // namespace s7200::interrupts
