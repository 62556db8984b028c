// Pulse outputs Q0.0 and Q0.1: PLS, SMB66–85, events 19 and 20 (facts 3.1, 4.5).
//
//   SMB67, 77   .0 take cycle time  .1 take pulse width  .2 take pulse count  .3 ms instead of µs  .6 PWM instead of PTO
//               .7 enabled
//   SMB66, 76   .6 pulse train overflow  .7 pulse train idle
//   SMW68, 78   cycle time      SMW70, 80   pulse width      SMD72, 82   pulse count
//
// A cycle time below 2 units counts as 2 units, a pulse count of 0 as 1. A width of 0 is off, one of the whole cycle or more
// is on. PLS with .7 = 0 ends either at once (S7-200 manual C233-01, 9-50). PLS during a pulse train puts one more train in
// line; a further one sets the overflow bit and is not taken (9-52).
//
// Not documented, modelled so:
// - A pulse begins with its 1 half; an odd cycle time makes the 1 half the shorter one.
//   [PulseOutput.AnOddCycleHasItsShorterHalfFirst]
// - PLS during PWM takes effect at once, with the beginning of a cycle: a CPU 21x has no synchronous update (SM67.4).
//   [PulseOutput.PlsDuringPwmBeginsANewCycleAtOnce]
// - Once pulses have ended, their point follows its image from the end of the scan on.
//   [PulseOutput.PlsWithoutEnableEndsItAtOnceAndTheImageHasThePointAgain]
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

constexpr std::uint32_t status_of(std::uint8_t output) { return image::kSM + 66 + 10u * output; }
constexpr std::uint8_t kOverflowBit = 6, kIdleBit = 7;

enum Control : std::uint8_t { kTakeCycle = 1, kTakeWidth = 2, kTakeCount = 4, kMilliseconds = 8, kPwm = 64, kEnable = 128 };

}  // namespace

void Cpu::program_pulses(std::uint8_t output) {
  PulseOutput& pulses = s.pulse[output];
  const std::uint8_t* sm = &s.image[status_of(output)];
  const std::uint8_t control = sm[1];
  if (!(control & kEnable)) return end_pulses(output);

  const Time unit = control & kMilliseconds ? kMillisecond : kMicrosecond;
  PulseTrain train = pulses.last;
  train.pwm = control & kPwm;
  if (control & kTakeCycle) {
    train.unit = unit;
    train.cycle = std::max<Time>(load16(sm + 2), 2) * unit;
  }
  if (control & kTakeWidth) train.width = load16(sm + 4) * unit;
  if (control & kTakeCount) train.count = std::max(load32(sm + 6), 1u);

  const bool in_train = pulses.running && !pulses.train.pwm;
  if (in_train && pulses.has_next) {
    put_bit(status_of(output), kOverflowBit, true);
    return;
  }
  pulses.last = train;
  if (!in_train) return start_pulses(output, train, s.time);
  pulses.next = train;
  pulses.has_next = true;
}

void Cpu::start_pulses(std::uint8_t output, const PulseTrain& train, Time at) {
  PulseOutput& pulses = s.pulse[output];
  pulses.train = train;
  pulses.running = true;
  pulses.has_next = false;
  pulses.left = train.count;
  put_bit(status_of(output), kIdleBit, train.pwm);
  begin_pulse(output, at);
}

/// PTO: half the cycle, in whole units. PWM: the width, all or nothing of the cycle at its ends.
Time Cpu::high_time(const PulseTrain& train) {
  return train.pwm ? std::min(train.width, train.cycle) : train.cycle / train.unit / 2 * train.unit;
}

void Cpu::begin_pulse(std::uint8_t output, Time at) {
  const PulseTrain& train = s.pulse[output].train;
  const Time high = high_time(train);
  s.pulse[output].cycle_end = at + train.cycle;
  put_output_point(0, output, high > 0, at);
  queue_.schedule(high > 0 ? at + high : at + train.cycle, EventOwner::Cpu, static_cast<std::uint8_t>(kPulse0 + output));
  attend();
}

/// The falling edge of a pulse, or the end of its cycle.
void Cpu::continue_pulses(std::uint8_t output, Time at) {
  PulseOutput& pulses = s.pulse[output];
  if (at < pulses.cycle_end) {
    put_output_point(0, output, false, at);
    queue_.schedule(pulses.cycle_end, EventOwner::Cpu, static_cast<std::uint8_t>(kPulse0 + output));
    return;
  }
  if (pulses.train.pwm || --pulses.left > 0) return begin_pulse(output, at);
  const bool has_next = pulses.has_next;
  if (has_next)
    start_pulses(output, pulses.next, at);
  else
    end_pulses(output);
  occurred(static_cast<std::uint8_t>(19 + output), at);
}

void Cpu::end_pulses(std::uint8_t output) {
  s.pulse[output].running = s.pulse[output].has_next = false;
  queue_.cancel(EventOwner::Cpu, static_cast<std::uint8_t>(kPulse0 + output));
  put_bit(status_of(output), kIdleBit, true);
}

}  // namespace s7200
