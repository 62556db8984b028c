#include "tools/host/pace.hpp"

#include <algorithm>
#include <cmath>

namespace s7200::tools {
namespace {

Time nanoseconds(Pace::Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

/// kNever where that is beyond what 64 bits hold.
Time later(Time than, double by) { return by >= static_cast<double>(kNever - than) ? kNever : than + static_cast<Time>(by); }

}  // namespace

Pace::Pace(Time begin, double speed) : begin_(begin), begin_moment_(Clock::now()), report_{.speed = speed} {}

Time Pace::at(Clock::time_point moment) const {
  return later(begin_, std::floor(static_cast<double>(nanoseconds(moment - begin_moment_)) * report_.speed));
}

Pace::Clock::time_point Pace::when(Time simulated) const {
  if (simulated == kNever) return Clock::time_point::max();
  const Time begin = nanoseconds(begin_moment_.time_since_epoch());
  return Clock::time_point(
      std::chrono::nanoseconds(later(begin, std::ceil(static_cast<double>(simulated - begin_) / report_.speed))));
}

Time Pace::next_goal(Time simulated) const {
  return std::min(at(Clock::now()), later(simulated, static_cast<double>(nanoseconds(kBearable)) * report_.speed));
}

bool Pace::reached(Time simulated, Clock::time_point planned) {
  const auto now = Clock::now();
  report_.worst_lag = std::max(report_.worst_lag, nanoseconds(now - planned));
  if (now - when(simulated) <= kBearable) return false;
  report_.drift += at(now) - simulated;
  begin_ = simulated;
  begin_moment_ = now;
  return true;
}

}  // namespace s7200::tools
