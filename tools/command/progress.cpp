#include "tools/command/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "tools/host/host_time.hpp"

namespace s7200::tools {

Progress::Progress(const serial::Simulation& simulation, const RunLimits& limits)
    : simulation_(simulation), limits_(limits), next_(host_time() + 2 * kSecond) {}

void Progress::operator()() {
  const Time now = host_time();
  if (now <= next_ || !isatty(STDERR_FILENO)) return;
  next_ = now + kSecond;
  const std::string goal = limits_.end == kNever ? fmt::format("{} scans", limits_.scans) : format_duration(limits_.end);
  fmt::print(stderr, "\r{} of {} simulated", format_duration(simulation_.time()), goal);
  if (simulation_.time() >= limits_.end) fmt::print(stderr, "\n");
}

}  // namespace s7200::tools
