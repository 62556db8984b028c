// How far a long run has come.
#pragma once

#include <functional>

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

}  // namespace s7200::tools
