#include "tools/scenario/parallel_run.hpp"

#include <algorithm>
#include <chrono>

namespace s7200::tools {

ParallelRun::ParallelRun(const std::vector<Scenario>& scenarios, const std::vector<Bench>& benches, unsigned jobs)
    : scenarios_(scenarios), benches_(benches), results_(scenarios.size()) {
  for (unsigned i = 0; i < std::min<std::size_t>(jobs, scenarios.size()); ++i) threads_.emplace_back([this] { work(); });
}

ParallelRun::~ParallelRun() {
  stop_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void ParallelRun::each(const std::function<bool(std::size_t, ScenarioResult)>& finished,
                       const std::function<void(std::size_t)>& waiting) {
  for (std::size_t i = 0; i < scenarios_.size(); ++i)
    if (!finished(i, take(i, waiting))) return;
}

ScenarioResult ParallelRun::take(std::size_t i, const std::function<void(std::size_t)>& waiting) {
  std::unique_lock lock(mutex_);
  while (!ready_.wait_for(lock, std::chrono::milliseconds(200), [&] { return results_[i] || failed_; }))
    if (waiting) waiting(i);
  if (!results_[i]) std::rethrow_exception(failed_);
  return std::move(*results_[i]);
}

void ParallelRun::work() {
  for (std::size_t i; !stop_ && (i = next_++) < scenarios_.size();) {
    std::optional<ScenarioResult> result;
    std::exception_ptr failed;
    try {
      result = run_scenario(scenarios_[i], benches_[i]);
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

}  // namespace s7200::tools
