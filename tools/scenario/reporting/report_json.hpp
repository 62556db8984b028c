// How scenarios went, for machines. tools/JSON.md has the keys.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tools/scenario/reporting/report.hpp"

namespace s7200::tools {

/// Which scenario, or rule, it is: the keys before how it went.
nlohmann::ordered_json scenario_json(const Scenario& scenario);

nlohmann::ordered_json to_json(const std::vector<Report>& reports);

// Its parts, for who prints them as they come.

nlohmann::ordered_json exchange_json(const Scenario& scenario, const Seen& seen);
/// How a scenario went, without its exchanges.
nlohmann::ordered_json outcome_json(const Report& report);
/// How many scenarios went how.
nlohmann::ordered_json counts_json(const std::vector<Report>& reports);

}  // namespace s7200::tools
