// Body: PID (facts 10.8).
//
// The loop table holds real numbers: PV and SP (scaled to 0 … 1), M, KC, TS in seconds, TI and TD in minutes, the bias MX
// and the previous PV. PV and SP are not checked. A rising power flow makes the change from manual to automatic bumpless; at the
// first execution after the change to RUN there is none: the memory of power flow is set then (S7-200 manual, PID: modes).
// Two PIDs of the same LOOP disturb each other on a CPU; here each has its own memory of power flow.
//
// Not documented, modelled so:
// - A term that is not a finite number sets SM1.1 and ends PID: what has been stored by then stays. An infinite TI switches
//   the integral term off. [Pid.AResultThatIsNotANumberSetsSM11, Pid.AnInfiniteIntegralTimeSwitchesTheIntegralTermOff]
// - Auto-tuning (release 2, tables that begin with PIDA at byte 36 and ask for it) is error 0013. [Pid.AutoTuningIsRefused]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "interpreter/instructions/real_math.hpp"

namespace s7200::bodies {

inline constexpr std::uint32_t kPidTable = 36;
inline constexpr float kSecondsInAMinute = 60;

/// Offsets of the reals in the loop table.
enum PidEntry : std::uint32_t {
  kProcessVariable = 0,
  kSetpoint = 4,
  kOutput = 8,
  kGain = 12,
  kSampleTime = 16,
  kIntegralTime = 20,
  kDerivativeTime = 24,
  kBias = 28,
  kPreviousVariable = 32
};

class PidTable {
 public:
  PidTable(Core& core, std::uint32_t at) : core_(core), at_(at) {}

  float operator[](PidEntry entry) const { return core_.get<float>({.at = at_ + entry}); }
  void put(PidEntry entry, float value) { core_.put(Operand{.at = at_ + entry}, value); }

  bool wants_tuning() const {
    constexpr std::uint32_t kIdentification = 36, kControl = 40;
    return core_.in_area(at_, kControl + 1) && std::memcmp(&core_.s.image[at_ + kIdentification], "PIDA", 4) == 0 &&
           (core_.s.image[at_ + kControl] & 1) != 0;
  }

 private:
  Core& core_;
  std::uint32_t at_;
};

/// Calculates one sample of a loop. Returns whether all of it could be calculated.
inline bool calculate_loop(PidTable& loop) {
  const float gain = loop[kGain], term_gain = gain == 0 ? 1 : gain;
  const float error = loop[kSetpoint] - loop[kProcessVariable];
  const float proportional = gain * error;
  const float integral_part = term_gain * (loop[kSampleTime] / (loop[kIntegralTime] * kSecondsInAMinute)) * error;
  const float derivative = term_gain * (loop[kDerivativeTime] * kSecondsInAMinute / loop[kSampleTime]) *
                           (loop[kPreviousVariable] - loop[kProcessVariable]);
  const float integral = integral_part + loop[kBias], sum = proportional + integral + derivative;
  if (!std::isfinite(sum)) return false;
  const float bias = sum > 1 ? 1 - (proportional + derivative) : sum < 0 ? -(proportional + derivative) : integral;
  loop.put(kBias, std::clamp(bias, 0.0f, 1.0f));
  loop.put(kOutput, std::clamp(sum, 0.0f, 1.0f));
  loop.put(kPreviousVariable, loop[kProcessVariable]);
  return true;
}

/// PID TBL, LOOP. Operand 2, added at load, is the power flow at its last execution.
inline void control_loop(Core& core, const Op& op) {
  const bool before = core.bit(op[2]), now = core.s.stack.top();
  core.put_bit(op[2].at, op[2].bit, now);
  if (!now) {
    core.s.time += core.program().no_power_flow - op.cost;
    core.s.eno = false;
    return;
  }
  PidTable loop(core, op[0].at);
  if ((core.model().self & kCpu22xRelease2) != 0 && loop.wants_tuning()) return core.run_error(RunError::PidTable);
  if (!before) {
    loop.put(kSetpoint, loop[kProcessVariable]);
    loop.put(kPreviousVariable, loop[kProcessVariable]);
    loop.put(kBias, loop[kOutput]);
  }
  core.set_flags(kOverflow, calculate_loop(loop) ? 0 : kOverflow);
}

}  // namespace s7200::bodies
