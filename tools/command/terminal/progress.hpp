// How far a long run has come, and how it ended.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "interpreter/analysis/waiter.hpp"
#include "tools/rig/run.hpp"

namespace s7200::tools {

/// On a terminal, once a second, from the second second on. The limits outlive it.
class Progress {
 public:
  /// `now`: simulated time.
  Progress(std::function<Time()> now, const RunLimits& limits);

  void operator()();

 private:
  std::function<Time()> now_;
  const RunLimits& limits_;
  Time next_;  ///< of the host
};

/// A number that grows, as `1200 runs`. On a terminal, once a second, from the second second on.
class CountedProgress {
 public:
  explicit CountedProgress(std::string what);  ///< one of it: `run`
  ~CountedProgress() { end(); }
  CountedProgress(const CountedProgress&) = delete;
  CountedProgress& operator=(const CountedProgress&) = delete;

  void operator()(std::uint64_t count);
  void end();  ///< what is printed next begins a line

 private:
  std::string what_;
  Time next_;  ///< of the host
  bool shown_ = false;
};

/// An analysis for which the command waits: a signal ends it. `progress` must live as long as it.
Waiter waiting_with(CountedProgress& progress);

/// `ended by time`, `interrupted`
std::string ending_text(std::string_view reason);

}  // namespace s7200::tools
