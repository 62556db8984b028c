#include "tools/command/running/run_observers.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/command/exit_code.hpp"

namespace s7200::tools {

RunObservers::RunObservers(Rig& rig, const RunOptions& options) {
  const Observed observed{.coverage = options.coverage.wanted(), .profile = options.profile.wanted()};
  for (std::size_t plc = 0; plc < rig.plan().plcs.size(); ++plc) {
    const PlcPlan& plan = rig.plan().plcs[plc];
    const std::string name = is_of_one_program(rig.plan()) ? "" : plan.name;
    PlcObservers& observers = observed_.emplace_back(ObservedPlc{name, PlcObservers(plan.program, observed)}).observers;
    observers.add_to(rig.sinks(plc));
    observers.begin(rig.plc(plc).cpu());
  }
}

CoverageOfPrograms RunObservers::coverage() const {
  CoverageOfPrograms coverage;
  for (const ObservedPlc& each : observed_) each.observers.report(coverage);
  return coverage;
}

ProfileOfPrograms RunObservers::profile() const {
  ProfileOfPrograms all;
  for (const ObservedPlc& each : observed_) each.observers.report(all, each.plc);
  return all;
}

nlohmann::ordered_json RunObservers::json(const RunOptions& options) const {
  nlohmann::ordered_json results = nlohmann::ordered_json::object();
  options.coverage.add_to(results, coverage());
  options.profile.add_to(results, profile());
  return results;
}

int RunObservers::show(const RunOptions& options, int exit_code) const {
  if (options.profile.wanted() && !options.profile.show(profile(), options.json)) return kUnusable;
  if (!options.coverage.wanted()) return exit_code;
  const CoverageOfPrograms all = coverage();
  if (!options.coverage.show(all, options.json)) return kUnusable;
  return options.coverage.is_enough(all) ? exit_code : std::max<int>(exit_code, kCheckFailed);
}

}  // namespace s7200::tools
