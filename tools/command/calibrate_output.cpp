#include "tools/command/calibrate_output.hpp"

#include <algorithm>

#include "tools/views/results_json.hpp"

namespace s7200::tools {

nlohmann::ordered_json to_json(const CpuModel& model, const Measurement& measurement, const Fit& fit) {
  auto results = results_of("calibrate");
  results["cpu"] = model.name;
  results["identification"] = measurement.identification;
  results["loops"] = measurement.loops.size();
  results["contradiction_us"] = std::max(0.0, fit.contradiction) / 1000;
  results["found"] = nlohmann::ordered_json::array();
  for (const Fitted& each : fit.forms)
    if (each.found)
      results["found"].push_back({{"mnemonic", each.form.mnemonic},
                                  {"form", each.form.row->form},
                                  {"per_unit", each.form.per_unit},
                                  {"us", each.ns / 1000},
                                  {"within_us", each.within / 1000}});
  results["not_measured"] = not_measured(fit, model);
  return results;
}

}  // namespace s7200::tools
