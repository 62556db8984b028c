#include "interpreter/cpu/units/high_speed_counters.hpp"

#include "interpreter/cpu/interrupts.hpp"

namespace s7200::high_speed_counters {
namespace {

using namespace sm::counter;

constexpr std::uint32_t kInputBytes = 2;  ///< the input bytes that counters are wired to

std::uint32_t points_in_use(const State& s) {
  std::uint32_t points = 0;
  for (std::uint8_t number = 0; number < s.counter.size(); ++number)
    if (s.counter[number].defined) points |= points_of(kCounters[number], s.counter[number].mode);
  return points;
}

/// Points whose edges interrupts are attached to: I0.0 to I0.3, a rising and a falling edge each.
std::uint32_t points_with_interrupts(const State& s) {
  std::uint32_t points = 0;
  for (std::uint8_t event = event::kI00Rises; event <= event::kI03Falls; ++event)
    if (s.attached[event] != kNotAttached) points |= 1u << event / 2;
  return points;
}

bool input_point(const State& s, std::uint8_t point) { return (s.terminals[point / 8] >> (point % 8) & 1) != 0; }

/// Writes the current value to HC, and the status byte.
void show(State& s, std::uint8_t number) {
  const HighSpeedCounter& counter = s.counter[number];
  store32(&s.image[image::kHC + 4u * number], static_cast<std::uint32_t>(counter.current));
  s.image[kCounters[number].status] =
      static_cast<std::uint8_t>((counter.up ? kCountingUp : 0) | (counter.current == counter.preset ? kAtPreset : 0) |
                                (counter.current > counter.preset ? kAbovePreset : 0));
}

bool started(const State& s, std::uint8_t number) {
  const HighSpeedCounter& counter = s.counter[number];
  return !has_start(counter.mode) || input_point(s, kCounters[number].start) != counter.start_low;
}

bool in_reset(const State& s, std::uint8_t number) {
  const HighSpeedCounter& counter = s.counter[number];
  return has_reset(counter.mode) && input_point(s, kCounters[number].reset) != counter.reset_low && started(s, number);
}

void reset(Core& core, std::uint8_t number, Time at) {
  core.s.counter[number].current = 0;
  show(core.s, number);
  interrupts::occurred(core, kCounters[number].was_reset, at);
}

void turn(Core& core, std::uint8_t number, bool up, Time at) {
  HighSpeedCounter& counter = core.s.counter[number];
  if (counter.enabled && up != counter.up) interrupts::occurred(core, kCounters[number].turned, at);
  counter.up = up;
  show(core.s, number);
}

void count(Core& core, std::uint8_t number, bool up, Time at) {
  HighSpeedCounter& counter = core.s.counter[number];
  const bool clocks_turn = clocking(counter.mode) == Clocking::UpAndDown || clocking(counter.mode) == Clocking::Quadrature;
  if (clocks_turn) turn(core, number, up, at);
  counter.current = static_cast<std::int32_t>(static_cast<std::uint32_t>(counter.current) + (up ? 1u : ~0u));
  show(core.s, number);
  if (counter.current == counter.preset) interrupts::occurred(core, kCounters[number].reached, at);
}

void count_pulse(Core& core, std::uint8_t number, std::uint8_t point, bool level, Time at) {
  const HighSpeedCounter& counter = core.s.counter[number];
  const CounterInfo& wiring = kCounters[number];
  const bool on_clock = point == wiring.clock, on_second = point == wiring.direction;
  switch (clocking(counter.mode)) {
    case Clocking::InternalDirection:
    case Clocking::DirectionInput:
      if (on_clock && level) count(core, number, counter.up, at);
      break;
    case Clocking::UpAndDown:
      if ((on_clock || on_second) && level) count(core, number, on_clock, at);
      break;
    case Clocking::Quadrature: {
      const bool a = input_point(core.s, wiring.clock), b = input_point(core.s, wiring.direction);
      if (counter.single_rate && on_clock && !b) count(core, number, level, at);
      if (!counter.single_rate && (on_clock || on_second))
        count(core, number, on_clock ? a != b : a == b, at);  // A ahead: up
      break;
    }
    case Clocking::PulseOutput:
      break;
  }
}

/// An input point has changed; all points already have their new levels.
void see(Core& core, std::uint8_t number, std::uint8_t point, bool level, Time at) {
  const HighSpeedCounter& counter = core.s.counter[number];
  const CounterInfo& wiring = kCounters[number];
  if (point == wiring.direction && clocking(counter.mode) == Clocking::DirectionInput) turn(core, number, level, at);
  if (!counter.enabled || !started(core.s, number)) return;
  if (!in_reset(core.s, number)) return count_pulse(core, number, point, level, at);
  const bool just_active = point == wiring.reset || (has_start(counter.mode) && point == wiring.start);
  if (just_active) reset(core, number, at);
}

}  // namespace

void define(Core& core, std::uint8_t number, std::uint8_t mode) {
  State& s = core.s;
  HighSpeedCounter& counter = s.counter[number];
  if (counter.defined) return core.run_error(RunError::CounterDefinedTwice);
  if (points_of(kCounters[number], mode) & (points_in_use(s) | points_with_interrupts(s))) return core.run_error(RunError::InputTaken);
  const std::uint8_t control = s.image[kCounters[number].status + kControl];
  counter.defined = true;
  counter.mode = mode;
  counter.reset_low = control & kResetLow;
  counter.start_low = control & kStartLow;
  counter.single_rate = control & kSingleRate;
}

bool use_event(const Core& core, std::uint8_t event) {
  return event <= event::kI03Falls && (points_in_use(core.s) >> event / 2 & 1) != 0;
}

void program(Core& core, std::uint8_t number) {
  State& s = core.s;
  HighSpeedCounter& counter = s.counter[number];
  if (!counter.defined) return core.run_error(RunError::CounterNotDefined);
  const std::uint8_t* const sm = &s.image[kCounters[number].status];
  const std::uint8_t control = sm[kControl];
  if (control & kTakeDirection) counter.up = control & kUp;
  if (clocking(counter.mode) == Clocking::DirectionInput) counter.up = input_point(s, kCounters[number].direction);
  if (control & kTakeCurrent) counter.current = static_cast<std::int32_t>(load32(sm + kNewCurrent));
  if (control & kTakePreset) counter.preset = static_cast<std::int32_t>(load32(sm + kNewPreset));
  counter.enabled = control & kEnable;
  if (counter.enabled && in_reset(s, number)) counter.current = 0;
  show(s, number);
}

void pulse_begins(Core& core, std::uint8_t output, Time at) {
  for (std::uint8_t number = 0; number < core.s.counter.size(); ++number) {
    const HighSpeedCounter& counter = core.s.counter[number];
    const bool counts = counter.enabled && clocking(counter.mode) == Clocking::PulseOutput;
    if (counts && kCounters[number].pulse_output == output) count(core, number, counter.up, at);
  }
}

void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at) {
  if (byte >= kInputBytes) return;
  const std::uint8_t levels = core.s.terminals[byte];
  for (std::uint8_t number = 0; number < core.s.counter.size(); ++number) {
    if (!core.s.counter[number].defined) continue;
    for (std::uint8_t bit = 0; bit < 8; ++bit)
      if (changed >> bit & 1) see(core, number, static_cast<std::uint8_t>(byte * 8 + bit), levels >> bit & 1, at);
  }
}

}  // namespace s7200::high_speed_counters
