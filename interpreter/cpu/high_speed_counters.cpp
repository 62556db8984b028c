// High-speed counters HSC0–HSC2: HDEF, HSC, SMB36–65, events 12–18 (facts 3.1, 4.5, 5.2).
//
// Modes: 0–2 direction by the control byte, 3–5 by an input, 6–8 separate up and down clocks, 9–11 two clocks 90° apart;
// the second of each group adds an external reset, the third reset and start. HSC0 has mode 0 only.
//
//   SMB37, 47, 57   .0 reset active low  .1 start active low  .2 quadrature counts once a period, else four times
//                   .3 up  .4 take direction  .5 take new preset  .6 take new current value  .7 enabled
//   SMB36, 46, 56   .5 counting up  .6 current = preset  .7 current > preset
//   SMD38, 48, 58   new current value      SMD42, 52, 62   new preset
//
// Not documented, modelled so:
// - The levels of reset and start and the quadrature rate are taken by HDEF.
// - Counting up to the preset or down to it gives the event; loading a current value does not.
// - While reset is active the counter stands at 0; its event comes when it becomes active.
// - Direction events come when a count goes the other way than the last one (modes 6–11) or the direction input changes
//   (modes 3–5). The internal direction gives none.
// - One count a period (.2 = 1): the rising edge of clock A counts up and its falling edge down, both while B is 0.
// - The counters follow every edge; the highest frequency of the real inputs (7 kHz, 2 kHz for HSC0) is not enforced.
#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

/// Input points of a counter, as byte * 8 + bit; its SM bytes; its events.
struct Wiring {
  std::uint8_t clock, direction, reset, start;
  std::uint32_t special_memory;
  std::uint8_t reached, turned, was_reset;
};

constexpr std::uint8_t kNoEvent = 0xFF;
constexpr std::uint8_t kNoPoint = 0xFF;
constexpr Wiring kWiring[] = {
    {0, kNoPoint, kNoPoint, kNoPoint, image::kSM + 36, 12, kNoEvent, kNoEvent},  // I0.0
    {6, 7, 8, 9, image::kSM + 46, 13, 14, 15},                                   // I0.6 I0.7 I1.0 I1.1
    {10, 11, 12, 13, image::kSM + 56, 16, 17, 18},                               // I1.2 I1.3 I1.4 I1.5
};

enum Control : std::uint8_t {
  kResetLow = 1,
  kStartLow = 2,
  kSingleRate = 4,
  kUp = 8,
  kTakeDirection = 16,
  kTakePreset = 32,
  kTakeCurrent = 64,
  kEnable = 128
};

bool has_reset(std::uint8_t mode) { return mode % 3 != 0; }
bool has_start(std::uint8_t mode) { return mode % 3 == 2; }

}  // namespace

void Cpu::define_counter(std::uint8_t number, std::uint8_t mode) {
  HighSpeedCounter& counter = s.counter[number];
  if (counter.defined) return run_error(RunError::CounterDefinedTwice);
  if (number == 0 && (s.attached[0] != kNotAttached || s.attached[1] != kNotAttached))
    return run_error(RunError::InputTaken);
  const std::uint8_t control = s.image[kWiring[number].special_memory + 1];
  counter.defined = true;
  counter.mode = mode;
  counter.reset_low = control & kResetLow;
  counter.start_low = control & kStartLow;
  counter.single_rate = control & kSingleRate;
}

bool Cpu::counter_uses(std::uint8_t event) const { return event <= 1 && s.counter[0].defined; }

void Cpu::program_counter(std::uint8_t number) {
  HighSpeedCounter& counter = s.counter[number];
  if (!counter.defined) return run_error(RunError::CounterNotDefined);
  const std::uint32_t sm = kWiring[number].special_memory;
  const std::uint8_t control = s.image[sm + 1];
  if (control & kTakeDirection) counter.up = control & kUp;
  if (control & kTakeCurrent) counter.current = static_cast<std::int32_t>(load32(&s.image[sm + 2]));
  if (control & kTakePreset) counter.preset = static_cast<std::int32_t>(load32(&s.image[sm + 6]));
  counter.enabled = control & kEnable;
  show_counter(number);
}

/// The current value in HC and the status byte.
void Cpu::show_counter(std::uint8_t number) {
  const HighSpeedCounter& counter = s.counter[number];
  store32(&s.image[image::kHC + 4u * number], static_cast<std::uint32_t>(counter.current));
  s.image[kWiring[number].special_memory] =
      static_cast<std::uint8_t>((counter.up ? 0x20 : 0) | (counter.current == counter.preset ? 0x40 : 0) |
                                (counter.current > counter.preset ? 0x80 : 0));
}

void Cpu::count(std::uint8_t number, bool up, Time at) {
  HighSpeedCounter& counter = s.counter[number];
  const Wiring& wiring = kWiring[number];
  if (counter.mode >= 6 && up != counter.up) occurred(wiring.turned, at);
  counter.up = up;
  counter.current = static_cast<std::int32_t>(static_cast<std::uint32_t>(counter.current) + (up ? 1u : ~0u));
  show_counter(number);
  if (counter.current == counter.preset) occurred(wiring.reached, at);
}

/// An input point that counters may be wired to has changed; all points stand at their new levels.
void Cpu::counters_see(std::uint8_t point, bool level, Time at) {
  for (std::uint8_t number = 0; number < std::size(kWiring); ++number)
    if (s.counter[number].defined) counter_sees(number, point, level, at);
}

void Cpu::counter_sees(std::uint8_t number, std::uint8_t point, bool level, Time at) {
  HighSpeedCounter& counter = s.counter[number];
  const Wiring& wiring = kWiring[number];
  const auto input = [&](std::uint8_t p) { return (s.image[image::kInputs + p / 8] >> (p % 8) & 1) != 0; };
  const auto group = counter.mode / 3;

  const bool in_reset = has_reset(counter.mode) && input(wiring.reset) != counter.reset_low;
  if (in_reset && point == wiring.reset && counter.enabled) {
    counter.current = 0;
    show_counter(number);
    occurred(wiring.was_reset, at);
  }
  const bool started = !has_start(counter.mode) || input(wiring.start) != counter.start_low;
  if (!counter.enabled) return;
  if (group == 1 && point == wiring.direction) {
    if (level != counter.up) occurred(wiring.turned, at);
    counter.up = level;
    show_counter(number);
  }
  if (in_reset || !started) return;
  if (group <= 1 && point == wiring.clock && level) count(number, counter.up, at);
  if (group == 2 && level && point == wiring.clock) count(number, true, at);
  if (group == 2 && level && point == wiring.direction) count(number, false, at);
  if (group == 3 && (point == wiring.clock || point == wiring.direction)) {
    const bool a = input(wiring.clock), b = input(wiring.direction);
    if (!counter.single_rate)
      count(number, point == wiring.clock ? a != b : a == b, at);  // A ahead of B counts up
    else if (point == wiring.clock && !b)
      count(number, level, at);
  }
}

}  // namespace s7200
