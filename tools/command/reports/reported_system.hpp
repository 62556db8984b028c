// A system file with all that it names, read once more for a report.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/faces/page/engine/carried_system.hpp"
#include "tools/plan/system_plan.hpp"

namespace s7200::tools {

/// `plan`: as it is run. `spots`: where masters have joined it. Trouble if a file has gone meanwhile.
Result<std::shared_ptr<const page::CarriedSystem>> reported_system(const std::string& path, const SystemPlan& plan,
                                                                   std::vector<Spot> spots);

}  // namespace s7200::tools
