// Runs scenarios: on programs in simulation, or on any slave.
#pragma once

#include <functional>
#include <memory>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/program.hpp"
#include "tools/coverage/observed.hpp"
#include "tools/measuring/band.hpp"
#include "tools/scenario/result.hpp"
#include "tools/scenario/scenario.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// What a scenario is run on.
struct Bench {
  std::shared_ptr<const Program> program{};   ///< in simulation
  std::shared_ptr<const ProgramBand> band{};  ///< the program with other times too; null: with its own only
  Slave* slave = nullptr;                     ///< instead of a program; not owned
  SerialFormat format{};                      ///< of the slave's line
  /// Instead of both, makes a slave in simulation of which only the line is seen, powered up for this scenario; may be left
  /// out.
  std::function<std::unique_ptr<SlaveInSimulation>(const Scenario&)> make_slave{};
  bool exchanges_wanted = true;    ///< all of them are in the result
  Observed observed{};             ///< of programs in simulation
  bool recordings_wanted = false;  ///< of a run that found nothing, too
  /// Is told of each exchange when it is over, in the thread that runs the scenario, and the result has none; may be left
  /// out.
  std::function<void(const Seen&)> watch{};
  StopToken stop{};       ///< ends the run, which is skipped then
  std::string problem{};  ///< why there is neither; the scenario fails then
};

/// Runs a scenario to its end, findings or not; a slave that is lost is a finding and ends it. SlaveUnreachable passes
/// through. On a slave that is not a program, scenarios that act inside are skipped as a whole, steps that look inside by
/// themselves. Outside simulation, only upper limits of the latency are judged of times: the computer in between cannot be
/// trusted with more. A rule of which that leaves something unjudged is skipped too, unless it is broken already. With a
/// band it is one table's result, and a failure is one even where it is expected.
ScenarioResult run_scenario(const Scenario& scenario, const Bench& bench);

/// What is a known gap must fail.
void turn_if_expected_to_fail(const Scenario& scenario, ScenarioResult& result);

}  // namespace s7200::tools
