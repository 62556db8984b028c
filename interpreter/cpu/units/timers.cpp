#include "interpreter/cpu/units/timers.hpp"

#include <algorithm>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/units.hpp"

namespace s7200::timers {
namespace {

/// Ticks of a time base in a scan. Ticks beyond 25 s are lost (A5E00066097-02, 9-146).
std::int64_t ticks(const Core& core, Time base, Time from, Time to) {
  constexpr Time kLongest = 25 * kSecond;
  const Time tick = core.by_own_clock(base);
  return std::min(to / tick - from / tick, kLongest / base);
}

void put_bit(State& s, std::uint32_t timer, bool value) {
  std::uint8_t& byte = s.image[image::kTBits + timer / 8];
  const auto mask = static_cast<std::uint8_t>(1u << timer % 8);
  byte = static_cast<std::uint8_t>(value ? byte | mask : byte & ~mask);
}

std::int16_t value_of(const State& s, std::uint32_t timer) {
  return static_cast<std::int16_t>(load16(&s.image[image::kT + 2 * timer]));
}

/// A TOF stops at its preset and its bit goes off; others count on to 32767, with their bit on from the preset on.
void add_ticks(State& s, std::uint32_t number, std::int64_t ticks) {
  TimerState& timer = s.timer[number];
  const std::int64_t before = value_of(s, number);
  const std::int64_t last = timer.off_delay ? std::max<std::int64_t>(before, timer.preset) : 32767;
  const std::int64_t value = std::min(before + ticks, last);
  const bool reached = value >= timer.preset;
  store16(&s.image[image::kT + 2 * number], static_cast<std::uint16_t>(value));
  put_bit(s, number, reached != timer.off_delay);
  if (timer.off_delay && reached) timer.enabled = false;
}

/// The instant since which a timer that was like `before` is enabled. One that does not count has no such moment: its scans
/// are alike.
Time enabled_since(const TimerState& before, bool enabled, Time now) {
  if (!enabled) return 0;
  return before.enabled ? before.since : now;
}

void await_tick_1ms(Core& core, Time from) {
  const Time tick = core.by_own_clock(kMillisecond);
  core.s.next_tick_1ms = (from / tick + 1) * tick;
  core.schedule(core.s.next_tick_1ms, kTick1ms);
  core.attend();
}

void turn_off(State& s, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t number = first; number < first + count; ++number) {
    TimerState& timer = s.timer[number];
    timer.input = false;
    if (timer.off_delay || timer_base(number).base < 100 * kMillisecond) timer.enabled = false;
  }
}

}  // namespace

void execute(Core& core, std::uint32_t number, bool enabled, std::int16_t preset, bool retentive) {
  State& s = core.s;
  TimerState& timer = s.timer[number];
  if (!enabled) {
    timer = {.preset = preset};
    if (retentive) return;
    store16(&s.image[image::kT + 2 * number], 0);
    return put_bit(s, number, false);
  }
  const bool was_enabled = timer.enabled;
  const Time base = timer_base(number).base;
  timer = {.preset = preset, .enabled = true, .since = was_enabled ? timer.since : s.time};
  if (!retentive && !was_enabled) store16(&s.image[image::kT + 2 * number], 0);
  add_ticks(s, number, was_enabled && base == 100 * kMillisecond ? s.ticks_100ms : 0);
  if (base == kMillisecond && s.next_tick_1ms == kNever) await_tick_1ms(core, s.time);
}

void execute_off_delay(Core& core, std::uint32_t number, bool input, std::int16_t preset, bool powered) {
  State& s = core.s;
  TimerState& timer = s.timer[number];
  const bool goes_off = timer.input && !input && powered, was_enabled = timer.enabled;
  const bool enabled = powered && !input && (was_enabled || goes_off);
  timer = {.preset = preset,
           .enabled = enabled,
           .off_delay = true,
           .input = input && powered,
           .since = enabled_since(timer, enabled, s.time)};
  if (input || goes_off || !powered) store16(&s.image[image::kT + 2 * number], 0);
  if (!enabled) return put_bit(s, number, timer.input);
  const Time base = timer_base(number).base;
  add_ticks(s, number, was_enabled && base == 100 * kMillisecond ? s.ticks_100ms : 0);
  if (base == kMillisecond && s.next_tick_1ms == kNever) await_tick_1ms(core, s.time);
}

