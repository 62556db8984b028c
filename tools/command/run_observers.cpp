#include "tools/command/run_observers.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/command/exit_code.hpp"

namespace s7200::tools {

RunObservers::RunObservers(Rig& rig, const Observed& observed) {
  for (std::size_t plc = 0; plc < rig.plan().plcs.size(); ++plc) {
    PlcObservers& observers = observers_.emplace_back(rig.plan().plcs[plc].program, observed);
    observers.add_to(rig.sinks(plc));
    observers.begin(rig.plc(plc).cpu());
  }
}

CoverageOfPrograms RunObservers::coverage() const {
  CoverageOfPrograms coverage;
  for (const PlcObservers& each : observers_) each.report(coverage);
  return coverage;
}

nlohmann::ordered_json RunObservers::json(const CoverageOptions& options) const {
  nlohmann::ordered_json results = nlohmann::ordered_json::object();
  options.add_to(results, coverage());
  return results;
}

int RunObservers::show(const CoverageOptions& options, bool json, int exit_code) const {
  if (!options.wanted()) return exit_code;
  const CoverageOfPrograms all = coverage();
  if (!options.show(all, json)) return kUnusable;
  return options.is_enough(all) ? exit_code : std::max<int>(exit_code, kCheckFailed);
}

}  // namespace s7200::tools
