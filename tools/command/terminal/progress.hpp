// How far a long run has come, and how it ended.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/waiter.hpp"
#include "tools/host/files/record_file.hpp"
#include "tools/rig/run.hpp"

namespace s7200::tools {

/// On a terminal, once a second, from the second second on, with the sizes that records will have. A note says when one will
/// be larger than it may be. The limits outlive it.
class Progress {
 public:
  /// `now`: simulated time; `records`: how far they have grown.
  Progress(std::function<Time()> now, std::function<std::vector<RecordSize>()> records, const RunLimits& limits);

  /// False when a record has reached its limit.
  bool operator()();

 private:
  double at_end(const RecordSize& record) const;
  void note_too_large(const std::vector<RecordSize>& records);

  std::function<Time()> now_;
  std::function<std::vector<RecordSize>()> records_;
  bool noted_ = false;
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
