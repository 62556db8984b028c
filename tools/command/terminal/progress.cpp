#include "tools/command/terminal/progress.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "tools/host/console.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

Progress::Progress(std::function<Time()> now, const RunLimits& limits)
    : now_(std::move(now)), limits_(limits), next_(host_time() + 2 * kSecond) {}

void Progress::operator()() {
  const Time now = host_time();
  if (now <= next_ || !is_terminal(Standard::Error)) return;
  next_ = now + kSecond;
  const std::string goal = limits_.end == kNever ? counted(limits_.scans, "scan") : format_duration(limits_.end);
  fmt::print(stderr, "\r{} of {} simulated", format_duration(now_()), goal);
  if (now_() >= limits_.end) fmt::print(stderr, "\n");
}

CountedProgress::CountedProgress(std::string what) : what_(std::move(what)), next_(host_time() + 2 * kSecond) {}

void CountedProgress::operator()(std::uint64_t count) {
  const Time now = host_time();
  if (now <= next_ || !is_terminal(Standard::Error)) return;
  next_ = now + kSecond;
  shown_ = true;
  fmt::print(stderr, "\r{}", counted(count, what_));
}

void CountedProgress::end() {
  if (std::exchange(shown_, false)) fmt::print(stderr, "\n");
}

Waiter waiting_with(CountedProgress& progress) {
  return {interruption(), [&progress, steps = std::uint64_t{0}]() mutable { progress(++steps); }};
}

std::string ending_text(std::string_view reason) {
  return reason == "interrupted" ? std::string(reason) : fmt::format("ended by {}", reason);
}

}  // namespace s7200::tools
