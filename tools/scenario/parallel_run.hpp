// Scenarios run several at a time; their results come one after the other.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "tools/scenario/runner.hpp"

namespace s7200::tools {

/// Begins at once, `jobs` at a time, and ends with the object. Neither is owned.
class ParallelRun {
 public:
  ParallelRun(const std::vector<Scenario>& scenarios, const std::vector<Bench>& benches, unsigned jobs);
  ~ParallelRun();

  /// Hands over each result, in the order of the scenarios and in this thread. `finished` returns false to end it there.
  /// `waiting` hears every 200 ms how many are done. Throws what a scenario threw.
  void each(const std::function<bool(std::size_t, ScenarioResult)>& finished,
            const std::function<void(std::size_t)>& waiting);

 private:
  void work();
  ScenarioResult take(std::size_t i, const std::function<void(std::size_t)>& waiting);

  const std::vector<Scenario>& scenarios_;
  const std::vector<Bench>& benches_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::vector<std::optional<ScenarioResult>> results_;
  std::exception_ptr failed_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace s7200::tools
