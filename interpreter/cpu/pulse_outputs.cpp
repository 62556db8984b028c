#include "interpreter/cpu/pulse_outputs.hpp"

#include <algorithm>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/points.hpp"
#include "interpreter/cpu/units.hpp"

namespace s7200::pulse_outputs {
namespace {

using namespace sm::pulses;

constexpr std::uint8_t event_of(std::uint8_t output) { return static_cast<std::uint8_t>(kPulse0 + output); }

/// PTO: half the cycle, in whole units. PWM: the width, at most the whole cycle.
Time high_time(const PulseTrain& train) {
  return train.pwm ? std::min(train.width, train.cycle) : train.cycle / train.unit / 2 * train.unit;
}

void begin_pulse(Core& core, std::uint8_t output, Time at) {
  const PulseTrain& train = core.s.pulse[output].train;
  const Time high = high_time(train);
  core.s.pulse[output].cycle_end = at + train.cycle;
  points::put_output(core, 0, output, high > 0, at);
  core.schedule(high > 0 ? at + high : at + train.cycle, event_of(output));
  core.attend();
}

void start(Core& core, std::uint8_t output, const PulseTrain& train, Time at) {
  PulseOutput& pulses = core.s.pulse[output];
  pulses.train = train;
  pulses.running = true;
  pulses.has_next = false;
  pulses.left = train.count;
  core.put_mask(kStatus[output], kIdle, train.pwm);
  begin_pulse(core, output, at);
}

void end(Core& core, std::uint8_t output) {
  core.s.pulse[output].running = core.s.pulse[output].has_next = false;
  core.cancel(event_of(output));
  core.put_mask(kStatus[output], kIdle, true);
}

}  // namespace

void program(Core& core, std::uint8_t output) {
  PulseOutput& pulses = core.s.pulse[output];
  const std::uint8_t* const sm = &core.s.image[kStatus[output]];
  const std::uint8_t control = sm[kControl];
  if (!(control & kEnable)) return end(core, output);

  const Time unit = control & kMilliseconds ? kMillisecond : kMicrosecond;
  PulseTrain train = pulses.last;
  train.pwm = control & kPwm;
  if (control & kTakeCycle) {
    train.unit = unit;
    train.cycle = std::max<Time>(load16(sm + kCycleTime), 2) * unit;
  }
  if (control & kTakeWidth) train.width = load16(sm + kPulseWidth) * unit;
  if (control & kTakeCount) train.count = std::max(load32(sm + kPulseCount), 1u);

  const bool in_train = pulses.running && !pulses.train.pwm;
  if (in_train && pulses.has_next) return core.put_mask(kStatus[output], kTrainOverflow, true);
  pulses.last = train;
  if (!in_train) return start(core, output, train, core.s.time);
  pulses.next = train;
  pulses.has_next = true;
}

bool drive(const Core& core, std::uint32_t byte, std::uint8_t bit) {
  return byte == 0 && bit < core.s.pulse.size() && core.s.pulse[bit].running;
}

void power_up(Core& core, const RetentiveMemory*) {
  for (const std::uint32_t status : kStatus) core.s.image[status] = kIdle;
}

void enter_stop(Core& core) {
  for (std::uint8_t output = 0; output < core.s.pulse.size(); ++output)
    if (core.s.pulse[output].running) end(core, output);
}

/// The falling edge of a pulse, or the end of its cycle.
void handle(Core& core, std::uint8_t what, Time at) {
  const auto output = static_cast<std::uint8_t>(what - kPulse0);
  PulseOutput& pulses = core.s.pulse[output];
  if (at < pulses.cycle_end) {
    points::put_output(core, 0, output, false, at);
    core.schedule(pulses.cycle_end, what);
    return;
  }
  if (pulses.train.pwm || --pulses.left > 0) return begin_pulse(core, output, at);
  if (pulses.has_next)
    start(core, output, pulses.next, at);
  else
    end(core, output);
  interrupts::occurred(core, static_cast<std::uint8_t>(event::kPulses0Complete + output), at);
}

}  // namespace s7200::pulse_outputs