void clear_current_values(Core& core, const Operand& first, std::uint32_t count) {
  if (first.at < image::kTBits || first.at >= image::kInputs) return;
  for (const AreaInfo& area : {info(Area::T), info(Area::C)}) {
    if (first.at < area.bits || first.at >= area.bits + 32) continue;
    const std::uint32_t number = (first.at - area.bits) * 8 + first.bit;
    std::fill_n(core.s.image.begin() + area.base + number * 2, count * 2, std::uint8_t{0});
    if (area.area == Area::T) turn_off(core.s, number, count);
  }
}

/// Both inputs of each counter count as 1 before the first execution, so an input that is 1 then has not risen.
void power_up(Core& core, const RetentiveMemory*) { core.s.counter_inputs.fill(3); }

/// The time in STOP is no time of a scan.
void enter_run(Core& core) { core.s.previous_scan_begin = core.s.time; }

void enter_stop(Core& core) {
  core.cancel(kTick1ms);
  core.s.next_tick_1ms = kNever;
}

void count_scan(Core& core) {
  State& s = core.s;
  const Time from = s.previous_scan_begin, to = s.time;
  s.previous_scan_begin = to;
  s.ticks_100ms = static_cast<std::int16_t>(ticks(core, 100 * kMillisecond, from, to));
  for (const std::uint8_t timer : core.program().timers_10ms)
    if (s.timer[timer].enabled) add_ticks(s, timer, ticks(core, 10 * kMillisecond, from, to));
}

Time next_change(const Core& core) {
  const State& s = core.s;
  const Program& program = core.program();
  Time next = kNever;
  for (const auto* timers : {&program.timers_10ms, &program.timers_100ms})
    for (const std::uint8_t number : *timers) {
      const TimerState& timer = s.timer[number];
      const Time base = timer_base(number).base;
      const bool every_tick = program.looks.every_tick.test(number);
      // One of 100 ms that is off after the program may have been on in it, and have counted when it was executed.
      if (!timer.enabled && !(every_tick && base == 100 * kMillisecond)) continue;
      const std::int64_t ticks = every_tick ? 1 : timer.preset - value_of(s, number);
      const Time tick = core.by_own_clock(base);
      if (ticks > 0) next = std::min(next, (s.previous_scan_begin / tick + ticks) * tick);
    }
  return next;
}

bool any_counts(const Core& core) {
  const Program& program = core.program();
  const auto counts = [&](std::uint8_t number) { return core.s.timer[number].enabled; };
  return program.uses_timers &&
         (std::ranges::any_of(program.timers_1ms, counts) || std::ranges::any_of(program.timers_10ms, counts) ||
          std::ranges::any_of(program.timers_100ms, counts));
}

void move_on(const Core& core, State& s, Time by, Time last_scan) {
  const Program& program = core.program();
  const Time from = s.previous_scan_begin, to = from + by;
  s.previous_scan_begin = to;
  s.ticks_100ms = static_cast<std::int16_t>(ticks(core, 100 * kMillisecond, to - last_scan, to));
  for (const auto* timers : {&program.timers_10ms, &program.timers_100ms})
    for (const std::uint8_t number : *timers) {
      const Time tick = core.by_own_clock(timer_base(number).base);
      if (s.timer[number].enabled) add_ticks(s, number, to / tick - from / tick);
    }
}

/// A millisecond has passed.
void handle(Core& core, std::uint8_t, Time at) {
  State& s = core.s;
  s.next_tick_1ms = kNever;
  bool any = false;
  for (const std::uint8_t timer : core.program().timers_1ms) {
    if (!s.timer[timer].enabled) continue;
    any = true;
    if (s.timer[timer].since >= at) continue;
    const bool reaches = value_of(s, timer) == s.timer[timer].preset - 1;
    add_ticks(s, timer, 1);
    if (reaches && timer == 32) interrupts::occurred(core, event::kT32Reached, at);
    if (reaches && timer == 96) interrupts::occurred(core, event::kT96Reached, at);
  }
  if (any) await_tick_1ms(core, at);
}

}  // namespace s7200::timers
