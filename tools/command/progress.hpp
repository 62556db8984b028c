// How far a long run has come.
#pragma once

#include "tools/rig/run.hpp"

namespace s7200::tools {

/// On a terminal, once a second, from the second second on. The references outlive it.
class Progress {
 public:
  Progress(const serial::Simulation& simulation, const RunLimits& limits);

  void operator()();

 private:
  const serial::Simulation& simulation_;
  const RunLimits& limits_;
  Time next_;  ///< of the host
};

}  // namespace s7200::tools
