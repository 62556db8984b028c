#include "tools/pace.hpp"

#include <algorithm>
#include <cmath>

namespace s7200::tools {
namespace {

Time nanoseconds(Pace::Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

}  // namespace

Pace::Pace(Time begin, double speed) : begin_(begin), begin_moment_(Clock::now()), report_{.speed = speed} {}

Time Pace::at(Clock::time_point moment) const {
  return begin_ + static_cast<Time>(std::floor(static_cast<double>(nanoseconds(moment - begin_moment_)) * report_.speed));
}

Pace::Clock::time_point Pace::when(Time simulated) const {
  if (simulated == kNever) return Clock::time_point::max();
  return begin_moment_ +
         std::chrono::nanoseconds(static_cast<Time>(std::ceil(static_cast<double>(simulated - begin_) / report_.speed)));
}

Time Pace::next_goal(Time simulated) const {
  const auto most = static_cast<Time>(static_cast<double>(nanoseconds(kBearable)) * report_.speed);
  return std::min(at(Clock::now()), simulated + most);
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
