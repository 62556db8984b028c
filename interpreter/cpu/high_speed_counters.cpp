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
// .0–.2 are taken by HDEF; .3 is the direction in modes 0–2 and the direction to begin with in the others (S7-200 manual
// C233-01, 9-38). All modes have the event of the preset, those with a reset input that of the reset, and all but 0–2 that
// of a change of direction (A5E00066097-02, 9-39). While start is not active, clocks and reset are ignored; a counter that
// is started during reset is cleared (the manual's chapter on the counters).
//
// Not documented, modelled so:
// - Loading a current value or a preset that makes the two equal is not the event of the preset.
//   [HighSpeedCounter.LoadingThePresetOrTheCurrentValueGivesNoEvent]
// - A counter that is started during reset gives the event of the reset.
//   [HighSpeedCounter.Mode2WithoutStartClocksAndResetAreIgnored]
// - In modes 3–5, HSC takes the level of the direction input for the direction to begin with.
//   [HighSpeedCounter.Modes3To5TakeTheirDirectionFromAnInputEvenBeforeItChanges]
// - One count a period (.2 = 1): the rising edge of clock A counts up and its falling edge down, both while B is 0.
//   [HighSpeedCounter.Modes9To11CountOnceAPeriodIfAsked]
// - In STOP the counters go on; their events are not taken. [HighSpeedCounter.InStopTheCounterGoesOnWithoutEvents]
// Not modelled: the highest frequency of the inputs (7 kHz, 2 kHz for HSC0). The counters follow every edge.
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

/// What the clocks of a mode are.
enum class Clocking { InternalDirection, DirectionInput, UpAndDown, Quadrature };
Clocking clocking(std::uint8_t mode) { return static_cast<Clocking>(mode / 3); }

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
  if (clocking(counter.mode) == Clocking::DirectionInput) counter.up = input_point(kWiring[number].direction);
  if (control & kTakeCurrent) counter.current = static_cast<std::int32_t>(load32(&s.image[sm + 2]));
  if (control & kTakePreset) counter.preset = static_cast<std::int32_t>(load32(&s.image[sm + 6]));
  counter.enabled = control & kEnable;
  if (counter.enabled && counter_in_reset(number)) counter.current = 0;
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

bool Cpu::counter_started(std::uint8_t number) const {
  const HighSpeedCounter& counter = s.counter[number];
  return !has_start(counter.mode) || input_point(kWiring[number].start) != counter.start_low;
}

bool Cpu::counter_in_reset(std::uint8_t number) const {
  const HighSpeedCounter& counter = s.counter[number];
  return has_reset(counter.mode) && input_point(kWiring[number].reset) != counter.reset_low && counter_started(number);
}

void Cpu::reset_counter(std::uint8_t number, Time at) {
  s.counter[number].current = 0;
  show_counter(number);
  occurred(kWiring[number].was_reset, at);
}

void Cpu::turn_counter(std::uint8_t number, bool up, Time at) {
  HighSpeedCounter& counter = s.counter[number];
  if (counter.enabled && up != counter.up) occurred(kWiring[number].turned, at);
  counter.up = up;
  show_counter(number);
}

void Cpu::count(std::uint8_t number, bool up, Time at) {
  HighSpeedCounter& counter = s.counter[number];
  if (clocking(counter.mode) >= Clocking::UpAndDown) turn_counter(number, up, at);
  counter.current = static_cast<std::int32_t>(static_cast<std::uint32_t>(counter.current) + (up ? 1u : ~0u));
  show_counter(number);
  if (counter.current == counter.preset) occurred(kWiring[number].reached, at);
}

/// An input point has changed; all points stand at their new levels.
void Cpu::counter_sees(std::uint8_t number, std::uint8_t point, bool level, Time at) {
  const HighSpeedCounter& counter = s.counter[number];
  const Wiring& wiring = kWiring[number];
  if (point == wiring.direction && clocking(counter.mode) == Clocking::DirectionInput) turn_counter(number, level, at);
  if (!counter.enabled || !counter_started(number)) return;
  if (!counter_in_reset(number)) return count_pulse(number, point, level, at);
  const bool just_active = point == wiring.reset || (has_start(counter.mode) && point == wiring.start);
  if (just_active) reset_counter(number, at);
}

void Cpu::count_pulse(std::uint8_t number, std::uint8_t point, bool level, Time at) {
  const HighSpeedCounter& counter = s.counter[number];
  const Wiring& wiring = kWiring[number];
  const bool on_clock = point == wiring.clock, on_second = point == wiring.direction;
  switch (clocking(counter.mode)) {
    case Clocking::InternalDirection:
    case Clocking::DirectionInput:
      if (on_clock && level) count(number, counter.up, at);
      break;
    case Clocking::UpAndDown:
      if ((on_clock || on_second) && level) count(number, on_clock, at);
      break;
    case Clocking::Quadrature: {
      const bool a = input_point(wiring.clock), b = input_point(wiring.direction);
      if (counter.single_rate && on_clock && !b) count(number, level, at);
      if (!counter.single_rate && (on_clock || on_second)) count(number, on_clock ? a != b : a == b, at);  // A ahead: up
      break;
    }
  }
}

}  // namespace s7200
