// How work is asked to end early.
#pragma once

#include <atomic>

namespace s7200 {

/// Whoever starts work hands it a token, and the work asks the token now and then whether to stop; a copy is as good. The
/// flag that it looks at belongs to whoever has made it, outlives it, and may be set by a signal handler or another thread.
/// A token without a flag never asks for a stop.
class StopToken {
 public:
  StopToken() = default;
  explicit StopToken(const std::atomic<bool>& flag) : flag_(&flag) {}

  bool stop_requested() const { return flag_ != nullptr && *flag_; }

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace s7200
