// Interrupts: attaching, queues, priority, entry and return (S7-200 manual C230-02, 10-120; facts 3).
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

constexpr std::uint8_t kTimed0 = 10;
constexpr std::uint8_t kCharacterReceived = 8;

bool is_timed(std::uint8_t event) { return event == kTimed0 || event == kTimed0 + 1; }

}  // namespace

void Cpu::attach(std::uint8_t event, std::uint8_t routine) {
  if (counter_uses(event)) return run_error(RunError::PointTaken);
  s.attached[event] = routine;
  Time interval = 0;
  if (is_timed(event)) {
    const std::uint8_t timer = event - kTimed0;
    interval = std::max(s.image[image::kSM + 34 + timer] * kMillisecond, program_->model->shortest_timed_interval);
    s.timed_interval[timer] = interval;
    queue_.schedule(s.time + interval, EventOwner::Cpu, timer);
    attend();
  }
  trace({.at = s.time, .kind = TraceKind::Attach, .event = event, .routine = routine, .interval = interval});
}

void Cpu::detach(std::uint8_t event) {
  s.attached[event] = kNotAttached;
  if (is_timed(event)) queue_.cancel(EventOwner::Cpu, event - kTimed0);
  trace({.at = s.time, .kind = TraceKind::Detach, .event = event});
  InterruptQueue& queue = s.queue[static_cast<std::size_t>(find_event(event)->queue)];
  const auto begin = queue.entry.begin(), end = begin + queue.count;
  for (auto entry = begin; entry != end; ++entry)
    if (entry->event == event) trace({.at = s.time, .kind = TraceKind::EventDropped, .event = event, .since = entry->at});
  const auto kept = std::remove_if(begin, end, [&](const QueuedInterrupt& q) { return q.event == event; });
  std::fill(kept, end, QueuedInterrupt{});
  s.waiting = static_cast<std::uint8_t>(s.waiting - (end - kept));
  queue.count = static_cast<std::uint8_t>(kept - begin);
  forget_overflow_if_idle();
}

/// The overflow bits go when the queues are empty and the main program goes on (S7-200 manual C230-02, 10-120).
void Cpu::forget_overflow_if_idle() {
  if (s.waiting == 0 && !s.in_interrupt) s.image[image::kSM4] &= 0xF8;
}

void Cpu::enable_interrupts(bool enabled) {
  s.interrupts_enabled = enabled;
  s.image[image::kSM4] = static_cast<std::uint8_t>((s.image[image::kSM4] & ~0x10) | (enabled ? 0x10 : 0));
  attend();
}

void Cpu::handle(const Event& event) {
  if (event.what == kTick1ms) return tick_1ms_timers(event.at);
  if (event.what >= kPulse0) return continue_pulses(event.what - kPulse0, event.at);
  const auto number = static_cast<std::uint8_t>(kTimed0 + event.what);
  queue_.schedule(event.at + s.timed_interval[event.what], EventOwner::Cpu, event.what);
  occurred(number, event.at);
}

/// First come, first served (S7-200 manual C230-02, 10-120); what comes at the same instant waits in the order of the list
/// of events (facts 3.1).
void Cpu::occurred(std::uint8_t event, Time at, std::uint8_t byte, bool parity_error) {
  const std::uint8_t routine = event < kEvents ? s.attached[event] : kNotAttached;
  if (routine == kNotAttached || s.mode != Mode::Run || s.stop_after_scan) return;
  const auto group = static_cast<std::size_t>(find_event(event)->queue);
  InterruptQueue& queue = s.queue[group];
  if (queue.count == program_->model->queue_depth[group]) {
    s.image[image::kSM4] |= static_cast<std::uint8_t>(1u << group);  // SM4.0–SM4.2
    trace({.at = at, .kind = TraceKind::EventLost, .event = event, .routine = routine, .byte = byte});
    return;
  }
  const auto end = queue.entry.begin() + queue.count++;
  const auto place = std::find_if(queue.entry.begin(), end, [&](const QueuedInterrupt& q) {
    return q.at == at && find_event(q.event)->order > find_event(event)->order;
  });
  std::move_backward(place, end, end + 1);
  *place = {at, event, byte, parity_error};
  ++s.waiting;
  trace({.at = at, .kind = TraceKind::EventOccurred, .event = event, .routine = routine});
}

/// The first of the highest group that has any.
QueuedInterrupt Cpu::next_queued() {
  const auto queue = std::find_if(s.queue.begin(), s.queue.end(), [](const InterruptQueue& q) { return q.count != 0; });
  const QueuedInterrupt first = queue->entry[0];
  std::copy(queue->entry.begin() + 1, queue->entry.begin() + queue->count, queue->entry.begin());
  queue->entry[--queue->count] = {};
  --s.waiting;
  return first;
}

void Cpu::take_interrupt() {
  const QueuedInterrupt interrupt = next_queued();
  s.saved = {s.pc, s.stack, s.rail, {}, s.image[image::kSM1]};
  std::copy_n(s.image.begin() + image::kAC, s.saved.accumulators.size(), s.saved.accumulators.begin());
  if (interrupt.event == kCharacterReceived) {  // just before the routine starts (S7-200 manual C233-01, 9-188)
    s.image[image::kSM + 2] = interrupt.byte;
    put_bit(image::kSM + 3, 0, interrupt.parity_error);
  }
  s.in_interrupt = true;
  s.serving_event = interrupt.event;
  s.serving_routine = s.attached[interrupt.event];
  s.serving_since = s.time;
  s.stack = LogicStack::on_entry();
  s.rail = true;
  s.pc = program_->interrupt[s.serving_routine];
  trace({.at = s.time,
         .kind = TraceKind::ServiceBegin,
         .event = s.serving_event,
         .routine = s.serving_routine,
         .since = interrupt.at});
  s.time += program_->interrupt_entry;
}

void Cpu::return_from_interrupt() {
  trace({.at = s.time,
         .kind = TraceKind::ServiceEnd,
         .event = s.serving_event,
         .routine = s.serving_routine,
         .since = s.serving_since});
  s.in_interrupt = false;
  s.pc = s.saved.return_to;
  s.stack = s.saved.stack;
  s.rail = s.saved.rail;
  std::copy(s.saved.accumulators.begin(), s.saved.accumulators.end(), s.image.begin() + image::kAC);
  s.image[image::kSM1] = s.saved.smb1;
  forget_overflow_if_idle();
  attend();
}

}  // namespace s7200
