// What calibrate has found, for machines.
#pragma once

#include <nlohmann/json.hpp>

#include "interpreter/model/cpu_model.hpp"
#include "tools/calibration/fit.hpp"
#include "tools/calibration/measurement.hpp"

namespace s7200::tools {

nlohmann::ordered_json to_json(const CpuModel& model, const Measurement& measurement, const Fit& fit);

}  // namespace s7200::tools
