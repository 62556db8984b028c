// Simulated time that follows the clock of the computer.
#pragma once

#include <chrono>

#include "interpreter/base/time.hpp"

namespace s7200::tools {

class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// The simulation stands at `begin` and is to go `speed` times as fast as the clock from now on.
  Pace(Time begin, double speed);

  /// The time that the simulation should have at a moment, and the moment at which it should have a time. Never, when 64
  /// bits do not reach so far.
  Time at(Clock::time_point moment) const;
  Clock::time_point when(Time simulated) const;

  /// The furthest to run now without looking at anything else.
  Time next_goal(Time simulated) const;

  /// The simulation was to be woken at `planned` and now stands at `simulated`. If it is late by more than kBearable, it
  /// does not try to catch up: its clock goes on from there, and the lost time is drift. Returns true when that has just
  /// happened.
  bool reached(Time simulated, Clock::time_point planned);

  struct Report {
    double speed = 1;
    Time drift = 0;      ///< simulated time that was lost because the computer could not keep up
    Time worst_lag = 0;  ///< of the clock: how much later than planned the simulation came to where it should have been
  };
  const Report& report() const { return report_; }

  static constexpr std::chrono::milliseconds kBearable{250};

 private:
  Time begin_;
  Clock::time_point begin_moment_;
  Report report_;
};

}  // namespace s7200::tools
