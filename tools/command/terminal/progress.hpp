// How far a long run has come, and how it ended.
#pragma once

#include <functional>
#include <string>
#include <string_view>

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

/// `ended by time`, `interrupted`
std::string ending_text(std::string_view reason);

}  // namespace s7200::tools
