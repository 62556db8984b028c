// Independent pieces of work done several at a time; their results come one after the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace s7200::tools {

/// Runs work on threads: it begins at once, `jobs` at a time, and ends with the object.
template <class Result>
class ParallelRun {
 public:
  ParallelRun(std::size_t count, unsigned jobs, std::function<Result(std::size_t)> work)
      : work_(std::move(work)), results_(count) {
    for (unsigned i = 0; i < std::min<std::size_t>(std::max(1U, jobs), count); ++i)
      threads_.emplace_back([this] { do_work(); });
  }
  ParallelRun(const ParallelRun&) = delete;
  ParallelRun& operator=(const ParallelRun&) = delete;
  ~ParallelRun() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

  /// Hands over each result, in their order and in this thread. `finished` returns false to end it there. `waiting` hears
  /// every 200 ms, however fast they come, how many are done; it may be left out. Throws what the work threw.
  void each(const std::function<bool(std::size_t, Result)>& finished, const std::function<void(std::size_t)>& waiting) {
    auto next = Clock::now() + kBetween;
    for (std::size_t i = 0; i < results_.size(); ++i) {
      while (!is_there(i, next)) next = tell(waiting, i);
      if (!finished(i, take(i))) return;
      if (Clock::now() >= next) next = tell(waiting, i + 1);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kBetween{200};

  static Clock::time_point tell(const std::function<void(std::size_t)>& waiting, std::size_t done) {
    if (waiting) waiting(done);
    return Clock::now() + kBetween;
  }

  bool is_there(std::size_t i, Clock::time_point until) {
    std::unique_lock lock(mutex_);
    return ready_.wait_until(lock, until, [&] { return results_[i] || failed_; });
  }

  Result take(std::size_t i) {
    const std::lock_guard lock(mutex_);
    if (!results_[i]) std::rethrow_exception(failed_);
    return std::move(*results_[i]);
  }

  void do_work() {
    for (std::size_t i; !stop_ && (i = next_++) < results_.size();) {
      std::optional<Result> result;
      std::exception_ptr failed;
      try {
        result = work_(i);
      } catch (...) {
        failed = std::current_exception();
      }
      const std::lock_guard lock(mutex_);
      results_[i] = std::move(result);
      if (failed && !failed_) failed_ = failed;
      if (failed) stop_ = true;
      ready_.notify_all();
    }
  }

  std::function<Result(std::size_t)> work_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::vector<std::optional<Result>> results_;
  std::exception_ptr failed_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace s7200::tools
