// A request to work that it end before it is done.
#pragma once

#include <atomic>

namespace s7200 {

/// A token that the starter of work hands to it, and that the work asks now and then; a copy is as good. It looks at a flag
/// of its giver's, which lives longer and may be set by a signal handler or another thread. A token without a flag never
/// asks for an end.
class StopToken {
 public:
  StopToken() = default;
  explicit StopToken(const std::atomic<bool>& flag) : flag_(&flag) {}

  bool stop_requested() const { return flag_ != nullptr && *flag_; }

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace s7200
