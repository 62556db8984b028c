// The same traffic on two programs: where they differ first. And traffic to compare them with.
#pragma once

#include <string>

#include "tools/scenario/report.hpp"

namespace s7200::tools {

struct Comparison {
  bool timing = true;  ///< latencies count too
  Time tolerance = 0;  ///< by which they may differ
};

/// What is shown of a scenario that went over two programs.
struct Difference {
  bool found = false;
  std::string text{};
};

/// The first different answer, and the first different latency if it comes before.
Difference compare(const Scenario& scenario, const ScenarioResult& one, const ScenarioResult& other,
                   const std::string& one_name, const std::string& other_name, const Comparison& comparison, bool colour);

}  // namespace s7200::tools
