// The same traffic on two programs: where they differ first.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "tools/scenario/reporting/report.hpp"

namespace s7200::tools {

struct Comparison {
  bool timing = true;            ///< latencies count too
  Time tolerance = 0;            ///< by which they may differ
  bool one_after_other = false;  ///< the sides never run at the same time: they may be one and the same
  bool colour = false;           ///< of the text
};

/// What is shown of a scenario that went over two programs.
struct Difference {
  bool found = false;
  std::string text{};
};

/// A scenario that went over two slaves.
struct Compared {
  const Scenario* scenario = nullptr;
  std::string skipped{};  ///< why it was not compared; empty if it was
  std::size_t exchanges = 0;
  Difference difference{};
};

/// Who is told of each exchange when it is over.
using ExchangeListener = std::function<void(const Seen&)>;

/// One of both that are compared.
struct Side {
  std::string name;
  std::function<ScenarioResult(const ExchangeListener&)> run;  ///< throws as run_scenario() does
};

/// The first different answer, and the first different latency if it comes before. The sides run at the same time, and none
/// gets far ahead of the other: a long run needs no more memory than a short one.
Compared compare(const Scenario& scenario, const Side& one, const Side& other, const Comparison& comparison);

}  // namespace s7200::tools
