// What was done to a simulation from outside, as JSON: in saved sessions and in reports. It knows no files and throws
// nothing.
#pragma once

#include <nlohmann/json.hpp>

#include "interpreter/model/cpu_model.hpp"
#include "tools/json/json_taker.hpp"
#include "tools/session/past/actions/action.hpp"

namespace s7200::tools {

/// `{"send": "01 03 …", "format": [9600, 8, "none", 1], …}`
nlohmann::ordered_json json_of(const Action& action);

/// The action, of a PLC of that model; anything if the JSON is not one, and `taker` says what is wrong with it.
Action take_action(JsonTaker& taker, const nlohmann::ordered_json& json, const CpuModel& model);

}  // namespace s7200::tools
