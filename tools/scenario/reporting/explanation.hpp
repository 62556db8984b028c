// Why a scenario failed: a failed one is run again, with a past that can be asked.
#pragma once

#include <memory>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/program.hpp"
#include "tools/scenario/result.hpp"
#include "tools/scenario/scenario.hpp"

namespace s7200::tools {

/// Adds to the findings that are shown why an answer is missing or wrong, what it waited for if its latency is wrong, and
/// who wrote memory last; or that it came after what is written down of a run. Does nothing where the run has no recordings.
void explain(const Scenario& scenario, const std::shared_ptr<const Program>& program, StopToken stop,
             ScenarioResult& result);

}  // namespace s7200::tools
