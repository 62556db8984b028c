#include "interpreter/cpu/units/pulse_outputs.hpp"

#include <algorithm>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/units.hpp"
#include "interpreter/cpu/units/high_speed_counters.hpp"
#include "interpreter/cpu/units/points.hpp"

namespace s7200::pulse_outputs {
namespace {

using namespace sm::pulses;

constexpr std::uint8_t event_of(std::uint8_t output) { return static_cast<std::uint8_t>(kPulse0 + output); }

/// PTO: half the cycle, in whole units. PWM: the width, at most the whole cycle.
Time high_time(const PulseTrain& train) {
  return train.pwm ? std::min(train.width, train.cycle) : train.cycle / train.unit / 2 * train.unit;
}

constexpr std::int64_t kShortestCycle = 2, kLongestCycle = 65535;  ///< in units

/// A segment of a profile: its first cycle time (word), by how much each cycle is longer (word, signed), and the number of
/// pulses (double word). False after the last one.
bool load_segment(Core& core, std::uint8_t output) {
  PulseOutput& pulses = core.s.pulse[output];
  PulseTrain& train = pulses.train;
  if (pulses.segment == train.segments) return false;
  const std::uint8_t* const segment = &core.s.image[train.table + 1 + kSegmentBytes * pulses.segment++];
  train.cycle = std::max<std::int64_t>(load16(segment), kShortestCycle) * train.unit;
  pulses.delta = static_cast<std::int16_t>(load16(segment + 2)) * train.unit;
  pulses.left = std::max(load32(segment + 4), 1u);
  core.s.image[kSegment[output]] = pulses.segment;
  return true;
}

void begin_pulse(Core& core, std::uint8_t output, Time at) {
  const PulseTrain& train = core.s.pulse[output].train;
  const Time high = high_time(train);
  core.s.pulse[output].cycle_end = at + train.cycle;
  points::put_output(core, 0, output, high > 0, at);
  if (!train.pwm) high_speed_counters::pulse_begins(core, output, at);
  core.schedule(high > 0 ? at + high : at + train.cycle, event_of(output));
  core.attend();
}

void start(Core& core, std::uint8_t output, const PulseTrain& train, Time at) {
  PulseOutput& pulses = core.s.pulse[output];
  pulses.train = train;
  pulses.running = true;
  pulses.has_next = false;
  pulses.left = train.count;
  pulses.segment = 0;
  pulses.delta = 0;
  if (train.profile) load_segment(core, output);
  core.put_mask(kStatus[output], kIdle, train.pwm);
  begin_pulse(core, output, at);
}

void end(Core& core, std::uint8_t output) {
  core.s.pulse[output].running = core.s.pulse[output].has_next = false;
  core.cancel(event_of(output));
  core.put_mask(kStatus[output], kIdle, true);
}

/// The profile of SMW168 or SMW178. False, with an error, if there is none.
bool take_profile(Core& core, std::uint8_t output, PulseTrain& train) {
  const std::uint32_t offset = load16(&core.s.image[kProfileTable[output]]), table = image::kV + offset;
  const auto fits = [&](std::uint32_t bytes) { return offset + bytes <= core.model().size_of(Area::V); };
  if (!fits(1) || !fits(1 + kSegmentBytes * core.s.image[table])) {
    core.run_error(RunError::OperandRange);
    return false;
  }
  if (core.s.image[table] == 0) {
    core.run_error(RunError::NoSegments);
    return false;
  }
  train.table = table;
  train.segments = core.s.image[table];
  return true;
}

/// A pulse of a train has ended. False if there is none after it.
bool go_on(Core& core, std::uint8_t output) {
  PulseOutput& pulses = core.s.pulse[output];
  if (--pulses.left == 0) return pulses.train.profile && load_segment(core, output);
  pulses.train.cycle += pulses.delta;
  return true;
}

bool cycle_in_range(const PulseTrain& train) {
  return train.cycle >= kShortestCycle * train.unit && train.cycle <= kLongestCycle * train.unit;
}

}  // namespace

void program(Core& core, std::uint8_t output) {
  PulseOutput& pulses = core.s.pulse[output];
  const std::uint8_t* const sm = &core.s.image[kStatus[output]];
  const std::uint8_t control = sm[kControl] & core.model().pulse_control;
  if (!(control & kEnable)) {
    if (pulses.running && pulses.train.profile) core.put_mask(kStatus[output], kUserAbort, true);
    return end(core, output);
  }

  const Time unit = control & kMilliseconds ? kMillisecond : kMicrosecond;
  PulseTrain train = pulses.last;
  train.pwm = control & kPwm;
  train.profile = !train.pwm && (control & kProfile);
  if (train.profile) {
    if (!take_profile(core, output, train)) return;
    train.unit = unit;
  } else if (control & kTakeCycle) {
    train.unit = unit;
    train.cycle = std::max<Time>(load16(sm + kCycleTime), 2) * unit;
  }
  if (control & kTakeWidth) train.width = load16(sm + kPulseWidth) * unit;
  if (control & kTakeCount) train.count = std::max(load32(sm + kPulseCount), 1u);

  const bool in_train = pulses.running && !pulses.train.pwm;
  const bool synchronous = pulses.running && pulses.train.pwm && train.pwm && (control & kSynchronous);
  if (in_train && pulses.has_next) return core.put_mask(kStatus[output], kTrainOverflow, true);
  pulses.last = train;
  if (!in_train && !synchronous) return start(core, output, train, core.s.time);
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
  if (pulses.train.pwm && pulses.has_next) return start(core, output, pulses.next, at);
  if (pulses.train.pwm) return begin_pulse(core, output, at);
  if (go_on(core, output)) {
    if (cycle_in_range(pulses.train)) return begin_pulse(core, output, at);
    core.put_mask(kStatus[output], kDeltaError, true);
    return end(core, output);
  }
  if (pulses.has_next)
    start(core, output, pulses.next, at);
  else
    end(core, output);
  interrupts::occurred(core, static_cast<std::uint8_t>(event::kPulses0Complete + output), at);
}

}  // namespace s7200::pulse_outputs
