// Timers of 1, 10 and 100 ms (facts 6.4): who adds the ticks, and when (S7-200 manual C230-02, 10-14 and 10-15).
// Not documented, modelled so: no timer counts in STOP. [Timer.InStopNoTimerCounts]
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

/// Ticks of a time base in a scan. Beyond 25 s a scan loses them (A5E00066097-02, 9-146).
std::int64_t ticks(Time base, Time from, Time to) {
  constexpr Time kLongest = 25 * kSecond;
  return std::min(to / base - from / base, kLongest / base);
}

}  // namespace

void Cpu::add_ticks(std::uint32_t timer, std::int64_t ticks) {
  std::uint8_t* const current = &s.image[image::kT + 2 * timer];
  const std::int64_t value = std::min<std::int64_t>(static_cast<std::int16_t>(load16(current)) + ticks, 32767);
  store16(current, static_cast<std::uint16_t>(value));
  put_bit(image::kTBits + timer / 8, static_cast<std::uint8_t>(timer % 8), value >= s.timer[timer].preset);
}

void Cpu::execute_timer(std::uint32_t number, bool enabled, std::int16_t preset, bool retentive) {
  TimerState& timer = s.timer[number];
  const bool was_enabled = timer.enabled;
  const Time base = timer_base(number).base;
  timer = {preset, enabled, was_enabled ? timer.since : s.time};
  if (!enabled && retentive) return;
  if (!retentive && !(enabled && was_enabled)) store16(&s.image[image::kT + 2 * number], 0);
  if (!enabled) return put_bit(image::kTBits + number / 8, static_cast<std::uint8_t>(number % 8), false);
  add_ticks(number, was_enabled && base == 100 * kMillisecond ? s.ticks_100ms : 0);
  if (base == kMillisecond && s.next_tick_1ms == kNever) await_tick_1ms(s.time);
}

/// R: a timer of 1 or 10 ms stands still until its instruction is executed with power flow again; one of 100 ms counts in
/// its instruction, with which it goes on (S7-200 manual C230-02, 10-14 and 10-15).
void Cpu::turn_timers_off(std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t number = first; number < first + count; ++number)
    if (timer_base(number).base < 100 * kMillisecond) s.timer[number].enabled = false;
}

void Cpu::await_tick_1ms(Time from) {
  s.next_tick_1ms = (from / kMillisecond + 1) * kMillisecond;
  queue_.schedule(s.next_tick_1ms, EventOwner::Cpu, kTick1ms);
  attend();
}

/// 10 ms timers hold still during a scan; 100 ms timers add the ticks of the previous scan when they are executed.
void Cpu::update_timers_at_scan_begin() {
  const Time from = s.previous_scan_begin, to = s.time;
  s.previous_scan_begin = to;
  s.ticks_100ms = static_cast<std::int16_t>(ticks(100 * kMillisecond, from, to));
  for (const std::uint8_t timer : program_->timers_10ms)
    if (s.timer[timer].enabled) add_ticks(timer, ticks(10 * kMillisecond, from, to));
}

void Cpu::tick_1ms_timers(Time at) {
  s.next_tick_1ms = kNever;
  bool any = false;
  for (const std::uint8_t timer : program_->timers_1ms) {
    if (!s.timer[timer].enabled) continue;
    any = true;
    if (s.timer[timer].since >= at) continue;
    add_ticks(timer, 1);
    const bool reached = static_cast<std::int16_t>(load16(&s.image[image::kT + 2u * timer])) == s.timer[timer].preset;
    if (reached && timer == 32) occurred(21, at);
    if (reached && timer == 96) occurred(22, at);
  }
  if (any) await_tick_1ms(at);
}

}  // namespace s7200
